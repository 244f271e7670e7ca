//! FEDRAT with a distance: another feed rate from so far before a check surface (language reference 8.3).

use apt_cldata::record::{ClKind, ClWord};
use apt_geometry::canonical::Cylinder;
use arelem::sequence::{CutSequence, ToolPosition};
use smol_str::SmolStr;

use super::{Section2, code};

/// Share of a cut vector below which a place on it is its end.
const SAME_PLACE: f64 = 1e-9;

/// A feed rate from so far before a check surface.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Approach {
    /// Length of path before the end of the motion.
    distance: f64,
    /// The feed rate there.
    feed: f64,
}

/// The feed rates that FEDRAT has given.
#[derive(Debug, Default)]
pub(super) struct Feeds {
    /// What the last FEDRAT says that gives a feed rate for everything: its operands.
    basic: Option<Vec<ClWord>>,
    /// `FEDRAT/basic,distance,feed`: before every check surface, until another basic feed rate.
    always: Option<Approach>,
    /// `FEDRAT/distance,feed`: before the next check surface.
    once: Option<Approach>,
}

impl Feeds {
    /// Takes a FEDRAT. Gives the operands of its record; none where it waits for a check surface. With a word among them it
    /// speaks of units, and with one number or more than three it is as it stands.
    pub(super) fn state(&mut self, arguments: Vec<ClWord>) -> Option<Vec<ClWord>> {
        use ClWord::Number;
        match *arguments.as_slice() {
            [Number(distance), Number(feed)] => {
                self.once = Some(Approach { distance, feed });
                return None;
            }
            [Number(basic), Number(distance), Number(feed)] => {
                self.always = Some(Approach { distance, feed });
                self.basic = Some(vec![Number(basic)]);
            }
            _ => {
                self.always = None;
                self.basic = Some(arguments);
            }
        }
        self.basic.clone()
    }

    /// The feed rate before the check surface of the motion that comes now.
    fn approach(&mut self) -> Option<Approach> {
        self.once.take().or(self.always)
    }
}

impl Section2<'_> {
    /// A FEDRAT in the records.
    pub(super) fn feed(&mut self, isn: u32, source: u32, arguments: Vec<ClWord>) {
        self.push(isn, source, feed_record(arguments));
    }

    /// The positions of a directed motion, in two pieces where its end has a feed rate of its own. The circle that it
    /// follows stands before each of them.
    pub(super) fn directed(
        &mut self,
        isn: u32,
        source: u32,
        name: &str,
        sequence: &CutSequence,
        circle: Option<&Cylinder>,
    ) {
        let Some(Approach { distance, feed }) = self.feeds.approach() else {
            return self.piece(isn, source, name, &sequence.points, circle);
        };
        let path: Vec<ToolPosition> = self.tool.into_iter().chain(sequence.points.iter().copied()).collect();
        let (far, near) = parted(&path, distance, circle);
        self.piece(isn, source, name, &far, circle);
        if self.output_on && !near.is_empty() {
            self.feed(isn, source, vec![ClWord::Number(feed)]);
        }
        self.piece(isn, source, name, &near, circle);
        if let (true, false, Some(basic)) = (self.output_on, near.is_empty(), self.feeds.basic.clone()) {
            self.feed(isn, source, basic);
        }
    }

    fn piece(
        &mut self,
        isn: u32,
        source: u32,
        name: &str,
        points: &[ToolPosition],
        circle: Option<&Cylinder>,
    ) {
        if let (Some(circle), false) = (circle, points.is_empty()) {
            let kind = ClKind::Arc {
                surface: SmolStr::new(name),
                center: circle.point,
                axis: circle.axis,
                radius: circle.radius,
            };
            self.push(isn, source, kind);
        }
        self.positions(isn, source, false, name, points);
    }
}

/// FEDRAT with these operands.
fn feed_record(arguments: Vec<ClWord>) -> ClKind {
    ClKind::Postprocessor { word: SmolStr::new_static("FEDRAT"), code: Some(code::FEDRAT), arguments }
}

/// The positions after the first one of a path, up to where so much of it is left, and the others. The place between them
/// is a position of its own, the last one of the first piece.
fn parted(
    path: &[ToolPosition],
    distance: f64,
    circle: Option<&Cylinder>,
) -> (Vec<ToolPosition>, Vec<ToolPosition>) {
    let mut left = distance.max(0.0);
    for (index, pair) in path.windows(2).enumerate().rev() {
        let [from, to] = pair else { continue };
        let length = (to.tip - from.tip).norm();
        if left >= length * (1.0 - SAME_PLACE) {
            left = (left - length).max(0.0);
            continue;
        }
        // The piece that is left ends with `to`, or begins behind it.
        let (mut far, near) = (path[1..=index].to_vec(), path[index + 1..].to_vec());
        if left <= length * SAME_PLACE {
            far.push(*to);
            return (far, near[1..].to_vec());
        }
        far.push(between(from, to, 1.0 - left / length, circle));
        return (far, near);
    }
    (Vec::new(), path.get(1..).unwrap_or_default().to_vec())
}

/// A position between two others: the tool end on the straight line or, where both are equally far from the axis of the
/// circle that is followed, on the arc; the axis turns evenly.
fn between(from: &ToolPosition, to: &ToolPosition, share: f64, circle: Option<&Cylinder>) -> ToolPosition {
    let mut tip = from.tip.lerp(&to.tip, share);
    if let Some(circle) = circle {
        let across = |tip: apt_geometry::Vec3| {
            let out = tip - circle.point;
            out - circle.axis * out.dot(&circle.axis)
        };
        let (first, last, here) = (across(from.tip), across(to.tip), across(tip));
        let radius = first.norm();
        if (last.norm() - radius).abs() <= SAME_PLACE * radius && here.norm() > 0.0 {
            tip += here * (radius / here.norm() - 1.0);
        }
    }
    ToolPosition { tip, axis: from.axis.slerp(&to.axis, share) }
}
