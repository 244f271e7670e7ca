//! What of a surface of patches is near a tool: one survey serves until the tool has moved by its margin.

use std::cell::{Cell, RefCell};

use apt_geometry::Vec3;

use super::{
    clearance::Reading,
    followed::Following,
    patch::{Bends, Net, Patch, ball, extent, halves_across, halves_along, jet},
    span::Bend,
    strip,
    tool::{Profile, Tool},
};

/// Parts of a survey; where there are more the general search is asked.
const PARTS: usize = 6_000;
/// Product of size and curvature above which a part is halved.
const BENT: f64 = 0.25;
/// Size below which a part is not halved: in radii of the tool, and for a tool without body relative to the surface.
const SMALLEST_RADII: f64 = 0.25;
const SMALLEST: f64 = 0.01;
/// Greatest size of a part, in radii of the tool.
const PART_RADII: f64 = 2.0;
/// Margin of a survey: in radii of the tool, and for a tool without body relative to the surface.
const MARGIN_RADII: f64 = 1.0;
const POINT_MARGIN: f64 = 0.05;
/// How coarse the first search is, relative to the margin.
const COARSE: f64 = 0.1;

/// A surface in patches, with what was seen of it last.
#[derive(Debug, Clone)]
pub(super) struct Sheet {
    pub(super) patches: Vec<Patch>,
    /// Whether it ends at both sides of all patches, across.
    ends_across: bool,
    /// For tools with a body, and for points.
    near: RefCell<[Option<Near>; 2]>,
}

/// A part of a patch.
#[derive(Debug, Clone)]
pub(super) struct Part {
    pub(super) net: Net,
    pub(super) center: Vec3,
    pub(super) radius: f64,
    pub(super) bends: Option<Bends>,
    /// Curvature that the surface may have more.
    pub(super) slack: f64,
    pub(super) against: bool,
    pub(super) sharp: bool,
    /// The way of the tool at which it may come as near as that way: its distance is at least this less the way so far.
    pub(super) far: Cell<f64>,
}

/// All parts near a tool in one position.
#[derive(Debug, Clone)]
struct Near {
    profile: Profile,
    tip: Vec3,
    axis: Vec3,
    /// Where the tool was last, and its way until then.
    here: [Vec3; 2],
    way: f64,
    /// How far the tool may move until there may be others.
    margin: f64,
    /// No other part was nearer.
    bound: f64,
    /// Empty where there are too many.
    parts: Vec<Part>,
    /// The contact found last.
    last: Option<(usize, [f64; 2])>,
}

impl Sheet {
    pub(super) fn new(patches: Vec<Patch>, ends_across: bool) -> Self {
        Self { patches, ends_across, near: RefCell::new([None, None]) }
    }

    /// The parts nearer to the tool than `bound`. None where there are too many.
    fn survey(&self, tip: &Vec3, tool: &Tool<'_>, bound: f64, size: f64) -> Option<Vec<Part>> {
        let widest = tool.profile.widest();
        let [smallest, greatest] = if widest > 0.0 {
            [SMALLEST_RADII * widest, PART_RADII * widest]
        } else {
            [SMALLEST * size, f64::INFINITY]
        };
        let half = 0.5 * tool.profile.top_height();
        let middle = tip + tool.axis * half;
        let girth = half.hypot(widest);
        let mut parts = Vec::new();
        let mut open: Vec<(Net, [bool; 2])> = Vec::new();
        for patch in &self.patches {
            if patch.remoteness(&middle) - patch.girth - girth > bound {
                continue;
            }
            open.push((patch.net, [self.ends_across; 2]));
            while let Some((net, ends)) = open.pop() {
                let (center, radius) = ball(&net);
                let far = tool.signed_distance(&(center - tip)).0 - radius;
                if far > bound {
                    continue;
                }
                let far = Cell::new(far);
                let bends = if radius > greatest { None } else { Bends::of(&net) };
                let is_flat = bends.is_some_and(|b| b.hollow[0].max(b.hollow[1]) * radius <= BENT);
                if radius > smallest && !is_flat {
                    let [along, across] = extent(&net);
                    if along >= across {
                        open.extend(halves_along(&net).map(|half| (half, ends)));
                    } else {
                        let [first, last] = halves_across(&net);
                        open.extend([(first, [ends[0], false]), (last, [false, ends[1]])]);
                    }
                } else if parts.len() >= PARTS {
                    return None;
                } else {
                    let sharp = patch.sharp || ends[0] || ends[1];
                    let (slack, against) = (patch.slack, patch.against);
                    parts.push(Part { net, center, radius, bends, slack, against, sharp, far });
                }
            }
        }
        Some(parts)
    }

    /// The clearance on a side, to within `tolerance`, where balls show it.
    pub(super) fn at(
        &self,
        side: f64,
        tip: &Vec3,
        tool: &Tool<'_>,
        size: f64,
        tolerance: f64,
    ) -> Option<Reading> {
        let slot = usize::from(tool.profile.is_point());
        let mut near = self.take(slot, tip, tool, size)?;
        let found =
            Following { sheet: self, parts: &near.parts, way: near.way, side, tip, tool, size, tolerance }
                .reading(&mut near.last);
        self.near.borrow_mut()[slot] = Some(near);
        found
    }

