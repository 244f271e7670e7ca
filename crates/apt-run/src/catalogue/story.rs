//! Words for the story of a motion.

use arelem::{
    error::RoleName,
    story::{Route, Story, StorySurface, StoryVector, SurfaceShape, VectorEnd},
};

use super::{
    a_kind,
    motion::{place, relation, role},
    number,
};

/// The story in sentences, the general before the particular: route, surfaces, start and end, cut vectors in groups that end
/// for the same reason.
pub fn lines(story: &Story) -> Vec<String> {
    let mut lines = vec![route(story)];
    lines.extend(story.surfaces.iter().map(surface));
    lines.extend(axis(story));
    lines.push(way(story));
    lines.extend(groups(&story.vectors).into_iter().map(group));
    lines
}

fn route(story: &Story) -> String {
    let what = if story.start_up { "start-up" } else { "motion" };
    let how = match story.route {
        Route::ClosedForm => "in closed form, in the plane across the vertical tool".to_owned(),
        Route::Straight => "as one straight move between two planes".to_owned(),
        Route::Iteration => "by iteration on the clearances".to_owned(),
    };
    let corrections = match story.corrections {
        Some(1) => "; 1 correction brings the tool onto its surfaces at the end".to_owned(),
        Some(count) => format!("; {count} corrections bring the tool onto its surfaces at the end"),
        None => String::new(),
    };
    format!("{what} computed {how}{corrections}")
}

fn surface(told: &StorySurface) -> String {
    let name = if told.name.is_empty() { String::new() } else { format!(" {}", told.name) };
    let side =
        if told.side > 0.0 { "the side its normal points to" } else { "the side away from its normal" };
    let shape = match told.shape {
        SurfaceShape::Flat => "flat",
        SurfaceShape::Convex => "bending away from the tool",
        SurfaceShape::Concave => "hollow towards the tool",
        SurfaceShape::General => "curved both ways",
    };
    let stock =
        if told.thickness == 0.0 { String::new() } else { format!(", THICK {}", number(told.thickness)) };
    let [start, end] = told.clearance;
    format!(
        "{}{name}: {}, {shape}, {} on {side}, clearance {} at the start and {} at the end, {} to {} allowed{stock}",
        role(told.role),
        a_kind(told.kind),
        relation(told.relation),
        number(rounded(start)),
        number(rounded(end)),
        number(-told.inside),
        number(told.outside),
    )
}

/// Angles below this are rounding, radians.
const NO_ANGLE: f64 = 1e-9;

/// How the tool axis stands, unless it stands upright all along.
fn axis(story: &Story) -> Option<String> {
    let [start, end] = [&story.start.axis, &story.end.axis].map(|axis| place(&axis.map(rounded_axis)));
    if story.turned > NO_ANGLE {
        let most = number((story.turned.to_degrees() * 1e3).round() / 1e3);
        return Some(format!(
            "the tool axis turns from {start} to {end}, {most} degrees from its start at most"
        ));
    }
    let upright = story.start.axis.x.hypot(story.start.axis.y) <= NO_ANGLE && story.start.axis.z > 0.0;
    (!upright).then(|| format!("the tool axis is {start} all along"))
}

fn way(story: &Story) -> String {
    let sense =
        story.forward.map_or(String::new(), |forward| format!(", setting out along {}", place(&forward)));
    // One is the least of every motion.
    let least = story.minimum.filter(|least| *least > 1);
    let least = least.map_or(String::new(), |least| format!("; no fewer than {least} are possible"));
    format!(
        "from {} to {}{sense}: {}{least}",
        place(&story.start.tip),
        place(&story.end.tip),
        counted(story.vectors.len())
    )
}

/// Vectors in a row that end for the same reason.
fn groups(vectors: &[StoryVector]) -> Vec<(usize, &[StoryVector])> {
    let mut groups = Vec::new();
    let mut first = 1;
    for run in vectors.chunk_by(|a, b| same(&a.end, &b.end)) {
        groups.push((first, run));
        first += run.len();
    }
    groups
}

fn same(a: &VectorEnd, b: &VectorEnd) -> bool {
    match (a, b) {
        (VectorEnd::Curvature { role: a, .. }, VectorEnd::Curvature { role: b, .. })
        | (VectorEnd::Proof { role: a }, VectorEnd::Proof { role: b }) => a == b,
        (VectorEnd::MaximumStep, VectorEnd::MaximumStep) => true,
        _ => false,
    }
}

fn group((first, vectors): (usize, &[StoryVector])) -> String {
    let numbers = match vectors.len() {
        1 => format!("vector {first} ends"),
        count => format!("vectors {first} to {} end", first + count - 1),
    };
    let fold = |pick: fn(f64, f64) -> f64, from: f64| vectors.iter().map(|one| one.length).fold(from, pick);
    let (least, greatest) = (fold(f64::min, f64::INFINITY), fold(f64::max, 0.0));
    let length = match vectors.len() {
        1 => format!("length {}", number(rounded(least))),
        _ => format!("lengths {} to {}", number(rounded(least)), number(rounded(greatest))),
    };
    let why = vectors.last().map_or(String::new(), |last| reason(&last.end, vectors));
    format!("{numbers} {why} ({length})")
}

