//! The tables leave out no form, and of no form an alternative.

use std::collections::BTreeSet;

use apt_geometry::canonical::GeometryKind;
use apt_geometry::definition::{Argument, ArgumentKind, Parameter, formats, matching_format};

use super::{CONICS, ROWS, session};

/// What a match of a form says: the end of the arguments taken, and the alternatives that were used.
type Match = (usize, BTreeSet<String>);

/// Every way in which a sequence of parameters takes the arguments from a place on. `path` tells where in the form the
/// sequence stands.
fn matches(parameters: &[Parameter], path: &str, kinds: &[ArgumentKind], from: usize) -> Vec<Match> {
    let mut states = vec![(from, BTreeSet::new())];
    for (index, parameter) in parameters.iter().enumerate() {
        let path = format!("{path}.{index}");
        states = states
            .into_iter()
            .flat_map(|(at, used)| {
                let extended = move |(end, more): Match| (end, used.union(&more).cloned().collect());
                single(parameter, &path, kinds, at).into_iter().map(extended).collect::<Vec<_>>()
            })
            .collect();
    }
    states
}

fn single(parameter: &Parameter, path: &str, kinds: &[ArgumentKind], at: usize) -> Vec<Match> {
    let found = kinds.get(at).copied();
    let taken = |used: Option<String>| vec![(at + 1, used.into_iter().collect())];
    match (parameter, found) {
        (Parameter::Scalar(_), Some(ArgumentKind::Scalar)) => taken(None),
        (Parameter::Word(word), Some(ArgumentKind::Modifier(modifier))) if *word == modifier => taken(None),
        (Parameter::Selector(words), Some(ArgumentKind::Modifier(modifier))) if words.contains(&modifier) => {
            taken(Some(format!("{path} {}", modifier.word())))
        }
        (Parameter::Entity(_, types), Some(ArgumentKind::Geometry(kind))) if types.contains(&kind) => {
            taken(Some(format!("{path} {}", kind.word())))
        }
        (Parameter::Choice(sequences), _) => sequences
            .iter()
            .enumerate()
            .flat_map(|(index, sequence)| {
                let mark = format!("{path} choice {index}");
                matches(sequence, &format!("{path}:{index}"), kinds, at).into_iter().map(
                    move |(end, mut used)| {
                        used.insert(mark.clone());
                        (end, used)
                    },
                )
            })
            .collect(),
        (Parameter::Repeated(sequence), _) => {
            let mut all: Vec<Match> = Vec::new();
            let mut fresh = vec![(at, BTreeSet::new())];
            while !fresh.is_empty() {
                fresh = fresh
                    .into_iter()
                    .flat_map(|(at, used): Match| {
                        let extended = move |(end, more): Match| (end, used.union(&more).cloned().collect());
                        matches(sequence, path, kinds, at).into_iter().map(extended).collect::<Vec<_>>()
                    })
                    .collect();
                all.extend(fresh.iter().cloned());
            }
            all
        }
        _ => Vec::new(),
    }
}

/// Every alternative of a form: words of selectors, types of entities, branches of choices.
fn alternatives(parameters: &[Parameter], path: &str) -> BTreeSet<String> {
    let mut all = BTreeSet::new();
    for (index, parameter) in parameters.iter().enumerate() {
        let path = format!("{path}.{index}");
        match parameter {
            Parameter::Scalar(_) | Parameter::Word(_) => {}
            Parameter::Selector(words) => {
                all.extend(words.iter().map(|word| format!("{path} {}", word.word())));
            }
            Parameter::Entity(_, kinds) => {
                all.extend(kinds.iter().map(|kind| format!("{path} {}", kind.word())));
            }
            Parameter::Choice(sequences) => {
                for (index, sequence) in sequences.iter().enumerate() {
                    all.insert(format!("{path} choice {index}"));
                    all.extend(alternatives(sequence, &format!("{path}:{index}")));
                }
            }
            Parameter::Repeated(sequence) => all.extend(alternatives(sequence, &path)),
        }
    }
    all
}

/// No form is left out of the tables, and of no form a word, a type of entity or a branch.
#[test]
fn every_alternative_of_every_form_has_a_row() {
    let session = session();
    let rows: Vec<_> = ROWS
        .iter()
        .chain(CONICS)
        .map(|(body, _)| {
            let (word, parameters) = body.split_once('/').expect("a type");
            let kind = GeometryKind::from_word(word).expect("a type word");
            let arguments = session.arguments(parameters).expect("arguments");
            (kind, arguments.iter().map(Argument::kind).collect::<Vec<_>>())
        })
        .collect();
    let mut missing = String::new();
    for kind in GeometryKind::all() {
        for format in formats(kind) {
            assert!(!format.help.is_empty());
            let mut wanted = alternatives(format.parameters, "");
            let mut used = false;
            for (_, kinds) in rows.iter().filter(|row| row.0 == kind) {
                let taken_by_format = matching_format(kind, kinds)
                    .is_some_and(|found| std::ptr::eq(found.parameters, format.parameters));
                for (end, marks) in matches(format.parameters, "", kinds, 0) {
                    if taken_by_format && end == kinds.len() {
                        used = true;
                        wanted.retain(|mark| !marks.contains(mark));
                    }
                }
            }
            if !used || !wanted.is_empty() {
                missing.push_str(&format!("{}: {}: {wanted:?}\n", kind.word(), format.help));
            }
        }
    }
    assert!(missing.is_empty(), "without a row:\n{missing}");
}
