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
    /// One of these words.
    Words(&'static [&'static str]),
    SculpturedSurface,
    /// A sculptured surface or a space curve.
    SculpturedElement,
    GuideSurface,
    SpaceCurve,
    LineOrCircle,
    FeedsOrPlane,
    DistanceVectorOrPlane,
    /// PS or a sculptured surface, and ON or OFF.
    CheckedAndSwitch,
}

/// A block of conditions that SCON sets and SMIL needs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ConditionBlock {
    /// SCON/DS.
    Guide,
    /// SCON/PS.
    Part,
    /// SCON/AXIS.
    Axis,
    /// SCON/FEED with four feed rates.
    Feed,
    /// SCON/FEED with a plane.
    Clearance,
    /// SCON/STEPOV.
    Stepover,
}

impl ConditionBlock {
    /// All blocks.
    pub const ALL: [ConditionBlock; 6] =
        [Self::Guide, Self::Part, Self::Axis, Self::Feed, Self::Clearance, Self::Stepover];

    /// The statement that sets the block.
    pub fn statement(self) -> &'static str {
        match self {
            Self::Guide => "SCON/DS",
            Self::Part => "SCON/PS",
            Self::Axis => "SCON/AXIS",
            Self::Feed => "SCON/FEED",
            Self::Clearance => "SCON/FEED,plane",
            Self::Stepover => "SCON/STEPOV",
        }
    }

    /// The statement with the places of its operands.
    pub fn template(self) -> &'static str {
        match self {
            Self::Guide => "SCON/DS,surface,PARAM,ulo,uhi,vlo,vhi,ON,vector",
            Self::Part => "SCON/PS,TO,surface,PLUS,0",
            Self::Axis => "SCON/AXIS,vector",
            Self::Feed => "SCON/FEED,cutting,stepover,plunge,rapid",
            Self::Clearance => "SCON/FEED,plane",
            Self::Stepover => "SCON/STEPOV,height,greatest,lift,passes",
        }
    }
}
