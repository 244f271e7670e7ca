//! Evidence of findings: what stands somewhere, and what should.

use apt_geometry::canonical::GeometryKind;
use smol_str::SmolStr;

/// What kind of thing a parameter or name is, as evidence.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Found {
    /// A number.
    Scalar,
    /// A geometric entity.
    Geometry(GeometryKind),
    /// A vocabulary word.
    Word(SmolStr),
    /// A label.
    Label,
    /// A macro name.
    Macro,
    /// A reserved array without subscript.
    Array,
    /// Text in quotes.
    Text,
    /// An empty position.
    Nothing,
}

/// What is wrong with a pair of SYN.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SynonymFault {
    /// One of the two is neither a name nor a word.
    NoSymbol,
    /// Where the new name should stand is a word, or a name that is used already.
    NotNew,
    /// Where the word of the language should stand is none, or SYN.
    NotWord,
}

/// What a statement wants at a place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Expected {
    Scalar,
    Surface,
    Plane,
    Point,
    Vector,
    Matrix,
    MatrixOrNomore,
    PlaneOrNumbers,
    Name,
    Label,
    Word,
    OnOrOff,
    ScalarOrWord,
    Integer,
    Pattern,
    Nothing,
}
