//! The second fundamental form over parts of a surface: how it bends in each direction, not only how much at most.

use nalgebra::Matrix3;

use super::{
    Bounds, CLOSE, Enclose, MAX_DEPTH, MAX_PARTS, Part, Survey, WORK_OF_PART,
    rulings::{OnRulings, Rulings},
};
use crate::{Vec3, patience::Patience};

/// Which multiple of the change of a frame its pseudo-inverse may change by, times the norms of both pseudo-inverses, if both frames
/// have full rank (Wedin).
const PSEUDO_INVERSE: f64 = std::f64::consts::SQRT_2;
/// Size of a part, as a share of the reach of a question, from which on it is not halved.
const FINE: f64 = 1.0 / 32.0;
/// The same where a cylinder along a line is asked about: what smaller parts tell more closely does not make up for their number.
const FINE_ACROSS: f64 = 1.0;
/// How many forms are one unit of work where they are compared.
const FORMS_A_UNIT: usize = 8;
/// Error of forms, as a share of them, that tells how a surface bends along a line that is nearly straight on it.
const FINE_ERROR: f64 = 0.005;

/// The question which curvature a cylinder along a line needs at least to bend as much as a surface that nearly goes along it.
#[derive(Debug, Clone, Copy)]
pub struct Lengthwise {
    /// Unit direction of the line.
    pub along: Vec3,
    /// How much the surface may bend along it, the least first: the less of that, the more it may bend across.
    pub least: [f64; LENGTHWISE],
    /// A curvature that no better one is looked for than.
    pub enough: f64,
    /// More is none.
    pub most: f64,
}

/// How many bends along a line are asked about at once.
pub const LENGTHWISE: usize = 6;

/// What is asked of the forms of all parts within reach, with what has been found.
#[derive(Debug, Clone)]
pub(in super::super) enum Forms {
    NotAsked,
    /// The forms themselves.
    All(Vec<Form>),
    /// Which cylinder along a line bends as much.
    Across(Lengthwise, Across),
    /// How much the surface bends away from the side along a direction.
    Along(Along),
    /// How much it bends to the side beside straight lines of its own, along a direction.
    OnRulings(OnRulings),
}

/// How all places of a part bend.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Bent {
    pub(super) form: Form,
    /// Where lines of the second parameter are straight.
    pub(super) rulings: Option<Rulings>,
}

/// The least cylinder along a line, as far as parts have been looked at.
#[derive(Debug, Clone, Copy, Default)]
pub(in super::super) struct Across {
    /// Index of the least bend along the line with which there may be such a cylinder.
    least: usize,
    curvature: f64,
}

/// The greatest bend along a unit direction, as far as parts have been looked at, and one up to which it need not be told closely.
#[derive(Debug, Clone, Copy)]
pub(in super::super) struct Along {
    direction: Vec3,
    enough: f64,
    found: f64,
}

impl Forms {
    /// The same question in the coordinates of a surface.
    pub(super) fn turned(self, turned: impl Fn(&Vec3) -> Vec3) -> Self {
        match self {
            Self::Across(asked, found) => {
                let along = turned(&asked.along);
                Self::Across(Lengthwise { along, ..asked }, found)
            }
            Self::Along(asked) => Self::Along(Along { direction: turned(&asked.direction), ..asked }),
            asked => asked,
        }
    }
}

/// Second fundamental forms of all places of a part of a surface, as forms on vectors in space: that of a vector is that of its
/// part in the tangent plane. Positive where the surface bends towards the side asked about.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Form {
    middle: Matrix3<f64>,
    /// The form of no unit vector differs by more from that of `middle`.
    error: f64,
}

impl Form {
    /// Forms along the natural normal from a form in an orthonormal frame, given how much the form in such frames may differ
    /// (`error`), and how much frames do (`change`, less than one).
    ///
    /// A vector w stands for `a = J⁺w` in another frame J. With `‖J − J₀‖ ≤ ε` it is at most `|w|/(1 − ε)` long and by
    /// `√2 ε/(1 − ε)|w|` off that in the first.
    pub(super) fn about([x, y]: [Vec3; 2], [p, q, r]: [f64; 3], error: f64, change: f64) -> Self {
        let mixed = x * y.transpose();
        let middle = x * x.transpose() * p + (mixed + mixed.transpose()) * q + y * y.transpose() * r;
        let greatest = 0.5 * (p + r).abs() + (0.5 * (p - r)).hypot(q) + error;
        let longest = 1.0 / (1.0 - change);
        let off = PSEUDO_INVERSE * change * longest;
        Self { middle, error: error + greatest * (longest + 1.0) * off }
    }

    /// That of a surface that bends along one unit direction alone.
    pub(in super::super) fn of_ridge(direction: &Vec3, bend: f64, error: f64) -> Self {
        Self { middle: direction * direction.transpose() * bend, error }
    }

    /// Along the natural normal or against it.
    #[must_use]
    fn seen_from(&self, side: f64) -> Self {
        Self { middle: self.middle * side, ..*self }
    }