    /// What is near the tool, from before or seen now.
    fn take(&self, slot: usize, tip: &Vec3, tool: &Tool<'_>, size: f64) -> Option<Near> {
        let known = self.near.borrow_mut()[slot].take().filter(|near| near.profile == *tool.profile);
        let moved = known.as_ref().map_or(f64::INFINITY, |near| near.moved(tip, tool));
        let known = match known {
            Some(mut near) if moved <= near.margin => {
                near.way += near.since(tip, tool);
                near.here = [*tip, tool.axis];
                return Some(near);
            }
            other => other,
        };
        let widest = tool.profile.widest();
        let margin = if widest > 0.0 { MARGIN_RADII * widest } else { POINT_MARGIN * size };
        // The contact of before is a bound for now, unless the tool went far.
        let before = known.filter(|near| moved <= 4.0 * near.margin).and_then(|near| {
            let (k, at) = near.last?;
            Some(jet(&near.parts.get(k)?.net, at.map(|x| x.clamp(0.0, 1.0)))[0])
        });
        let upper = match before {
            Some(place) => tool.signed_distance(&(place - tip)).0,
            None => strip::nearest(&self.patches, tip, tool, COARSE * margin, 0.0)?.value,
        };
        let bound = upper.max(0.0) + 2.0 * margin;
        let parts = self.survey(tip, tool, bound, size).unwrap_or_default();
        let last = before.and_then(|place| {
            let apart = |part: &Part| (part.center - place).norm() / part.radius;
            nearest_by(&parts, apart).map(|k| (k, [0.5; 2]))
        });
        Some(Near {
            profile: tool.profile.clone(),
            tip: *tip,
            axis: tool.axis,
            here: [*tip, tool.axis],
            way: 0.0,
            margin,
            bound,
            parts,
            last,
        })
    }

    /// How the slope of the clearance on a side can grow where the tool and all of it move no farther than `travel` from a
    /// position; None where that is not known. The clearances at the ends are without thickness.
    pub(super) fn bend(
        &self,
        side: f64,
        tip: &Vec3,
        tool: &Tool<'_>,
        values: [f64; 2],
        travel: f64,
        size: f64,
    ) -> Option<Bend> {
        let [first, last] = values;
        let depth = (0.5 * travel - first.min(last)).max(0.0);
        // No contact on the way is farther from where the tool was.
        let reach = first.abs().max(last.abs()) + 1.5 * travel;
        let slot = usize::from(tool.profile.is_point());
        let near = self.near.borrow();
        let known = near[slot].as_ref().filter(|near| {
            near.profile == *tool.profile
                && !near.parts.is_empty()
                && near.moved(tip, tool) + reach <= near.bound
        });
        let seen;
        let parts = match known {
            Some(near) => &near.parts,
            None => {
                seen = self.survey(tip, tool, reach, size)?;
                &seen
            }
        };
        let mut rate: f64 = 0.0;
        for part in parts {
            if tool.signed_distance(&(part.center - tip)).0 - part.radius > reach {
                continue;
            }
            if part.sharp {
                return None;
            }
            // Behind the surface.
            let behind = usize::from((side > 0.0) != part.against);
            rate = rate.max(part.bends?.hollow[behind] + part.slack);
        }
        Bend::over(rate, depth)
    }
}

impl Near {
    /// No place of the tool is farther from where it was.
    fn moved(&self, tip: &Vec3, tool: &Tool<'_>) -> f64 {
        (tip - self.tip).norm() + (tool.axis - self.axis).norm() * tool.profile.reach()
    }

    /// The same from where it was last.
    fn since(&self, tip: &Vec3, tool: &Tool<'_>) -> f64 {
        let [last, axis] = self.here;
        (tip - last).norm() + (tool.axis - axis).norm() * tool.profile.reach()
    }
}

/// The part that is nearest by some measure.
pub(super) fn nearest_by(parts: &[Part], apart: impl Fn(&Part) -> f64) -> Option<usize> {
    let all = parts.iter().map(apart).enumerate();
    all.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(k, _)| k)
}

impl Part {
    /// About its place nearest to a point.
    pub(super) fn near(&self, x: &Vec3) -> Vec3 {
        let mut at = [0.5; 2];
        let mut place = self.center;
        for _ in 0..2 {
            let [here, along, across] = jet(&self.net, at);
            let from = x - here;
            let (a, b, c) = (along.norm_squared(), along.dot(&across), across.norm_squared());
            let (p, q) = (along.dot(&from), across.dot(&from));
            let area = a * c - b * b;
            if area <= 0.0 {
                return place;
            }
            at = [at[0] + (c * p - b * q) / area, at[1] + (a * q - b * p) / area].map(|t| t.clamp(0.0, 1.0));
            place = jet(&self.net, at)[0];
        }
        place
    }

    /// Curvature of the balls on a side of the surface that hold no place of the part.
    pub(super) fn hollow(&self, side: f64) -> Option<f64> {
        self.bends.map(|b| b.hollow[usize::from(self.sense(side) < 0.0)])
    }

    /// The side of the surface as one of along × across.
    pub(super) fn sense(&self, side: f64) -> f64 {
        if self.against { -side } else { side }
    }
}
