//! Contacts at the edges of a surface: where one touches the tool before any other place does, and how a tool that is behind the surface
//! comes out past its end.

use super::{Best, Search};
use crate::clearance::{Contact, crease::Beside};

/// Clearance, in radii of the tool, below which an edge near the contact may be nearer than that.
const ABOUT: f64 = 0.05;

/// How an edge of the surface is the contact.
pub(super) enum Taken {
    /// It is not.
    Not,
    /// The tool touches it, but the surface elsewhere as well.
    AsOneOfTwo,
    /// No other place that was found is nearer.
    AsNearest,
    /// The tool comes out past the end there, which is shown.
    AsFreed,
}

impl Search<'_> {
    /// Whether the contact is at an edge of the surface, no place of which is nearer to the tool by more than a slack; the contact is
    /// then exactly there.
    pub(super) fn is_on_crease(&mut self, slack: f64) -> bool {
        let Some(touch) = self.touch_of_crease() else { return false };
        match self.takes_crease(touch, slack) {
            Taken::AsNearest => self.beside().clears(&touch, self.best.value - slack),
            Taken::AsOneOfTwo => {
                let level = self.best.value - slack;
                self.best.contact.is_some_and(|contact| self.beside().clears(&contact, level))
            }
            Taken::AsFreed => true,
            Taken::Not => false,
        }
    }

    /// The tool beside the surface.
    pub(super) fn beside(&self) -> Beside<'_> {
        let Self { tool, surface, side, tip, .. } = *self;
        Beside { tool, surface, side, tip }
    }

    /// Where an edge of the surface next to the contact touches the tool.
    pub(super) fn touch_of_crease(&self) -> Option<Contact> {
        let (contact, beside) = (self.best.contact?, self.beside());
        // In the surface the edge may be deeper in the tool than any point of the tool is under the surface; next to it distances of
        // points have valleys on both sides of it.
        if self.best.value < ABOUT * self.tool.radius() {
            beside.nearest_beside(&contact.surface)
        } else {
            beside.spot(&contact.surface).and_then(|spot| Some(beside.touch(&spot)?.1))
        }
    }

    /// Takes where an edge touches the tool for the contact, if it is.
    pub(super) fn takes_crease(&mut self, touch: Contact, slack: f64) -> Taken {
        // A straight piece that lies along the surface as far as the edge touches it before that as well: that is where it is guided.
        let away = self.best.contact.map_or(0.0, |contact| (touch.surface - contact.surface).norm());
        if away > ABOUT * self.tool.radius() && (touch.clearance - self.best.value).abs() <= slack {
            return Taken::AsOneOfTwo;
        }
        if let Some(behind) = self.behind_end(touch, slack) {
            self.best = Best { value: behind.clearance, contact: Some(behind), piece: self.best.piece };
            return Taken::AsFreed;
        }
        if touch.clearance <= self.best.value + slack {
            self.best.take(self.best.piece, touch.clearance, || touch);
            return Taken::AsNearest;
        }
        // What of the tool is behind the surface by more comes out past the end by less.
        match self.freed(touch, slack).filter(|out| out.clearance >= self.best.value - slack) {
            Some(out) => {
                self.best = Best { value: out.clearance, contact: Some(out), piece: self.best.piece };
                Taken::AsFreed
            }
            None => Taken::Not,
        }
    }

    /// The way out of the surface past its end, where that touches the tool, if the tool is clear then.
    fn freed(&self, touch: Contact, slack: f64) -> Option<Contact> {
        let out = self.beside().leading_off(touch).filter(|out| out.clearance < 0.0)?;
        let is_freed =
            self.surface.edge_at(&out.surface).is_some() && self.beside().clears(&out, out.clearance - slack);
        is_freed.then_some(out)
    }

    /// For a line that passes the end of the surface behind it, deeper there than any place of it is that has been found, that contact, if
    /// it is shown: on the other side of the end distances of the line's places tell nothing of how deep it is.
    fn behind_end(&self, touch: Contact, slack: f64) -> Option<Contact> {
        if self.tool.radius() > 0.0 || self.best.value >= 0.0 {
            return None;
        }
        let is_deeper = |out: &Contact| out.clearance < self.best.value - slack;
        let out = self.freed(touch, slack).filter(is_deeper)?;
        (!self.beside().has_shorter_way(&out, slack)).then_some(out)
    }

    /// Takes the way past the end of the surface for a line in it whose depth is not shown: just before the end places of the line are as
    /// deep as anywhere, and beyond it nothing is.
    pub(super) fn takes_way_past_end(&mut self, slack: f64) -> bool {
        let is_line_in = self.tool.radius() <= 0.0 && self.best.value < 0.0;
        let touch = if is_line_in { self.touch_of_crease() } else { None };
        let Some(out) = touch.and_then(|touch| self.freed(touch, slack)) else { return false };
        self.best = Best { value: out.clearance, contact: Some(out), piece: self.best.piece };
        true
    }
}