    /// In other coordinates, given the vectors of these there.
    #[must_use]
    pub(in super::super) fn turned(&self, map: &Matrix3<f64>) -> Self {
        Self { middle: map.transpose() * self.middle * map, ..*self }
    }

    /// The error with which this form would hold another one too, as far as it bends to the side asked about, if that is not more than
    /// an error.
    fn standing_in(&self, other: &Self, most: f64) -> Option<f64> {
        let apart = other.middle - self.middle;
        let mean = apart.trace() / 3.0;
        let room = most - mean - other.error;
        // No eigenvalue is farther from their mean.
        let square = (apart.norm_squared() - 3.0 * mean * mean).max(0.0) * (2.0 / 3.0);
        (room >= 0.0 && square <= room * room).then(|| mean + square.sqrt() + other.error)
    }

    /// That of a unit vector, and how far from it those of others may be that differ from it by no longer a vector than `off`.
    pub(super) fn about_direction(&self, way: &Vec3, off: f64) -> (f64, f64) {
        (way.dot(&(self.middle * way)), self.error + self.middle.norm() * off * (2.0 + off))
    }

    /// How much the surface bends away from the side at most along a unit vector, at all these places.
    pub fn bend_away(&self, along: &Vec3) -> f64 {
        self.error - along.dot(&(self.middle * along))
    }

    /// Which curvature a cylinder along a unit direction needs at least to bend at all these places towards the side as much as
    /// the surface in each direction, and more by a margin; `None` if the surface may bend to that side along the direction itself.
    ///
    /// The least b with `S ≤ b (I − t tᵀ)` for all forms S: with `c` the mixed terms of t and the rest, and `s < 0` that of t,
    /// what is left across is `S − c cᵀ/s`. Its greater eigenvalue follows from the trace and the sum of squares.
    pub fn curvature_across(&self, along: &Vec3, margin: f64) -> Option<f64> {
        let error = self.error + margin;
        let own = self.middle * along;
        let straight = own.dot(along);
        let least = straight + error;
        if least >= 0.0 || !error.is_finite() {
            return None;
        }
        let mixed = own - along * straight;
        let size = mixed.norm_squared() / -least;
        let trace = self.middle.trace() - straight + size;
        let crossed = mixed.dot(&(self.middle * mixed)) / -least;
        let square = self.middle.norm_squared() - 2.0 * own.norm_squared()
            + straight * straight
            + 2.0 * crossed
            + size * size;
        let greatest = 0.5 * (trace + (2.0 * square - trace * trace).max(0.0).sqrt());
        Some((greatest + error).max(0.0))
    }
}

/// Share of the greatest curvature by which one form may stand in for others.
const ALIKE: f64 = 0.01;

/// Few forms that bend in each direction as much as all of some, and hardly more; none once `patience` is over.
pub(in super::super) fn leading(forms: Vec<Form>, patience: Patience<'_>) -> Option<Vec<Form>> {
    let mut sized: Vec<(f64, Form)> =
        forms.into_iter().map(|form| (form.middle.norm() + form.error, form)).collect();
    sized.sort_by(|a, b| b.0.total_cmp(&a.0));
    let slack = ALIKE * sized.first().map_or(0.0, |first| first.0);
    let mut kept: Vec<(Form, f64)> = Vec::new();
    for (_, form) in sized {
        if patience.ends_after((kept.len() / FORMS_A_UNIT) as u32 + 1) {
            return None;
        }
        let stands_in =
            kept.iter_mut().find_map(|(known, most)| Some((known.standing_in(&form, *most)?, known)));
        match stands_in {
            Some((needed, known)) => known.error = known.error.max(needed),
            None => kept.push((form, form.error + slack)),
        }
    }
    Some(kept.into_iter().map(|(form, _)| form).collect())
}

impl<'a> Survey<'a> {
    pub(super) fn about_forms(
        center: &Vec3,
        reach: f64,
        side: f64,
        forms: Forms,
        patience: Patience<'a>,
    ) -> Self {
        Self { forms, ..Self::new(center, [0.0, reach], (side, &Vec3::zeros()), patience) }
    }

    /// Asks for the forms of all parts within reach of a point, as bent towards a side.
    pub(in super::super) fn of_forms(center: &Vec3, reach: f64, side: f64, patience: Patience<'a>) -> Self {
        Self::about_forms(center, reach, side, Forms::All(Vec::new()), patience)
    }

    /// Asks which cylinder along a line bends as much as all parts within reach of a point towards a side.
    pub(in super::super) fn of_lengthwise(
        center: &Vec3,
        reach: f64,
        side: f64,
        asked: Lengthwise,
        patience: Patience<'a>,
    ) -> Self {
        Self::about_forms(center, reach, side, Forms::Across(asked, Across::default()), patience)
    }

