//! What the contact near by tells about other points and about moves of the tool.

use std::sync::Arc;

use apt_geometry::{Vec3, surface::Foot};

use super::{
    Far, Pose, Start, Zone,
    trough::{Acrosses, Bends, Grounds},
};
use crate::clearance::{Contact, Gauge, Tool, memory::Memory};

/// What is known about a contact in a steady ball.
#[derive(Clone)]
struct Known {
    start: Start,
    surface: Vec3,
    zone: Zone,
    far: Option<Far>,
    bends: Option<Arc<Bends>>,
    across: Acrosses,
}

/// What is known about a tool and a surface, for questions about points near by.
pub(in crate::clearance) struct Around<'a> {
    pose: Pose<'a>,
    memory: &'a Memory,
    known: Option<Known>,
}

impl<'a> Around<'a> {
    pub(in crate::clearance) fn new(gauge: &'a Gauge, tool: &'a Tool, tip: &'a Vec3, spread: f64) -> Self {
        let Gauge { side, memory, .. } = gauge;
        let pose = Pose { tool, surface: gauge.met(tool), side: *side, tip };
        let known = memory.near.try_borrow().ok().and_then(|near| {
            let (contacts, near) = (&near, near.at(&pose, spread)?);
            let zone = *near.zone.as_ref().ok()?;
            let bends = near.bends.as_ref().ok().cloned();
            Some(Known {
                start: near.start,
                surface: near.surface,
                zone,
                far: contacts.far(&pose, zone.top),
                bends,
                across: near.across,
            })
        });
        Self { pose, memory, known }
    }

    /// The foot of a point, if that is known to be the only one.
    pub(in crate::clearance) fn foot(&self, p: &Vec3) -> Option<Foot> {
        let Known { start, zone, .. } = *self.known.as_ref()?;
        let found = Pose { tip: p, ..self.pose }.touch(&Start { piece: None, ..start })?;
        let Contact { clearance, gradient, surface, .. } = found.contact;
        let inside = |q: &Vec3| (q - zone.center).norm() <= zone.radius;
        let steady = clearance <= zone.depth && clearance >= -zone.steady.beyond;
        let known = inside(p) && inside(&surface) && steady;
        let side = self.pose.side;
        known.then_some(Foot { distance: side * clearance, point: surface, normal: gradient * side })
    }

    /// A bound of the second derivatives of the distances of all points of the tool that are not farther than `range[1]` while
    /// no point strays farther than `spread` from its place and none comes nearer than `range[0]`.
    pub(in crate::clearance) fn upward_bend(&self, spread: f64, range: [f64; 2]) -> Option<f64> {
        let Known { start, surface, zone, .. } = self.known.as_ref()?;
        start.piece?;
        let (whole, level) = (zone.top >= self.pose.tool.profile.top.height, range[1] + spread);
        let alone = self.pose.stays_in(zone, surface, spread)
            && (whole || self.top(level).is_some() || self.pose.is_off(zone.top, level));
        alone.then(|| zone.steady.upward_bend(range[0])).flatten()
    }

    /// Whether the clearance is nowhere below a level while the tool end moves straight from one position to another, by the
    /// contact in one of them.
    pub(in crate::clearance) fn keeps(&self, contact: &Contact, way: [&Vec3; 2], level: f64) -> bool {
        let Some(Known { start: Start { piece: Some(_), .. }, zone, far, bends, across, .. }) = &self.known
        else {
            return false;
        };
        let Tool { axis, profile, .. } = self.pose.tool;
        let polar = contact.gradient.dot(axis).clamp(-1.0, 1.0).acos();
        let on_corner = profile.arc > 0.0 && polar >= profile.fan[0] && polar <= profile.fan[1];
        let ball = if on_corner { profile.arc } else { 0.0 };
        let kept = |tip: &Vec3| {
            let pose = Pose { tip, ..self.pose };
            let flank = zone.top >= profile.top.height || far.is_some_and(|far| far.left(&pose) >= level);
            flank && pose.stays_in(zone, &contact.surface, 0.0) && pose.flank_keeps(contact, zone, level)
        };
        let by_ball = |tip: &Vec3| Pose { tip, ..self.pose }.bottom_keeps(contact, ball, zone, level);
        let by_cylinder = || {
            let bends = bends.as_ref().filter(|_| profile.lower.height > 0.0);
            let grounds = Grounds { steady: zone.steady, level, stray: (way[1] - way[0]).norm() };
            let mut across = *across;
            let kept = bends.is_some_and(|bends| {
                way.into_iter().all(|tip| {
                    let pose = Pose { tip, ..self.pose };
                    let trough = bends
                        .trough(&pose, contact, &grounds, &mut across)
                        .filter(|_| bends.hold(&pose, contact, &grounds));
                    trough.is_some_and(|trough| pose.bottom_lies_in(&trough, contact, level))
                })
            });
            if let (Some(bends), Ok(mut near)) = (bends, self.memory.near.try_borrow_mut()) {
                near.learn(bends, across);
            }
            kept
        };
        contact.clearance + ball >= -zone.steady.beyond
            && way.into_iter().all(kept)
            && (way.into_iter().all(by_ball) || by_cylinder())
    }

    /// A height above which the flank is known to be farther from the surface than a level.
    pub(in crate::clearance) fn top(&self, level: f64) -> Option<f64> {
        let far = self.known.as_ref()?.far?;
        (far.left(&self.pose) >= level).then_some(far.from)
    }
}
