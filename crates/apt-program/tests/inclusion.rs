//! Statements of other files: where their findings, records and frames come from.

use std::{
    path::{Path, PathBuf},
    sync::Arc,
};

use apt_program::{
    ControlFinding, FindingKind, FrameKind, IncludeFailure, IncludeResolver, Options, Program, SourceFile,
    evaluate, expand,
};
use apt_syntax::{Dialect, DialectName, SyntaxTree, TextRange};

/// Files by name.
struct Shelf(Vec<(&'static str, &'static str)>);

impl IncludeResolver for Shelf {
    fn resolve(&self, name: &str) -> Result<Arc<SourceFile>, IncludeFailure> {
        if name == "LOCKED" {
            return Err(IncludeFailure::Unreadable { path: "LOCKED.apt".into(), reason: "no rights".into() });
        }
        let file = self.0.iter().find(|(known, _)| *known == name);
        let (name, text) = file.ok_or(IncludeFailure::NotFound { searched: vec!["shelf".into()] })?;
        Ok(Arc::new(SourceFile { path: PathBuf::from(name), tree: parse(text) }))
    }

    fn is_program(&self, path: &Path) -> bool {
        path == Path::new("MAIN")
    }
}

fn parse(text: &str) -> SyntaxTree {
    SyntaxTree::parse(text, Dialect::named(DialectName::Free))
}

fn options(files: &[(&'static str, &'static str)]) -> Options {
    Options { include: Some(Arc::new(Shelf(files.to_vec()))), ..Options::default() }
}

fn run(text: &str, files: &[(&'static str, &'static str)]) -> Program {
    evaluate(&parse(text), &options(files), &|| false)
}

const LIBRARY: &str = "$$ drilling\nHOLE=MACRO/X,DP\nGOTO/X,0,0\nGODLTA/-DP\nTERMAC\nSAFE=5\n";

#[test]
fn a_macro_of_another_file_keeps_its_places() {
    let program = run(
        "PARTNO A\nINCLUD/LIB\n\nCALL/HOLE,X=1,DP=SAFE\nCALL/HOLE,X=NONE,DP=1\nFINI\n",
        &[("LIB", LIBRARY)],
    );
    let records: Vec<_> = program.records().filter(|record| record.origin.source.is_some()).collect();
    assert!(records.len() >= 2, "{records:?}");
    let origin = &records[0].origin;
    let source = origin.source.as_ref().unwrap();
    assert_eq!((origin.isn, source.path.as_path()), (3, Path::new("LIB")));
    assert_eq!(origin.place_in_program().0, 4);
    let frame = origin.frame.as_ref().unwrap();
    assert_eq!((frame.kind, frame.isn, frame.source.is_none()), (FrameKind::Macro, 4, true));
    let finding = program.findings().find(|one| matches!(one.kind, FindingKind::Undefined { .. })).unwrap();
    assert_eq!((finding.origin.isn, finding.origin.place_in_program().0), (3, 5));
    assert!(finding.origin.source.is_some());
    let unused = program.findings().filter(|one| matches!(one.kind, FindingKind::Unused { .. }));
    assert_eq!(unused.count(), 0, "a library need not be used up");
}

#[test]
fn a_nested_inclusion_leads_back_to_the_program() {
    let files = [("OUTER", "$$ one\n\nINCLUD/INNER\n"), ("INNER", "A=1\nGOTO/NONE,A,0\n")];
    let program = run("\nINCLUD/OUTER\nFINI\n", &files);
    let finding = program.findings().find(|one| matches!(one.kind, FindingKind::Undefined { .. })).unwrap();
    assert_eq!((finding.origin.isn, finding.origin.place_in_program().0), (2, 2));
    let inner = finding.origin.frame.as_ref().unwrap();
    assert_eq!((inner.kind, inner.name.as_str(), inner.isn), (FrameKind::Include, "INNER", 3));
    assert_eq!(inner.source.as_ref().unwrap().path, Path::new("OUTER"));
    let outer = inner.parent.as_ref().unwrap();
    assert_eq!((outer.name.as_str(), outer.isn, outer.source.is_none()), ("OUTER", 2, true));
}

#[test]
fn library_macros_and_stored_segments_are_found_as_files_are() {
    let program =
        run("LIBRY/LIB\nREAD/2,SEG\nCALL/HOLE,X=B,DP=1\nFINI\n", &[("LIB", LIBRARY), ("SEG", "B=2\n")]);
    assert_eq!(program.findings().count(), 0, "{:?}", program.findings().collect::<Vec<_>>());
    let program = run("LIBRY/NONE\nCALL/NONE,X=1\nFINI\n", &[]);
    let kinds: Vec<_> = program.findings().map(|one| &one.kind).collect();
    let searched = vec!["shelf".into()];
    assert_eq!(
        kinds,
        [&FindingKind::Control(ControlFinding::IncludeNotFound { name: "NONE".into(), searched })],
        "that the macro is missing is told once"
    );
    let program = run("LIBRY/LIB\nCALL/LIB\nFINI\n", &[("LIB", LIBRARY)]);
    assert_eq!(program.findings().count(), 1, "the file holds another macro");
}