    /// Asks how much all parts within reach of a point bend away from a side along a unit direction, closely where that is more than
    /// enough.
    pub(in super::super) fn of_bend_along(
        center: &Vec3,
        reach: f64,
        side: f64,
        (direction, enough): (Vec3, f64),
        patience: Patience<'a>,
    ) -> Self {
        let found = f64::NEG_INFINITY;
        Self::about_forms(center, reach, side, Forms::Along(Along { direction, enough, found }), patience)
    }

    /// The least bend along the line with which there is such a cylinder, and the curvature of that.
    pub(in super::super) fn curvature_across(&self) -> Option<(f64, f64)> {
        match self.forms {
            Forms::Across(asked, found) if !self.jumps => {
                Some((*asked.least.get(found.least)?, found.curvature))
            }
            _ => None,
        }
    }

    /// The greatest bend along the direction.
    pub(in super::super) fn bend_along(&self) -> Option<f64> {
        match self.forms {
            Forms::Along(asked) if !self.jumps => Some(asked.found),
            _ => None,
        }
    }

    /// The forms asked for, unless some place within reach has none.
    pub(in super::super) fn forms(self) -> Option<Vec<Form>> {
        match self.forms {
            Forms::All(forms) if !self.jumps => Some(forms),
            _ => None,
        }
    }
}

impl Forms {
    /// Takes a form, or that there is none, in so far as halves of its part are not to be looked at; whether they are.
    fn take(&mut self, bent: Option<&Bent>, middle: &Vec3, side: f64, is_fine: bool) -> Taken {
        let form = bent.map(|bent| &bent.form);
        let close = |error: f64| form.is_some_and(|form| form.error <= error * form.middle.norm());
        let seen = form.map(|form| form.seen_from(side));
        match self {
            Self::NotAsked => Taken::Whole,
            Self::All(_) if !is_fine && !close(CLOSE) => Taken::Halves,
            Self::All(forms) => seen.map_or(Taken::Nothing, |form| {
                forms.push(form);
                Taken::Whole
            }),
            Self::Across(asked, found) => found.take(asked, seen, is_fine || close(FINE_ERROR)),
            Self::Along(asked) => {
                let bend = seen.map_or(f64::INFINITY, |form| form.bend_away(&asked.direction));
                let is_wanted = bend > asked.enough.max(asked.found) && asked.found <= asked.enough;
                if (is_wanted || !bend.is_finite()) && !is_fine {
                    return Taken::Halves;
                }
                asked.found = asked.found.max(bend);
                if bend.is_finite() { Taken::Whole } else { Taken::Nothing }
            }
            Self::OnRulings(asked) => {
                asked.take(bent.and_then(|bent| bent.rulings.as_ref()), middle, side, is_fine)
            }
        }
    }
}

/// What a form of a part tells.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Taken {
    /// Enough.
    Whole,
    /// Less than its halves.
    Halves,
    /// That there is no answer.
    Nothing,
}

impl Across {
    /// Takes the cylinder that a part needs.
    fn take(&mut self, asked: &Lengthwise, seen: Option<Form>, is_fine: bool) -> Taken {
        // The more it may bend along the line the less is needed across.
        while let Some(least) = asked.least.get(self.least) {
            let needed = seen.and_then(|form| form.curvature_across(&asked.along, -least));
            let needed = needed.unwrap_or(f64::INFINITY);
            if needed > asked.enough.max(self.curvature) && !is_fine {
                return Taken::Halves;
            }
            if needed <= asked.most {
                self.curvature = self.curvature.max(needed);
                return Taken::Whole;
            }
            self.least += 1;
        }
        Taken::Nothing
    }
}

impl Part {
    /// Takes the forms of the places within reach; its halves tell them more closely where needed.
    pub(super) fn survey_forms(&self, sheet: &impl Enclose, survey: &mut Survey<'_>, depth: u32) {
        if self.bound(&survey.center) > survey.reach {
            return;
        }
        if let Forms::OnRulings(asked) = &survey.forms
            && asked.is_off(self)
        {
            return;
        }
        if survey.is_given_up() {
            return;
        }
        if self.form.made().is_none() {
            survey.counts(WORK_OF_PART);
        }
        let form = self.form.get(|| self.form_of(sheet).map(Box::new));
        let fine = if matches!(survey.forms, Forms::Across(..)) { FINE_ACROSS } else { FINE };
        let is_fine =
            self.extent.radius <= fine * survey.reach || depth >= MAX_DEPTH || survey.seen >= MAX_PARTS;
        match survey.forms.take(form.as_deref(), &self.extent.center, survey.side, is_fine) {
            Taken::Whole => {}
            Taken::Halves => self.survey_halves(sheet, survey, depth),
            Taken::Nothing => survey.jumps = true,
        }
    }

    /// The forms of all places, if the part is smooth and does not end.
    fn form_of(&self, sheet: &impl Enclose) -> Option<Bent> {
        let enclosure = sheet.enclose(&self.rectangle);
        let is_smooth = !enclosure.ends && enclosure.sharp == [false; 2];
        Bounds::of(&enclosure, self.rectangle.half).bent.filter(|_| is_smooth)
    }
}
