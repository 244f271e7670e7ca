//! Creo and Pro/ENGINEER: blanks about the slash, ten decimals, `$$->` pseudo statements, CIRCLE before the positions.

use super::{Axes, Circles, CutterForm, CycleForm, CyclePart, Deep, Form, TextForm, ToolForm};
use crate::text::{detect::ClDialect, number::Field, sheet::Layout};

pub(super) const FORM: Form = Form {
    dialect: ClDialect::Creo,
    layout: Layout { columns: 72, slash: " / ", comma: ", ", mark: "  $", indent: "        " },
    position: Field::decimals(10),
    axis: Field::decimals(10),
    value: Field::decimals(6),
    size: Field::decimals(6),
    counts: true,
    goto: "GOTO",
    axis_row: true,
    bare_rows: true,
    axes: Axes::WhereTold,
    multax: &["ON"],
    circles: Circles::BeforePositions,
    feed_value_first: true,
    speed_value_first: false,
    tool: ToolForm::Couples { register: "OSETNO" },
    cutter: CutterForm::Pseudo,
    cycle: CycleForm {
        depth: "DEPTH",
        depth_signed: false,
        clearance: "CLEAR",
        step: "STEP",
        retract: "RETURN",
        feed_value_first: false,
        deep: Some(Deep::Withdraws),
        order: [
            CyclePart::Depth,
            CyclePart::Step,
            CyclePart::Feed,
            CyclePart::Clearance,
            CyclePart::Retract,
            CyclePart::Rest,
        ],
    },
    texts: &[("INSERT", TextForm::Slash), ("PARTNO", TextForm::Slash), ("PPRINT", TextForm::Slash)],
    // Which version wrote the file is not known, for none did.
    title: Some("*         Pro/CLfile  Version"),
    part_number: false,
    operations: false,
    numbered: false,
    tells_units: true,
    own: &[],
};