#[test]
fn circles_end_with_the_way_they_go() {
    let circle = |text: &str, files: &[(&'static str, &'static str)]| {
        let program = run(text, files);
        let found = program.findings().find_map(|one| match &one.kind {
            FindingKind::Control(ControlFinding::IncludeCycle { name, through }) => {
                Some((name.to_string(), through.join(" "), one.origin.isn))
            }
            _ => None,
        });
        assert!(program.is_complete());
        found
    };
    let files = [("A", "INCLUD/B\n"), ("B", "X=1\nINCLUD/A\n"), ("SELF", "INCLUD/SELF\n"), ("MAIN", "")];
    assert_eq!(circle("INCLUD/A\nFINI\n", &files), Some(("A".into(), "A B A".into(), 2)));
    assert_eq!(circle("INCLUD/SELF\nFINI\n", &files), Some(("SELF".into(), "SELF SELF".into(), 1)));
    assert_eq!(circle("INCLUD/MAIN\nFINI\n", &files), Some(("MAIN".into(), "MAIN".into(), 1)));
    assert_eq!(circle("INCLUD/LIB\nINCLUD/LIB\nFINI\n", &[("LIB", "X=1\n")]), None, "twice is no circle");
    let locked = run("INCLUD/LOCKED\nFINI\n", &[]);
    assert!(
        locked
            .findings()
            .any(|one| matches!(one.kind, FindingKind::Control(ControlFinding::IncludeUnreadable { .. })))
    );
}

#[test]
fn edits_before_an_inclusion_move_its_frames_and_nothing_inside() {
    let files = [("LIB", LIBRARY)];
    let tree = parse("PARTNO A\nINCLUD/LIB\nCALL/HOLE,X=1,DP=SAFE\nFINI\n");
    let before = evaluate(&tree, &options(&files), &|| false);
    let (edited, change) = tree.edit(TextRange::empty(9.into()), "$$ new\n");
    let updated = before.update(&edited, &change, &options(&files), &|| false);
    let afresh = evaluate(&edited, &options(&files), &|| false);
    assert_eq!(updated.records().collect::<Vec<_>>(), afresh.records().collect::<Vec<_>>());
    let places: Vec<_> =
        updated.records().map(|one| (one.origin.isn, one.origin.place_in_program().0)).collect();
    assert!(places.contains(&(3, 4)), "{places:?}");
}

#[test]
fn an_expansion_shows_included_statements_with_their_origin() {
    let files = [("LIB", LIBRARY)];
    let tree = parse("PARTNO A\n\nINCLUD/LIB\nCALL/HOLE,X=1,DP=SAFE\nFINI\n");
    let expanded = |at, depth| expand(&tree, &options(&files), at, depth, &|| false);
    assert_eq!(expanded(None, None).text(), "PARTNO A\nSAFE=5\nGOTO/1,0,0\nGODLTA/-SAFE\nFINI\n");
    let closed = expanded(None, Some(0)).text();
    assert_eq!(closed, "PARTNO A\nINCLUD/LIB\nCALL/HOLE,X=1,DP=SAFE\nFINI\n");
    let included = expanded(Some(2), None);
    assert_eq!(included.text(), "SAFE=5\n", "statement 3 of the program, not of the file");
    assert!(included.lines[0].origin.source.is_some());
}

#[test]
fn read_takes_surfaces_from_the_library_in_apt4() {
    let apt4 = |text: &str, files: &[(&'static str, &'static str)]| {
        let tree = SyntaxTree::parse(&format!("{text}\nFINI\n"), Dialect::named(DialectName::Apt4));
        evaluate(&tree, &options(files), &|| false)
    };
    let library = [("P1", "P1=POINT/1,2,3\n"), ("L1", "READ/1,P1\nL1=LINE/P1,(POINT/0,0)\n")];
    let program = apt4("READ/1,L1,P1\nGOTO/P1\nC=CIRCLE/CENTER,P1,TANTO,(LINE/0,0,1,0)", &library);
    let told: Vec<_> = program.findings().filter(|one| one.severity > apt_program::Severity::Hint).collect();
    assert!(told.is_empty(), "{told:?}");
    assert!(["L1", "P1", "C"].iter().all(|name| program.symbols().iter().any(|(known, _)| known == name)));
    let missing = apt4("READ/1,NIX", &library);
    assert!(
        missing
            .findings()
            .any(|one| matches!(&one.kind, FindingKind::Control(ControlFinding::IncludeNotFound { name, .. }) if name == "NIX"))
    );
    let bare = apt4("READ/1", &library);
    assert!(bare.findings().any(|one| matches!(one.kind, FindingKind::OperandCount { .. })));
}
