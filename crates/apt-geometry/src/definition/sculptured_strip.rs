//! One segment of a lofted surface as columns of bicubic patches.

use nalgebra::Vector4;

use super::sculptured_loft::{Rim, Ties};
use crate::{
    Vec3,
    parametric::{ArcPoint, CurveArc, Flow, Patch, SegmentMeasure, SpaceCurve},
};

/// How far a column of patches may be from the exact surface, as a share of the size of the surface.
const CLOSE: f64 = 2e-8;
/// Halvings of a column before it is taken as it is.
const MOST_HALVINGS: u32 = 8;
/// Places in a column where it is compared with the exact surface.
const PROBES: [f64; 3] = [0.25, 0.5, 0.75];
/// Difference of weights, as a share, up to which two arcs are joined by exact rulings.
const SAME_WEIGHT: f64 = 1e-12;
/// Difference of parameters that are the same end of an arc.
const SAME_PARAMETER: f64 = 1e-12;

/// A curve with its flow.
#[derive(Clone, Copy)]
pub(super) struct Strand<'a> {
    pub(super) curve: &'a SpaceCurve,
    pub(super) flow: &'a Flow,
}

/// What lies between two curves, or a part of it: the row and its local parameters along the cross curves.
#[derive(Clone, Copy)]
pub(super) struct RowPart {
    pub(super) row: usize,
    pub(super) from: f64,
    pub(super) to: f64,
}

/// A segment of all curves.
pub(super) struct Strip<'a> {
    pub(super) strands: &'a [Strand<'a>],
    pub(super) segment: usize,
    pub(super) ties: &'a Ties,
    pub(super) rows: &'a [RowPart],
    pub(super) pulls: Option<&'a [Pull]>,
}

/// Control points along v of a row, or a part of one, with their derivatives by u.
type Lines = [(Vec3, Vec3); 4];

/// How far a cross curve is from the rows without it.
pub(super) struct Pull {
    /// The end of segments that it belongs to.
    end: usize,
    /// For each part of a row what its control points lack there.
    misfits: Vec<[Vec3; 4]>,
}

/// The patches of a column, from the first row to the last.
pub(super) struct Column {
    pub(super) patches: Vec<Patch>,
    /// Global parameter where it ends.
    pub(super) end: f64,
}

/// The share of the later end at a parameter between two ends, level at both.
pub(super) fn blend(local: f64) -> f64 {
    local * local * (3.0 - 2.0 * local)
}

/// Cuts the parameters 0 to 1 at joints, then halves each piece until it is close; gives the pieces in order.
pub(super) fn cut(
    joints: impl Iterator<Item = f64>,
    is_close: &mut dyn FnMut(f64, f64) -> bool,
    piece: &mut dyn FnMut(f64, f64),
) {
    let mut ends = vec![0.0, 1.0];
    ends.extend(joints);
    ends.sort_by(f64::total_cmp);
    ends.dedup_by(|a, b| (*a - *b).abs() <= SAME_PARAMETER);
    for pair in ends.windows(2) {
        halved(pair[0], pair[1], 0, is_close, piece);
    }
}

fn halved(
    from: f64,
    to: f64,
    depth: u32,
    is_close: &mut dyn FnMut(f64, f64) -> bool,
    piece: &mut dyn FnMut(f64, f64),
) {
    if depth < MOST_HALVINGS && !is_close(from, to) {
        let middle = 0.5 * (from + to);
        halved(from, middle, depth + 1, is_close, piece);
        halved(middle, to, depth + 1, is_close, piece);
    } else {
        piece(from, to);
    }
}

/// The control points of a part of a cubic: the values of its polar form at the ends of the part.
fn part_of(control: [Vec3; 4], from: f64, to: f64) -> [Vec3; 4] {
    std::array::from_fn(|upper| {
        let mut work = control;
        for level in 0..3 {
            let share = if level < upper { to } else { from };
            for index in 0..3 - level {
                work[index] = work[index] * (1.0 - share) + work[index + 1] * share;
            }
        }
        work[0]
    })
}

