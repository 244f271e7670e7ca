//! The tolerance band, steps along a pass and between passes.

use apt_geometry::regional::{FeedDirection, StepoverCondition, StepoverRule};

use super::{Job, station::Station};

/// Share of the band in which the tool is placed.
const BAND_USED: f64 = 0.45;
/// Share of the band that a chord uses.
const CHORD_SHARE: f64 = 0.9;
/// Sagitta, as a share of the band, below which a section is straight.
const STRAIGHT: f64 = 1e-6;
/// Share of the admissible step that is tried.
const CAUTION: f64 = 0.95;
/// Sine of the angle between normal and axis below which a tool cuts with its flat bottom.
const FLAT_SINE: f64 = 1e-6;
/// How often a step over is shortened so that it keeps its limit everywhere.
const MOST_CORRECTIONS: usize = 8;

/// INTOL and OUTTOL of the part surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Band {
    inside: f64,
    outside: f64,
}

impl Band {
    pub(super) fn new(inside: f64, outside: f64) -> Self {
        Self { inside, outside }
    }

    /// Length that chords may deviate in all.
    fn chord(&self) -> f64 {
        CHORD_SHARE * (self.inside + self.outside)
    }

    /// How far above the surface the tool is placed so that its chords use the band: towards the outer side where the
    /// path is convex, towards the inner side where it is concave.
    pub(super) fn offset(&self, curvature: f64, length: f64) -> f64 {
        let middle = 0.5 * (self.outside - self.inside);
        let range = BAND_USED * (self.outside + self.inside);
        if curvature.abs() * length * length / 8.0 <= STRAIGHT * (self.inside + self.outside) {
            middle
        } else if curvature < 0.0 {
            middle + range
        } else {
            middle - range
        }
    }

    /// The longest move of a ball of `radius` over a section of this curvature.
    pub(super) fn step(&self, curvature: f64, radius: f64, most: f64) -> f64 {
        if curvature == 0.0 {
            return most;
        }
        let surface = 1.0 / curvature.abs();
        let path = if curvature < 0.0 { surface + radius } else { (surface - radius).abs() };
        let tolerance = self.chord();
        if path <= tolerance {
            return most;
        }
        // The chord whose sagitta is the tolerance.
        let sagitta = tolerance * (2.0 * path - tolerance);
        (2.0 * sagitta.sqrt()).min(most)
    }
}

impl Job<'_> {
    pub(super) fn band(&self) -> Band {
        Band::new(self.setting.inside, self.setting.outside)
    }

    /// How far the ball centre may move from one station to the next: from the curvatures at both and from those of the
    /// chord.
    pub(super) fn greatest_move(&self, last: &Station, next: &Station, stock: f64) -> f64 {
        let chord = next.contact.at.position - last.contact.at.position;
        let square = chord.norm_squared();
        let mut curvatures = vec![last.curvature, next.curvature];
        if square > 0.0 {
            curvatures.push(2.0 * last.contact.normal.dot(&chord) / square);
            curvatures.push(-2.0 * next.contact.normal.dot(&chord) / square);
        }
        let radius = self.tool.corner_radius() + stock;
        let most = self.setting.maximum_step;
        curvatures.iter().map(|&k| self.band().step(k, radius, most)).fold(most, f64::min)
    }

    /// The move that is tried from a station.
    pub(super) fn intended_move(&self, station: &Station, stock: f64) -> f64 {
        let radius = self.tool.corner_radius() + stock;
        CAUTION * self.band().step(station.curvature, radius, self.setting.maximum_step)
    }

    /// The step of the parameter across from one pass to the next: the least that any of its locations asks for.
    pub(super) fn stepover(
        &self,
        pass: &[Station],
        condition: &StepoverCondition,
        direction: FeedDirection,
        sign: f64,
        room: f64,
    ) -> f64 {
        let interval = |station: &Station| match condition.rule() {
            StepoverRule::Parameter(_) => None,
            StepoverRule::Distance(distance) => Some(distance),
            StepoverRule::Scallop { height, limit } => {
                Some(self.scallop_interval(station, height).min(limit.unwrap_or(f64::INFINITY)))
            }
        };
        if let StepoverRule::Parameter(step) = condition.rule() {
            return step.min(room);
        }
        let slope = |station: &Station| station.contact.normal.dot(&station.guide.projection).abs();
        // On the guide a step appears shortened by the slope of the part against the projection.
        let on_guide = |station: &Station| {
            let factor = if self.part_is_guide { 1.0 } else { slope(station) };
            interval(station).map(|length| length * factor)
        };
        let first = pass.iter().filter_map(|station| {
            let pace = station.guide.across.norm();
            on_guide(station).filter(|_| pace > 0.0).map(|length| length / pace)
        });
        let mut step = first.fold(room, f64::min);
        for _ in 0..MOST_CORRECTIONS {
            let excess = pass.iter().filter_map(|station| {
                let length = on_guide(station)?;
                let mut parameters = station.parameters;
                let across = match direction {
                    FeedDirection::Spline => &mut parameters[1],
                    FeedDirection::CrossSpline => &mut parameters[0],
                };
                *across += sign * step;
                let there = self.guide.at(parameters, direction).ok()?;
                Some((there.position - station.guide.position).norm() / length)
            });
            let worst = excess.fold(0.0, f64::max);
            if worst <= 1.0 {
                break;
            }
            step /= worst * (1.0 + f64::EPSILON);
        }
        step
    }

    /// The distance of two passes on the surface that leaves scallops of this height (sculptured surfaces reference 4.4),
    /// not more than the diameter of the tool.
    fn scallop_interval(&self, station: &Station, height: f64) -> f64 {
        let along = station.contact.normal.dot(&station.pose.axis);
        let sine = (1.0 - along * along).max(0.0).sqrt();
        let widest = 2.0 * (self.tool.corner_offset() + self.tool.corner_radius());
        let offset = self.tool.corner_offset();
        if offset > 0.0 && sine <= FLAT_SINE {
            return widest;
        }
        let radius = self.tool.corner_radius() + if offset > 0.0 { offset / sine } else { 0.0 };
        let across = station.contact.curvature().along(&station.guide.sideways);
        scallop_interval(radius, height, across).min(widest)
    }
}

