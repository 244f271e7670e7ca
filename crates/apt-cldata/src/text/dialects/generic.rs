//! APT CL text without the marks of a system: what `run --format cl` writes.

use super::{Axes, Circles, CutterForm, CycleForm, CyclePart, Form, ToolForm};
use crate::text::{detect::ClDialect, number::Field, sheet::Layout};

pub(super) const FORM: Form = Form {
    dialect: ClDialect::Generic,
    // Columns 73 to 80 of a card are for its number.
    layout: Layout { columns: 72, slash: "/", comma: ",", mark: "$", indent: "       " },
    position: Field::decimals(1),
    axis: Field::decimals(1),
    value: Field::decimals(1),
    size: Field::decimals(1),
    counts: false,
    goto: "GOTO",
    axis_row: false,
    bare_rows: false,
    axes: Axes::UnderMultax,
    multax: &["ON"],
    circles: Circles::AsRecorded,
    feed_value_first: true,
    speed_value_first: true,
    // ADJUST and LENGTH have codes on the tape, OSETNO has none.
    tool: ToolForm::Couples { register: "ADJUST" },
    cutter: CutterForm::Statement,
    // The widest public superset: the words of PostWorks.
    cycle: CycleForm {
        depth: "FEDTO",
        depth_signed: false,
        clearance: "RAPTO",
        step: "STEP",
        retract: "RTRCTO",
        feed_value_first: false,
        deep: None,
        order: [
            CyclePart::Depth,
            CyclePart::Feed,
            CyclePart::Clearance,
            CyclePart::Step,
            CyclePart::Retract,
            CyclePart::Rest,
        ],
    },
    texts: &[],
    title: None,
    part_number: false,
    operations: false,
    numbered: false,
    tells_units: false,
    own: &[],
};
