//! Splits CL text into statements: continuation, remarks, sequence prefixes and free text.

/// Words whose line is text and not arguments.
pub(super) const TEXT_WORDS: [&str; 7] =
    ["PARTNO", "PPRINT", "INSERT", "LETTER", "TPRINT", "REMARK", "TITLES"];

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
}

/// Splits a text; linear in its length.
pub(super) fn statements(text: &str) -> Vec<Statement> {
    let mut found = Vec::new();
    let mut lines = text.lines().enumerate();
    while let Some((at, line)) = lines.next() {
        let line = without_row_prefix(line);
        let number = saturated(found.len() + 1);
        let start = saturated(at);
        if let Some(free) = free_text(line) {
            found.push(Statement { number, line: start, text: String::new(), free: Some(free) });
            continue;
        }
        // Creo's pseudo statements are continued by `$`, and the rows below them are no positions.
        if line.trim_start().starts_with("$$") {
            let mut row = line;
            while line.trim_start().starts_with("$$->") && row.trim_end().ends_with('$') {
                match lines.next() {
                    Some((_, next)) => row = next,
                    None => break,
                }
            }
            found.push(Statement { number, line: start, text: String::new(), free: None });
            continue;
        }
        let mut text = String::new();
        let mut rest = line;
        loop {
            match rest.find('$') {
                None => {
                    text.push_str(rest);
                    break;
                }
                Some(mark) => {
                    text.push_str(&rest[..mark]);
                    if rest[mark..].starts_with("$$") {
                        break;
                    }
                }
            }
            match lines.next() {
                Some((_, next)) => rest = next,
                None => break,
            }
        }
        found.push(Statement { number, line: start, text, free: None });
    }
    found
}

fn saturated(value: usize) -> u32 {
    u32::try_from(value).unwrap_or(u32::MAX)
}

/// Takes off the `N12   ,` and `C12   ,` of NCL listings.
fn without_row_prefix(line: &str) -> &str {
    let inner = line.trim_start();
    let Some(rest) = inner.strip_prefix(['N', 'C', 'n', 'c']) else { return line };
    let digits = rest.bytes().take_while(u8::is_ascii_digit).count();
    if digits == 0 {
        return line;
    }
    rest[digits..].trim_start().strip_prefix(',').unwrap_or(line)
}

/// The word and text of a text statement; quotes and the slash of the ISO 4343 form are taken off.
fn free_text(line: &str) -> Option<(&'static str, String)> {
    let inner = line.trim_start();
    let word = TEXT_WORDS.into_iter().find(|word| {
        inner.get(..word.len()).is_some_and(|start| start.eq_ignore_ascii_case(word))
            && !inner[word.len()..].starts_with(|c: char| c.is_ascii_alphanumeric() || c == '_')
    })?;
    let rest = inner[word.len()..].trim();
    let rest = rest.strip_prefix('/').map_or(rest, str::trim);
    let quoted = rest.strip_prefix('\'').and_then(|rest| rest.strip_suffix('\''));
    Some((word, quoted.unwrap_or(rest).to_owned()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(source: &str) -> Vec<(u32, u32, String)> {
        statements(source).into_iter().map(|found| (found.number, found.line, found.text)).collect()
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
    fn text_statements_keep_dollars() {
        let found = statements("PPRINT COST 5$\nGOTO/1,2,3\nPARTNO/'A, B'\n");
        assert_eq!(found[0].free, Some(("PPRINT", "COST 5$".to_owned())));
        assert_eq!(found[1].text, "GOTO/1,2,3");
        assert_eq!(found[2].free, Some(("PARTNO", "A, B".to_owned())));
    }
}
