//! Vertices that can be spared. Every vector is made as long as it can be from where it begins, without regard to what follows: where the
//! path bends the other way, turns in a corner or comes to its end a short vector is left between two long ones. If one vertex in place
//! of the two at its ends sees both the vertex before and the one beyond, the motion needs a vector less.

use apt_geometry::Vec3;

use super::{March, TANGENT_SINE, Vertex};
use crate::{
    clearance::Shape,
    directed::stop::Watcher,
    error::MotionFailure,
    role::{Bend, Working},
};

/// Share of the lesser of the vectors beside it below which a vector is short: where a path bends evenly more or less, vectors as long as
/// they can be do not differ so much.
const SHORT: f64 = 0.6;
/// Places on a short vector next to which the one vertex is looked for, as shares of it.
const PLACES: [f64; 3] = [0.5, 0.0, 1.0];
/// By how much of the vector to the next one a vertex beside them is moved onward, or back by that of the vector to it.
const MOVED: f64 = 0.1;
/// Cosine between a vector and the one in its place below which that leads another way (60°).
const LEAST_ONWARD: f64 = 0.5;
/// Share of MAXDP that its length may be above it by rounding.
const ROUNDING: f64 = 1e-9;
/// Sine between two vectors below which their lines do not tell where they meet.
const LEAST_SINE: f64 = 1e-6;

/// Where a vertex may lie.
struct Choice {
    /// Where it has been, one of them or in the middle of two.
    old: Vec3,
    /// What it has been.
    were: Vec<Vertex>,
    /// Places for it, and whether no way to the end of the search is known not to lead on from there.
    places: Vec<(Vertex, bool)>,
}

/// Vertices beside each other, one of which is to take the place of two.
struct Stretch {
    choices: Vec<Choice>,
    /// On which hand the path keeps both surfaces all along it.
    hand: Option<f64>,
}

impl Stretch {
    fn of(choices: Vec<Choice>) -> Self {
        let old: Vec<&Vertex> = choices.iter().flat_map(|choice| &choice.were).collect();
        let mut signs = old.windows(2).flat_map(|pair| {
            let way = pair[1].tip - pair[0].tip;
            [pair[0], pair[1]].map(|vertex| hand_of(vertex, &way))
        });
        let first = signs.next().flatten();
        let is_one = signs.all(|sign| sign == first);
        Self { hand: first.filter(|_| is_one), choices }
    }
}

/// True if a vector leads onward along the path at both its ends, as far as the hand tells. In a bend much tighter than the bands are wide a vector
/// against the path keeps them as well, and differs from the one in whose place it would be by less than a right angle.
pub(super) fn is_onward(hand: Option<f64>, from: &Vertex, to: &Vertex) -> bool {
    let way = to.tip - from.tip;
    hand.is_none() || [from, to].into_iter().all(|vertex| hand_of(vertex, &way) == hand)
}

