//! The modifier words of geometric definitions.

macro_rules! modifiers {
    ($($variant:ident = $word:literal,)*) => {
        /// A modifier word of a definition; the spelling is that of the language.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        #[expect(missing_docs, reason = "the names are the language's own words, spelled out")]
        pub enum Modifier { $($variant,)* }

        impl Modifier {
            /// The modifier with this spelling, if definitions know it.
            pub fn from_word(word: &str) -> Option<Self> {
                match word {
                    $($word => Some(Self::$variant),)*
                    "DSTAN" => Some(Self::TangentTo),
                    "CIRCUL" => Some(Self::Arc),
                    "GRID" => Some(Self::Parallel),
                    _ => None,
                }
            }

            /// The spelling in the language.
            pub fn word(self) -> &'static str {
                match self { $(Self::$variant => $word,)* }
            }
        }
    };
}

modifiers! {
    AtAngle = "ATANGL",
    Center = "CENTER",
    Cross = "CROSS",
    FunctionOfY = "FUNOFY",
    IntersectionOf = "INTOF",
    Inverse = "INVERS",
    Large = "LARGE",
    Left = "LEFT",
    Length = "LENGTH",
    Minus = "MINUS",
    NegativeX = "NEGX",
    NegativeY = "NEGY",
    NegativeZ = "NEGZ",
    NoX = "NOX",
    NoY = "NOY",
    NoZ = "NOZ",
    Parallel = "PARLEL",
    PerpendicularTo = "PERPTO",
    Plus = "PLUS",
    PositiveX = "POSX",
    PositiveY = "POSY",
    PositiveZ = "POSZ",
    Radius = "RADIUS",
    Right = "RIGHT",
    Scale = "SCALE",
    Small = "SMALL",
    TangentTo = "TANTO",
    Times = "TIMES",
    Translate = "TRANSL",
    Unit = "UNIT",
    XLarge = "XLARGE",
    XSmall = "XSMALL",
    XyPlane = "XYPLAN",
    XyRotation = "XYROT",
    YLarge = "YLARGE",
    YSmall = "YSMALL",
    YzPlane = "YZPLAN",
    YzRotation = "YZROT",
    ZLarge = "ZLARGE",
    ZSmall = "ZSMALL",
    ZxPlane = "ZXPLAN",
    ZxRotation = "ZXROT",
    ThreePointsTwoSlopes = "3PT2SL",
    FourPointsOneSlope = "4PT1SL",
    FivePoints = "5PT",
    Intercept = "INTERC",
    Slope = "SLOPE",
    In = "IN",
    Out = "OUT",
    Canon = "CANON",
    Mirror = "MIRROR",
    Counterclockwise = "CCLW",
    Clockwise = "CLW",
    Constant = "CONST",
    Increment = "INCR",
    Decrement = "DECR",
    Linear = "LINEAR",
    Arc = "ARC",
    XAxis = "XAXIS",
    YAxis = "YAXIS",
    ZAxis = "ZAXIS",
    FourPoint = "FOURPT",
    TwoPoint = "TWOPT",
    PointSlope = "PTSLOP",
    PointNormal = "PTNORM",
    Spline = "SPLINE",
    RadiusAngle = "RTHETA",
    AngleRadius = "THETAR",
    Xyz = "XYZ",
    Transform = "TRFORM",
    Normal = "NORMAL",
    Through = "THRU",
    Random = "RANDOM",
    At = "AT",
    On = "ON",
    XCoordinate = "XCOORD",
    YCoordinate = "YCOORD",
    ZCoordinate = "ZCOORD",
    Type = "TYPE",
}
