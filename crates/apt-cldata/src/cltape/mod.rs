//! The binary CLTAPE of the public APT III port, `cl.tap`, and the binary CL file of NCL and PostWorks, which is read only.
//!
//! Little-endian records without blocking, each with a header of four 32-bit integers (serial number, number of data
//! words, class, subclass) and data words of eight bytes: a float, a small integer in the low half, or text.

mod ncl;
mod reader;
mod word;
mod writer;

pub use ncl::is_ncl_file;
pub use reader::{TapeContents, TapeNote, TapeReadError, is_tape, read_tape};
pub(crate) use writer::written;
pub use writer::{TapeWriteError, write_tape, write_tape_until};

/// Record classes.
pub(crate) const CLASS_SEQUENCE: i32 = 1000;
pub(crate) const CLASS_POSTPROCESSOR: i32 = 2000;
pub(crate) const CLASS_SURFACE: i32 = 3000;
pub(crate) const CLASS_MOTION: i32 = 5000;
pub(crate) const CLASS_PARAMETER: i32 = 6000;
pub(crate) const CLASS_MODE: i32 = 9000;
pub(crate) const CLASS_END: i32 = 14000;
/// Class of the first record of an NCL file.
pub(crate) const HEADER_OF_NCL: u16 = 7400;

/// Subclasses.
pub(crate) const SURFACE_DRIVE: i32 = 2;
pub(crate) const MOTION_FROM: i32 = 3;
pub(crate) const MOTION_GOTO: i32 = 5;
pub(crate) const MOTION_MORE: i32 = 6;
pub(crate) const MODE_MULTAX: i32 = 2;
pub(crate) const MODE_UNITS: i32 = 9;

/// Bytes of a record header and of a data word.
pub(crate) const HEADER_BYTES: usize = 16;
pub(crate) const WORD_BYTES: usize = 8;
/// Data words before the coordinates of a motion record: name and subscript.
pub(crate) const MOTION_NAME_WORDS: usize = 2;
/// Most coordinate words in one motion record: 80 points, or 40 with tool axis.
pub(crate) const MOTION_COORDINATE_WORDS: usize = 240;
/// Subclasses whose data are text: LETTER, PPRINT, PARTNO, INSERT.
pub(crate) const TEXT_CODES: [(i32, &str); 4] =
    [(1043, "LETTER"), (1044, "PPRINT"), (1045, "PARTNO"), (1046, "INSERT")];
/// DISPLY, which has a text where it has the words of one, and switches otherwise.
pub(crate) const DISPLAY_CODE: (i32, &str) = (1021, "DISPLY");
/// Data words of a text record, and characters of text in each of them.
pub(crate) const TEXT_WORDS: usize = 11;
pub(crate) const TEXT_CHARACTERS_PER_WORD: usize = 6;
/// Canonical surface type of a circle, and the count that follows it.
pub(crate) const CIRCLE_TYPE: u32 = 4;
pub(crate) const CIRCLE_COUNT: u32 = 9;
/// Words of class 6000 that share a subclass, with the integer that tells on a tape which of the two it is.
pub(crate) const SWITCH_WORDS: [(i32, u32, &str); 4] =
    [(1, 0, "CUT"), (1, 1, "DNTCUT"), (2, 0, "2DCALC"), (2, 1, "3DCALC")];
/// The other words of class 6000; some systems have a subclass of its own for CUT.
pub(crate) const PARAMETER_WORDS: [(i32, &str); 5] =
    [(0, "CUT"), (3, "TOLER"), (4, "INTOL"), (5, "OUTTOL"), (6, "CUTTER")];
