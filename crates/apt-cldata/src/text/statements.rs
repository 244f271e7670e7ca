//! Splits CL text into statements: continuation, remarks, sequence prefixes and free text.

/// Words whose line is text and not arguments.
pub(super) const TEXT_WORDS: [&str; 7] =
    ["PARTNO", "PPRINT", "INSERT", "LETTER", "TPRINT", "REMARK", "TITLES"];

/// DISPLY, whose line is text where it stands behind a slash and is none of the switches.
const DISPLAY: &str = "DISPLY";
const DISPLAY_SWITCHES: [&str; 5] = ["ON", "OFF", "AUTO", "LIGHT", "NIXIE"];

/// One statement with remarks and continuation marks taken out.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Statement {
    /// Number from 1; blank lines and remarks count, continuation lines do not.
    pub(super) number: u32,
    /// Zero-based line it begins on.
    pub(super) line: u32,
    /// Its text; empty for blank lines and remarks.
    pub(super) text: String,
    /// The word and the text after it, for a text statement.
    pub(super) free: Option<(&'static str, String)>,
    /// What stands behind `$$`, or behind the `$` of a line that goes on.
    pub(super) remarks: Vec<String>,
}

/// Splits a text, one statement after the other; linear in its length.
pub(super) fn statements(text: &str) -> impl Iterator<Item = Statement> {
    let mut lines = text.lines().enumerate();
    let mut found = 0;
    std::iter::from_fn(move || {
        let (at, whole) = lines.next()?;
        found += 1;
        let line = without_row_prefix(whole);
        let mut statement = Statement {
            number: saturated(found),
            line: saturated(at),
            text: String::new(),
            free: None,
            remarks: Vec::new(),
        };
        let mut next = || lines.next().map(|(_, next)| next);
        if let Some((word, text)) = free_text(line) {
            let text = if line.len() < whole.len() { rows_of_text(text, &mut next) } else { text };
            statement.free = Some((word, text));
        } else if let Some(remark) = line.trim_start().strip_prefix("$$") {
            statement.remarks.push(remark_with_rows(remark, &mut next));
        } else {
            significant(line, &mut statement, &mut next);
        }
        Some(statement)
    })
}

/// PostWorks goes on with a text in the next row where one ends in `~`.
fn rows_of_text<'a>(text: String, next: &mut impl FnMut() -> Option<&'a str>) -> String {
    let mut joined = text;
    while joined.ends_with('~') {
        joined.pop();
        let Some(row) = next() else { break };
        joined.push_str(row.trim_end());
    }
    joined
}

/// Creo's pseudo statements are continued by `$`, and the rows below them are no positions.
fn remark_with_rows<'a>(remark: &str, next: &mut impl FnMut() -> Option<&'a str>) -> String {
    let mut joined = remark.trim_end().to_owned();
    while remark.starts_with("->") && joined.ends_with('$') {
        joined.truncate(joined.trim_end_matches('$').trim_end().len());
        let Some(row) = next() else { break };
        joined.push(' ');
        joined.push_str(row.trim());
    }
    joined
}

fn significant<'a>(line: &'a str, statement: &mut Statement, next: &mut impl FnMut() -> Option<&'a str>) {
    let mut rest = line;
    loop {
        let Some(mark) = rest.find('$') else { return statement.text.push_str(rest) };
        statement.text.push_str(&rest[..mark]);
        let (remark, ends) = match rest[mark..].strip_prefix("$$") {
            Some(remark) => (remark, true),
            None => (&rest[mark + 1..], false),
        };
        if !remark.trim().is_empty() {
            statement.remarks.push(remark.trim_end().to_owned());
        }
        if ends {
            return;
        }
        let Some(row) = next() else { return };
        rest = row;
    }
}

fn saturated(value: usize) -> u32 {
    u32::try_from(value).unwrap_or(u32::MAX)
}

/// Takes off the `N12   ,` and `C12   ` of NCL listings.
fn without_row_prefix(line: &str) -> &str {
    let inner = line.trim_start();
    let Some(rest) = inner.strip_prefix(['N', 'C', 'n', 'c']) else { return line };
    let digits = rest.bytes().take_while(u8::is_ascii_digit).count();
    if digits == 0 {
        return line;
    }
    let behind = &rest[digits..];
    match behind.trim_start().strip_prefix(',') {
        Some(statement) => statement,
        // The row in which a long record goes on has no comma.
        None if inner.starts_with(['C', 'c']) && is_word_row(behind) => behind,
        None => line,
    }
}

/// Blanks, and then a word.
fn is_word_row(behind: &str) -> bool {
    behind.starts_with(' ') && behind.trim_start().starts_with(|c: char| c.is_ascii_alphabetic())
}

