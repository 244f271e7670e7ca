//! The section of a surface with the plane of a chord, as a function of the share of the chord: the curves that a ruled
//! surface is made from (language reference 4.16).

use super::{RootSelection, Surface};
use crate::canonical::extent::{SECTION_BEYOND, SECTION_MISFIT, SECTION_STEEP_BEYOND};
use crate::{Vec3, canonical::RuledCurve};

/// Slope over the chord above which a section is not followed: its end on a circle over the diameter, where the share of
/// the chord stops telling where on the curve one is.
const STEEP: f64 = 1e3;
/// Share of the chord by which one-sided derivatives are taken inside.
const NUDGE: f64 = 4e-14;
/// Steps over the chord itself at which heights are noted.
const STEPS: usize = 32;
/// Halvings that find the last place of a section that becomes too steep.
const HALVINGS: u32 = 40;

/// A point of a curve with derivatives with respect to its parameter.
#[derive(Debug, Clone, Copy)]
pub(super) struct CurvePoint {
    pub(super) point: Vec3,
    pub(super) first: Vec3,
    pub(super) second: Vec3,
}

/// Height of the section over its chord with its derivatives by the share of the chord.
#[derive(Debug, Clone, Copy)]
struct Height {
    value: f64,
    slope: f64,
    bend: f64,
}

/// The section curve, followed on its surface as far as it is not too steep over the chord, and straight from there on.
pub(super) struct SectionCurve {
    surface: Surface,
    start: Vec3,
    chord: Vec3,
    across: Vec3,
    /// Shares of the chord in order with the heights there, to start from.
    known: Vec<(f64, f64)>,
}

impl SectionCurve {
    /// `None` if the section does not reach from one end of the chord to the other.
    pub(super) fn new(curve: &RuledCurve<'_>) -> Option<Self> {
        let surface = Surface::from_geometry(curve.surface).ok()?;
        let across = curve.across.try_normalize(0.0)?;
        let chord = curve.end - curve.start;
        let mut section = Self { surface, start: curve.start, chord, across, known: Vec::new() };
        section.follow()?;
        Some(section)
    }

    /// Heights from the middle of the chord outward.
    fn follow(&mut self) -> Option<()> {
        let middle = self.start + self.chord * 0.5;
        let height =
            self.surface.directed_distance(&middle, &self.across, RootSelection::AheadElseNearest).ok()?;
        let mut known = self.walk(height, -1.0);
        known.reverse();
        known.push((0.5, height));
        known.extend(self.walk(height, 1.0));
        self.known = known;
        // A section that runs over the whole chord is the curve, wherever the end points are: it is looked for from the
        // chord along the direction across. One that stands upright at an end is held to the end points.
        let [first, last] = self.reach();
        if first <= 0.0 && last >= 1.0 {
            return Some(());
        }
        let ends = [self.at(0.0, 0.5).point, self.at(1.0, 0.5).point];
        let misfit = (ends[0] - self.start).norm().max((ends[1] - self.start - self.chord).norm());
        (misfit <= SECTION_MISFIT * self.chord.norm()).then_some(())
    }

    fn walk(&self, height: f64, sense: f64) -> Vec<(f64, f64)> {
        let mut found = Vec::new();
        let (mut share, mut guess) = (0.5, height);
        let mut step = sense / STEPS as f64;
        let most = STEPS / 2 + (STEPS as f64 * SECTION_BEYOND) as usize;
        let Some(mut here) = self.height(share, guess) else { return found };
        let mut halvings = 0;
        while found.len() < most + HALVINGS as usize
            && (share + step - 0.5).abs() <= 0.5 + SECTION_BEYOND + 1e-9
        {
            let beyond = (share + step - 0.5).abs() > 0.5 + 1e-9;
            let next = self.height(share + step, guess + here.slope * step).filter(|next| {
                // The other branch of the section is not this curve.
                let same = (next.value - guess - here.slope * step).abs() <= self.chord.norm();
                same && (!beyond || next.slope.abs() <= SECTION_STEEP_BEYOND * self.chord.norm())
            });
            match next {
                Some(next) => {
                    share += step;
                    guess = next.value;
                    here = next;
                    found.push((share, guess));
                }
                None if !beyond && halvings < HALVINGS => {
                    halvings += 1;
                    step *= 0.5;
                }
                None => break,
            }
        }
        found
    }

