//! Which dialect a text is written in.

use std::ops::Range;

use super::DialectName;
use crate::dialect::SequenceFieldRule;
use crate::record::SequenceEvidence;

/// A dialect and why it was chosen.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Detection {
    /// The dialect.
    pub name: DialectName,
    /// Why.
    pub reason: DetectionReason,
}

/// Why a dialect was chosen.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum DetectionReason {
    /// A comment such as `$$ apt-lsp: dialect=apt4` among the first lines.
    Comment,
    /// The ending of the file's name.
    Extension(String),
    /// Something in the text that only this dialect has.
    Mark(&'static str),
    /// Columns 73-80 hold sequence numbers.
    SequenceFields,
    /// Nothing speaks for another one.
    Default,
}

/// How many lines with something in them are looked at.
pub const LINES_LOOKED_AT: usize = 50;
/// Among how many lines the comment that names the dialect may stand.
const COMMENT_LINES: usize = 5;

/// File endings that only CL files have.
const CL_EXTENSIONS: [&str; 10] =
    ["aptsource", "cls", "clsf", "ncl", "tph", "as", "cl", "cla", "cldata", "clf"];

/// Starts of lines (upper case, blanks removed) that only the text of CAM systems has.
const CL_MARKS: [&str; 9] = [
    "$$*PRO/CLFILE",
    "$$->",
    "$$*CATIA",
    "$$CATIAAPTVERSION",
    "$$OPERATIONNAME:",
    "TOOLPATH/",
    "END-OF-PATH",
    "TLDATA/",
    "MOVARC/",
];

/// Texts in quotes behind a slash, as CAM systems write them. A part programmer may begin a text that way too, so that
/// definitions speak louder.
const QUOTED_TEXTS: [&str; 2] = ["PARTNO/'", "PPRINT/'"];

/// Starts of statements (upper case, blanks removed) that only APT4 has.
const APT4_STARTS: [&str; 6] = ["SCON/", "SMIL/", "DO/", "SSPRT/", "AVCTRL/", "CHKSRF/"];
/// Parts of statements that only APT4 has.
const APT4_PARTS: [&str; 8] = ["=SSURF/", "=SCURV/", ".EQ.", ".NE.", ".LT.", ".LE.", ".GT.", ".GE."];

/// What speaks for a dialect wherever it stands in a text. It is kept with a text that is edited, and found anew only where
/// an edit touches something of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BodyEvidence {
    /// The dialect that statements speak for, and by what.
    mark: Option<(DialectName, &'static str)>,
    sequence: SequenceEvidence,
}

impl BodyEvidence {
    /// Looks through a text.
    pub fn of(text: &str) -> Self {
        Self { mark: mark_of_statements(text), sequence: SequenceEvidence::of(text) }
    }

    /// What is found after some whole lines have given way to others; `whole`, the new text, is looked through only if one
    /// of them speaks for a dialect.
    #[must_use]
    pub fn after(self, gone: &str, come: &str, whole: impl FnOnce() -> String) -> Self {
        let speaks = |lines: &str| lines.lines().any(|line| mark_of_line(line).is_some());
        let mark = if speaks(gone) || speaks(come) { mark_of_statements(&whole()) } else { self.mark };
        let sequence = self.sequence.minus(SequenceEvidence::of(gone)).plus(SequenceEvidence::of(come));
        Self { mark, sequence }
    }
}

/// Finds the dialect of a text: a comment that names it, marks of its content, the ending of the file's name, and
/// sequence fields, in this order.
pub fn detect(text: &str, file_name: Option<&str>) -> Detection {
    detect_with(text, BodyEvidence::of(text), file_name)
}

/// The same for a text of which no more than the first [`LINES_LOOKED_AT`] lines with something in them are given, and what
/// was found in all of it.
pub fn detect_with(head: &str, body: BodyEvidence, file_name: Option<&str>) -> Detection {
    if let Some(name) = named_in_comment(head) {
        return Detection { name, reason: DetectionReason::Comment };
    }
    if let Some((name, mark)) = mark_of_system(head).or(body.mark) {
        return Detection { name, reason: DetectionReason::Mark(mark) };
    }
    if let Some(extension) = file_name.and_then(cl_extension)
        && !is_part_program(head)
    {
        return Detection { name: DialectName::Cl, reason: DetectionReason::Extension(extension) };
    }
    if body.sequence.decides(SequenceFieldRule::WhenPresent) {
        return Detection { name: DialectName::Apt3, reason: DetectionReason::SequenceFields };
    }
    Detection { name: DialectName::default(), reason: DetectionReason::Default }
}

fn named_in_comment(text: &str) -> Option<DialectName> {
    text.get(name_in_comment(text)?)?.parse().ok()
}