impl Strand<'_> {
    /// Global arc parameter of an end of segments.
    fn end(&self, end: usize) -> f64 {
        let segments = &self.flow.segments;
        match segments.get(end) {
            Some(segment) => segment.first,
            None => segments.last().map_or(0.0, |segment| segment.last),
        }
    }

    /// The place at an end of segments.
    pub(super) fn boundary(&self, end: usize) -> Vec3 {
        self.curve.evaluate_global(self.end(end)).map_or_else(Vec3::zeros, |at| at.position)
    }

    /// The cross direction given there.
    pub(super) fn cross(&self, end: usize) -> Option<Vec3> {
        let parameter = self.end(end);
        let index = parameter.round();
        ((parameter - index).abs() <= SAME_PARAMETER)
            .then(|| self.curve.cross.get(index as usize).copied().flatten())
            .flatten()
    }

    /// The cubic with the places and derivatives of a segment at two of its local parameters, which one arc joins.
    fn cubic(&self, segment: usize, [from, to]: [f64; 2]) -> [Vec3; 4] {
        let middle = 0.5 * (from + to);
        let ((p, dp), (q, dq)) = (self.at(segment, from, middle), self.at(segment, to, middle));
        let third = (to - from) / 3.0;
        [p, p + dp * third, q - dq * third, q]
    }

    /// Whether a segment is close to that cubic.
    pub(super) fn is_close_to_cubic(&self, segment: usize, [from, to]: [f64; 2], size: f64) -> bool {
        let control = self.cubic(segment, [from, to]);
        PROBES.iter().all(|&share| {
            let exact = self.at(segment, from + (to - from) * share, 0.5 * (from + to)).0;
            (exact - part_of(control, share, share)[0]).norm() <= CLOSE * size
        })
    }

    /// Local parameters of a segment where arcs meet.
    pub(super) fn joints(&self, segment: usize) -> Vec<f64> {
        let Some(part) = self.flow.segments.get(segment) else { return Vec::new() };
        let first = part.first.floor() as usize + 1;
        (first..self.curve.arcs.len())
            .map(|joint| joint as f64)
            .take_while(|joint| *joint < part.last - SAME_PARAMETER)
            .filter(|joint| *joint > part.first + SAME_PARAMETER)
            .filter_map(|joint| self.flow.flow_parameter(self.curve, joint))
            .map(|flow| flow - segment as f64)
            .collect()
    }

    /// The place and its derivative by the local parameter of a segment, on the arc that holds `within`.
    fn at(&self, segment: usize, local: f64, within: f64) -> (Vec3, Vec3) {
        let parameter = |local: f64| self.flow.arc_parameter(self.curve, segment, local).unwrap_or(0.0);
        let index = self.curve.locate(parameter(within)).map_or(0, |found| found.0);
        let Some(arc) = self.curve.arcs.get(index) else { return (Vec3::zeros(), Vec3::zeros()) };
        let t = (parameter(local) - index as f64).clamp(0.0, 1.0);
        let at: ArcPoint = arc.evaluate(t);
        (at.position, at.first * self.flow.pace(self.curve, segment, index, t))
    }

    /// The arc of a part of a segment, where the segment follows the arcs' own parameters.
    fn exact(&self, segment: usize, from: f64, to: f64) -> Option<CurveArc> {
        let part = self.flow.segments.get(segment)?;
        if part.measure != SegmentMeasure::Param {
            return None;
        }
        let along = |local: f64| part.along(self.curve, local);
        let (index, _) = self.curve.locate(along(0.5 * (from + to)))?;
        let local = |parameter: f64| (along(parameter) - index as f64).clamp(0.0, 1.0);
        Some(self.curve.arcs.get(index)?.between(local(from), local(to)))
    }
}

