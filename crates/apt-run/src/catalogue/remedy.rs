//! Words for what cures a failed motion: the statements as a programmer writes them, hints and titles of fixes.

use apt_geometry::{
    Vec3,
    motion::{DriveSide, PartSide, PerRole, Turn},
};
use arelem::{
    cure::{Cure, Remedy},
    error::RoleName,
};

use super::motion::{place, relation, role};

/// Decimals of the numbers in a statement.
const DECIMALS: usize = 9;

/// The hint that names what was found to help; none if nothing was.
pub(super) fn hint(remedies: &[Remedy]) -> Option<String> {
    let told: Vec<_> =
        remedies.iter().map(|one| format!("{} ends at {}", what(&one.cure), place(&one.end))).collect();
    (!told.is_empty()).then(|| told.join("; "))
}

/// The changed program, as the subject of a sentence.
fn what(cure: &Cure) -> String {
    match cure {
        Cure::Relation { relation: other, .. } => format!("{} here", relation(*other)),
        Cure::Occurrence { occurrence, .. } => format!("{occurrence},INTOF"),
        Cure::EarlierOccurrence { occurrence, .. } => {
            format!("the motion before it with {occurrence},INTOF lets this one through, which then")
        }
        Cure::Turn(turn) => turn_word(*turn).to_owned(),
        Cure::DriveSide(side) => drive_side_word(*side).to_owned(),
        Cure::PartSide(side) => part_side_word(*side).to_owned(),
        Cure::WithoutDirection => "the GO without INDIRV and INDIRP".to_owned(),
        Cure::Tolerance { role: name, inside, by, .. } => {
            let word = if *inside { "INTOL" } else { "OUTTOL" };
            let statement = statement(cure).unwrap_or_else(|| word.to_owned());
            format!("{statement}, looser by {} for the {},", decimal(*by), role(*name))
        }
        Cure::MoveTo { by, .. } => {
            format!("{} ({} away) before it", statement(cure).unwrap_or_default(), decimal(*by))
        }
        Cure::Direction(_) | Cure::SurfaceVector { .. } | Cure::Points(_) => {
            format!("{} before it", statement(cure).unwrap_or_default())
        }
    }
}

/// The statement that a cure puts before the failed one, if it is such a cure.
pub(crate) fn statement(cure: &Cure) -> Option<String> {
    Some(match cure {
        Cure::Direction(vector) => format!("INDIRV/{}", triple(vector)),
        Cure::SurfaceVector { role, vector } => {
            let before = match role {
                RoleName::Drive => "",
                RoleName::Part => ",",
                RoleName::Check(_) => ",,",
            };
            format!("SRFVCT/{before}(VECTOR/{})", triple(vector))
        }
        Cure::Tolerance { inside, values, .. } => {
            format!("{}/{}", if *inside { "INTOL" } else { "OUTTOL" }, per_role(values))
        }
        Cure::MoveTo { position, .. } => format!("GOTO/{}", triple(position)),
        Cure::Points(count) => format!("NUMPTS/{count}"),
        Cure::DriveSide(side) => drive_side_word(*side).to_owned(),
        Cure::PartSide(side) => part_side_word(*side).to_owned(),
        Cure::Relation { .. }
        | Cure::Occurrence { .. }
        | Cure::EarlierOccurrence { .. }
        | Cure::Turn(_)
        | Cure::WithoutDirection => return None,
    })
}

/// The word for a turn.
pub(crate) fn turn_word(turn: Turn) -> &'static str {
    match turn {
        Turn::Left => "GOLFT",
        Turn::Right => "GORGT",
        Turn::Forward => "GOFWD",
        Turn::Back => "GOBACK",
        Turn::Up => "GOUP",
        Turn::Down => "GODOWN",
    }
}

/// The word for the side of the drive surface.
pub(crate) fn drive_side_word(side: DriveSide) -> &'static str {
    match side {
        DriveSide::Left => "TLLFT",
        DriveSide::Right => "TLRGT",
        DriveSide::On => "TLON",
    }
}

/// The word for how the tool stands to the part surface.
pub(crate) fn part_side_word(side: PartSide) -> &'static str {
    match side {
        PartSide::Offset => "TLOFPS",
        PartSide::On => "TLONPS",
    }
}

/// The word of a relation.
pub(crate) fn relation_word(other: apt_geometry::motion::Relation) -> &'static str {
    relation(other)
}

/// A number as a statement takes it: no exponent.
fn decimal(value: f64) -> String {
    // The sum turns -0 into 0.
    let text = format!("{:.DECIMALS$}", value + 0.0);
    let short = text.trim_end_matches('0').trim_end_matches('.');
    if matches!(short, "" | "-" | "-0") { "0".to_owned() } else { short.to_owned() }
}

pub(crate) fn triple(v: &Vec3) -> String {
    [v.x, v.y, v.z].map(decimal).join(",")
}

/// The values, the repeated ones at the end left out.
fn per_role(values: &PerRole) -> String {
    let all = [values.part, values.drive, values.check[0], values.check[1]];
    let last = all[3];
    let same = all.iter().rev().take_while(|value| **value == last).count();
    let kept = (all.len() + 1).saturating_sub(same).max(1);
    all.iter().take(kept).map(|value| decimal(*value)).collect::<Vec<_>>().join(",")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn statements_are_written_as_the_language_takes_them() {
        let all = PerRole::all(0.002);
        let one = PerRole { part: 0.001, ..all };
        let role = RoleName::Part;
        let (inside, by) = (true, 0.001);
        for (cure, text) in [
            (Cure::Direction(Vec3::new(1.0, -0.0, 1e-12)), "INDIRV/1,0,0"),
            (Cure::SurfaceVector { role, vector: Vec3::new(0.0, 0.6, -0.8) }, "SRFVCT/,(VECTOR/0,0.6,-0.8)"),
            (Cure::Tolerance { role, inside, by, values: all }, "INTOL/0.002"),
            (Cure::Tolerance { role, inside: false, by, values: one }, "OUTTOL/0.001,0.002"),
            (Cure::Points(800), "NUMPTS/800"),
            (Cure::MoveTo { position: Vec3::new(0.25, 1e-5, 0.0), by, forward: None }, "GOTO/0.25,0.00001,0"),
        ] {
            assert_eq!(statement(&cure).as_deref(), Some(text));
        }
        assert_eq!(statement(&Cure::Turn(Turn::Left)), None);
    }

    #[test]
    fn a_hint_tells_what_helps_and_where_it_leads() {
        let end = Vec3::new(5.75, 0.25, 0.0);
        let turn = Remedy { cure: Cure::Turn(Turn::Left), end };
        let count = Remedy { cure: Cure::Occurrence { check: 0, occurrence: 2 }, end };
        assert_eq!(hint(&[]), None);
        assert_eq!(
            hint(&[turn, count]).as_deref(),
            Some("GOLFT ends at (5.75, 0.25, 0); 2,INTOF ends at (5.75, 0.25, 0)")
        );
    }
}
