//! Autodesk HSM and Fusion, "Common ISO 4343": quoted text, MOVARC with the angle, positional LOADTL.

use super::{Axes, Circles, CutterForm, CycleForm, CyclePart, Deep, Form, TextForm, ToolForm};
use crate::text::{detect::ClDialect, number::Field, sheet::Layout};

pub(super) const FORM: Form = Form {
    dialect: ClDialect::Hsm,
    // It continues no lines; readers take at least 256 columns.
    layout: Layout { columns: 256, slash: "/", comma: ", ", mark: "$", indent: "  " },
    position: Field::decimals(6),
    axis: Field::decimals(9),
    value: Field::decimals(6),
    size: Field::decimals(6),
    counts: true,
    goto: "GOTO",
    axis_row: false,
    bare_rows: false,
    axes: Axes::UnderMultax,
    multax: &["ON"],
    circles: Circles::WithAngle,
    feed_value_first: true,
    speed_value_first: true,
    tool: ToolForm::Positions,
    cutter: CutterForm::Statement,
    cycle: CycleForm {
        depth: "",
        depth_signed: false,
        clearance: "",
        step: "INCR",
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
    texts: &[("PARTNO", TextForm::Quoted), ("PPRINT", TextForm::Quoted)],
    title: None,
    part_number: true,
    operations: false,
    numbered: false,
    tells_units: true,
    own: &[],
};