/// Where the comment that names the dialect has the name, in bytes.
pub fn name_in_comment(text: &str) -> Option<Range<usize>> {
    for line in text.lines().filter(|line| !line.trim().is_empty()).take(COMMENT_LINES) {
        let Some(comment) = line.trim().strip_prefix("$$") else { continue };
        let Some(setting) = comment.trim().strip_prefix("apt-lsp:") else { continue };
        for pair in setting.split([',', ' ']) {
            let name =
                pair.trim().strip_prefix("dialect=").filter(|name| name.parse::<DialectName>().is_ok());
            if let Some(name) = name {
                // Both are parts of one text.
                let start = name.as_ptr().addr() - text.as_ptr().addr();
                return Some(start..start + name.len());
            }
        }
    }
    None
}

fn lines_looked_at(text: &str) -> impl Iterator<Item = String> + '_ {
    text.lines().filter(|line| !line.trim().is_empty()).take(LINES_LOOKED_AT).map(|line| {
        line.chars().filter(|character| !character.is_whitespace()).collect::<String>().to_ascii_uppercase()
    })
}

/// What only CL files of some system have among their first lines.
fn mark_of_system(head: &str) -> Option<(DialectName, &'static str)> {
    let mut quoted = None;
    for line in lines_looked_at(head) {
        if let Some(mark) = CL_MARKS.into_iter().find(|mark| line.starts_with(mark)) {
            return Some((DialectName::Cl, mark));
        }
        if is_postworks_row(&line) {
            return Some((DialectName::Cl, "N1,"));
        }
        quoted = quoted.or_else(|| QUOTED_TEXTS.into_iter().find(|mark| line.starts_with(mark)));
    }
    quoted.filter(|_| !is_part_program(head)).map(|mark| (DialectName::Cl, mark))
}

/// The dialect that the statements speak for. Those of APT4 may come late in a program, and an IF over several statements
/// later still.
fn mark_of_statements(text: &str) -> Option<(DialectName, &'static str)> {
    let mut apt4 = None;
    for mark in text.lines().filter_map(mark_of_line) {
        if mark.0 == DialectName::Free {
            return Some(mark);
        }
        apt4 = apt4.or(Some(mark));
    }
    apt4
}

/// The dialect that a line speaks for.
fn mark_of_line(line: &str) -> Option<(DialectName, &'static str)> {
    let is_text = ["PARTNO", "PPRINT", "REMARK", "INSERT", "TITLES", "$$"]
        .iter()
        .any(|word| line.get(..word.len()).is_some_and(|head| head.eq_ignore_ascii_case(word)));
    if is_text || !line.contains(['.', '=', '/']) {
        return None;
    }
    let statement: String =
        line.chars().take_while(|character| *character != '$').filter(|c| !c.is_whitespace()).collect();
    let statement = statement.to_ascii_uppercase();
    let after_label = statement
        .split_once(')')
        .filter(|(label, _)| !label.contains('('))
        .map_or(&*statement, |(_, rest)| rest);
    if begins_several(after_label) {
        return Some((DialectName::Free, "THEN"));
    }
    let start = APT4_STARTS.into_iter().find(|mark| after_label.starts_with(mark));
    let relations = after_label.starts_with("IF(");
    let part = || {
        let mut parts = APT4_PARTS.into_iter().filter(|part| relations || part.starts_with('='));
        parts.find(|part| after_label.contains(part))
    };
    start.or_else(part).map(|mark| (DialectName::Apt4, mark))
}

/// Whether a statement (upper case, without blanks and label) is an IF over several statements, which APT4 does not have.
fn begins_several(statement: &str) -> bool {
    statement.starts_with("IF(") && statement.trim_end_matches(';').ends_with(")THEN")
}

/// `N12,WORD…`: the rows of PostWorks text.
fn is_postworks_row(line: &str) -> bool {
    let Some(rest) = line.strip_prefix('N') else { return false };
    let digits = rest.bytes().take_while(u8::is_ascii_digit).count();
    digits > 0 && rest.get(digits..).is_some_and(|rest| rest.starts_with(',') && rest.len() > 1)
}

/// The ending of a name, if it is one of CL files; `op010.ncl.12` has a version behind it.
fn cl_extension(file_name: &str) -> Option<String> {
    let mut parts = file_name.rsplit('.');
    let mut last = parts.next()?;
    if !last.is_empty() && last.bytes().all(|byte| byte.is_ascii_digit()) {
        last = parts.next()?;
    }
    parts.next()?;
    let extension = last.to_ascii_lowercase();
    CL_EXTENSIONS.contains(&extension.as_str()).then_some(extension)
}

