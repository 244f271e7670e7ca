//! Every word that can begin a statement or a definition: hover, signature help, and offers that never break the
//! grammar.

#![allow(clippy::unwrap_used, clippy::indexing_slicing, reason = "a test may stop at once")]

use std::sync::Arc;

use apt_run::settings::Settings;
use apt_syntax::{
    Dialect, DialectName, SyntaxTree,
    vocabulary::{Word, WordClass, lookup, words},
};

use super::{Completion, CompletionKind};
use crate::{
    Analysis,
    forms::{Atom, forms_of, kinds_of},
};

const DIALECTS: [DialectName; 2] = [DialectName::Apt3, DialectName::Apt4];

/// A name of every kind of value.
const NAMES: &str = "P1=POINT/1,2\nP2=POINT/3,5\nL1=LINE/P1,P2\nPL1=PLANE/0,0,1,0\nC1=CIRCLE/0,0,5\nV1=VECTOR/1,0,0\n\
    MA=MATRIX/TRANSL,1,0,0\nPA=PATERN/LINEAR,P1,P2,3\nEL=ELLIPS/CENTER,P1,3,2,0\n\
    TC=TABCYL/NOZ,SPLINE,0,0,1,1,2,0,3,1\nA1=2\nM1=MACRO/X\nTERMAC\n";

/// A name of each kind of value that only APT4 has.
const SCULPTURED: &str = "P3=POINT/4,1\nCV=SCURV/SPLINE,P1,P2,P3\nSS=SSURF/RULED,CV,AXIS,V1\n";

fn analysis(text: &str, dialect: DialectName) -> Analysis {
    let settings = Settings { dialect: Some(dialect.to_string()), ..Settings::default() };
    Analysis::new(text, Some("part.apt".to_owned()), &Arc::new(settings))
}

/// The words that begin a statement, and the types, which begin a definition.
fn beginners(dialect: DialectName) -> impl Iterator<Item = &'static Word> {
    words()
        .iter()
        .filter(move |word| word.is_in(dialect))
        .filter(|word| !matches!(word.class, WordClass::Minor | WordClass::Function))
}

/// A statement up to behind its word, with the slash if parameters come.
fn opened(word: &Word) -> String {
    match word.class {
        WordClass::GeometricType => format!("XX={}/", word.spelling),
        _ if word.spelling == "MACRO" => "XX=MACRO/".to_owned(),
        _ => format!("{}/", word.spelling),
    }
}

/// What can stand for the first parameter of each form.
fn first_parameters(word: &Word) -> Vec<String> {
    let mut all = Vec::new();
    for form in forms_of(word) {
        for index in form.matched(&[]).next {
            let text = match form.parameters[index].atom {
                Atom::Word(spelling) => spelling.to_owned(),
                Atom::Number(number) => number.to_owned(),
                Atom::Placeholder("mod" | "modifier") => continue,
                Atom::Placeholder(name) => match kinds_of(name) {
                    None => "2".to_owned(),
                    Some([]) => continue,
                    Some(kinds) => {
                        let name = match kinds[0].word() {
                            "POINT" => "P1",
                            "LINE" => "L1",
                            "CIRCLE" => "C1",
                            "PLANE" => "PL1",
                            "VECTOR" => "V1",
                            "MATRIX" => "MA",
                            "PATERN" => "PA",
                            "TABCYL" => "TC",
                            "SCURV" => "CV",
                            "SSURF" => "SS",
                            _ => "EL",
                        };
                        name.to_owned()
                    }
                },
            };
            all.push(text);
        }
    }
    all.sort();
    all.dedup();
    all
}

/// What accepting an offer inserts, with `1` for what is to be filled in.
fn accepted(offer: &Completion) -> String {
    let Some(snippet) = &offer.snippet else { return offer.label.clone() };
    let mut text = String::new();
    let mut rest = snippet.replace("$0", "");
    while let Some(at) = rest.find("${") {
        text.push_str(&rest[..at]);
        text.push('1');
        rest = rest[at..].split_once('}').map_or(String::new(), |(_, rest)| rest.to_owned());
    }
    text + &rest
}

/// The syntax errors of the statement that `line` begins with.
fn errors(line: &str, dialect: DialectName) -> Vec<String> {
    let tree = SyntaxTree::parse(&format!("{line}\n"), Dialect::named(dialect));
    let view = tree.statement(0);
    view.parsed()
        .errors
        .iter()
        .filter(|error| !error.kind.is_warning())
        .map(|error| error.kind.to_string())
        .collect()
}

/// The places of a word where parameters begin: behind its slash, and behind the first parameter of each form.
fn places(word: &Word) -> Vec<String> {
    let open = opened(word);
    let mut places = vec![open.clone()];
    places.extend(first_parameters(word).iter().map(|first| format!("{open}{first},")));
    places
}

