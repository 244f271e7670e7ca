//! What an evaluation can begin with: an older one, and the edits since.

use std::sync::Arc;

use apt_program::{Options, Program, evaluate};
use apt_syntax::{StatementChange, SyntaxTree};

/// Edits in more places than these are taken as one that spans them all.
const MOST_STEPS: usize = 16;

/// An evaluated version, and how the present one came of it.
#[derive(Debug, Clone)]
pub(crate) struct Basis {
    program: Arc<Program>,
    tree: SyntaxTree,
    /// The edits, each with the version after it. Those that came to nothing are left out.
    steps: Vec<(SyntaxTree, StatementChange)>,
}

impl Basis {
    /// An evaluated version.
    pub(crate) fn of(tree: &SyntaxTree, program: &Arc<Program>) -> Self {
        Self { program: Arc::clone(program), tree: tree.clone(), steps: Vec::new() }
    }

    /// The same with one more edit, which led to the version `tree`.
    pub(crate) fn after(mut self, tree: &SyntaxTree, change: StatementChange) -> Self {
        let mut change = change;
        while let Some((_, last)) = self.steps.last()
            && (touch(last, &change) || self.steps.len() >= MOST_STEPS)
        {
            change = merged(last, &change);
            self.steps.pop();
        }
        let before = self.steps.last().map_or(&self.tree, |(tree, _)| tree);
        if !is_nothing(before, tree, &change) {
            self.steps.push((tree.clone(), change));
        }
        self
    }

    /// Evaluates the present version.
    pub(crate) fn evaluate(
        &self,
        tree: &SyntaxTree,
        options: &Options,
        cancel: &dyn Fn() -> bool,
    ) -> Program {
        if self.program.asked_for_files() {
            // The files may have changed too.
            return evaluate(tree, options, cancel);
        }
        self.program.update_in_steps(&self.steps, options, cancel)
    }
}

/// Whether two changes, the second coming after the first, concern the same statements or neighbours.
fn touch(first: &StatementChange, second: &StatementChange) -> bool {
    second.first <= first.first + first.inserted && first.first <= second.first + second.removed
}

/// One change that has the effect of two, the second coming after the first.
fn merged(a: &StatementChange, b: &StatementChange) -> StatementChange {
    let first = a.first.min(b.first);
    let middle_end = (a.first + a.inserted).max(b.first + b.removed);
    let old_end = middle_end - a.inserted + a.removed;
    let new_end = middle_end - b.removed + b.inserted;
    StatementChange {
        first,
        removed: old_end - first,
        inserted: new_end - first,
        scanned: a.scanned + b.scanned,
    }
}

/// Whether a change left every statement as it was: what was typed has been taken back.
fn is_nothing(before: &SyntaxTree, after: &SyntaxTree, change: &StatementChange) -> bool {
    let same = |index: usize| before.statement(index).text() == after.statement(index).text();
    change.removed == change.inserted
        && before.layout() == after.layout()
        && (change.first..change.first + change.removed).all(same)
}

#[cfg(test)]
mod tests {
    use apt_syntax::{TextRange, dialect::Dialect};

    use super::*;

    const TEXT: &str = "P1=POINT/1,2\nP2=POINT/3,4\nP3=POINT/5,6\nP4=POINT/7,8\nGOTO/P4\nFINI\n";

    /// A version, evaluated when it was first read, after edits: each with its place and how many bytes it takes out.
    fn edited(text: &str, edits: &[(usize, usize, &str)]) -> (Basis, SyntaxTree) {
        let mut tree = SyntaxTree::parse(text, Dialect::named(Default::default()));
        let program = Arc::new(evaluate(&tree, &Options::default(), &|| false));
        let mut basis = Basis::of(&tree, &program);
        for (at, removed, insert) in edits {
            let range = TextRange::at((*at as u32).into(), (*removed as u32).into());
            let (next, change) = tree.edit(range, insert);
            basis = basis.after(&next, change);
            tree = next;
        }
        (basis, tree)
    }

    /// Evaluates, and compares the outcome with that of a new evaluation.
    fn evaluated(basis: &Basis, tree: &SyntaxTree) -> Program {
        let program = basis.evaluate(tree, &Options::default(), &|| false);
        let fresh = evaluate(tree, &Options::default(), &|| false);
        assert_eq!(program.symbols(), fresh.symbols());
        assert!(program.records().eq(fresh.records()));
        assert!(program.findings().eq(fresh.findings()));
        program
    }

    #[test]
    fn what_is_taken_back_is_not_evaluated() {
        let taken_back =
            [(2, 0, "9"), (2, 1, ""), (30, 0, "$$"), (32, 0, "X"), (30, 3, ""), (60, 0, "\n"), (60, 1, "")];
        let (basis, tree) = edited(TEXT, &taken_back);
        assert_eq!(tree.text(), TEXT);
        assert!(basis.steps.is_empty(), "{:?}", basis.steps);
        assert_eq!(evaluated(&basis, &tree).statistics().evaluated_statements, 0);
    }

    #[test]
    fn edits_in_several_places_stay_apart() {
        let (basis, tree) = edited(TEXT, &[(9, 1, "8"), (10, 0, "0"), (49, 1, "5"), (23, 1, "1")]);
        let places: Vec<usize> = basis.steps.iter().map(|(_, change)| change.first).collect();
        assert_eq!(places, [0, 3, 1]);
        evaluated(&basis, &tree);
        let lines = "P=POINT/1,2\n".repeat(100);
        let many: Vec<_> = (0..40).map(|line| (line * 24 + 8, 1, "7")).collect();
        let (basis, tree) = edited(&lines, &many);
        assert!(basis.steps.len() <= MOST_STEPS);
        evaluated(&basis, &tree);
    }

    #[test]
    fn lines_put_in_and_taken_out_in_several_places_are_followed() {
        let edits = [(0, 0, "P9=POINT/9,9\n"), (39, 13, ""), (52, 0, "GOTO/P9\nGOTO/P1\n"), (13, 13, "")];
        let (basis, tree) = edited(TEXT, &edits);
        assert!(basis.steps.len() > 1, "{:?}", basis.steps);
        evaluated(&basis, &tree);
    }
}
