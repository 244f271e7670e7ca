//! How fast an axis turns that follows its law: the rules by which it is made of normals, differentiated, with the second derivatives of the
//! distances from both surfaces.

use apt_geometry::Vec3;
use nalgebra::Matrix3;

use super::{Law, Mode, SAME_DIRECTION, Standing, Touched, touched};
use crate::clearance::Tool;

/// Derivatives of a vector by two others, by their components as columns.
#[derive(Debug, Clone, Copy)]
struct Rates {
    first: Matrix3<f64>,
    second: Matrix3<f64>,
}

impl Rates {
    fn map(&self, by: &Matrix3<f64>) -> Self {
        Self { first: by * self.first, second: by * self.second }
    }
}

/// The unit vector along another one, and its derivatives by that.
fn unit(vector: &Vec3) -> Option<(Vec3, Matrix3<f64>)> {
    let length = vector.norm();
    (length > SAME_DIRECTION).then(|| {
        let unit = vector / length;
        (unit, (Matrix3::identity() - unit * unit.transpose()) / length)
    })
}

fn times(factor: f64) -> Matrix3<f64> {
    Matrix3::from_diagonal_element(factor)
}

impl Law {
    /// Derivatives of the axis by the coordinates of the tool end, as columns, for a tool that stands with its end there; `None` where
    /// they have no closed form.
    ///
    /// With the normal n at the place p(tip, axis, n), its derivatives N by that place, the other normal m and its derivatives M:
    /// dn = N·(dtip + p_axis·daxis + p_n·dn) and daxis = a_n·dn + a_m·M·dtip, two linear equations for dn and daxis.
    pub(crate) fn rate(&self, tool: &Tool, tip: &Vec3, standing: &Standing) -> Option<Matrix3<f64>> {
        let Standing { axis, base: (normal, bend), other } = standing;
        match self.mode {
            Mode::Normal => return Some(*bend),
            Mode::Parallel { .. } => return None,
            Mode::Fan { from, about, angle, line, .. } => {
                let (sin, cos) = (angle * self.share_of_fan(tip)?).sin_cos();
                let turning = (about.cross(&from) * cos - from * sin) * angle;
                return Some(turning * line.transpose());
            }
            _ => {}
        }
        let by_normals = self.turning(normal, other.as_ref().map(|(normal, _)| normal))?;
        let by_other = other.map_or_else(Matrix3::zeros, |(_, bend)| by_normals.second * bend);
        let moved = self.moving(tool, axis, normal)?;
        let settling = Matrix3::identity() - bend * (moved.second + moved.first * by_normals.first);
        let normal_rate = settling.try_inverse()? * bend * (Matrix3::identity() + moved.first * by_other);
        let rate = by_normals.first * normal_rate + by_other;
        rate.iter().all(|x| x.is_finite()).then_some(rate)
    }

    /// Where Newton's method leads a normal that is not that at the contact, from what it is led to by the law and how that bends.
    pub(super) fn foretold(
        &self,
        tool: &Tool,
        (from, to, bend): (&Vec3, &Vec3, &Matrix3<f64>),
        (axis, other): (&Vec3, Option<&Vec3>),
    ) -> Option<Vec3> {
        let moved = self.moving(tool, axis, from)?;
        let led = bend * (moved.second + moved.first * self.turning(from, other)?.first);
        let step = (Matrix3::identity() - led).try_inverse()? * (to - from);
        (from + step).try_normalize(SAME_DIRECTION)
    }

    /// Derivatives of the axis by the normal and by that of the other surface.
    fn turning(&self, normal: &Vec3, other: Option<&Vec3>) -> Option<Rates> {
        let alone = |first: Matrix3<f64>| Rates { first, second: Matrix3::zeros() };
        Some(match self.mode {
            Mode::Tangent { vector: Some(vector), sense, .. } => {
                let (_, along) = unit(&normal.cross(&vector))?;
                alone(along * vector.cross_matrix() * -sense)
            }
            Mode::Tangent { vector: None, sense, .. } => {
                let [_, aside] = frame_rates(normal, other?)?;
                aside.map(&times(sense))
            }
            Mode::Tilted { cosine, sine } => {
                let [_, aside] = frame_rates(normal, other?)?;
                Rates { first: times(cosine) + aside.first * sine, second: aside.second * sine }
            }
            Mode::Across { vector, cosine, sine, .. } => {
                let flat = Matrix3::identity() - vector * vector.transpose();
                let (_, along) = unit(&(flat * normal))?;
                alone((times(cosine) + vector.cross_matrix() * sine) * along * flat)
            }
            Mode::Lead { along, ahead, aside, sense } => {
                let [tangent, across] = frame_rates(normal, other?)?;
                let sum = |tangent, across| tangent * (ahead * sense) + across * aside;
                Rates {
                    first: times(along) + sum(tangent.first, across.first),
                    second: sum(tangent.second, across.second),
                }
            }
            Mode::Normal | Mode::Parallel { .. } | Mode::Fan { .. } => return None,
        })
    }

