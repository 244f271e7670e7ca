//! Siemens NX CLSF: one block for each operation, units first, the axis where it changes, CIRCLE before the end.

use super::{Axes, Circles, CutterForm, CycleForm, CyclePart, Form, TextForm, ToolForm};
use crate::text::{detect::ClDialect, number::Field, sheet::Layout, words::TOOL_PATH};

/// What ends an operation.
pub(crate) const END_OF_PATH: &str = "END-OF-PATH";

pub(super) const FORM: Form = Form {
    dialect: ClDialect::Nx,
    // It continues no lines; readers take at least 256 columns.
    layout: Layout { columns: 256, slash: "/", comma: ",", mark: "$", indent: "" },
    position: Field::decimals(4),
    axis: Field::decimals(7),
    value: Field::decimals(4),
    size: Field::decimals(4),
    counts: true,
    goto: "GOTO",
    axis_row: false,
    bare_rows: true,
    axes: Axes::WhereChanged,
    multax: &["ON"],
    circles: Circles::BeforeEnd,
    feed_value_first: false,
    speed_value_first: false,
    tool: ToolForm::LoadTool,
    cutter: CutterForm::ToolData,
    cycle: CycleForm {
        depth: "FEDTO",
        depth_signed: true,
        clearance: "RAPTO",
        step: "STEP",
        retract: "RTRCTO",
        feed_value_first: false,
        deep: None,
        order: [
            CyclePart::Clearance,
            CyclePart::Depth,
            CyclePart::Retract,
            CyclePart::Step,
            CyclePart::Feed,
            CyclePart::Rest,
        ],
    },
    texts: &[("INSERT", TextForm::Slash), ("PPRINT", TextForm::Slash)],
    title: None,
    part_number: false,
    operations: true,
    numbered: false,
    tells_units: false,
    own: &[END_OF_PATH, "LOAD", "MSYS", "PAINT", "SELECT", "TLDATA", TOOL_PATH],
};
