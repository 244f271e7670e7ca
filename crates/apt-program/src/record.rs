//! What Section 1 hands on: the records of PROTAP, with their origins.

use std::{path::PathBuf, sync::Arc};

use apt_geometry::{canonical::Matrix, copy::CopyStep, motion::MotionCommand, regional::RegionalMilling};
use apt_syntax::{SyntaxTree, TextRange};
use smol_str::SmolStr;

/// Where something comes from: the statement, and the macro calls and loop turns around it.
#[derive(Debug, Clone, PartialEq)]
pub struct Origin {
    /// Internal statement number, from 1: blank and comment lines count, continuation lines do not.
    pub isn: u32,
    /// Which statement part, relative to the start of the statement.
    pub range: TextRange,
    /// The macro call or loop turn that this statement runs in; `None` at the top level.
    pub frame: Option<Arc<Frame>>,
    /// The included file that the statement stands in; `None` for the program itself.
    pub source: Option<Arc<SourceFile>>,
}

impl Origin {
    /// A place in the program itself, outside of all macro calls and loops.
    pub fn in_program(isn: u32, range: TextRange) -> Self {
        Self { isn, range, frame: None, source: None }
    }

    /// Number and range of the statement of the program that led here: the statement itself, or the INCLUD or CALL of
    /// the program through which a statement of an included file came to be executed.
    pub fn place_in_program(&self) -> (u32, TextRange) {
        if self.source.is_none() {
            return (self.isn, self.range);
        }
        let around = std::iter::successors(self.frame.as_deref(), |frame| frame.parent.as_deref());
        let called = around.into_iter().find(|frame| frame.source.is_none());
        called.map_or((1, TextRange::default()), |frame| (frame.isn, frame.range))
    }

    /// The numbers of all statements of the program by which this was done: the statement itself, and each CALL, INCLUD and
    /// LOOPST around it.
    pub fn statements_in_program(&self) -> impl Iterator<Item = u32> {
        let around = std::iter::successors(self.frame.as_deref(), |frame| frame.parent.as_deref());
        let around = around.filter(|frame| frame.source.is_none()).map(|frame| frame.isn);
        std::iter::once(self.place_in_program().0).chain(around)
    }
}

/// A file whose statements an INCLUD puts in.
#[derive(Debug, Clone)]
pub struct SourceFile {
    /// Where it was found.
    pub path: PathBuf,
    /// Its statements.
    pub tree: SyntaxTree,
}

impl PartialEq for SourceFile {
    /// Two readings of one file are the same file.
    fn eq(&self, other: &Self) -> bool {
        self.path == other.path
    }
}

/// One level of macro call or loop turn.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    /// Macro call or loop.
    pub kind: FrameKind,
    /// Macro name; empty for a loop.
    pub name: SmolStr,
    /// ISN of the CALL, or of the LOOPST or DO.
    pub isn: u32,
    /// Range of the CALL or LOOPST, relative to its statement.
    pub range: TextRange,
    /// How many times a backward jump has been taken in this loop or macro body, plus one.
    pub turn: u32,
    /// The frame around this one.
    pub parent: Option<Arc<Frame>>,
    /// The included file that the CALL, LOOPST or INCLUD stands in; `None` for the program itself.
    pub source: Option<Arc<SourceFile>>,
}

/// The kind of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names say it")]
pub enum FrameKind {
    Macro,
    Loop,
    Include,
}

/// One record for Sections 2 to 4.
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    /// Where it comes from.
    pub origin: Origin,
    /// The label of the statement, where TRANTO and multiple check surfaces can go on.
    pub label: Option<SmolStr>,
    /// What it says.
    pub kind: RecordKind,
}

/// What a record says.
#[derive(Debug, Clone, PartialEq)]
pub enum RecordKind {
    /// A command to Section 2. A trailing feed rate has become a FEDRAT record before it.
    Motion(Box<MotionCommand>),
    /// SMIL with the conditions of SCON and the switches in force.
    Regional(Box<RegionalMilling>),
    /// A post-processor statement (class 2000).
    Postprocessor {
        /// The word.
        word: SmolStr,
        /// Its subclass.
        code: u16,
        /// Its parameters in order.
        arguments: Vec<PostArgument>,
    },
    /// PARTNO, PPRINT, INSERT with their text.
    Text {
        /// The word.
        word: SmolStr,
        /// Its subclass.
        code: u16,
        /// The text after the word, verbatim.
        text: SmolStr,
    },
    /// TRACUT/matrix (`Some`) or TRACUT/NOMORE.
    Transform(Option<Matrix>),
    /// INDEX/n (`end` false) or INDEX/n,NOMORE.
    Index {
        /// The index number.
        number: i64,
        /// True for NOMORE.
        end: bool,
    },
    /// COPY.
    Copy {
        /// The index number.
        number: i64,
        /// What each copy adds.
        step: CopyStep,
        /// How many copies.
        count: u32,
    },
    /// A record that Section 2 only passes through: CUTTER/OPTION, DMILL, BEVELS.
    Control {
        /// The word.
        word: SmolStr,
        /// Class and subclass.
        code: [u16; 2],
        /// Its parameters.
        arguments: Vec<PostArgument>,
    },
    /// DNTCUT/PRINT, behind the command of DNTCUT: the positions that are kept from the path are listed.
    ListSuppressed,
    /// PTONLY/1: Section 2 is not to run at all, wherever in the program this stands (language reference 7.10).
    SkipMotion,
    /// TRANTO/label.
    Transfer(SmolStr),
    /// A motion, or a parameter that motions depend on, that could not be evaluated: Section 1 has reported why.
    /// What follows is not known to stand where the program wants it.
    Gap,
    /// FINI.
    End,
}

/// One parameter of a post-processor statement.
#[derive(Debug, Clone, PartialEq)]
pub enum PostArgument {
    /// A number.
    Number(f64),
    /// A word with its code.
    Word(SmolStr, u16),
    /// Quoted or free text (CL dialects).
    Text(SmolStr),
    /// A canonical form (CLEARP, CLRSRF, TRANS).
    Geometry(apt_geometry::canonical::Geometry),
}