impl March<'_> {
    /// Spares one of two vertices wherever a short vector is between them, beginning with the first. The vertices beside both may move.
    pub(super) fn spare_vertices(&mut self, start: &Vertex) -> Result<(), MotionFailure> {
        // Of several positions on a check surface each counts as the vectors have met it.
        if self.prepared.attitude.turns() || self.watcher.met > 0 {
            return Ok(());
        }
        let before = self.tangency.has_any().then(|| self.points.clone());
        self.spare_all(start)?;
        let Some(before) = before.filter(|before| *before != self.points) else { return Ok(()) };
        // So does each tangency.
        let along = |points: &[Vec3]| -> Vec<Vec3> {
            std::iter::once(start.tip).chain(points.iter().copied()).collect()
        };
        if !self.met_along(&along(&self.points))?.is_as(&self.met_along(&along(&before))?) {
            self.points = before;
        }
        Ok(())
    }

    /// The same, whatever is met along the vectors.
    fn spare_all(&mut self, start: &Vertex) -> Result<(), MotionFailure> {
        let mut k = 1;
        while k + 1 < self.points.len() {
            let is_short = {
                let length = |k: usize| (self.at(start, k + 1) - self.at(start, k)).norm();
                length(k) < SHORT * length(k - 1).min(length(k + 1))
            };
            if is_short && let Some((first, places)) = self.one_for_two(start, k)? {
                let replaced = first..first + places.len() + 1;
                self.points.splice(replaced, places);
                // A vector before it may have become a short one.
                k = k.saturating_sub(1).max(1);
                continue;
            }
            k += 1;
        }
        Ok(())
    }

    /// A vertex by its number, that of the start being zero.
    pub(super) fn at(&self, start: &Vertex, k: usize) -> Vec3 {
        k.checked_sub(1).map_or(start.tip, |k| self.points[k])
    }

    /// Places for one vertex instead of two and for those beside them, and the index of the first point that gives way; one more of them
    /// does than there are places. The vector from vertex `k` is short.
    fn one_for_two(&self, start: &Vertex, k: usize) -> Result<Option<(usize, Vec<Vec3>)>, MotionFailure> {
        let last = self.points.len();
        let (first, end) = (k.saturating_sub(2), (k + 3).min(last));
        let mut choices = Vec::new();
        for k in (first..k).chain(k + 2..=end) {
            choices.push(if k == first || k == end {
                let beside = self.at(start, if k == first { k + 1 } else { k - 1 });
                let way = if k == first { beside - self.at(start, k) } else { self.at(start, k) - beside };
                let vertex = Vertex::at(self.prepared, self.at(start, k), &way)?;
                Choice { old: vertex.tip, were: vec![vertex], places: vec![(vertex, true)] }
            } else {
                self.beside(&[k - 1, k, k + 1].map(|k| self.at(start, k)))?
            });
        }
        let four = [k - 1, k, k + 1, k + 2].map(|k| self.at(start, k));
        choices.insert(k - first, self.between(&four)?);
        let mut found = Vec::new();
        let mut stretch = Stretch::of(choices);
        if !self.leads_through(&mut stretch, (0, 0), &mut found) {
            return Ok(None);
        }
        found.reverse();
        let vertices: Vec<Vertex> =
            stretch.choices.iter().zip(&found).map(|(choice, k)| choice.places[*k].0).collect();
        let inner = || vertices[1..vertices.len() - 1].iter().map(|vertex| vertex.tip).collect();
        Ok(self.meets_nothing(&vertices).then(|| (first, inner())))
    }

    /// Whether vectors lead through one place of each choice, from a place of one of them on; the places, the last one first.
    fn leads_through(
        &self,
        stretch: &mut Stretch,
        (level, k): (usize, usize),
        found: &mut Vec<usize>,
    ) -> bool {
        let choices = &mut stretch.choices;
        if level + 1 == choices.len() {
            found.push(k);
            return true;
        }
        choices[level].places[k].1 = false;
        let (from, old) = (choices[level].places[k].0, choices[level + 1].old - choices[level].old);
        let most = self.state.maximum_step * (1.0 + ROUNDING);
        for next in 0..choices[level + 1].places.len() {
            let (to, may_lead_on) = stretch.choices[level + 1].places[next];
            let way = to.tip - from.tip;
            let leads = may_lead_on
                && way.norm() <= most
                && way.dot(&old) > LEAST_ONWARD * way.norm() * old.norm()
                && is_onward(stretch.hand, &from, &to)
                && self.stepper.proven(&from, &to);
            if leads && self.leads_through(stretch, (level + 1, next), found) {
                found.push(k);
                return true;
            }
        }
        false
    }

    /// Places for a vertex between two others: where it is, and the limits of the bands there, a little back and a little onward.
    fn beside(&self, [before, here, beyond]: &[Vec3; 3]) -> Result<Choice, MotionFailure> {
        let sense = beyond - before;
        let vertex = Vertex::at(self.prepared, *here, &sense)?;
        let about = [*here, here + (before - here) * MOVED, here + (beyond - here) * MOVED];
        let mut places = vec![(vertex, true)];
        places.extend(self.at_limits(&about, &sense).map(|vertex| (vertex, true)));
        Ok(Choice { old: *here, were: vec![vertex], places })
    }

    /// Places for one vertex instead of the two in the middle: where the lines of the vectors to the first and from the other are nearest
    /// to each other, and the limits of the bands next to the vector between them.
    fn between(&self, [a, b, c, d]: &[Vec3; 4]) -> Result<Choice, MotionFailure> {
        let sense = c - b;
        let mut vertices = Vec::new();
        for place in [meeting(a, b, c, d), Some(*b), Some(*c)].into_iter().flatten() {
            vertices.push(Vertex::at(self.prepared, place, &sense)?);
        }
        let were = vertices[vertices.len() - 2..].to_vec();
        let mut places: Vec<_> = vertices.into_iter().map(|vertex| (vertex, true)).collect();
        let about = PLACES.map(|share| b + sense * share);
        places.extend(self.at_limits(&about, &sense).map(|vertex| (vertex, true)));
        Ok(Choice { old: 0.5 * (b + c), were, places })
    }

    /// The positions at the limits of the bands next to places.
    fn at_limits<'b>(&'b self, about: &'b [Vec3], sense: &'b Vec3) -> impl Iterator<Item = Vertex> + 'b {
        let [part, drive] = [&self.prepared.part, &self.prepared.drive].map(limits);
        let clearances: Vec<[f64; 2]> =
            part.iter().flat_map(|part| drive.iter().map(move |drive| [*part, *drive])).collect();
        about.iter().flat_map(move |place| {
            let settled = |at: &[f64; 2]| Vertex::settled_at(self.prepared, *at, place, sense);
            clearances.iter().filter_map(settled).collect::<Vec<_>>()
        })
    }

    /// Whether no check surface is met along vectors, the last of which may be that to the end.
    fn meets_nothing(&self, vertices: &[Vertex]) -> bool {
        let mut watcher = Watcher::new(self.prepared, self.checks);
        vertices.windows(2).all(|pair| {
            let is_last = self.points.last() == Some(&pair[1].tip);
            is_last || watcher.scan(&pair[0].sweep(self.prepared, &pair[1])).is_none()
        })
    }
}

