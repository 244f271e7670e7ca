//! Comments by which an author says that a finding has been looked at.
//!
//! `$$ apt-lsp: allow APT0952` behind a statement, or on a line of its own before it, allows the finding in that
//! statement; several codes are divided by blanks or commas. `$$ apt-lsp: allow-file APT0951` allows it in the whole
//! program. Errors cannot be allowed: a program that cannot be carried out stays one. A comment that allows nothing is
//! itself a finding, as far as it can be judged: codes of the motion when the motion was computed, codes of the tape
//! never, since the tape is made for one machine of many.

use std::ops::Range;

use apt_geometry::patience::Patience;
use apt_program::Origin;
use apt_syntax::{SyntaxTree, TextRange, TextSize, tree::StatementView};

use crate::{
    Cancelled, catalogue,
    diagnostic::{Diagnostic, Fix, Severity, statement_range},
    go_on,
    lint::notes::addressing_blocks,
};

/// How a comment addresses this program.
pub const ADDRESS: &str = "apt-lsp:";

/// The code of a comment that allows nothing.
pub const ALLOWS_NOTHING: &str = "APT0960";

/// The word that allows a finding in one statement.
pub const IN_STATEMENT: &str = "allow";

/// The word that allows a finding in the whole program.
pub const IN_PROGRAM: &str = "allow-file";

/// Why a comment allows nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Idle {
    /// There is no such code.
    UnknownCode,
    /// The finding is an error.
    Error,
    /// Nothing of the kind was found there.
    NothingFound,
}

/// One code in one comment.
#[derive(Debug)]
struct Allowance {
    code: String,
    /// The number of the statement; none for the whole program.
    statement: Option<u32>,
    /// Where the code stands: the statement of the comment, and the place in it.
    isn: u32,
    range: TextRange,
    /// What is to be taken away if it serves nothing, bytes of the text.
    removal: Range<usize>,
    served: bool,
    met_error: bool,
}

/// What the comments of a program allow.
#[derive(Debug, Default)]
pub struct Allowances {
    list: Vec<Allowance>,
}

impl Allowances {
    /// Reads the comments.
    ///
    /// # Errors
    ///
    /// [`Cancelled`] when who waits has given up before the end.
    pub fn of(tree: &SyntaxTree, patience: Patience<'_>) -> Result<Self, Cancelled> {
        let mut list = Vec::new();
        for block in addressing_blocks(tree, patience)? {
            go_on(patience, block.statement_count())?;
            for view in block.statements().filter(|view| view.text().contains(ADDRESS)) {
                read(tree, &view, &mut list);
            }
        }
        Ok(Self { list })
    }

    /// Whether no comment allows anything.
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// Takes out what is allowed. Errors stay; the severities are those of the catalogue, before any setting.
    pub fn filter(&mut self, findings: &mut Vec<Diagnostic>) {
        if self.list.is_empty() {
            return;
        }
        findings.retain(|finding| {
            let own = finding.origin.source.is_none();
            let mut allowed = false;
            for allowance in self.list.iter_mut().filter(|one| one.code == finding.wording.code) {
                let meant = allowance.statement.is_none_or(|isn| own && isn == finding.origin.isn);
                let error = finding.severity == Severity::Error;
                allowance.served |= meant && !error;
                allowance.met_error |= meant && error;
                allowed |= meant && !error;
            }
            !allowed
        });
    }

    /// What has allowed nothing. `motion` says that the findings of Sections 2 and 3 have been filtered too.
    pub fn idle(&self, motion: bool) -> Vec<Diagnostic> {
        self.list
            .iter()
            .filter(|one| !one.served)
            .filter_map(|one| Some((one, one.reason(motion)?)))
            .map(idle)
            .collect()
    }
}

impl Allowance {
    /// Why it has served nothing; none if that cannot be known.
    fn reason(&self, motion: bool) -> Option<Idle> {
        if self.met_error {
            return Some(Idle::Error);
        }
        if catalogue::explain(&self.code).is_none_or(|page| page.code != self.code) {
            return Some(Idle::UnknownCode);
        }
        let of_motion = self.code.starts_with("APT06")
            || self.code.starts_with("APT071")
            || self.code.starts_with("APT072");
        let of_tape = catalogue::is_tape_code(&self.code);
        (!of_tape && (motion || !of_motion)).then_some(Idle::NothingFound)
    }
}

fn idle((allowance, reason): (&Allowance, Idle)) -> Diagnostic {
    let title = format!("Remove the comment that allows {}", allowance.code);
    let fix = Fix { title, edits: vec![(allowance.removal.clone(), String::new())], preferred: true };
    catalogue::idle_allowance(
        reason,
        &allowance.code,
        Origin::in_program(allowance.isn, allowance.range),
        vec![fix],
    )
}

