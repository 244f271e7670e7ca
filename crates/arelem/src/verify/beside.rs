//! Parts of a surface beside a straight piece of the tool, as of a wall along which a flank lies.
//!
//! A twisted wall has no contact of its own with the tool there: it leads a little away along the flank, or nearer, all the way. So its
//! parts are held against a cylinder along the piece that holds the tool, from the place of each that is nearest at its end.

use apt_geometry::Vec3;

use super::{
    followed::{BALLS, Following},
    patch::jet,
    survey::Part,
    tool::Tool,
    trough::{Rise, is_within_of_line, nearest_piece},
};

/// Steps to the place that is nearest on a line of a part, the last of them, and the first, in parameters.
const STEPS: u32 = 8;
const LAST_STEP: f64 = 1e-9;
const FIRST_STEP: f64 = 1e-3;

/// The straight piece of the meridian nearest to a place, in the plane of that place and the axis.
struct Piece {
    /// Unit, from the tool end on.
    along: Vec3,
    /// Unit, across it out of the tool.
    outward: Vec3,
}

impl Piece {
    /// Beside a place, from the tool end. None for a tool without straight pieces.
    fn beside(tool: &Tool<'_>, place: &Vec3) -> Option<Self> {
        let (at, out) = tool.split(place);
        let (a, b) = nearest_piece(tool, at)?;
        let way = [b[0] - a[0], b[1] - a[1]];
        let length = way[0].hypot(way[1]);
        let [across, up] = way.map(|x| x / length);
        Some(Self { along: out * across + tool.axis * up, outward: out * up - tool.axis * across })
    }
}

impl Following<'_> {
    /// Whether a part is shown to be no nearer than `least` to a tool that has a straight piece beside it. Its own contact is, or would
    /// be, at such parameters.
    pub(super) fn is_beside_straight(&self, part: &Part, contact: [f64; 2], least: f64) -> bool {
        let Some((at, piece)) = self.nearest_at_end(part, contact) else { return false };
        let [place, by_u, by_v] = jet(&part.net, at);
        let towards = -piece.outward;
        let Some(rise) = Rise::of(&part.net, at, &towards) else { return false };
        let way = rise.way(&piece.along.cross(&piece.outward));
        // How far it comes nearer as its derivatives there say.
        let slopes = [towards.dot(&by_u), towards.dot(&by_v)];
        let level: f64 = (0..2).map(|k| (slopes[k] * (1.0 - at[k])).max(-slopes[k] * at[k])).sum();
        let widest = self.tool.profile.widest();
        let top = self.tool.axis.dot(&(part.center - self.tip)) + part.radius + least;
        // What of the tool is higher is farther from the part.
        let below = top.max(self.tool.profile.edges()[1][1]) + widest;
        let low = self.tool.profile.below(below);
        let low = self.tool.with(&low);
        let size = if widest > 0.0 { widest } else { part.radius };
        BALLS.into_iter().map(|k| k * size).any(|radius| {
            let over = level + rise.beyond((&way, 1.0 / radius), at);
            let narrower = radius * (radius - 2.0 * over);
            let center = place + towards * radius - self.tip;
            narrower > 0.0 && is_within_of_line(&low, &center, &piece.along, narrower.sqrt() - least)
        })
    }

    /// Parameters of the place of a part nearest to the straight piece of the tool beside it, on the side at which a contact is beyond it
    /// if there is just one; and that piece.
    fn nearest_at_end(&self, part: &Part, contact: [f64; 2]) -> Option<([f64; 2], Piece)> {
        let mut at = contact.map(|x| x.clamp(0.0, 1.0));
        let is_beyond = [0, 1].map(|k| at[k] != contact[k]);
        let piece = |at: [f64; 2]| Piece::beside(self.tool, &(jet(&part.net, at)[0] - self.tip));
        let free = match is_beyond {
            [true, false] => 1,
            [false, true] => 0,
            _ => return Some((at, piece(at)?)),
        };
        // How fast the way out of the tool grows along the side.
        let slope = |x: f64| -> Option<f64> {
            let mut there = at;
            there[free] = x;
            Some(piece(there)?.outward.dot(&jet(&part.net, there)[1 + free]))
        };
        let (mut x, mut last) =
            (at[free], if at[free] < 0.5 { at[free] + FIRST_STEP } else { at[free] - FIRST_STEP });
        let (mut here, mut before) = (slope(x)?, slope(last)?);
        for _ in 0..STEPS {
            let next = (x - here * (x - last) / (here - before)).clamp(0.0, 1.0);
            if !next.is_finite() {
                break;
            }
            (last, before) = (x, here);
            (x, here) = (next, slope(next)?);
            if (x - last).abs() <= LAST_STEP {
                break;
            }
        }
        at[free] = x;
        Some((at, piece(at)?))
    }
}
