//! What is typed, laid beside a form.

use apt_geometry::canonical::GeometryKind;

use super::{Atom, Form, Step, kinds_of};

/// What is known of a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ValueKind {
    /// Nothing: a name without a value yet.
    Unknown,
    /// A number.
    Scalar,
    /// Geometry of this type.
    Geometry(GeometryKind),
}

/// One typed parameter or comma.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Typed<'a> {
    /// A vocabulary word.
    Word(&'a str),
    /// A value.
    Value(ValueKind),
    /// A comma.
    Comma,
}

/// How far what is typed goes along with a form.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Matched {
    /// The parameters that can stand next.
    pub(crate) next: Vec<usize>,
    /// What came before may go on, so that anything can stand next.
    pub(crate) more: bool,
    /// How many of the typed parameters and commas fit.
    pub(crate) fits: usize,
    /// How many of the words among these are taken only because what came before may go on.
    pub(crate) dotted: usize,
    /// All of them do.
    pub(crate) all: bool,
}

impl Atom {
    /// Whether the typed parameter can stand for this.
    pub(crate) fn takes(self, typed: Typed<'_>) -> bool {
        match (self, typed) {
            (Atom::Word(word), Typed::Word(typed)) => word == typed,
            (Atom::Number(_), Typed::Value(kind)) => !matches!(kind, ValueKind::Geometry(_)),
            (Atom::Placeholder("mod" | "modifier"), typed) => matches!(typed, Typed::Word(_)),
            (Atom::Placeholder(name), Typed::Word(_)) => kinds_of(name) == Some(&[]),
            (Atom::Placeholder(name), Typed::Value(kind)) => match (kinds_of(name), kind) {
                (_, ValueKind::Unknown) | (Some([]), _) => true,
                (None, kind) => kind == ValueKind::Scalar,
                (Some(kinds), ValueKind::Geometry(kind)) => kinds.contains(&kind),
                (Some(_), ValueKind::Scalar) => false,
            },
            _ => false,
        }
    }
}

impl Form {
    /// Lays typed parameters beside the form.
    pub(crate) fn matched(&self, typed: &[Typed<'_>]) -> Matched {
        let mut at = self.reachable([0]);
        let mut dotted = 0;
        for (fits, one) in typed.iter().enumerate() {
            let mut next: Vec<usize> = at.iter().filter_map(|&place| self.after(place, *one)).collect();
            // A word that the form has here is that word, and not one more of what came before.
            let named = |&place: &usize| self.names(place, *one).then_some(place + 1);
            if at.iter().any(|place| named(place).is_some()) {
                next = at.iter().filter_map(named).collect();
            } else if next.is_empty() {
                return Matched { fits, dotted, all: false, ..self.expected(&at) };
            } else if matches!(one, Typed::Word(_)) && at.iter().all(|&place| self.passes(place, *one)) {
                dotted += 1;
            }
            at = self.reachable(next);
        }
        Matched { fits: typed.len(), dotted, all: true, ..self.expected(&at) }
    }

    /// Where the form goes on behind a place if this is typed there.
    fn after(&self, place: usize, typed: Typed<'_>) -> Option<usize> {
        let goes_on = match *self.steps.get(place)? {
            Step::Comma => typed == Typed::Comma,
            Step::Parameter(index) => self.parameters.get(index)?.atom.takes(typed),
            Step::More(_) => true,
            Step::Split(..) | Step::Jump(_) => false,
        };
        goes_on.then_some(place + 1)
    }

    /// Whether the form has this very word at a place.
    fn names(&self, place: usize, typed: Typed<'_>) -> bool {
        let Some(Step::Parameter(index)) = self.steps.get(place) else { return false };
        let atom = self.parameters.get(*index).map(|parameter| parameter.atom);
        matches!((atom, typed), (Some(Atom::Word(word)), Typed::Word(typed)) if word == typed)
    }

    /// Whether a place takes this by its dots or not at all.
    fn passes(&self, place: usize, typed: Typed<'_>) -> bool {
        matches!(self.steps.get(place), Some(Step::More(_))) || self.after(place, typed).is_none()
    }

    /// The places that can be reached from some without typing anything, in order, splits and jumps left out.
    fn reachable(&self, from: impl IntoIterator<Item = usize>) -> Vec<usize> {
        let mut seen = vec![false; self.steps.len() + 1];
        let mut open: Vec<usize> = from.into_iter().collect();
        while let Some(place) = open.pop() {
            match seen.get_mut(place) {
                Some(known) if !*known => *known = true,
                _ => continue,
            }
            match self.steps.get(place) {
                Some(Step::Split(first, other)) => open.extend([*first, *other]),
                Some(Step::Jump(to)) => open.push(*to),
                _ => {}
            }
        }
        let stands = |place: &usize| !matches!(self.steps.get(*place), Some(Step::Split(..) | Step::Jump(_)));
        (0..seen.len()).filter(|&place| seen[place]).filter(stands).collect()
    }

    fn expected(&self, at: &[usize]) -> Matched {
        let mut next = Vec::new();
        let mut more = false;
        for place in at {
            match self.steps.get(*place) {
                Some(Step::Parameter(index)) => next.push(*index),
                Some(Step::More(before)) => {
                    more = true;
                    next.extend(*before);
                }
                _ => {}
            }
        }
        Matched { next, more, fits: 0, dotted: 0, all: true }
    }
}

#[cfg(test)]
mod tests {
    use apt_syntax::vocabulary::lookup;