/// Definitions and motion along surfaces make a part program.
fn is_part_program(text: &str) -> bool {
    lines_looked_at(text).filter(|line| !line.starts_with("$$")).any(|line| {
        ["=POINT/", "=LINE/", "=PLANE/", "=CIRCLE/", "=MACRO", "=VECTOR/", "=CYLNDR/"]
            .iter()
            .any(|mark| line.contains(mark))
            || ["GOLFT/", "GORGT/"].iter().any(|mark| line.contains(mark))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn name(text: &str, file: &str) -> DialectName {
        detect(text, Some(file)).name
    }

    #[test]
    fn comments_and_marks_decide_before_the_name() {
        assert_eq!(name("PARTNO X\n$$ apt-lsp: dialect=apt4\n", "a.apt"), DialectName::Apt4);
        assert_eq!(name("$$*         Pro/CLfile  Version 11.0\nGOTO / 1, 2, 3\n", "a.txt"), DialectName::Cl);
        assert_eq!(name("TOOL PATH/P,TOOL,T\nEND-OF-PATH\n", "a.apt"), DialectName::Cl);
        assert_eq!(name("MACHIN/G\nPARTNO/'1001'\n", "a.apt"), DialectName::Cl);
        assert_eq!(name("N1    , PARTNO  SPAR\nN2    , MACHIN/ PWORKS, 12\n", "x"), DialectName::Cl);
        assert_eq!(name("PARTNO A\nIF(X.EQ.1.AND.Y.EQ.2)Z=1\n", "a.apt"), DialectName::Apt4);
        assert_eq!(name("PARTNO A\n20)DO/A,I=1,4\n", "a.apt"), DialectName::Apt4);
        assert_eq!(
            name("PARTNO A\nIF(X.EQ.1)Z=1\nb) if (X.gt.2) then $$ so\nENDIF\n", "a.apt"),
            DialectName::Free
        );
        assert_eq!(name("PARTNO A\nPPRINT IF(X.EQ.1)THEN\nIF(X.EQ.1)THEN=1\n", "a.apt"), DialectName::Apt4);
    }

    #[test]
    fn the_whole_text_is_looked_through_only_where_lines_speak_for_a_dialect() {
        let text = "PARTNO A\nP=POINT/1,2\nFINI\n";
        let body = BodyEvidence::of(text);
        for line in ["P2=POINT/1,.5\n", "$$ SCON/INT\n", "PPRINT IF(X.EQ.1)\n", "\n", "GOTO/P $$ DO/5\n"] {
            let more = body.after("", line, || panic!("{line} says nothing"));
            assert_eq!(more, BodyEvidence::of(&format!("{text}{line}")));
            assert_eq!(more.after(line, "", || panic!("{line} says nothing")), body);
        }
        let card = format!("{:<72}{:08}\n", "A=1", 10);
        for line in ["DO/5,I=1,3\n", "A=1\n7) if (x .eq. 1) y=2\n", "IF(A.GT.1)THEN\n", &card] {
            let whole = format!("{text}{line}");
            let more = body.after("", line, || whole.clone());
            assert_eq!(more, BodyEvidence::of(&whole));
            assert_ne!(more, body);
            assert_eq!(more.after(line, "", || text.to_owned()), body);
        }
    }

    #[test]
    fn a_part_program_may_begin_its_name_with_a_quotation_mark() {
        let program = "partno /'two plates \"4 in\" wide\npl = plane/0,0,1,2\nFINI\n";
        assert_eq!(name(program, "a.apt"), DialectName::Free);
        assert_eq!(name("PPRINT/'ROUGHING'\nGOTO/1,2,3\n", "a.apt"), DialectName::Cl);
    }

    #[test]
    fn the_ending_decides_for_files_without_definitions() {
        assert_eq!(name("GOTO/1,2,3\n", "a.cl"), DialectName::Cl);
        assert_eq!(name("GOTO/1,2,3\n", "a.ncl.12"), DialectName::Cl);
        assert_eq!(name("P=POINT/1,2\nGOTO/P\n", "a.cl"), DialectName::Free);
        assert_eq!(name("FROM/0,0,0\nGOTO/1,2,3\nFINI\n", "a.apt"), DialectName::Free);
        assert_eq!(detect("", None), Detection { name: DialectName::Free, reason: DetectionReason::Default });
    }

    #[test]
    fn cards_are_recognised_by_their_sequence_fields() {
        let deck: String = ["PARTNO X", "A=1", "FINI"]
            .iter()
            .enumerate()
            .map(|(n, text)| format!("{text:<72}{n:08}\n"))
            .collect();
        assert_eq!(detect(&deck, Some("a.apt")).reason, DetectionReason::SequenceFields);
    }
}