/// Adds the allowances of a statement's comments.
fn read(tree: &SyntaxTree, view: &StatementView, list: &mut Vec<Allowance>) {
    let parsed = view.parsed();
    let alone = parsed.elements.is_empty();
    for comment in &parsed.comments {
        let text = view.text().get(Range::<usize>::from(*comment)).unwrap_or("");
        let Some((word, codes)) = codes_of(text) else { continue };
        let statement = match word {
            IN_PROGRAM => None,
            _ if alone => Some(following(tree, view)),
            _ => Some(view.isn()),
        };
        let only = codes.len() == 1;
        for (code, place) in codes {
            let start = usize::from(comment.start());
            let range = text_range(start + place.start, start + place.end);
            let unneeded = match only {
                true => Range::<usize>::from(*comment),
                false => start + place.start..start + place.end,
            };
            list.push(Allowance {
                code,
                statement,
                isn: view.isn(),
                range,
                removal: removal(tree, view, unneeded, only && alone),
                served: false,
                met_error: false,
            });
        }
    }
}

/// A code with its place in a comment.
type Named = (String, Range<usize>);

/// The word and the codes of a comment that allows something.
fn codes_of(comment: &str) -> Option<(&'static str, Vec<Named>)> {
    let after = comment.find(ADDRESS)? + ADDRESS.len();
    let before = comment.get(..after - ADDRESS.len())?;
    if !before.chars().all(|character| matches!(character, '$' | ' ' | '\t')) {
        return None;
    }
    let rest = comment.get(after..)?;
    let mut words = Vec::new();
    let mut from = None;
    for (at, character) in rest.char_indices().chain([(rest.len(), ' ')]) {
        let divides = character.is_whitespace() || character == ',';
        match (from, divides) {
            (None, false) => from = Some(at),
            (Some(start), true) => {
                words.push((rest.get(start..at)?, after + start..after + at));
                from = None;
            }
            _ => {}
        }
    }
    let mut words = words.into_iter();
    let word = match words.next()?.0 {
        IN_STATEMENT => IN_STATEMENT,
        IN_PROGRAM => IN_PROGRAM,
        _ => return None,
    };
    Some((word, words.map(|(code, place)| (code.to_ascii_uppercase(), place)).collect()))
}

/// The number of the next statement that is more than a comment.
fn following(tree: &SyntaxTree, view: &StatementView) -> u32 {
    let mut next = view.index + 1;
    while next < tree.statement_count() && tree.statement(next).parsed().elements.is_empty() {
        next += 1;
    }
    u32::try_from(next + 1).unwrap_or(u32::MAX)
}

/// The bytes of the text that go away with a piece of a statement: with the marks and blanks that divide it from its
/// neighbour, and with the line if nothing else stands on it.
fn removal(tree: &SyntaxTree, view: &StatementView, piece: Range<usize>, whole: bool) -> Range<usize> {
    const DIVIDES: [char; 3] = [' ', '\t', ','];
    if whole {
        return Range::<usize>::from(view.range());
    }
    let after = view.text().get(piece.end..).unwrap_or("");
    let gap = after.len() - after.trim_start_matches(DIVIDES).len();
    let is_followed =
        after.trim_start_matches(DIVIDES).starts_with(|next: char| next.is_ascii_alphanumeric());
    let before = view.text().get(..piece.start).unwrap_or("");
    let range = match is_followed {
        true => piece.start..piece.end + gap,
        false => before.trim_end_matches(DIVIDES).len()..piece.end,
    };
    statement_range(tree, view.isn(), text_range(range.start, range.end))
}

fn text_range(start: usize, end: usize) -> TextRange {
    let size = |offset: usize| TextSize::new(u32::try_from(offset).unwrap_or(u32::MAX));
    TextRange::new(size(start), size(end.max(start)))
}

/// A comment that allows a finding: [`IN_STATEMENT`] or [`IN_PROGRAM`].
pub fn comment(word: &str, code: &str) -> String {
    format!("$$ {ADDRESS} {word} {code}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_name_codes() {
        let codes = |text: &str| {
            let (word, codes) = codes_of(text)?;
            Some((
                word,
                codes.into_iter().map(|(code, place)| (code, text[place].to_owned())).collect::<Vec<_>>(),
            ))
        };
        let one = |code: &str, written: &str| vec![(code.to_owned(), written.to_owned())];
        assert_eq!(codes("$$ apt-lsp: allow APT0952"), Some((IN_STATEMENT, one("APT0952", "APT0952"))));
        assert_eq!(codes("$$apt-lsp:allow-file apt0951 "), Some((IN_PROGRAM, one("APT0951", "apt0951"))));
        assert_eq!(codes("$$ apt-lsp: allow A, B  C").map(|(_, codes)| codes.len()), Some(3));
        assert_eq!(codes("$$ apt-lsp: allow"), Some((IN_STATEMENT, Vec::new())));
        for other in ["$$ x", "$$ apt-lsp: dialect=free", "$$ see apt-lsp: allow APT0952", "", "$$ apt-lsp:"]
        {
            assert_eq!(codes(other), None, "{other}");
        }
    }
}
