//! What each system writes: one file per dialect, one description in each.
//!
//! A description is data. What differs by more than spelling – circles, tools, cycles – is named here and carried out by the writer.
//! Source of the facts: `reference/cl-and-tape.md` section 2 of the project's reference.

mod catia;
mod creo;
mod generic;
mod hsm;
mod ncl;
pub(crate) mod nx;

use super::{detect::ClDialect, number::Field, sheet::Layout};

/// How a system writes CL text.
#[derive(Debug)]
pub(crate) struct Form {
    pub(crate) dialect: ClDialect,
    pub(crate) layout: Layout,
    /// Coordinates.
    pub(crate) position: Field,
    /// Components of the tool axis.
    pub(crate) axis: Field,
    /// Parameters of words for the post-processor.
    pub(crate) value: Field,
    /// Parameters of CUTTER, INTOL and their kin.
    pub(crate) size: Field,
    /// Whether numbers that count (of tools, registers, functions) stand without decimals.
    pub(crate) counts: bool,
    /// GOTO with what stands between it and the slash.
    pub(crate) goto: &'static str,
    /// Whether the tool axis stands on a row of its own.
    pub(crate) axis_row: bool,
    /// Whether the positions of a record after its first stand without a word.
    pub(crate) bare_rows: bool,
    /// When the tool axis is written.
    pub(crate) axes: Axes,
    /// What MULTAX says when it begins.
    pub(crate) multax: &'static [&'static str],
    pub(crate) circles: Circles,
    /// Whether the value stands before the unit in FEDRAT.
    pub(crate) feed_value_first: bool,
    /// Whether the value stands before RPM in SPINDL.
    pub(crate) speed_value_first: bool,
    pub(crate) tool: ToolForm,
    pub(crate) cutter: CutterForm,
    pub(crate) cycle: CycleForm,
    /// Texts that do not stand behind one blank.
    pub(crate) texts: &'static [(&'static str, TextForm)],
    /// The remark in the first line by which the system is recognised.
    pub(crate) title: Option<&'static str>,
    /// Whether PARTNO stands in the file even if it says nothing.
    pub(crate) part_number: bool,
    /// Whether every operation is a block of its own, between TOOL PATH and END-OF-PATH, and there is no FINI.
    pub(crate) operations: bool,
    /// Whether statements carry their number.
    pub(crate) numbered: bool,
    /// Whether the unit stands in the file.
    pub(crate) tells_units: bool,
    /// Words that only this system has.
    pub(crate) own: &'static [&'static str],
}

/// When the tool axis is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Axes {
    /// On every position under MULTAX, and never else.
    UnderMultax,
    /// The same, and where a position of the source has one without MULTAX.
    WhereTold,
    /// Where it changes.
    WhereChanged,
}

/// How a motion along a circle is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Circles {
    /// The circle as it stands on the record, then all positions.
    AsRecorded,
    /// `CIRCLE/` of the tool ends, with the axis by the right hand, then all positions.
    BeforePositions,
    /// `CIRCLE/`, then the end; a full turn at most.
    BeforeEnd,
    /// `MOVARC/` with the angle, then the end.
    WithAngle,
    /// `INDIRV/`, then `TLON,GOFWD/` along the circle to a line or plane through its centre and the end; less than half a turn, so that the
    /// end is where the check surface is met first.
    Driven,
}

/// How a tool is called.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ToolForm {
    /// `LOADTL/n,LENGTH,l,…`, with the word before the number of the offset register.
    Couples { register: &'static str },
    /// `LOADTL/n,0,length,register`.
    Positions,
    /// `LOAD/TOOL,n,ADJUST,register`; its length is part of TLDATA.
    LoadTool,
}

/// How a cutter is described.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum CutterForm {
    /// `CUTTER/d,r,e,f,a,b,h`.
    Statement,
    /// `$$-> CUTTER / d`.
    Pseudo,
    /// `TLDATA/MILL,d,r,length,taper,tip`.
    ToolData,
}

/// How the couples of CYCLE are spelled.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct CycleForm {
    /// Word before the depth; empty if it stands in its place alone.
    pub(crate) depth: &'static str,
    /// Whether the depth is the way along the tool axis, negative into the part.
    pub(crate) depth_signed: bool,
    /// Word before the clearance; empty if it stands alone at the end.
    pub(crate) clearance: &'static str,
    /// Word before the step.
    pub(crate) step: &'static str,
    /// Word before the height of return.
    pub(crate) retract: &'static str,
    /// Whether the feed rate stands before its unit.
    pub(crate) feed_value_first: bool,
    /// What DEEP does between its steps, where that is known.
    pub(crate) deep: Option<Deep>,
    /// The order in which they stand.
    pub(crate) order: [CyclePart; 6],
}

/// What a drill does between two steps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Deep {
    /// It is lifted a little, so that the chip breaks; THRU withdraws it.
    BreaksChips,
    /// It is withdrawn from the hole; BRKCHP breaks chips.
    Withdraws,
}

/// A part of CYCLE.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum CyclePart {
    Depth,
    Clearance,
    Retract,
    Feed,
    Step,
    /// Whatever else there is.
    Rest,
}

/// How free text stands behind its word.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum TextForm {
    /// Behind one blank.
    Blank,
    /// Behind the slash of the layout.
    Slash,
    /// In quotation marks behind a slash.
    Quoted,
}

/// Words whose parameters count something: tools, registers, blocks, functions.
pub(crate) const COUNTING: [&str; 19] = [
    "AUXFUN", "CUTCOM", "LOAD", "LOADTL", "MACHIN", "OFSTNO", "OPSKIP", "PAINT", "POSTN", "PREFUN", "REWIND",
    "SELCTL", "SELECT", "SEQNO", "TOOLNO", "TURRET", "UNLOAD", "HEAD", "CALSUB",
];

impl Form {
    /// The description of a dialect of text; that of APT CL text for what has none of its own.
    pub(crate) fn of(dialect: ClDialect) -> &'static Form {
        match dialect {
            ClDialect::Catia => &catia::FORM,
            ClDialect::Creo => &creo::FORM,
            ClDialect::Hsm => &hsm::FORM,
            ClDialect::Ncl => &ncl::FORM,
            ClDialect::Nx => &nx::FORM,
            ClDialect::Generic | ClDialect::Cltape | ClDialect::Nci | ClDialect::PartProgram => {
                &generic::FORM
            }
        }
    }

    /// Whether a word belongs to another system, so that nobody who reads this dialect knows it.
    pub(crate) fn is_strange(&self, word: &str) -> bool {
        let owner = ClDialect::ALL.into_iter().map(Form::of).find(|form| form.own.contains(&word));
        owner.is_some_and(|form| form.dialect != self.dialect)
    }
}