/// The program with the names and an open statement, evaluated, and the end of that statement.
fn typing(place: &str, dialect: DialectName) -> (Analysis, usize) {
    let more = if dialect == DialectName::Apt4 { SCULPTURED } else { "" };
    let analysis = analysis(&format!("{NAMES}{more}{place}\nFINI\n"), dialect);
    analysis.program(&|| false).unwrap();
    (analysis, NAMES.len() + more.len() + place.len())
}

#[test]
fn every_word_explains_itself() {
    let mut poor = Vec::new();
    for dialect in DIALECTS {
        for word in beginners(dialect) {
            let statement = opened(word);
            let analysis = analysis(&format!("{statement}\nFINI\n"), dialect);
            let at = statement.find(word.spelling).unwrap();
            let hover = analysis.hover(at, &|| false).unwrap();
            let told = hover.is_some_and(|hover| {
                hover.markdown.contains(word.help) && word.help.len() >= "Probe in x.".len()
            });
            if !told {
                poor.push(word.spelling);
            }
        }
    }
    assert_eq!(poor, Vec::<&str>::new());
}

#[test]
fn every_word_with_parameters_shows_its_forms() {
    let mut without = Vec::new();
    for dialect in DIALECTS {
        for word in beginners(dialect).filter(|word| !forms_of(word).is_empty()) {
            let place = opened(word);
            let (analysis, offset) = typing(&place, dialect);
            let help = analysis.signature_help(offset);
            let shown = help.map_or(0, |help| help.signatures.len());
            if shown != forms_of(word).iter().filter(|form| form.is_of(dialect)).count() {
                without.push(word.spelling);
            }
        }
    }
    assert_eq!(without, Vec::<&str>::new());
}

#[test]
fn offers_are_what_the_forms_allow_and_keep_the_grammar() {
    let mut wrong = String::new();
    let mut count = 0;
    for dialect in DIALECTS {
        for word in beginners(dialect) {
            for place in places(word) {
                let (analysis, offset) = typing(&place, dialect);
                let before = errors(&place, dialect);
                for offer in analysis.completions(offset, &|| false).unwrap() {
                    count += 1;
                    let line = format!("{place}{}", accepted(&offer));
                    let broken = errors(&line, dialect).into_iter().find(|error| !before.contains(error));
                    if let Some(error) = broken {
                        wrong += &format!("{dialect}: {line}: {error}\n");
                    }
                    if offer.kind != CompletionKind::Modifier {
                        continue;
                    }
                    let minor = lookup(&offer.label).unwrap();
                    let stands = Atom::Word(minor.spelling);
                    let mut parameters = forms_of(word).iter().flat_map(|form| &form.parameters);
                    if !parameters.any(|one| one.atom == stands) && !minor.used_in.contains(&word.spelling) {
                        wrong += &format!("{dialect}: {place} offers {}\n", offer.label);
                    }
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
    assert!(count > 5_000, "{count} offers");
}

#[test]
fn jumps_are_offered_the_labels_they_reach() {
    let text = "L1)A1=1\nM1=MACRO/X\nM2)A1=X\nJUMPTO/$0\nTERMAC\nLOOPST\nL3)A1=2\nIF(A1)L3,\nLOOPND\nFINI\n";
    let labels = |text: &str| -> Vec<String> {
        let offset = text.find("$0").unwrap();
        let analysis = analysis(&text.replacen("$0", "", 1), DialectName::Free);
        analysis.program(&|| false).unwrap();
        analysis.completions(offset, &|| false).unwrap().into_iter().map(|one| one.label).collect()
    };
    assert_eq!(labels(text), ["M2"]);
    assert_eq!(labels(&text.replace("$0", "M2").replace("IF(A1)L3,", "JUMPTO/$0")), ["L3"]);
    assert_eq!(labels("L1)A1=1\nLOOPST\nL3)A1=2\nLOOPND\nTRANTO/$0\nFINI\n"), ["L1"]);
}

#[test]
fn functions_in_lists_come_in_parentheses_where_the_dialect_wants_them() {
    let inserted = |dialect: DialectName, line: &str| {
        let (analysis, offset) = typing(line, dialect);
        let offer = analysis
            .completions(offset, &|| false)
            .unwrap()
            .into_iter()
            .find(|one| one.label == "SINF")
            .unwrap();
        offer.snippet.unwrap()
    };
    assert_eq!(inserted(DialectName::Apt3, "GOTO/"), "(SINF(${1:x}))$0");
    assert_eq!(inserted(DialectName::Apt4, "GOTO/"), "SINF(${1:x})$0");
    assert_eq!(inserted(DialectName::Apt3, "X=ATAN2F(1,"), "SINF(${1:x})$0");
    assert_eq!(inserted(DialectName::Apt3, "X=1+"), "SINF(${1:x})$0");
    assert_eq!(inserted(DialectName::Apt3, "GOTO/(1+"), "SINF(${1:x})$0");
}
