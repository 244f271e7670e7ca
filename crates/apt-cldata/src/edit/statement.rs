//! The edit statements as CL records: TRACUT, INDEX and COPY stand in the CL file as the program gives them.

use apt_geometry::{canonical::Matrix, copy::CopyStep};
use smol_str::SmolStr;

use super::{COPY_CODE, INDEX_CODE, TRACUT_CODE};
use crate::record::{ClKind, ClRecord, ClWord};

/// A COPY statement.
pub(super) struct CopyOrder {
    pub(super) number: i64,
    pub(super) step: CopyStep,
    pub(super) count: u32,
    pub(super) isn: u32,
    pub(super) source: u32,
}

impl CopyOrder {
    /// The statement in the words that the program used.
    pub(super) fn statement(&self) -> ClRecord {
        let mut words = vec![ClWord::Number(self.number as f64)];
        let mut option = |word: &str, numbers: &mut dyn Iterator<Item = f64>| {
            words.push(ClWord::Word(word.into()));
            words.extend(numbers.map(number_word));
        };
        match &self.step {
            CopyStep::Same => option("SAME", &mut std::iter::empty()),
            CopyStep::Translation(by) => option("TRANSL", &mut by.iter().copied()),
            CopyStep::RotationAboutZ(degrees) => option("XYROT", &mut std::iter::once(*degrees)),
            CopyStep::Matrix(matrix) => option("MODIFY", &mut matrix.rows.into_iter().flatten()),
        }
        words.push(ClWord::Number(f64::from(self.count)));
        statement("COPY", COPY_CODE, words, self.isn, self.source)
    }
}

pub(super) fn statement(word: &str, code: u16, arguments: Vec<ClWord>, isn: u32, source: u32) -> ClRecord {
    ClRecord {
        isn,
        source,
        kind: ClKind::Postprocessor { word: SmolStr::new(word), code: Some(code), arguments },
    }
}

pub(super) fn index_statement(number: i64, isn: u32, source: u32) -> ClRecord {
    statement("INDEX", INDEX_CODE, vec![ClWord::Number(number as f64)], isn, source)
}

pub(super) fn transform_statement(matrix: Option<&Matrix>, isn: u32, source: u32) -> ClRecord {
    let words = match matrix {
        Some(matrix) => matrix.rows.into_iter().flatten().map(number_word).collect(),
        None => vec![ClWord::Word("NOMORE".into())],
    };
    statement("TRACUT", TRACUT_CODE, words, isn, source)
}

/// Adding zero takes the sign off a negative zero.
fn number_word(value: f64) -> ClWord {
    ClWord::Number(value + 0.0)
}
