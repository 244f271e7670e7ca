//! How the distance bends beside a straight piece of the tool that lies nearly along the surface, as a flank does beside the rulings of
//! a ruled surface: much less along the piece than across it.
//!
//! Where all forms S of the surface about are at most `μ I + b (I − t tᵀ)`, so are `S (1 − d S)⁻¹` at a distance d with
//! `μ/(1 − d μ)` along t and `(μ + b)/(1 − d (μ + b))` across it, for that grows with S.
//!
//! Which places are about: where distances d > 0 bend downward by no more than `B`, nearest places do not jump, for a lesser one of two distances is
//! bent without bound where they meet; and `I − d H` with `−B ≤ H ≤ 1/d`, which takes moves of a place to those of its nearest one, makes none
//! longer than `1 + d B` times.

use apt_geometry::{
    Vec3,
    surface::{LENGTHWISE, Lengthwise, Surface},
};

use super::{
    Tool,
    certify::Face,
    floor::{Base, Course, Straight},
    patch::{Patch, Stretch},
};

/// Shares of the bend that are tried for that along the piece.
const SHARES: [f64; LENGTHWISE] = [0.0, 1.0 / 512.0, 1.0 / 128.0, 1.0 / 32.0, 1.0 / 8.0, 1.0 / 4.0];
/// How many times the bend in all directions that across the piece may be: the less is let along it, the more is needed across.
const MOST_ACROSS: f64 = 2.0;
/// Least share of its length that a piece counts with.
const LEAST_LENGTH: f64 = 1.0 / 64.0;

impl Course {
    /// About a straight piece along a unit direction in the tangent plane, with its middle at a base within reach of which distances bend by
    /// no more than `bend` in any direction.
    pub(super) fn nearly_straight(
        face: Face<'_>,
        tool: &Tool<'_>,
        along: &Vec3,
        base: &Base,
        [reach, bend]: [f64; 2],
    ) -> Option<Self> {
        let Face { surface, side } = face;
        let stock = surface.stock(side);
        let distance = base.distance + stock;
        // No foot of a place within reach is farther from the place, nor, where all of these are outside, from its foot.
        let (feet, beside) = (distance.abs() + 2.0 * reach, reach * (1.0 + (distance + reach) * bend));
        let (center, within) = if distance > reach && beside < feet {
            (base.place - base.gradient * distance, beside)
        } else {
            (base.place, feet)
        };
        let asked = Lengthwise {
            along: *along,
            least: SHARES.map(|share| share * bend),
            enough: bend,
            most: MOST_ACROSS * bend,
        };
        let (least, across) = surface.curvature_across(side, &center, within, asked, tool.patience)?;
        let deepest = (distance + reach).max(0.0);
        let [least, most] = [least, least + across].map(|curvature| curvature / (1.0 - deepest * curvature));
        let is_bounded = deepest * (least + across) < 1.0;
        let straight = Some(Straight { along: *along, spared: most - least });
        is_bounded.then_some(Self { bend: most, straight })
    }

    /// How much distances bend along a unit direction.
    pub(super) fn bend_along(&self, way: &Vec3) -> f64 {
        let spared = self.straight.map_or(0.0, |straight| straight.spared * straight.along.dot(way).powi(2));
        self.bend - spared
    }

    /// How long a piece along the straight direction is beside one across, for how the distance bends.
    pub(super) fn share_of_length(&self) -> f64 {
        let spared = self.straight.map_or(0.0, |straight| straight.spared);
        (1.0 - spared / self.bend).max(0.0).sqrt().max(LEAST_LENGTH)
    }
}

/// The direction of a straight piece in the middle of a patch, in the tangent plane of a surface.
pub(super) fn direction(tool: &Tool, patch: &Patch, normal: &Vec3) -> Option<Vec3> {
    let Stretch::Line([a, b]) = patch.stretch else { return None };
    let (sin, cos) = patch.azimuth.sin_cos();
    let radial = tool.across[0] * cos + tool.across[1] * sin;
    let way = tool.axis * (b[1] - a[1]) + radial * (b[0] - a[0]);
    (way - normal * normal.dot(&way)).try_normalize(0.0)
}

/// Whether surfaces of a kind may lie along a straight piece without a common direction of all their lines.
pub(super) fn is_apt(surface: &Surface) -> bool {
    surface.has_charts() && surface.generator().is_none()
}

#[cfg(test)]
mod tests {
    use apt_geometry::{
        cutter::Cutter,
        surface::{Bend, Region},
    };

    use super::{super::patch::flank_between, *};
    use crate::{tests::v, verify::tests::lofts};

    /// No place of a stretch of the flank beside surfaces of nearly straight lines is nearer than its bound, which is higher for a long
    /// stretch than that by the bend in all directions.
    #[test]
    fn no_place_of_a_flank_is_nearer_than_its_bound() {
        let cutter = Cutter::from_numbers(&[0.5], 1.0).expect("a cutter");
        let (mut seen, mut closer) = (0, 0);
        for geometry in [lofts::roof(), lofts::vault()] {
            let surface = Surface::from_geometry(&geometry).expect("a surface");
            let side = surface.foot(&v(0.0, 0.0, 9.0)).distance.signum();
            for k in 0..40 {
                let axis = v(0.2 - 0.01 * f64::from(k), 1.0, 0.05).normalize();
                let tool = Tool::new(cutter, axis);
                let foot = surface.foot(&v(-0.8 + 0.04 * f64::from(k), 0.0, 4.0));
                let tip = foot.point + foot.normal * (side * 0.27) - axis * 1.0;
                let radial = tool.split(&-(foot.normal * side)).2;
                let azimuth = radial.dot(&tool.across[1]).atan2(radial.dot(&tool.across[0]));
                let patch = Patch { azimuth, half: 0.02, ..flank_between(&tool, [0.9, 1.1]) };
                let middle = patch.middle(&tool, &tip, None);
                let base = Base::at(&surface, side, middle.place);
                let (reach, distance) = (middle.reach, base.distance);
                let region = Region {
                    center: base.place,
                    radius: reach,
                    lowest: -distance - reach,
                    highest: reach - distance,
                };
                let Bend::AtMost(bend) =
                    surface.bend(-side, &surface.foot(&base.place), &region, tool.patience)
                else {
                    continue;
                };
                let face = Face { surface: &surface, side };
                let along = direction(&tool, &patch, &base.gradient).expect("a direction");
                let Some(course) = Course::nearly_straight(face, &tool, &along, &base, [reach, bend]) else {
                    continue;
                };
                let least = patch.least(&tool, &tip, &base, course);
                let plain = patch.least(&tool, &tip, &base, Course::along_generator(bend, None));
                seen += 1;
                closer += u32::from(least > plain);
                for (i, j) in (0..=8).flat_map(|i| (0..=8).map(move |j| (i, j))) {
                    let (sin, cos) = (azimuth + 0.02 * (f64::from(i) / 4.0 - 1.0)).sin_cos();
                    let aside = tool.across[0] * cos + tool.across[1] * sin;
                    let place = tip + aside * tool.radius() + axis * (0.9 + 0.025 * f64::from(j));
                    let distance = side * surface.signed_distance(&place);
                    assert!(distance >= least - 1e-12, "{distance} under {least}");
                }
            }
        }
        assert!(seen >= 30 && closer >= 20, "{seen} stretches, {closer} closer");
    }
}
