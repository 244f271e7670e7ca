//! Where long lines are broken.

use apt_syntax::SyntaxKind;

use super::line::{Atom, columns};

/// One line of all atoms.
pub(super) fn joined(indent: usize, atoms: &[Atom]) -> String {
    let mut code = " ".repeat(indent);
    code.extend(atoms.iter().map(|atom| atom.text.as_str()));
    code
}

/// Lines that end, with their `$`, in column `limit` at the latest, as far as the atoms allow it. `continued` says that a
/// `$` follows the last line too.
pub(super) fn broken(
    indent: usize,
    further: usize,
    atoms: &[Atom],
    continued: bool,
    limit: usize,
) -> Vec<String> {
    let mut codes = Vec::new();
    let mut atoms = atoms.to_vec();
    let mut from = 0;
    while let Some(rest) = atoms.get(from..).filter(|rest| !rest.is_empty()) {
        let indent = if from == 0 { indent } else { further };
        let room = limit.checked_sub(indent + usize::from(continued));
        let taken = if room.is_some_and(|room| fit(rest, room)) {
            rest.len()
        } else {
            break_after(rest, indent, limit)
        };
        let (line, _) = rest.split_at(taken.clamp(1, rest.len()));
        codes.push(joined(indent, line));
        from += line.len();
        // The blank that stood before an element does not begin a line.
        if let Some(next) = atoms.get_mut(from) {
            next.text = next.text.trim_start().to_owned();
        }
    }
    codes
}

/// Whether all atoms fit into so many columns. Looks no farther than that, so that a long statement costs no more than
/// its length.
fn fit(atoms: &[Atom], room: usize) -> bool {
    let mut taken = 0;
    atoms.iter().all(|atom| {
        taken += columns(&atom.text);
        taken <= room
    })
}

/// How well a line may end after an atom; none if it may not. No line begins with a mark.
fn quality(atom: &Atom, next: Option<&Atom>) -> Option<u8> {
    use SyntaxKind as Kind;
    let mark = |kind| {
        matches!(
            kind,
            Kind::Comma
                | Kind::Slash
                | Kind::Equals
                | Kind::RightParenthesis
                | Kind::Star
                | Kind::Power
                | Kind::Relation
        )
    };
    if !atom.may_break || next.is_none_or(|next| mark(next.kind)) {
        return None;
    }
    Some(match atom.kind {
        Kind::Comma => 3,
        Kind::Slash | Kind::Equals | Kind::Plus | Kind::Minus | Kind::Star => 2,
        Kind::Power | Kind::LeftParenthesis | Kind::Relation => 1,
        _ => 0,
    })
}

/// How many atoms the line takes: up to the best place that fits, the last one of equals; if none fits, up to the first
/// place of all.
fn break_after(atoms: &[Atom], indent: usize, limit: usize) -> usize {
    let mut end = indent;
    let mut best: Option<(u8, usize)> = None;
    for (index, atom) in atoms.iter().enumerate() {
        end += columns(&atom.text);
        let fits = end < limit;
        if !fits && best.is_some() {
            break;
        }
        let Some(quality) = quality(atom, atoms.get(index + 1)) else { continue };
        if !fits {
            return index + 1;
        }
        if best.is_none_or(|(so_far, _)| quality >= so_far) {
            best = Some((quality, index + 1));
        }
    }
    best.map_or(atoms.len(), |(_, taken)| taken)
}