    use super::super::forms_of;
    use super::*;

    /// Reads `C` as a circle, `L` as a line, `P` as a point, digits as numbers, longer capitals as words.
    fn typed(text: &'static str) -> Vec<Typed<'static>> {
        let mut all = Vec::new();
        for (index, one) in text.split(',').enumerate() {
            if index > 0 {
                all.push(Typed::Comma);
            }
            all.push(match one {
                "" => continue,
                "C" => Typed::Value(ValueKind::Geometry(GeometryKind::Circle)),
                "L" => Typed::Value(ValueKind::Geometry(GeometryKind::Line)),
                "P" => Typed::Value(ValueKind::Geometry(GeometryKind::Point)),
                "?" => Typed::Value(ValueKind::Unknown),
                word if word.len() > 1 && lookup(word).is_some() => Typed::Word(word),
                _ => Typed::Value(ValueKind::Scalar),
            });
        }
        all
    }

    /// What the forms of a word that go along expect next.
    fn next(word: &str, text: &'static str) -> Vec<String> {
        let mut names = Vec::new();
        for form in forms_of(lookup(word).unwrap()) {
            let matched = form.matched(&typed(text));
            if matched.all {
                names.extend(
                    matched
                        .next
                        .iter()
                        .map(|&index| form.text[form.parameters[index].range.clone()].to_owned()),
                );
            }
        }
        names.sort();
        names.dedup();
        names
    }

    #[test]
    fn forms_tell_what_can_stand_next() {
        assert_eq!(
            next("LINE", "P,"),
            ["ATANGL", "LEFT", "PARLEL", "PERPTO", "RIGHT", "SLOPE", "TANTO", "point"]
        );
        assert_eq!(next("LINE", "P,PARLEL,"), ["line"]);
        assert_eq!(next("LINE", "P,ATANGL,30,"), ["XAXIS", "YAXIS", "line"]);
        assert_eq!(next("POINT", "XLARGE,"), ["INTOF"]);
        assert_eq!(next("POINT", "XLARGE,INTOF,L,"), ["circle", "conic"]);
        assert_eq!(next("GOLFT", "C,PAST,"), ["cs", "cs1", "n"]);
        assert_eq!(next("GOLFT", "C,PAST,2,"), ["INTOF"]);
        assert_eq!(next("GOLFT", "C,L,"), ["feed", "label1"]);
        assert_eq!(next("SINF", ""), ["x"]);
        assert_eq!(next("SPINDL", "800,"), ["CCLW", "CLW"]);
        assert!(next("LINE", "SPINDL,").is_empty());
        assert!(next("CIRCLE", "CENTER,L,").is_empty(), "a line is no centre");
        assert!(next("CIRCLE", "CENTER,?,").contains(&"RADIUS".to_owned()), "what is not known yet may fit");
        assert_eq!(next("LOADTL", "1,2,3,"), ["n"], "dots go on");
        assert!(next("SCURV", "CURSEG,P,P,FLOW,").contains(&"CHORD".to_owned()));
        assert_eq!(next("PRINT", "AVPRT,"), ["OFF", "ON"]);
    }

    #[test]
    fn a_word_after_dots_is_that_word() {
        let knots = "NURBS,DEGREE,1,1,KNOTS,0,0,1,1,";
        assert_eq!(next("SSURF", "NURBS,DEGREE,1,1,KNOTS,0,0,1,1,KNOTS,"), ["t"]);
        assert_eq!(next("SSURF", "NURBS,DEGREE,1,1,KNOTS,0,0,1,1,KNOTS,0,0,1,1,PTS,"), ["point"]);
        assert_eq!(next("SSURF", "NURBS,DEGREE,1,1,KNOTS,0,0,1,1,KNOTS,0,0,1,1,PTS,P,P,P,P,WEIGHT,"), ["w"]);
        assert_eq!(next("SSURF", knots), ["KNOTS", "t"]);
        // Another form takes the words of a flow only by its dots.
        let flow = typed("SPLINE,P,P,FLOW,PARAM,0,1,SEG,");
        let dotted =
            |form: &Form| Some(form.matched(&flow)).filter(|matched| matched.all).map(|one| one.dotted);
        let all: Vec<usize> = forms_of(lookup("SCURV").unwrap()).iter().filter_map(dotted).collect();
        assert_eq!(all, [3, 0]);
    }

    #[test]
    fn sculptured_surfaces_stand_for_surfaces_of_motion() {
        let sculptured = Typed::Value(ValueKind::Geometry(GeometryKind::Sculptured));
        assert!(Atom::Placeholder("cs").takes(sculptured) && Atom::Placeholder("ds").takes(sculptured));
    }
}