/// The sign of part gradient × drive gradient · way at a vertex: along an edge of what the tool may reach it stays. None where both surfaces are
/// tangent, or the way is straight across the path.
pub(super) fn hand_of(vertex: &Vertex, way: &Vec3) -> Option<f64> {
    let across = vertex.part.gradient.cross(&vertex.drive.gradient).try_normalize(TANGENT_SINE)?;
    Some(across.dot(way)).filter(|along| *along != 0.0).map(f64::signum)
}

/// The middle of the shortest way between the lines of two vectors, if they are not parallel.
fn meeting(a: &Vec3, b: &Vec3, c: &Vec3, d: &Vec3) -> Option<Vec3> {
    let before = (b - a).try_normalize(0.0)?;
    let beyond = (d - c).try_normalize(0.0)?;
    let (way, cosine) = (c - b, before.dot(&beyond));
    let square_of_sine = 1.0 - cosine * cosine;
    if square_of_sine < LEAST_SINE * LEAST_SINE {
        return None;
    }
    let (along_before, along_beyond) = (way.dot(&before), way.dot(&beyond));
    let onward = (along_before - cosine * along_beyond) / square_of_sine;
    let back = (along_beyond - cosine * along_before) / square_of_sine;
    Some(0.5 * (b + before * onward + c - beyond * back))
}

/// The clearances at which vertices lie.
fn limits(role: &Working) -> Vec<f64> {
    match role.shape {
        Shape::Flat => vec![0.0],
        Shape::Convex => vec![role.vertex(Bend::Convex)],
        Shape::Concave => vec![role.vertex(Bend::Concave)],
        Shape::General => vec![role.vertex(Bend::Convex), role.vertex(Bend::Concave)],
    }
}