impl Strip<'_> {
    /// The columns of the segment.
    pub(super) fn columns(&self, size: f64) -> Vec<Column> {
        let joints = self.strands.iter().flat_map(|strand| strand.joints(self.segment));
        let mut columns = Vec::new();
        let all = |from: f64, to: f64| self.exact(from, to).unwrap_or_else(|| self.fitted(from, to));
        cut(
            joints,
            &mut |from, to| self.exact(from, to).is_some() || self.is_close(&all(from, to), from, to, size),
            &mut |from, to| {
                columns.push(Column { patches: all(from, to), end: self.segment as f64 + to });
            },
        );
        columns
    }

    /// Exact rulings between arcs of the same weights.
    fn exact(&self, from: f64, to: f64) -> Option<Vec<Patch>> {
        if !self.ties.is_ruled() || self.pulls.is_some() {
            return None;
        }
        let arcs: Vec<CurveArc> =
            self.strands.iter().map(|strand| strand.exact(self.segment, from, to)).collect::<Option<_>>()?;
        arcs.windows(2)
            .map(|pair| {
                let scale = pair[0].control[0].w / pair[1].control[0].w;
                let second = CurveArc { control: pair[1].control.map(|point| point * scale) };
                let alike = pair[0].control.iter().zip(&second.control);
                alike
                    .into_iter()
                    .all(|(a, b)| (a.w - b.w).abs() <= SAME_WEIGHT * a.w)
                    .then(|| Patch::between(&pair[0], &second))
            })
            .collect()
    }

    /// The four functions of u that make each row, or part of one, cubic in v.
    fn across(&self, local: f64, within: f64) -> Vec<Lines> {
        let mut whole: Option<(usize, Lines)> = None;
        let part = |(index, part): (usize, &RowPart)| {
            let lines = match whole {
                Some((row, lines)) if row == part.row => lines,
                _ => self.whole_row(part.row, local, within),
            };
            whole = Some((part.row, lines));
            let places = part_of(lines.map(|line| line.0), part.from, part.to);
            let slopes = part_of(lines.map(|line| line.1), part.from, part.to);
            let mut control = std::array::from_fn(|line| (places[line], slopes[line]));
            self.pull(index, local, &mut control);
            control
        };
        self.rows.iter().enumerate().map(part).collect()
    }

    /// The functions of a whole row without cross curves.
    fn whole_row(&self, row: usize, local: f64, within: f64) -> Lines {
        let at = |index: usize| {
            self.strands
                .get(index)
                .map_or((Vec3::zeros(), Vec3::zeros()), |strand| strand.at(self.segment, local, within))
        };
        let ((low, low_du), (high, high_du)) = (at(row), at(row + 1));
        let (ways, ways_du) = self.ways(row, local);
        let third = 1.0 / 3.0;
        let [first, second] = ways.unwrap_or([high - low; 2]);
        let [first_du, second_du] = if ways.is_some() { ways_du } else { [high_du - low_du; 2] };
        [
            (low, low_du),
            (low + first * third, low_du + first_du * third),
            (high - second * third, high_du - second_du * third),
            (high, high_du),
        ]
    }

    /// The derivatives across with their derivatives by u.
    fn ways(&self, row: usize, local: f64) -> (Option<[Vec3; 2]>, [Vec3; 2]) {
        // Central differences of a polynomial of degree six, exact far below the bound of the fit.
        const STEP: f64 = 1e-4;
        let at = |local: f64| self.ties.across(row, self.segment, local);
        let slope = match (at(local - 2.0 * STEP), at(local - STEP), at(local + STEP), at(local + 2.0 * STEP))
        {
            (Some(a), Some(b), Some(c), Some(d)) => {
                std::array::from_fn(|side| ((c[side] - b[side]) * 8.0 - (d[side] - a[side])) / (12.0 * STEP))
            }
            _ => [Vec3::zeros(); 2],
        };
        (at(local), slope)
    }

    /// Pulls a part of a row (index) onto the cross curves: their distance from it, falling off linearly from one to the
    /// next.
    fn pull(&self, part: usize, local: f64, control: &mut Lines) {
        let Some(pulls) = self.pulls else { return };
        let global = self.segment as f64 + local;
        let place = pulls.partition_point(|pull| (pull.end as f64) <= global).clamp(1, pulls.len() - 1);
        let (before, after) = (&pulls[place - 1], &pulls[place]);
        let span = (after.end - before.end) as f64;
        let share = (global - before.end as f64) / span;
        let (near, far) = (before.misfits[part], after.misfits[part]);
        for (index, (point, slope)) in control.iter_mut().enumerate() {
            *point += near[index] * (1.0 - share) + far[index] * share;
            *slope += (far[index] - near[index]) / span;
        }
    }

    /// What the rows lack to a cross curve at an end of this segment (local parameter 0 or 1).
    pub(super) fn lack(&self, rim: &Rim, local: f64) -> Pull {
        let wanted = Strand { curve: &rim.curve, flow: &rim.flow };
        // The arc at the very end: a segment may have several.
        let own = self.across(local, local);
        let misfit = |(part, own): (&RowPart, &Lines)| {
            let wanted = wanted.cubic(part.row, [part.from, part.to]);
            std::array::from_fn(|index| wanted[index] - own[index].0)
        };
        Pull { end: rim.end, misfits: self.rows.iter().zip(&own).map(misfit).collect() }
    }

    /// The bicubic patches with the exact values and derivatives at both ends of a column.
    fn fitted(&self, from: f64, to: f64) -> Vec<Patch> {
        let middle = 0.5 * (from + to);
        let (first, last) = (self.across(from, middle), self.across(to, middle));
        let third = (to - from) / 3.0;
        let patch = |(first, last): (&Lines, &Lines)| {
            let mut points = [[Vec3::zeros(); 4]; 4];
            for index in 0..4 {
                let ((p, dp), (q, dq)) = (first[index], last[index]);
                for (line, point) in points.iter_mut().zip([p, p + dp * third, q - dq * third, q]) {
                    line[index] = point;
                }
            }
            Patch::from_points(&points)
        };
        first.iter().zip(&last).map(patch).collect()
    }

    fn is_close(&self, patches: &[Patch], from: f64, to: f64, size: f64) -> bool {
        let middle = 0.5 * (from + to);
        PROBES.iter().all(|&share| {
            let exact = self.across(from + (to - from) * share, middle);
            patches.iter().zip(&exact).all(|(patch, control)| {
                let lines = patch.at_u(share);
                control.iter().zip(&lines).all(|((point, _), found): (_, &Vector4<f64>)| {
                    (point - found.xyz() / found.w).norm() <= CLOSE * size
                })
            })
        })
    }
}