/// The distance on a section of this curvature (positive concave) of two passes of a ball that leave a scallop.
fn scallop_interval(radius: f64, height: f64, curvature: f64) -> f64 {
    let height = height.min(radius);
    let plain = 2.0 * (2.0 * radius * height - height * height).max(0.0).sqrt();
    if (curvature * radius).abs() <= STRAIGHT {
        return plain;
    }
    let surface = 1.0 / curvature.abs();
    let (r, h) = if curvature < 0.0 { (radius, height) } else { (-radius, -height) };
    let (center, crest) = (surface + r, surface + h);
    if center <= 0.0 || crest <= 0.0 {
        return plain;
    }
    let cosine = (center * center + crest * crest - r * r) / (2.0 * center * crest);
    2.0 * surface * cosine.clamp(-1.0, 1.0).acos()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(found: f64, expected: f64) {
        assert!((found - expected).abs() < 1e-6, "found {found}, expected {expected}");
    }

    #[test]
    fn steps_are_those_of_the_reference() {
        // tol = 0.02 of the reference is nine tenths of the band here.
        let band = Band::new(0.5 * 0.02 / CHORD_SHARE, 0.5 * 0.02 / CHORD_SHARE);
        near(band.step(-1.0 / 40.0, 5.0, 10.0), 2.682983);
        near(band.step(1.0 / 40.0, 5.0, 10.0), 2.366094);
        near(band.step(0.0, 5.0, 10.0), 10.0);
        near(band.step(0.2, 5.0, 10.0), 10.0);
        // What rounding leaves of a straight section does not stop the tool.
        near(band.step(1e-17, 5.0, 10.0), 10.0);
    }

    #[test]
    fn scallops_are_those_of_the_reference() {
        near(scallop_interval(5.0, 0.02, 0.0), 0.893532);
        near(scallop_interval(5.0, 0.02, -1.0 / 30.0), 0.826981);
        near(scallop_interval(5.0, 0.02, 1.0 / 30.0), 0.979153);
    }

    #[test]
    fn the_tool_stands_where_its_chords_use_the_band() {
        let band = Band::new(0.002, 0.002);
        near(band.offset(-0.1, 1.0), 0.0018);
        near(band.offset(0.1, 1.0), -0.0018);
        near(band.offset(0.0, 1.0), 0.0);
        near(Band::new(0.0, 0.001).offset(0.1, 1.0), 0.00005);
    }
}
