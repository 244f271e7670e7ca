//! The pages of the diagnostic codes: complete, in order, and true. Every wrong sample gets its code, every right
//! sample neither the code nor an error nor a warning.

#![expect(clippy::unwrap_used, reason = "what fails in a helper fails the test")]

use std::{collections::BTreeSet, fs, path::Path, sync::Arc};

use apt_cldata::record::Units;
use apt_geometry::patience::Patience;
use apt_run::{
    catalogue::{self, Page, explain, pages},
    diagnostic::{Diagnostic, Severity},
    document::{Document, Level},
    settings::Settings,
};

/// The machine for which samples of tape codes are posted where the page names none.
const MACHINE: &str = "linuxcnc-mill3";

/// The codes that stand in quotation marks in the sources of the catalogue and its rooms.
fn codes_of_the_catalogue() -> BTreeSet<String> {
    let mut left = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join("src/catalogue")];
    let mut codes = BTreeSet::new();
    while let Some(path) = left.pop() {
        if path.is_dir() {
            left.extend(fs::read_dir(path).unwrap().map(|entry| entry.unwrap().path()));
            continue;
        }
        if path.extension().is_none_or(|extension| extension != "rs") {
            continue;
        }
        let text = fs::read_to_string(&path).unwrap();
        codes.extend(codes_in(&text).map(str::to_owned));
    }
    codes
}

fn codes_in(text: &str) -> impl Iterator<Item = &str> {
    text.split('"').filter(|part| {
        part.len() == 7 && part.starts_with("APT") && part.bytes().skip(3).all(|byte| byte.is_ascii_digit())
    })
}

/// The codes that the post-processor can give.
fn is_tape_code(code: &str) -> bool {
    ("APT0820".."APT0900").contains(&code)
}

/// All diagnostics of a sample; of tape codes also those of the tape.
fn diagnostics(page: &Page, text: &str) -> Vec<Diagnostic> {
    let settings = Arc::new(Settings { dialect: page.dialect.clone(), ..Settings::default() });
    let document = Document::new(text, Some("sample.apt".to_owned()), &settings);
    let mut list = document.diagnostics(Level::Motion, &|| false, &mut |_, _| {}).unwrap();
    if is_tape_code(&page.code) {
        let result = document.run(&|| false, &mut |_, _| {}).unwrap();
        let machine = apt_post::machine(page.machine.as_deref().unwrap_or(MACHINE)).unwrap();
        let options = apt_post::PostOptions { default_units: Units::Inches, ..Default::default() };
        let mut tape = apt_post::post(&result.records, &machine, &options);
        if page.code == "APT0898" {
            apt_post::punch::find_lacking(&mut tape, apt_post::punch::Code::Eia);
        }
        list.extend(
            catalogue::tape_diagnostics(
                document.tree(),
                &tape,
                &result.origins,
                &settings,
                Patience::default(),
            )
            .unwrap(),
        );
    }
    list
}

fn shown(list: &[Diagnostic]) -> String {
    let line = |found: &Diagnostic| {
        let wording = &found.wording;
        format!("\n    {} {:?} isn {}: {}", wording.code, found.severity, found.origin.isn, wording.message)
    };
    list.iter().map(line).collect()
}

#[test]
fn every_code_of_the_catalogue_has_its_page_and_every_page_its_code() {
    let pages: BTreeSet<String> = pages().iter().map(|page| page.code.clone()).collect();
    let codes = codes_of_the_catalogue();
    let without: Vec<_> = codes.difference(&pages).collect();
    let surplus: Vec<_> = pages.difference(&codes).collect();
    assert!(without.is_empty() && surplus.is_empty(), "no page: {without:?}, no code: {surplus:?}");
    assert!(codes.len() > 200, "{} codes", codes.len());
}

#[test]
fn pages_stand_in_the_order_of_their_codes() {
    let codes: Vec<&str> = pages().iter().map(|page| page.code.as_str()).collect();
    assert!(codes.is_sorted_by(|a, b| a < b), "{codes:?}");
}

#[test]
fn pages_have_a_title_and_a_few_sentences() {
    let titles: BTreeSet<&str> = pages().iter().map(|page| page.title.as_str()).collect();
    assert_eq!(titles.len(), pages().len(), "two pages have the same title");
    for page in pages() {
        let sentences = page.text.split_inclusive(['.', ':', ';']).count();
        assert!((1..=12).contains(&sentences) && page.text.len() > 80, "{}: {}", page.code, page.text);
        assert!(page.text.lines().all(|line| line.chars().count() <= 120), "{}: a long line", page.code);
        assert!(page.text.trim_end().ends_with(['.', '?']), "{}: {}", page.code, page.text);
        assert!(!page.title.ends_with('.') && page.title.len() < 80, "{}: {}", page.code, page.title);
    }
}

#[test]
fn wrong_samples_get_their_code() {
    let mut faults = String::new();
    for page in pages().iter().filter(|page| page.not_shown.is_none()) {
        let list = diagnostics(page, &page.wrong);
        if !list.iter().any(|found| found.wording.code == page.code) {
            faults.push_str(&format!("\n{} is not found:{}", page.code, shown(&list)));
        }
    }
    assert!(faults.is_empty(), "{faults}");
}

#[test]
fn right_samples_get_neither_their_code_nor_an_error_nor_a_warning() {
    let mut faults = String::new();
    for page in pages() {
        let list = diagnostics(page, &page.right);
        let bad = |found: &&Diagnostic| {
            found.wording.code == page.code || matches!(found.severity, Severity::Error | Severity::Warning)
        };
        let bad: Vec<Diagnostic> = list.iter().filter(bad).cloned().collect();
        if !bad.is_empty() {
            faults.push_str(&format!("\n{}:{}", page.code, shown(&bad)));
        }
    }
    assert!(faults.is_empty(), "{faults}");
}

#[test]
fn samples_end_in_fini_unless_that_is_the_fault() {
    for page in pages() {
        assert!(page.right.trim_end().ends_with("FINI"), "{}", page.code);
        let unfinished = ["APT0021", "APT0409", "APT0421", "APT0886", "APT0901"];
        let ends = page.wrong.trim_end().ends_with("FINI");
        assert_eq!(ends, !unfinished.contains(&page.code.as_str()), "{}", page.code);
    }
}

#[test]
fn a_page_is_found_by_its_code_however_it_is_written() {
    for written in ["APT0101", "apt0101", " 0101", "101"] {
        assert_eq!(explain(written).map(|page| page.code.as_str()), Some("APT0101"), "{written}");
    }
    for unknown in ["", "APT", "APT9998", "x", "70000"] {
        assert_eq!(explain(unknown), None, "{unknown}");
    }
}
