//! Formats of definitions: which parameters a type takes, and how a parameter list finds its format.
//!
//! As in APT III the kinds must match exactly. Directional words are one interchangeable kind while a format is
//! looked for; whether the word itself is allowed is a second question, so that a wrong one is reported as such
//! (language reference 4.0).

use std::collections::BTreeSet;

use super::given::Given;
use super::{Argument, DefinitionError, Modifier};
use crate::canonical::{Geometry, GeometryKind};

/// What an argument is, as far as formats tell arguments apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ArgumentKind {
    /// A number.
    Scalar,
    /// A modifier word.
    Modifier(Modifier),
    /// A geometric entity of this type.
    Geometry(GeometryKind),
    /// An empty position.
    Empty,
}

/// One parameter of a format, or a group of them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Parameter {
    /// A number, with its name in the documentation.
    Scalar(&'static str),
    /// Exactly this word.
    Word(Modifier),
    /// A directional word: one of these.
    Selector(&'static [Modifier]),
    /// A geometric entity of one of these types, with its name in the documentation.
    Entity(&'static str, &'static [GeometryKind]),
    /// One of these sequences.
    Choice(&'static [&'static [Parameter]]),
    /// A sequence that stands at least once and as often as wanted.
    Repeated(&'static [Parameter]),
}

/// One form of a definition.
#[derive(Debug, Clone, Copy)]
pub struct Format {
    /// The parameters in order.
    pub parameters: &'static [Parameter],
    /// What the form defines, in one line.
    pub help: &'static str,
    /// Makes the geometry from arguments that match the parameters.
    pub(super) build: fn(&Given<'_>) -> Result<Geometry, DefinitionError>,
}

/// The formats of a type, in the order of the documentation. CANON (all values of the canonical form, or a copy with
/// some replaced) is a form of every type and is not listed.
pub fn formats(kind: GeometryKind) -> &'static [Format] {
    match kind {
        GeometryKind::Point => super::point::FORMATS,
        GeometryKind::Line => super::line::FORMATS,
        GeometryKind::Plane => super::plane::FORMATS,
        GeometryKind::Circle => super::circle::FORMATS,
        GeometryKind::Cylinder => super::round::CYLINDER_FORMATS,
        GeometryKind::Cone => super::round::CONE_FORMATS,
        GeometryKind::Sphere => super::round::SPHERE_FORMATS,
        GeometryKind::Ellipse => super::conic::ELLIPSE_FORMATS,
        GeometryKind::Hyperbola => super::conic::HYPERBOLA_FORMATS,
        GeometryKind::GeneralConic => super::conic::GENERAL_FORMATS,
        GeometryKind::LoftConic => super::plane_conic_points::FORMATS,
        GeometryKind::Quadric => super::conic::QUADRIC_FORMATS,
        GeometryKind::Vector => super::vector::FORMATS,
        GeometryKind::Matrix => super::matrix::FORMATS,
        GeometryKind::PolyConic
        | GeometryKind::Loft
        | GeometryKind::Mesh
        | GeometryKind::ElementSurface
        // Their statements have qualifiers that come in any number and order: no list of formats holds them.
        | GeometryKind::Sculptured
        | GeometryKind::SpaceCurve => &[],
        GeometryKind::TabulatedCylinder => super::tabulated::FORMATS,
        GeometryKind::RuledSurface => super::ruled::FORMATS,
        GeometryKind::Pattern => super::pattern::FORMATS,
    }
}

/// Words that are interchangeable while a format is looked for.
const DIRECTIONAL: &[Modifier] = &[
    Modifier::XLarge,
    Modifier::XSmall,
    Modifier::YLarge,
    Modifier::YSmall,
    Modifier::ZLarge,
    Modifier::ZSmall,
    Modifier::PositiveX,
    Modifier::PositiveY,
    Modifier::PositiveZ,
    Modifier::NegativeX,
    Modifier::NegativeY,
    Modifier::NegativeZ,
    Modifier::Large,
    Modifier::Small,
    Modifier::Left,
    Modifier::Right,
    Modifier::In,
    Modifier::Out,
    Modifier::Plus,
    Modifier::Minus,
    Modifier::XyPlane,
    Modifier::YzPlane,
    Modifier::ZxPlane,
    Modifier::XyRotation,
    Modifier::YzRotation,
    Modifier::ZxRotation,
    Modifier::RadiusAngle,
    Modifier::AngleRadius,
    Modifier::XAxis,
    Modifier::YAxis,
    Modifier::ZAxis,
];

/// How strictly a directional word must be one of the format's.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Words {
    Listed,
    AnyDirectional,
}

impl Parameter {
    fn takes(&self, kind: ArgumentKind, words: Words) -> bool {
        match (self, kind) {
            (Parameter::Scalar(_), ArgumentKind::Scalar) => true,
            (Parameter::Word(word), ArgumentKind::Modifier(found)) => *word == found,
            (Parameter::Selector(listed), ArgumentKind::Modifier(found)) => {
                listed.contains(&found) || (words == Words::AnyDirectional && DIRECTIONAL.contains(&found))
            }
            (Parameter::Entity(_, kinds), ArgumentKind::Geometry(found)) => kinds.contains(&found),
            _ => false,
        }
    }
}

/// A walk of a parameter list over an argument list: which positions can be reached, and what was looked for at the
/// farthest position that an argument could not pass.
struct Walk<'a> {
    kinds: &'a [ArgumentKind],
    words: Words,
    farthest: usize,
    wanted: Vec<Parameter>,
}

