//! CATIA APT source: fields in columns, circles as drive surfaces, remarks that carry the operations.

use super::{Axes, Circles, CutterForm, CycleForm, CyclePart, Form, TextForm, ToolForm};
use crate::text::{detect::ClDialect, number::Field, sheet::Layout};

pub(super) const FORM: Form = Form {
    dialect: ClDialect::Catia,
    layout: Layout { columns: 80, slash: "/", comma: ",", mark: "$", indent: "   " },
    position: Field::decimals(5).wide(11),
    axis: Field::decimals(6).wide(9),
    value: Field::decimals(4).wide(10),
    size: Field::decimals(6).wide(10),
    counts: true,
    goto: "GOTO  ",
    axis_row: false,
    bare_rows: false,
    axes: Axes::UnderMultax,
    multax: &[],
    circles: Circles::Driven,
    feed_value_first: true,
    speed_value_first: true,
    tool: ToolForm::Couples { register: "ADJUST" },
    cutter: CutterForm::Statement,
    cycle: CycleForm {
        depth: "",
        depth_signed: false,
        clearance: "",
        step: "INCR",
        retract: "RETURN",
        feed_value_first: true,
        deep: None,
        order: [
            CyclePart::Depth,
            CyclePart::Step,
            CyclePart::Feed,
            CyclePart::Clearance,
            CyclePart::Retract,
            CyclePart::Rest,
        ],
    },
    texts: &[("TPRINT", TextForm::Slash)],
    title: Some("     CATIA APT VERSION 1.0"),
    part_number: false,
    operations: false,
    numbered: false,
    tells_units: false,
    own: &["END_OP", "OP_NAME", "PART_OPE", "START_OP", "TDATA", "TOOLPATH_TYPE"],
};