/// The word and text of a text statement; quotes and the slash of the ISO 4343 form are taken off.
fn free_text(line: &str) -> Option<(&'static str, String)> {
    let inner = line.trim_start();
    let word = TEXT_WORDS.into_iter().chain([DISPLAY]).find(|word| {
        inner.get(..word.len()).is_some_and(|start| start.eq_ignore_ascii_case(word))
            && !inner[word.len()..].starts_with(|c: char| c.is_ascii_alphanumeric() || c == '_')
    })?;
    let rest = inner[word.len()..].trim();
    if word == DISPLAY && !is_displayed(rest) {
        return None;
    }
    let rest = rest.strip_prefix('/').map_or(rest, str::trim);
    let quoted = rest.strip_prefix('\'').and_then(|rest| rest.strip_suffix('\''));
    Some((word, quoted.unwrap_or(rest).to_owned()))
}

/// Whether what stands behind DISPLY is a text: not a switch, and not the number of a lamp or of a display.
pub(super) fn is_displayed(behind: &str) -> bool {
    let Some(text) = behind.strip_prefix('/') else { return false };
    let first = text.split([',', '$']).next().unwrap_or_default().trim();
    let is_switch = DISPLAY_SWITCHES.iter().any(|switch| first.eq_ignore_ascii_case(switch));
    !(first.is_empty() || is_switch || first.parse::<f64>().is_ok())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(source: &str) -> Vec<(u32, u32, String)> {
        statements(source).map(|found| (found.number, found.line, found.text)).collect()
    }

    #[test]
    fn continuation_and_remarks() {
        let source = "GOTO / 48.0, 3.3, $ rest\n       -6.0 $$ remark\n$$ GOTO / 9,9,9\n\nRAPID\n";
        assert_eq!(
            texts(source),
            vec![
                (1, 0, "GOTO / 48.0, 3.3,        -6.0 ".to_owned()),
                (2, 2, String::new()),
                (3, 3, String::new()),
                (4, 4, "RAPID".to_owned()),
            ]
        );
    }

    #[test]
    fn rows_of_a_pseudo_statement_are_not_positions() {
        let source = "$$-> CSYS / 1,0,0,0, $\n 0,1,0,0, $\n 0,0,1,0\nGOTO / 1,2,3\n";
        assert_eq!(texts(source), vec![(1, 0, String::new()), (2, 3, "GOTO / 1,2,3".to_owned())]);
    }

    #[test]
    fn remarks_are_kept_with_their_statement() {
        let source = "$$ a $ b\nGOTO / 1, $ so\n 2,3 $$ far\n$$-> CSYS / 1, 0, $\n  0, 1\nRAPID\n";
        let remarks: Vec<(u32, Vec<String>)> =
            statements(source).map(|found| (found.line, found.remarks)).collect();
        let list = |texts: &[&str]| texts.iter().map(|text| (*text).to_owned()).collect::<Vec<String>>();
        assert_eq!(
            remarks,
            vec![
                (0, list(&[" a $ b"])),
                (1, list(&[" so", " far"])),
                (3, list(&["-> CSYS / 1, 0, 0, 1"])),
                (5, list(&[])),
            ]
        );
    }

    #[test]
    fn rows_of_postworks() {
        let source = "N5    , PPRINT CLAMP AT ENDS ~\nOF THE BAR\nC15     GOTO/ 1.,2.,3.\nC1 = POINT/1,2\n";
        let found: Vec<_> = statements(source).collect();
        assert_eq!(found[0].free, Some(("PPRINT", "CLAMP AT ENDS OF THE BAR".to_owned())));
        assert_eq!(found[1].text, "     GOTO/ 1.,2.,3.");
        assert_eq!(found[2].text, "C1 = POINT/1,2");
    }

    #[test]
    fn text_statements_keep_dollars() {
        let found: Vec<_> = statements("PPRINT COST 5$\nGOTO/1,2,3\nPARTNO/'A, B'\n").collect();
        assert_eq!(found[0].free, Some(("PPRINT", "COST 5$".to_owned())));
        assert_eq!(found[1].text, "GOTO/1,2,3");
        assert_eq!(found[2].free, Some(("PARTNO", "A, B".to_owned())));
    }

    #[test]
    fn displayed_texts_are_kept_as_they_are() {
        let free = |line: &str| statements(line).next().and_then(|found| found.free);
        for (line, text) in [
            ("DISPLY/PUT ON THE CLAMP, 3 mm left", "PUT ON THE CLAMP, 3 mm left"),
            ("disply / a  b 5$", "a  b 5$"),
            ("DISPLY/'ON'", "ON"),
        ] {
            assert_eq!(free(line), Some(("DISPLY", text.to_owned())), "{line}");
        }
        for line in
            ["DISPLY/ON", "DISPLY / off", "DISPLY/AUTO", "DISPLY/LIGHT,2", "DISPLY/1,2", "DISPLY", "DISPLY/"]
        {
            assert_eq!(free(line), None, "{line}");
        }
    }
}