fn reason(end: &VectorEnd, vectors: &[StoryVector]) -> String {
    match end {
        VectorEnd::Position => "at the start-up position".to_owned(),
        VectorEnd::CheckSurface { relation: reached, occurrence, check } => {
            let surface = role(RoleName::Check(*check));
            let time = if *occurrence > 1 {
                format!(", position number {occurrence} of its kind")
            } else {
                String::new()
            };
            format!("{} the {surface}{time}", relation(*reached))
        }
        VectorEnd::MaximumStep => "at the length that MAXDP allows".to_owned(),
        VectorEnd::Curvature { role: name, .. } => {
            let used = vectors.iter().filter_map(|one| match one.end {
                VectorEnd::Curvature { used, .. } => Some(used),
                _ => None,
            });
            let most = used.fold(0.0, f64::max);
            format!("where the sag at the {} fills {:.0} % of its tolerance", role(*name), 100.0 * most)
        }
        VectorEnd::Turn { angle } => format!("where the path turns by {:.1} degrees", angle.to_degrees()),
        VectorEnd::BeforeStop => "short of the stop, so that the last vector keeps the tolerance".to_owned(),
        VectorEnd::Proof { role: name } => {
            format!("where a longer one could not be proven to keep the tolerance of the {}", role(*name))
        }
    }
}

fn counted(count: usize) -> String {
    if count == 1 { "1 cut vector".to_owned() } else { format!("{count} cut vectors") }
}

/// Rounding leaves traces where a length is meant to be zero; nine decimals say all there is to say.
fn rounded(value: f64) -> f64 {
    (value * 1e9).round() / 1e9
}

/// Components of the tool axis: six decimals are a fifth of a second of arc.
fn rounded_axis(value: f64) -> f64 {
    (value * 1e6).round() / 1e6 + 0.0
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use super::*;
    use crate::{document::Document, settings::Settings};

    fn told(text: &str, isn: u32) -> String {
        let document = Document::new(text, None, &std::sync::Arc::new(Settings::default()));
        let result = document.run(&|| false, &mut |_, _| {}).unwrap();
        let motion = result.motions.iter().find(|motion| motion.origin.isn == isn).unwrap();
        lines(&motion.computed.story(&|| false).unwrap()).join("\n")
    }

    const PROGRAM: &str = "CUTTER/.5\nL1=LINE/0,0,1,0\nC1=CIRCLE/5,2,2\nFROM/0,2,0\nGO/TO,L1\n\
                           OUTTOL/.01\nTLRGT\nL2=LINE/5,0,5,9\nINDIRV/1,0,0\nGO/TO,C1\nGORGT/C1,ON,2,INTOF,L2\nFINI\n";

    #[test]
    fn an_axis_that_turns_or_leans_is_told() {
        let program = |axis: &str| {
            format!(
                "CUTTER/.5\nINTOL/.001\nOUTTOL/.001\nSP=SPHERE/0,0,0,5\nPL=PLANE/0,1,0,0\nFROM/0,0,7\nMULTAX\nTLAXIS/{axis}\n\
                 GO/ON,PL,TO,SP,ON,(PLANE/1,0,0,0)\nINDIRV/1,0,0\nTLON,GOFWD/PL,ON,(PLANE/1,0,0,2.5)\nFINI\n"
            )
        };
        let line = |axis: &str| {
            let story = told(&program(axis), 11);
            story.lines().find(|line| line.starts_with("the tool axis")).unwrap_or_default().to_owned()
        };
        expect!["the tool axis turns from (0, 0, 1) to (0.49995, 0, 0.866054), 29.997 degrees from its start at most"]
            .assert_eq(&line("NORMPS"));
        expect!["the tool axis is (0, 0.6, 0.8) all along"].assert_eq(&line("0,.6,.8"));
        expect![""].assert_eq(&line("0,0,1"));
    }

    #[test]
    fn a_story_is_told_in_sentences() {
        expect![[r#"
            start-up computed in closed form, in the plane across the vertical tool
            part surface: a PLANE, flat, TO on the side its normal points to, clearance 0 at the start and 0 at the end, 0 to 0.0005 allowed
            drive surface L1: a LINE, flat, TO on the side away from its normal, clearance 1.75 at the start and 0 at the end, 0 to 0.0005 allowed
            from (0, 2, 0) to (0, 0.25, 0): 1 cut vector
            vector 1 ends at the start-up position (length 1.75)"#]].assert_eq(&told(PROGRAM, 5));
        expect![[r#"
            motion computed in closed form, in the plane across the vertical tool
            part surface: a PLANE, flat, TO on the side its normal points to, clearance 0 at the start and 0 at the end, 0 to 0.01 allowed
            drive surface C1: a CIRCLE, bending away from the tool, TO on the side its normal points to, clearance 0 at the start and 0 at the end, 0 to 0.01 allowed
            check surface L2: a LINE, flat, ON on the side away from its normal, clearance 1.414213562 at the start and 0 at the end, 0 to 0.01 allowed
            from (3.585786438, 0.25, 0) to (5, 4.25, 0), setting out along (0.777777778, -0.628539361, 0): 22 cut vectors; no fewer than 21 are possible
            vectors 1 to 21 end where the sag at the drive surface fills 100 % of its tolerance (lengths 0.205337532 to 0.410673021)
            vector 22 ends ON the check surface, position number 2 of its kind (length 0.205337532)"#]].assert_eq(&told(PROGRAM, 11));
    }
}