    /// Height over the chord nearest to a guess; `None` where the curve is too steep or not there.
    fn height(&self, share: f64, guess: f64) -> Option<Height> {
        let from = self.start + self.chord * share + self.across * guess;
        let change = self.surface.directed_distance(&from, &self.across, RootSelection::Nearest).ok()?;
        let place = from + self.across * change;
        let (foot, hessian) = self.surface.foot_and_hessian(&place);
        let cosine = foot.normal.dot(&self.across);
        let slope = -foot.normal.dot(&self.chord) / cosine;
        if slope.is_nan() || slope.abs() > STEEP * self.chord.norm() {
            return None;
        }
        let along = self.chord + self.across * slope;
        Some(Height { value: guess + change, slope, bend: -along.dot(&(hessian * along)) / cosine })
    }

    /// First and last share of the chord up to which the section itself is followed.
    pub(super) fn reach(&self) -> [f64; 2] {
        let share = |known: Option<&(f64, f64)>| known.map_or(0.5, |k| k.0);
        [share(self.known.first()), share(self.known.last())]
    }

    /// Shares of the chord at which the curve may bend sharply.
    pub(super) fn joints(&self) -> Vec<f64> {
        let Surface::Tabulated(curve) = &self.surface else { return Vec::new() };
        let normal = self.chord.cross(&self.across);
        let axis = curve.generator();
        let along = normal.dot(&axis);
        if along.abs() <= 1e-9 * normal.norm() {
            return Vec::new();
        }
        // The direction across need not be square to the chord.
        let flat = self.across.cross(&normal);
        let share = |joint: Vec3| {
            let place = joint + axis * (normal.dot(&(self.start - joint)) / along);
            flat.dot(&(place - self.start)) / flat.dot(&self.chord)
        };
        curve.joints().into_iter().map(share).filter(|x| x.is_finite()).collect()
    }

    /// Point and derivatives at a share of the chord; the derivatives are those on the side towards `inside`.
    pub(super) fn at(&self, share: f64, inside: f64) -> CurvePoint {
        let [low, high] = self.reach();
        let held = share.clamp(low, high);
        let straight =
            share < low || share > high || (share <= low && inside < low) || (share >= high && inside > high);
        let towards = if straight { 0.5 * (low + high) } else { inside };
        let height = self.held(held, towards);
        let mut first = self.chord + self.across * height.slope;
        if straight {
            let longest = (1.0 + SECTION_STEEP_BEYOND) * self.chord.norm();
            first *= (longest / first.norm()).min(1.0);
        }
        let point = self.start + self.chord * held + self.across * height.value + first * (share - held);
        let second = if straight { Vec3::zeros() } else { self.across * height.bend };
        CurvePoint { point, first, second }
    }

    fn held(&self, share: f64, towards: f64) -> Height {
        let after = self.known.partition_point(|known| known.0 <= share);
        let pair = (self.known.get(after.saturating_sub(1)), self.known.get(after));
        let guess = match pair {
            (Some(a), Some(b)) if b.0 > a.0 => a.1 + (b.1 - a.1) * (share - a.0) / (b.0 - a.0),
            (Some(a), _) => a.1,
            (None, b) => b.map_or(0.0, |b| b.1),
        };
        let nudged = share + (towards - share).signum() * NUDGE;
        match (self.height(share, guess), self.height(nudged, guess)) {
            (Some(place), Some(beside)) => Height { value: place.value, ..beside },
            (Some(found), None) | (None, Some(found)) => found,
            (None, None) => Height { value: guess, slope: 0.0, bend: 0.0 },
        }
    }
}
