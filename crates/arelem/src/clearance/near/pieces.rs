//! Which piece of the tool a contact is on, and which one to look at instead.

use apt_geometry::Vec3;

use super::{Circle, Pose, Start, Touch};
use crate::clearance::{
    Contact,
    search::FAN_SLACK,
    tool::{Curve, Piece},
    waves::length,
};

/// Sine of the angle with a slanted piece that counts as none.
const LEVEL: f64 = 1e-7;
/// Share of the length of a slanted piece from its end within which a contact counts as one on the edge there.
const NEAR_END: f64 = 1e-6;
/// Share of its length from the end that it is seen from where contact on a slanted piece is looked for at first.
const FROM_END: f64 = 0.25;

impl Pose<'_> {
    pub(super) fn circle(&self, piece: Option<usize>) -> Option<Circle> {
        let Some(piece) = piece else { return Some(Circle::POINT) };
        match self.tool.pieces.get(piece)? {
            &Piece::Ring { radius, height, ball, .. } => Some(Circle { radius, height, ball }),
            _ => None,
        }
    }

    /// The circle of the tool, or the corner of a barrel, that a surface with a normal touches first, and how far along that.
    pub(super) fn piece_towards(&self, gradient: &Vec3) -> Option<(usize, f64)> {
        let profile = &self.tool.profile;
        let (along, across, _) = self.tool.split(gradient);
        let polar = across.atan2(along);
        let point = profile.support(across, -along).1;
        let [first, last] = profile.fan;
        if profile.arc > 0.0 && polar >= first && polar <= last {
            return Some((self.corner()?, ((polar - first) / (last - first)).clamp(0.0, 1.0)));
        }
        Some((self.edge(point.radius, point.height)?, 0.0))
    }

    /// The corner of the tool, if it is round.
    fn corner(&self) -> Option<usize> {
        let is_corner =
            |piece: &Piece| matches!(piece, Piece::Ring { fan: Some(_), .. } | Piece::Bulge { .. });
        self.tool.pieces.iter().position(is_corner)
    }

    /// The edge of the tool with a radius and a height.
    fn edge(&self, radius: f64, height: f64) -> Option<usize> {
        self.tool.pieces.iter().position(|piece| match piece {
            Piece::Ring { radius: r, height: h, fan: None, .. } => *r == radius && *h == height,
            _ => false,
        })
    }

    /// Azimuth of the side of the tool that faces a surface with a normal.
    pub(super) fn facing(&self, gradient: &Vec3) -> [f64; 2] {
        let flat = self.tool.across.map(|across| -gradient.dot(&across));
        let size = length(flat);
        if size > 0.0 { flat.map(|x| x / size) } else { [1.0, 0.0] }
    }

    /// Where to begin from a contact that was found otherwise.
    pub(super) fn start_at(&self, contact: &Contact) -> Option<Start> {
        let Contact { gradient, tool, .. } = contact;
        let direction = self.facing(gradient);
        let (along, ..) = self.tool.split(&(tool - self.tip));
        let on_slant = self.slants().find_map(|(piece, curve)| {
            let Curve::Line { height, .. } = curve else { return None };
            let rise = (along - height[0]) / (height[1] - height[0]);
            let inside = rise > NEAR_END && rise < 1.0 - NEAR_END;
            inside.then_some((piece, rise))
        });
        let (piece, rise, ball) = match on_slant {
            Some((piece, rise)) => (piece, rise, 0.0),
            None => {
                let (piece, rise) = self.piece_towards(gradient)?;
                (piece, rise, self.circle(Some(piece)).map_or(0.0, |circle| circle.ball))
            }
        };
        let place = self.surface.place(&(tool + gradient * ball))?;
        Some(Start { piece: Some(piece), direction, rise, place })
    }

    /// The slanted pieces of the tool, and the corner of a barrel, by their number.
    fn slants(&self) -> impl Iterator<Item = (usize, Curve)> {
        self.tool.pieces.iter().enumerate().filter_map(|(k, piece)| Some((k, piece.curve()?)))
    }

    /// Both ends of a slanted piece, or of the corner of a barrel, as the edges there have them.
    fn ends_of(&self, curve: &Curve) -> [[f64; 2]; 2] {
        match *curve {
            Curve::Line { radius: [r, q], height: [h, g] } => [[r, h], [q, g]],
            Curve::Arc { .. } => {
                [self.tool.profile.lower, self.tool.profile.upper].map(|end| [end.radius, end.height])
            }
        }
    }

    /// The slanted piece along which the distance falls from a contact on the edge at its end, and from which side to look at
    /// it.
    fn slant_beyond(&self, touch: &Touch) -> Option<(usize, f64)> {
        let at = |[radius, height]: [f64; 2]| touch.circle.radius == radius && touch.circle.height == height;
        let gradient = &touch.contact.gradient;
        let [c, s] = if touch.circle.radius > 0.0 { touch.start.direction } else { self.facing(gradient) };
        let radial = self.tool.across[0] * c + self.tool.across[1] * s;
        self.slants().find_map(|(piece, curve)| {
            let ends = self.ends_of(&curve);
            let (sense, rise, end) = if at(ends[0]) {
                (1.0, FROM_END, 0.0)
            } else if at(ends[1]) {
                (-1.0, 1.0 - FROM_END, 1.0)
            } else {
                return None;
            };
            let [wider, higher] = curve.at(end).way;
            let way = (radial * wider + self.tool.axis * higher) * sense;
            (way.dot(gradient) < -LEVEL * way.norm()).then_some((piece, rise))
        })
    }

    /// Whether a contact is one of the tool: the corner has it within its fan, a flat bottom and slanted pieces inside; and no way
    /// from an edge along a slanted piece leads down.
    pub(super) fn is_apt(&self, touch: &Touch) -> bool {
        match touch.start.piece.and_then(|piece| self.tool.pieces.get(piece)) {
            Some(Piece::Ring { radius, fan, .. }) => {
                let polar = touch.contact.gradient.dot(&self.tool.axis).clamp(-1.0, 1.0).acos();
                (*radius <= 0.0 || self.faces(touch))
                    && fan.is_none_or(|[least, greatest]| {
                        polar >= least - FAN_SLACK && polar <= greatest + FAN_SLACK
                    })
                    && (fan.is_some() || self.slant_beyond(touch).is_none())
            }
            Some(Piece::Disc { radius }) => length(touch.start.direction) <= *radius,
            Some(Piece::Frustum { .. } | Piece::Bulge { .. }) => {
                (0.0..=1.0).contains(&touch.start.rise) && self.faces(touch)
            }
            None => true,
        }
    }

    /// Whether a contact is at least that of a point of the tool.
    pub(super) fn is_of_tool(&self, touch: &Touch) -> bool {
        touch.circle.ball <= 0.0 && self.circle(touch.start.piece).is_some()
    }

    /// Whether a point of a circle is on the side of the tool that faces the surface.
    fn faces(&self, touch: &Touch) -> bool {
        let outward = touch.center - self.tip;
        let shares = self.tool.across.map(|a| a.dot(&outward) * a.dot(&touch.contact.gradient));
        shares[0] + shares[1] <= 0.0
    }

    /// Where to look instead of a piece of the tool that has no contact.
    pub(super) fn instead(&self, start: &Start, found: Option<&Touch>) -> Option<Start> {
        let pieces = &self.tool.pieces;
        let lower = self.tool.profile.lower;
        let last = found.map_or(*start, |found| found.start);
        if let Some(curve) = pieces.get(start.piece?)?.curve() {
            // Where the distance bends downward along it contact is at the other end.
            let end = usize::from(found.map_or(start.rise < 0.5, |found| found.start.rise >= 0.5));
            let [radius, height] = self.ends_of(&curve)[end];
            let piece = self.edge(radius, height);
            return Some(Start { piece: Some(piece?), ..last });
        }
        if let Some((piece, rise)) = found.and_then(|found| self.slant_beyond(found)) {
            let direction = found.map_or(last.direction, |found| match found.circle.radius > 0.0 {
                true => last.direction,
                false => self.facing(&found.contact.gradient),
            });
            return Some(Start { piece: Some(piece), direction, rise, ..last });
        }
        if let Piece::Disc { .. } = pieces.get(start.piece?)? {
            let reach = length(last.direction);
            // The corner of a barrel is not begun on from the bottom: it has its edge there.
            let round = self.tool.profile.arc > 0.0 && !self.tool.profile.is_barrel();
            let piece = if round { self.corner() } else { self.edge(lower.radius, lower.height) };
            return (reach > 0.0).then(|| Start {
                piece,
                direction: last.direction.map(|x| x / reach),
                ..last
            });
        }
        match found {
            Some(found) if self.faces(found) => {
                let gradient = &found.contact.gradient;
                let (piece, rise) = self.piece_towards(gradient)?;
                Some(Start { piece: Some(piece), direction: self.facing(gradient), rise, ..last })
            }
            _ => {
                let disc = pieces.iter().position(|piece| matches!(piece, Piece::Disc { .. }))?;
                Some(Start { piece: Some(disc), direction: last.direction.map(|x| x * lower.radius), ..last })
            }
        }
    }
}