impl<'a> Walk<'a> {
    fn new(kinds: &'a [ArgumentKind], words: Words) -> Self {
        Walk { kinds, words, farthest: 0, wanted: Vec::new() }
    }

    /// Every position behind a match of `parameters` that starts at one of `starts`.
    fn sequence(&mut self, parameters: &[Parameter], starts: BTreeSet<usize>) -> BTreeSet<usize> {
        let mut reached = starts;
        for parameter in parameters {
            if reached.is_empty() {
                break;
            }
            reached = self.parameter(parameter, &reached);
        }
        reached
    }

    fn parameter(&mut self, parameter: &Parameter, starts: &BTreeSet<usize>) -> BTreeSet<usize> {
        match parameter {
            Parameter::Choice(sequences) => {
                sequences.iter().flat_map(|sequence| self.sequence(sequence, starts.clone())).collect()
            }
            Parameter::Repeated(sequence) => {
                let mut all = BTreeSet::new();
                let mut fresh = starts.clone();
                // Every turn consumes arguments, so this ends with the argument list.
                while !fresh.is_empty() {
                    fresh = self.sequence(sequence, fresh).difference(&all).copied().collect();
                    all.extend(fresh.iter().copied());
                }
                all
            }
            _ => {
                starts.iter().filter(|start| self.single(parameter, **start)).map(|start| start + 1).collect()
            }
        }
    }

    fn single(&mut self, parameter: &Parameter, position: usize) -> bool {
        if self.kinds.get(position).is_some_and(|kind| parameter.takes(*kind, self.words)) {
            return true;
        }
        if position > self.farthest {
            self.farthest = position;
            self.wanted.clear();
        }
        if position == self.farthest && !self.wanted.contains(parameter) {
            self.wanted.push(*parameter);
        }
        false
    }

    fn matches(&mut self, format: &Format) -> bool {
        self.sequence(format.parameters, BTreeSet::from([0])).contains(&self.kinds.len())
    }
}

/// The format that takes these arguments.
pub(super) fn find(kind: GeometryKind, arguments: &[Argument]) -> Result<&'static Format, DefinitionError> {
    let kinds: Vec<ArgumentKind> = arguments.iter().map(Argument::kind).collect();
    let mut strict = Walk::new(&kinds, Words::Listed);
    if let Some(format) = formats(kind).iter().find(|format| strict.matches(format)) {
        return Ok(format);
    }
    let loose = |format: &&Format| Walk::new(&kinds, Words::AnyDirectional).matches(format);
    let Some(format) = formats(kind).iter().find(loose) else {
        return Err(DefinitionError::UnknownFormat { kind });
    };
    let mut walk = Walk::new(&kinds, Words::Listed);
    walk.matches(format);
    match kinds.get(walk.farthest) {
        Some(ArgumentKind::Modifier(found)) => Err(DefinitionError::WrongModifier {
            position: walk.farthest,
            found: *found,
            expected: walk.wanted.iter().flat_map(allowed_words).collect(),
        }),
        _ => Err(DefinitionError::UnknownFormat { kind }),
    }
}

fn allowed_words(parameter: &Parameter) -> Vec<Modifier> {
    match parameter {
        Parameter::Selector(listed) => listed.to_vec(),
        Parameter::Word(word) => vec![*word],
        _ => Vec::new(),
    }
}

/// The format that takes arguments of these kinds, its directional words included.
pub fn matching_format(kind: GeometryKind, given: &[ArgumentKind]) -> Option<&'static Format> {
    formats(kind).iter().find(|format| Walk::new(given, Words::Listed).matches(format))
}

/// What can stand after the arguments `given`, in the order of the formats; without repetition. Nothing when no format
/// begins like this.
pub fn type_of_next(kind: GeometryKind, given: &[ArgumentKind]) -> Vec<ArgumentKind> {
    let mut next = Vec::new();
    for format in formats(kind) {
        let mut walk = Walk::new(given, Words::Listed);
        walk.sequence(format.parameters, BTreeSet::from([0]));
        if walk.farthest < given.len() {
            continue;
        }
        for parameter in &walk.wanted {
            let kinds: Vec<ArgumentKind> = match parameter {
                Parameter::Scalar(_) => vec![ArgumentKind::Scalar],
                Parameter::Entity(_, kinds) => kinds.iter().copied().map(ArgumentKind::Geometry).collect(),
                other => allowed_words(other).into_iter().map(ArgumentKind::Modifier).collect(),
            };
            next.extend(kinds);
        }
    }
    if given.is_empty() {
        next.push(ArgumentKind::Modifier(Modifier::Canon));
    }
    let mut seen = Vec::with_capacity(next.len());
    next.retain(|kind| {
        !seen.contains(kind) && {
            seen.push(*kind);
            true
        }
    });
    next
}

/// Index of the first argument that no format of the type can have at its place, and the parameters that could stand
/// there; the index is the number of arguments when the list ends too early.
pub fn first_mismatch(kind: GeometryKind, given: &[ArgumentKind]) -> (usize, Vec<Parameter>) {
    let mut walk = Walk::new(given, Words::Listed);
    for format in formats(kind) {
        if walk.matches(format) {
            return (given.len(), Vec::new());
        }
    }
    (walk.farthest, walk.wanted)
}
