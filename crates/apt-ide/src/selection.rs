//! Growing selections: from a word to its parameter, the parameters, the statement, the macro or loop, the program.

use std::ops::Range;

use apt_syntax::statement::{Element, ElementKind};

use crate::{Analysis, absolute};

impl Analysis {
    /// What can be selected around an offset, from the least to the whole program; each contains the one before it.
    pub fn selections(&self, offset: usize) -> Vec<Range<usize>> {
        let tree = self.document().tree();
        let mut ranges: Vec<Range<usize>> = Vec::new();
        let Some((view, relative)) = self.statement_at(offset) else { return ranges };
        let mut add = |range: Range<usize>| {
            let grows = ranges.last().is_none_or(|last: &Range<usize>| {
                range.start <= last.start && range.end >= last.end && range != *last
            });
            if grows && range.start <= offset && offset <= range.end {
                ranges.push(range);
            }
        };
        let parsed = view.parsed();
        let at = parsed.elements.iter().find(|element| element.range.contains_inclusive(relative));
        at.map(|element| absolute(&view, element.range)).into_iter().for_each(&mut add);
        for part in &parsed.statement.parts {
            let inside = |element: &&Element| part.range.contains_range(element.range);
            let elements: Vec<Element> = parsed.elements.iter().filter(inside).cloned().collect();
            let at = elements.iter().position(|element| element.range.contains_inclusive(relative));
            let groups = at.map(|at| groups(&elements, at)).unwrap_or_default();
            for group in groups {
                let group = elements.get(group).unwrap_or_default();
                if let (Some(first), Some(last)) = (group.first(), group.last()) {
                    add(absolute(&view, first.range.cover(last.range)));
                }
            }
        }
        for part in &parsed.statement.parts {
            add(absolute(&view, part.range));
        }
        let start = usize::from(view.range().start());
        let blank = view.text().len() - view.text().trim_start().len();
        add(start + blank..start + view.text().trim_end().len());
        add(start..start + view.text().len());
        for region in self.regions().iter().rev().filter(|region| region.contains(view.index)) {
            let first = usize::from(tree.statement(region.first).range().start());
            add(first..usize::from(tree.statement(region.last).range().end()));
        }
        add(0..usize::from(tree.len()));
        ranges
    }
}

/// The groups of elements around one, from the least on: the parameter, the parameters, the definition, and the
/// parentheses around that, again and again.
fn groups(elements: &[Element], at: usize) -> Vec<Range<usize>> {
    use ElementKind::{Comma, Equals, Slash};
    let mut groups = Vec::new();
    let mut group = at..at + 1;
    // Each round goes one parenthesis outwards.
    for _ in 0..elements.len() {
        for borders in [&[Comma, Slash, Equals][..], &[Slash, Equals], &[Equals], &[]] {
            group = before(elements, group.start, borders)..behind(elements, group.end, borders);
            groups.push(group.clone());
        }
        let open = group.start.checked_sub(1).and_then(|open| elements.get(open));
        if open.is_none_or(|open| open.kind != ElementKind::LeftParenthesis) {
            break;
        }
        group = group.start - 1..(group.end + 1).min(elements.len());
        groups.push(group.clone());
    }
    groups
}

/// Where a group begins that ends before `from`: behind the last border, or behind an open parenthesis.
fn before(elements: &[Element], from: usize, borders: &[ElementKind]) -> usize {
    let mut depth = 0_usize;
    for (index, element) in elements.iter().enumerate().take(from).rev() {
        match element.kind {
            ElementKind::RightParenthesis => depth += 1,
            ElementKind::LeftParenthesis if depth == 0 => return index + 1,
            ElementKind::LeftParenthesis => depth -= 1,
            kind if depth == 0 && borders.contains(&kind) => return index + 1,
            _ => {}
        }
    }
    0
}

/// Where a group ends that begins before `from`: before the next comma if these are borders, or a closing parenthesis.
fn behind(elements: &[Element], from: usize, borders: &[ElementKind]) -> usize {
    let mut depth = 0_usize;
    for (index, element) in elements.iter().enumerate().skip(from) {
        match element.kind {
            ElementKind::LeftParenthesis => depth += 1,
            ElementKind::RightParenthesis if depth == 0 => return index,
            ElementKind::RightParenthesis => depth -= 1,
            ElementKind::Comma if depth == 0 && borders.contains(&ElementKind::Comma) => return index,
            _ => {}
        }
    }
    elements.len()
}
