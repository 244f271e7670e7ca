//! Changes of the program that cure a failed motion. Each was found to work by carrying out the motion with it.

use apt_geometry::motion::Relation;
use apt_syntax::{
    SyntaxTree, TextRange,
    statement::{Body, Element, ElementKind},
    vocabulary::WordClass,
};
use arelem::{cure::Cure, error::MotionWarning};

use super::Here;
use crate::{
    catalogue::remedy::{drive_side_word, part_side_word, relation_word, statement, triple, turn_word},
    diagnostic::Fix,
    pipeline::{RunFinding, RunFindingKind},
};

/// The words of each kind that a cure replaces.
const TURNS: &[&str] = &["GOLFT", "GORGT", "GOFWD", "GOBACK", "GOUP", "GODOWN"];
const DRIVE_SIDES: &[&str] = &["TLLFT", "TLRGT", "TLON", "TLNDON"];
const PART_SIDES: &[&str] = &["TLONPS", "TLOFPS"];
const DIRECTIONS: &[&str] = &["INDIRV", "INDIRP"];
const RELATIONS: &[&str] = &["TO", "ON", "PAST", "TANTO", "DSTAN", "PSTAN"];

/// The fixes of a finding of Section 2, the likeliest first.
pub(crate) fn of_run(tree: &SyntaxTree, finding: &RunFinding) -> Vec<Fix> {
    let here = Here::of(tree, &finding.origin);
    match &finding.kind {
        RunFindingKind::Failure { remedies, earlier, .. } => {
            let before = earlier.as_ref().and_then(|origin| Here::of(tree, origin));
            let place = |cure: &Cure| match cure {
                Cure::EarlierOccurrence { .. } => before.as_ref(),
                _ => here.as_ref(),
            };
            remedies.iter().filter_map(|remedy| place(&remedy.cure)?.cured(&remedy.cure)).collect()
        }
        RunFindingKind::Warning(MotionWarning::WrongSideOfDrive { side, .. }) => {
            // The motion keeps the side where the tool is: the other word changes nothing but what is said.
            here.and_then(|here| here.cured(&Cure::DriveSide(*side))).into_iter().collect()
        }
        _ => Vec::new(),
    }
}

