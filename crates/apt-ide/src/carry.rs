//! Which statements of two versions of a program are the same, so that what is known of them can be carried over.

use std::ops::Range;

use apt_syntax::{SyntaxTree, TextSize};

/// The statements of two versions before and behind an edit that are the same.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Carried {
    /// Statements before this one are the same in both versions, with the same index.
    pub(crate) first: usize,
    /// From this statement of the old version on they are the same again …
    pub(crate) old_resume: usize,
    /// … as from this one of the new version on.
    pub(crate) new_resume: usize,
}

/// Statements before that of an edit that are looked at again: its beginning may go on a statement before it.
const STATEMENTS_BEFORE: usize = 2;

/// Statements behind an edit among which one must begin at the same place as before.
const STATEMENTS_BEHIND: usize = 4_096;

impl Carried {
    /// Compares two versions, the new one being the old one with `range` (bytes) replaced by `inserted` bytes. `None`
    /// when nothing can be carried over.
    pub(crate) fn between(
        old: &SyntaxTree,
        new: &SyntaxTree,
        range: &Range<usize>,
        inserted: usize,
    ) -> Option<Self> {
        if old.layout() != new.layout() || old.statement_count() == 0 || new.statement_count() == 0 {
            return None;
        }
        let at = |tree: &SyntaxTree, offset: usize| tree.statement_at(TextSize::new(offset as u32));
        let first = at(old, range.start).saturating_sub(STATEMENTS_BEFORE);
        let behind = at(old, range.end) + 1;
        for index in behind..(behind + STATEMENTS_BEHIND).min(old.statement_count()) {
            let start = (usize::from(old.statement(index).start) + inserted).checked_sub(range.len())?;
            let candidate = new.statement(at(new, start));
            if usize::from(candidate.start) == start {
                return Some(Self { first, old_resume: index, new_resume: candidate.index });
            }
        }
        (behind >= old.statement_count()).then(|| Self {
            first,
            old_resume: old.statement_count(),
            new_resume: new.statement_count(),
        })
    }

    /// The statements of the new version that have to be looked at.
    pub(crate) fn changed(&self) -> Range<usize> {
        self.first..self.new_resume.max(self.first)
    }

    /// The index in the new version of a statement of the old one; `None` if it is not carried over.
    pub(crate) fn index(&self, old: usize) -> Option<usize> {
        if old < self.first {
            Some(old)
        } else {
            old.checked_sub(self.old_resume).map(|behind| self.new_resume + behind)
        }
    }
}

#[cfg(test)]
mod tests {
    use apt_syntax::{TextRange, dialect::Dialect};

    use super::*;

    /// Every statement that is carried over has the same text in both versions, and every other one is looked at.
    fn check(text: &str, range: Range<usize>, insert: &str) {
        let old = SyntaxTree::parse(text, Dialect::named(Default::default()));
        let bytes = TextRange::new((range.start as u32).into(), (range.end as u32).into());
        let (new, _) = old.edit(bytes, insert);
        let Some(carried) = Carried::between(&old, &new, &range, insert.len()) else { return };
        let mut seen: Vec<usize> = carried.changed().collect();
        for index in 0..old.statement_count() {
            if let Some(now) = carried.index(index) {
                assert_eq!(
                    old.statement(index).text(),
                    new.statement(now).text(),
                    "{text:?} {range:?} {insert:?}"
                );
                seen.push(now);
            }
        }
        seen.sort_unstable();
        assert_eq!(seen, (0..new.statement_count()).collect::<Vec<_>>(), "{text:?} {range:?} {insert:?}");
    }

    #[test]
    fn statements_carried_over_are_the_same_after_any_small_edit() {
        let text = "PARTNO A\nP1=POINT/1,$\n2\n$$ X\r\nL1=LINE/P1,P2\n\nM=MACRO\nTERMAC\nFINI\n";
        for start in 0..=text.len() {
            for end in start..=(start + 3).min(text.len()) {
                for insert in ["", "X", "$", "\n", "$$", "\r", "A\nB\n"] {
                    check(text, start..end, insert);
                }
            }
        }
    }
}
