//! The vocabulary: one data file, `vocabulary.toml`, holds class, code, forms and help of every word.

/// One word of the vocabulary.
#[derive(Debug, Clone, PartialEq)]
pub struct Word {
    /// The spelling, upper case.
    pub spelling: &'static str,
    /// What kind of word it is.
    pub class: WordClass,
    /// The integer code: of minor words the code on CL records, of post-processor words the subclass, of types the
    /// surface number.
    pub code: Option<u16>,
    /// The forms of the statement or definition, one line each.
    pub forms: &'static [&'static str],
    /// One line of help.
    pub help: &'static str,
}

/// The class of a word (language reference 3).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum WordClass {
    /// PARTNO and its kin: the rest of the card is text.
    Text,
    /// Motion.
    Motion,
    /// Tool position: TLLFT and its kin.
    ToolPosition,
    /// Path parameter with operands: CUTTER, INTOL.
    PathParameter,
    /// Path control, may be followed by a comma and another statement.
    PathControl,
    /// Logic: IF, LOOPST, MACRO, CALL, FINI.
    Logic,
    /// Symbol and definition control: RESERV, SYN, CANON, OBTAIN, ZSURF, REFSYS.
    Declaration,
    /// Cutter-path transformation: TRACUT, INDEX, COPY.
    Transformation,
    /// Input and output: READ, PUNCH, PRINT.
    InputOutput,
    /// System flag.
    SystemFlag,
    /// Geometric type.
    GeometricType,
    /// Function.
    Function,
    /// Post-processor word with parameters.
    Postprocessor,
    /// Post-processor word without parameters.
    PostprocessorBare,
    /// Minor word.
    Minor,
}
