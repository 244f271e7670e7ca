//! NCL and PostWorks text: numbered rows, eight decimals with blanks for zeros, CIRCLE before the positions.

use super::{Axes, Circles, CutterForm, CycleForm, CyclePart, Deep, Form, ToolForm};
use crate::text::{detect::ClDialect, number::Field, sheet::Layout};

pub(super) const FORM: Form = Form {
    dialect: ClDialect::Ncl,
    layout: Layout { columns: 72, slash: "/ ", comma: ", ", mark: " $", indent: "        " },
    position: Field::decimals(8).wide(13).blank(),
    axis: Field::decimals(8).wide(13).blank(),
    value: Field::decimals(0),
    size: Field::decimals(0),
    counts: false,
    goto: "GOTO",
    axis_row: true,
    bare_rows: false,
    axes: Axes::UnderMultax,
    multax: &["ON"],
    circles: Circles::BeforePositions,
    feed_value_first: false,
    speed_value_first: false,
    tool: ToolForm::Couples { register: "OFFSET" },
    cutter: CutterForm::Statement,
    cycle: CycleForm {
        depth: "FEDTO",
        depth_signed: false,
        clearance: "RAPTO",
        step: "STEP",
        retract: "RTRCTO",
        feed_value_first: false,
        deep: Some(Deep::BreaksChips),
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
    numbered: true,
    tells_units: false,
    own: &[],
};