impl Here<'_> {
    /// The program with a cure, where the place for it is sure.
    fn cured(&self, cure: &Cure) -> Option<Fix> {
        match cure {
            Cure::Turn(turn) => self.replaced(TURNS, turn_word(*turn)),
            Cure::DriveSide(side) => {
                let word = drive_side_word(*side);
                self.replaced(DRIVE_SIDES, word).or_else(|| self.before(word))
            }
            Cure::PartSide(side) => {
                let word = part_side_word(*side);
                self.replaced(PART_SIDES, word).or_else(|| self.before(word))
            }
            Cure::Relation { check: 0, relation } => self.related(*relation),
            Cure::Occurrence { check: 0, occurrence } | Cure::EarlierOccurrence { check: 0, occurrence } => {
                self.counted(*occurrence)
            }
            // With two check surfaces it is not sure which place is meant; and INDIRV may stand anywhere before the GO.
            Cure::Relation { .. }
            | Cure::Occurrence { .. }
            | Cure::EarlierOccurrence { .. }
            | Cure::WithoutDirection => None,
            Cure::MoveTo { forward: Some(forward), .. } => {
                let direction = format!("{}INDIRV/{}", self.line_end(), triple(forward));
                self.before(&(statement(cure)? + &direction))
            }
            Cure::Direction(_) => {
                let direction = statement(cure)?;
                self.given_direction()
                    .map_or_else(|| self.before(&direction), |given| given.rewritten(&direction))
            }
            _ => self.before(&statement(cure)?),
        }
    }

    /// The INDIRV or INDIRP that is in force here, where nothing between the two moves the tool, is jumped to or decides
    /// what is executed.
    fn given_direction(&self) -> Option<Here<'_>> {
        if self.parsed.statement.label.is_some() {
            return None;
        }
        let before = (0..self.view.index).rev().map(|index| self.tree.statement(index));
        let statements =
            before.map(|view| (view.parsed(), view)).filter(|(parsed, _)| !parsed.elements.is_empty());
        for (parsed, view) in statements {
            let single =
                parsed.statement.parts.len() == 1 && parsed.statement.label.is_none() && !parsed.is_broken();
            let verb = parsed.elements.first().filter(|_| single)?;
            if is_word(verb, DIRECTIONS) {
                return Some(Here { tree: self.tree, view, parsed, origin: self.origin });
            }
            if !lets_direction_be(&parsed.statement.parts[0].body) {
                return None;
            }
        }
        None
    }

    /// Another statement in the place of this one, where that stands on one line.
    fn rewritten(&self, statement: &str) -> Option<Fix> {
        let elements = &self.parsed.elements;
        let whole = TextRange::new(elements.first()?.range.start(), elements.last()?.range.end());
        let now = self.written(whole);
        (!now.contains(['\n', '\r']))
            .then(|| self.edit(whole, statement, format!("Replace {now} by {statement}")))
    }

    fn before(&self, statement: &str) -> Option<Fix> {
        let first = statement.lines().next().unwrap_or_default().to_owned();
        self.line_before(statement, format!("Insert {first} before the motion"))
    }

    /// Another word for the one of a kind that stands in the statement.
    fn replaced(&self, kind: &[&str], word: &str) -> Option<Fix> {
        let found = self.parsed.elements.iter().find(|element| is_word(element, kind))?;
        (found.text != word)
            .then(|| self.edit(found.range, word, format!("Replace {} by {word}", found.text)))
    }

    /// Another relation to the first check surface, said or implied.
    fn related(&self, relation: Relation) -> Option<Fix> {
        let word = relation_word(relation);
        let place = self.check_place()?;
        if is_word(place, RELATIONS) {
            return Some(self.edit(place.range, word, format!("Replace {} by {word}", place.text)));
        }
        let at = TextRange::empty(place.range.start());
        Some(self.edit(at, &format!("{word},"), format!("Insert {word}")))
    }

    /// Another count before INTOF, or the first one.
    fn counted(&self, occurrence: u32) -> Option<Fix> {
        let elements = &self.parsed.elements;
        let count = format!("{occurrence},INTOF");
        if let Some(intof) = elements.iter().position(|element| is_word(element, &["INTOF"])) {
            let number = elements.get(intof.checked_sub(2)?)?;
            let title = format!("Replace {},INTOF by {count}", number.text);
            return (number.kind == ElementKind::Number)
                .then(|| self.edit(number.range, &occurrence.to_string(), title));
        }
        let place = self.check_place()?;
        let title = format!("Insert {count}");
        if is_word(place, RELATIONS) {
            let after = TextRange::empty(place.range.end());
            return Some(self.edit(after, &format!(",{count}"), title));
        }
        Some(self.edit(TextRange::empty(place.range.start()), &format!("TO,{count},"), title))
    }

    /// What stands behind the drive surface: the first element of the part about the check surface.
    fn check_place(&self) -> Option<&Element> {
        let elements = &self.parsed.elements;
        let turn = elements.iter().position(|element| is_word(element, TURNS))?;
        let mut depth = 0_u32;
        for (index, element) in elements.iter().enumerate().skip(turn) {
            match element.kind {
                ElementKind::LeftParenthesis => depth += 1,
                ElementKind::RightParenthesis => depth = depth.saturating_sub(1),
                ElementKind::Comma if depth == 0 => return elements.get(index + 1),
                _ => {}
            }
        }
        None
    }

    fn edit(&self, range: TextRange, text: &str, title: String) -> Fix {
        Fix { title, edits: vec![(self.bytes(range), text.to_owned())], preferred: false }
    }
}

/// Whether a statement leaves a direction that is given in force: it neither moves the tool nor decides what is executed.
fn lets_direction_be(body: &Body) -> bool {
    use WordClass::{PathControl, PathParameter, Postprocessor, PostprocessorBare, SystemFlag, ToolPosition};
    match body {
        Body::Text { .. } | Body::Assignment { .. } | Body::Definition { .. } => true,
        Body::Major { word, .. } => matches!(
            word.word.class,
            PathControl | PathParameter | Postprocessor | PostprocessorBare | SystemFlag | ToolPosition
        ),
        _ => false,
    }
}