    /// Derivatives of the place where the normal is taken by the axis and by the normal.
    fn moving(&self, tool: &Tool, axis: &Vec3, normal: &Vec3) -> Option<Rates> {
        let upward = |height: f64| Rates { first: times(height), second: Matrix3::zeros() };
        if let Mode::Tangent { height, .. } = self.mode {
            return Some(upward(height));
        }
        let Touched { circle: center, arc } = touched(tool, axis, normal);
        if center.radius == 0.0 && arc <= 0.0 {
            return Some(upward(center.height));
        }
        let along = normal.dot(axis);
        let (_, radial) = unit(&(normal - axis * along))?;
        let by_axis = -(axis * normal.transpose() + times(along));
        let by_normal = Matrix3::identity() - axis * axis.transpose();
        Some(Rates {
            first: times(center.height) - radial * by_axis * center.radius,
            second: radial * by_normal * -center.radius - times(arc),
        })
    }
}

/// Derivatives of the two vectors of [`frame`](super::frame), along the line of motion and towards the other normal, by both normals.
fn frame_rates(normal: &Vec3, other: &Vec3) -> Option<[Rates; 2]> {
    let (tangent, along) = unit(&normal.cross(other))?;
    let tangent_rates = Rates { first: -along * other.cross_matrix(), second: along * normal.cross_matrix() };
    let carried = tangent_rates.map(&-normal.cross_matrix());
    let aside = Rates { first: carried.first + tangent.cross_matrix(), second: carried.second };
    Some([tangent_rates, aside])
}

#[cfg(test)]
mod tests {
    use apt_geometry::{canonical::Geometry, cutter::Cutter, surface::Surface};

    use super::super::{Directed, NORMALS};
    use super::*;
    use crate::{
        attitude::Attitude,
        tests::{cone, cylinder, plane, sphere, v},
        verify::tests::lofts,
    };

    /// What differences leave of nearest points that are searched for, relative.
    const NOISE: f64 = 1e-5;
    /// Most normals that an axis and its derivatives may take, where differences take seven times those of an axis.
    const MOST_NORMALS: u64 = 9;
    /// The same for a lens, for which what a search leaves open of a normal counts by the radius of its arc.
    const MOST_NORMALS_OF_LENS: u64 = 30;

    const BULL: Cutter = Cutter {
        diameter: 0.6,
        corner_radius: 0.1,
        corner_offset: 0.2,
        corner_height: 0.1,
        alpha: 0.0,
        beta: 0.0,
        height: 2.0,
    };

    /// A lens that touches with its arc, whose centre is beyond the axis.
    const LENS: Cutter = Cutter {
        diameter: 1.0,
        corner_radius: 2.0,
        corner_offset: -0.1,
        corner_height: 1.98,
        alpha: 0.0,
        beta: 0.0,
        height: 2.5,
    };

    fn directed(geometry: &Geometry) -> Directed {
        let surface = Surface::from_geometry(geometry).expect("a surface");
        Directed { surface, sign: 1.0, lift: Vec3::zeros() }
    }

    /// Every law that stands on normals, for a tool beside the surfaces.
    fn modes() -> [Mode; 7] {
        let vector = v(0.3, 1.0, -0.2).normalize();
        let (sine, cosine) = 0.2f64.sin_cos();
        let (ahead, aside) = (0.1, (sine * sine - 0.01f64).sqrt());
        [
            Mode::Normal,
            Mode::Tilted { cosine, sine },
            Mode::Across { vector, cosine, sine, leads: None },
            Mode::Lead { along: cosine, ahead, aside, sense: -1.0 },
            Mode::Tangent { height: 0.7, vector: None, sense: 1.0 },
            Mode::Tangent { height: 0.4, vector: Some(vector), sense: -1.0 },
            Mode::Fan {
                from: Vec3::z(),
                about: Vec3::x(),
                angle: 0.8,
                origin: v(0.0, -1.0, 0.0),
                line: v(0.1, 0.3, 0.0),
            },
        ]
    }

    fn surfaces() -> Vec<Geometry> {
        vec![
            sphere(0.2, 0.1, -4.0, 5.0),
            cylinder(v(0.0, 0.0, -2.0), v(0.1, 1.0, 0.0), 3.0),
            cone(v(0.0, -9.0, 1.0), v(0.0, 1.0, -0.2), 25.0),
            lofts::roof(),
            lofts::vault(),
        ]
    }

    #[test]
    fn an_axis_turns_as_fast_as_differences_tell() {
        let other = plane(1.0, 0.3, 0.2, -3.0);
        for (surface, cutter) in
            surfaces().into_iter().flat_map(|surface| [(surface.clone(), BULL), (surface, LENS)])
        {
            for mode in modes() {
                let law = Law { base: directed(&surface), other: Some(directed(&other)), mode };
                let tool = Tool::new(cutter, Vec3::z());
                let attitude = Attitude::following(&tool, law.clone());
                for tip in [v(0.3, 0.2, 3.4), v(-0.4, -0.5, 3.0)] {
                    let before = NORMALS.get();
                    let standing = law.standing(&tool, &tip).expect("an axis");
                    let rate = law.rate(&tool, &tip, &standing).expect("a rate");
                    let normals = NORMALS.get() - before;
                    let told = attitude.rate_by_differences(&law, &tip).expect("differences");
                    let (off, size) = ((rate - told).norm(), 1.0 + told.norm());
                    assert!(off < NOISE * size, "{surface:?} {mode:?} {tip}: {rate} and {told}");
                    let most = if cutter == LENS { MOST_NORMALS_OF_LENS } else { MOST_NORMALS };
                    assert!(normals <= most, "{surface:?} {mode:?} {tip}: {normals} normals");
                }
            }
        }
    }
}