fn is_word(element: &Element, words: &[&str]) -> bool {
    matches!(element.kind, ElementKind::Word | ElementKind::Name) && words.contains(&element.text.as_str())
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use crate::{
        diagnostic::Diagnostic,
        document::{Document, Level},
        format::applied,
        settings::Settings,
    };

    fn found(text: &str) -> Vec<Diagnostic> {
        let document = Document::new(text, None, &Arc::new(Settings::default()));
        document.diagnostics(Level::Motion, &|| false, &mut |_, _| {}).unwrap()
    }

    /// The fixes of the first finding with a code, and that each settles it.
    fn fixes(text: &str, code: &str) -> Vec<(String, String)> {
        let all = found(text);
        let Some(finding) = all.iter().find(|one| one.wording.code == code) else {
            panic!("no {code}: {all:?}")
        };
        let made: Vec<_> =
            finding.fixes.iter().map(|fix| (fix.title.clone(), applied(text, &fix.edits))).collect();
        for (title, fixed) in &made {
            let left = found(fixed);
            assert!(left.iter().all(|one| one.wording.code != code), "{title}:\n{fixed}\n{left:?}");
        }
        made
    }

    /// The same for the first of several codes that is found.
    fn fixes_of_any(text: &str, codes: &[&'static str]) -> Vec<(String, String)> {
        let all = found(text);
        let code = codes.iter().find(|code| all.iter().any(|one| one.wording.code == **code));
        fixes(text, code.unwrap_or_else(|| panic!("none of {codes:?}: {all:?}")))
    }

    const HEAD: &str = "CUTTER/.5\nL1=LINE/0,0,1,0\nL2=LINE/6,0,6,1\nC1=CIRCLE/6,.5,1\n";

    #[test]
    fn each_failure_gets_the_fixes_that_work() {
        let cases = [
            (
                "APT0642",
                "FROM/2,2,0\nGO/TO,L1\nTLLFT,GORGT/L1,TO,L2\nFINI\n",
                "TLLFT,GOLFT/L1,TO,L2",
                "Replace GORGT by GOLFT",
            ),
            (
                "APT0643",
                "FROM/2,2,0\nGO/TO,L1\nTLLFT,GOLFT/L1,TANTO,C1\nFINI\n",
                "GOLFT/L1,TO,C1",
                "Replace TANTO by TO",
            ),
            (
                "APT0642",
                "FROM/2,2,0\nGO/TO,L1\nTLLFT,GOLFT/L1,ON,3,INTOF,C1\nFINI\n",
                "ON,2,INTOF,C1",
                "Replace 3,INTOF by 2,INTOF",
            ),
            (
                "APT0627",
                "FROM/0,.25,0\nTLLFT,GOFWD/L1,ON,L2\nFINI\n",
                "TLLFT,GORGT/L1,ON,L2",
                "Replace GOFWD by GORGT",
            ),
            (
                "APT0620",
                "FROM/2,0,3\nGO/TO,L1\nFINI\n",
                "SRFVCT/(VECTOR/0,1,0)\nGO/TO,L1",
                "Insert SRFVCT/(VECTOR/0,1,0) before the motion",
            ),
            (
                "APT0625",
                "OUTTOL/.001\nFROM/0,.252,0\nTLLFT,GORGT/L1,ON,L2\nFINI\n",
                "OUTTOL/0.001,0.0021,0.001\nTLLFT,GORGT",
                "Insert OUTTOL/0.001,0.0021,0.001 before the motion",
            ),
            (
                "APT0622",
                "FROM/0,2,0\nOFFSET/TO,L1\nFINI\n",
                "INDIRV/0,-1,0\nOFFSET/TO,L1",
                "Insert INDIRV/0,-1,0 before the motion",
            ),
        ];
        for (code, text, expected, title) in cases {
            let made = fixes(&format!("{HEAD}{text}"), code);
            let hit = made.iter().find(|(told, _)| told == title);
            let Some((_, fixed)) = hit else { panic!("{code}: no {title:?} in {made:?}") };
            assert!(fixed.contains(expected), "{code}: {fixed}");
        }
    }

    /// A direction that is given already is given anew: with two of them the first one would have no effect (APT0957).
    #[test]
    fn a_direction_before_the_motion_is_replaced() {
        for (given, title) in [
            ("INDIRV/0,1,0", "Replace INDIRV/0,1,0 by INDIRV/0,-1,0"),
            ("INDIRP/0,9,0 $$ up\n$$ and on", "Replace INDIRP/0,9,0 by INDIRV/0,-1,0"),
            ("INDIRV/0,1,0\nNOPS\nFEDRAT/10", "Replace INDIRV/0,1,0 by INDIRV/0,-1,0"),
            // A jump may lead between the two.
            ("INDIRV/0,1,0\nA1)FEDRAT/10", "Insert INDIRV/0,-1,0 before the motion"),
        ] {
            let made = fixes(&format!("{HEAD}FROM/0,2,0\n{given}\nOFFSET/TO,L1\nFINI\n"), "APT0621");
            assert!(made.iter().any(|(told, _)| told == title), "{given}: {made:?}");
        }
    }

    /// Round a circle to the line x=1, which it meets above and below; then along the line.
    const ROUND: &str =
        "CUTTER/.5\nC9=CIRCLE/0,0,2\nL8=LINE/1,-9,1,9\nL7=LINE/-9,6,9,6\nFROM/-5,0,0\nGO/TO,C9\n";

    #[test]
    fn a_count_is_put_into_the_motion_before_where_a_later_crossing_was_meant() {
        // From above the way to the right leads down, from below it leads up, to L7.
        let text = format!("{ROUND}TLLFT,GOLFT/C9,ON,L8\nTLON,GORGT/L8,TO,L7\nFINI\n");
        let made = fixes(&text, "APT0642");
        let fixed =
            made.iter().find(|(title, _)| title == "Insert 2,INTOF").unwrap_or_else(|| panic!("{made:?}"));
        assert!(fixed.1.contains("TLLFT,GOLFT/C9,ON,2,INTOF,L8\nTLON,GORGT/L8,TO,L7"), "{fixed:?}");
        let hint = found(&text).into_iter().find_map(|one| one.wording.hint).unwrap_or_default();
        assert!(hint.contains("the motion before it with 2,INTOF"), "{hint}");
        // A count that is there is raised; a relation that is implied is said. Other statements may stand in between.
        for (first, expected) in [
            ("GOLFT/C9,ON,1,INTOF,L8", "GOLFT/C9,ON,2,INTOF,L8"),
            ("GOLFT/C9,ON,L8\nFEDRAT/10\nTOLER/.001", "GOLFT/C9,ON,2,INTOF,L8\nFEDRAT/10"),
        ] {
            let text = format!("{ROUND}TLLFT,{first}\nTLON,GORGT/L8,TO,L7\nFINI\n");
            let made = fixes(&text, "APT0642");
            assert!(made.iter().any(|(_, fixed)| fixed.contains(expected)), "{expected}: {made:?}");
        }
        // Where the tool was moved in between the motion before has no part in it.
        let text = format!(
            "{ROUND}TLLFT,GOLFT/C9,ON,L8\nGODLTA/0,0,0.1\nGODLTA/0,0,-0.1\nTLON,GORGT/L8,TO,L7\nFINI\n"
        );
        assert!(found(&text).iter().all(|one| one.fixes.iter().all(|fix| !fix.title.contains("INTOF"))));
    }

    #[test]
    fn the_side_that_is_said_is_turned_to_where_the_tool_is() {
        let text = format!("{ROUND}TLRGT,GOLFT/C9,ON,L8\nFINI\n");
        let made = fixes(&text, "APT0660");
        assert_eq!(made.len(), 1, "{made:?}");
        assert_eq!(made[0].0, "Replace TLRGT by TLLFT");
        assert!(made[0].1.contains("TLLFT,GOLFT/C9,ON,L8"), "{made:?}");
    }

    /// A ball 0.01 above part surfaces of many kinds, and past what is allowed: the tool is moved in, or it is tolerated.
    #[test]
    fn a_start_out_of_tolerance_is_cured_on_every_kind_of_part_surface() {
        for part in [
            "PLANE/.1,.2,1,-1",
            "CYLNDR/0,0,-3,0,1,.1,3",
            "SPHERE/0,0,-3,3",
            "CONE/(POINT/0,0,1),(VECTOR/.1,0,-1),60",
            "QADRIC/1,2,3,0,0,0,0,0,18,0",
        ] {
            let text = format!(
                "CUTTER/.5,.25\nOUTTOL/.001\nPS={part}\nDS=PLANE/0,1,0,.3\nFROM/-2,0,4\n\
                 GO/ON,DS,TO,PS,ON,(PLANE/1,0,0,-1)\nGODLTA/.01\nINDIRV/1,0,0\nTLON,GOFWD/DS,ON,(PLANE/1,0,0,1)\nFINI\n"
            );
            let made = fixes(&text, "APT0625");
            let titles: Vec<&str> = made.iter().map(|(title, _)| title.as_str()).collect();
            assert!(titles.iter().any(|title| title.starts_with("Insert OUTTOL/")), "{part}: {titles:?}");
            assert!(titles.iter().any(|title| title.starts_with("Insert GOTO/")), "{part}: {titles:?}");
        }
    }

    /// The stop is asked for in a relation, or the other way, in which it does not come: on curved check surfaces too.
    #[test]
    fn a_stop_that_lies_behind_is_cured_on_every_kind_of_check_surface() {
        for check in [
            "CIRCLE/6,0,1",
            "SPHERE/6,0,0,1",
            "CONE/(POINT/6,0,2),(VECTOR/0,0,-1),30",
            "QADRIC/1,2,3,0,0,0,-12,0,0,35",
        ] {
            let text = format!("{HEAD}CS={check}\nFROM/2,2,0\nGO/TO,L1\nTLLFT,GORGT/L1,TO,CS\nFINI\n");
            let made = fixes_of_any(&text, &["APT0641", "APT0642"]);
            let turned = made.iter().find(|(title, _)| title == "Replace GORGT by GOLFT");
            assert!(turned.is_some_and(|(_, fixed)| fixed.contains("GOLFT/L1,TO,CS")), "{check}: {made:?}");
        }
    }

    #[test]
    fn a_start_up_without_a_position_says_why() {
        for (text, code, words) in [
            (
                "FROM/0,0,1\nINDIRV/1,0,0\nGO/TO,(CIRCLE/0,0,.2)\nFINI\n",
                "APT0621",
                "the tool of radius 0.25 does not fit into the circle of radius 0.2",
            ),
            (
                "FROM/9,0,1\nINDIRV/1,0,0\nGO/TO,C1\nFINI\n",
                "APT0621",
                "there is no position TO the drive surface",
            ),
            (
                "FROM/0,0,3\nGO/TO,(PLANE/0,0,1,1),TO,(PLANE/0,0,1,0)\nFINI\n",
                "APT0624",
                "the drive surface and the part surface are parallel planes, 1 apart",
            ),
            (
                "FROM/0,0,3\nGO/TO,(LINE/0,1,5,1),TO,(PLANE/0,0,1,0),ON,(LINE/0,3,5,3)\nFINI\n",
                "APT0624",
                "choose a check surface that cuts the others",
            ),
            (
                "FROM/9,0,3\nMULTAX\nTLAXIS/PARLEL,2\nGO/TO,C1,TO,(PLANE/0,0,1,0)\nFINI\n",
                "APT0606",
                "PARLEL follows the rulings of a RLDSRF, and the surface that it names is none",
            ),
        ] {
            let all = found(&format!("{HEAD}{text}"));
            let Some(told) = all.iter().find(|one| one.wording.code == code) else {
                panic!("{text}: {all:?}")
            };
            let said = format!("{:?}", told.wording);
            assert!(said.contains(words), "{text}: {said}");
        }
    }

    #[test]
    fn the_hint_names_the_cure_and_where_it_leads() {
        let text = format!("{HEAD}FROM/2,2,0\nGO/TO,L1\nTLLFT,GORGT/L1,TO,L2\nFINI\n");
        let all = found(&text);
        let finding = all.iter().find(|one| one.wording.code == "APT0642").unwrap();
        let hint = finding.wording.hint.as_deref().unwrap();
        assert!(hint.starts_with("GOLFT ends at (5.75, 0.25, 0)"), "{hint}");
    }

    #[test]
    fn a_macro_that_fails_is_fixed_in_its_own_text() {
        let text =
            format!("{HEAD}M1=MACRO\nTLLFT,GORGT/L1,TO,L2\nTERMAC\nFROM/2,2,0\nGO/TO,L1\nCALL/M1\nFINI\n");
        let made = fixes(&text, "APT0642");
        assert!(made[0].1.contains("MACRO\nTLLFT,GOLFT/L1,TO,L2\nTERMAC"), "{made:?}");
    }
}
