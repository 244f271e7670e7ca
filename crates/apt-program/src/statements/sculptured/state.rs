//! The modal state of regional milling: the blocks of SCON and the switches.

use std::sync::Arc;

use apt_geometry::{
    canonical::Plane,
    regional::{
        AvoidanceControl, AxisCondition, CheckedSurfaces, FeedCondition, GuideCondition, PartCondition,
        StepoverCondition,
    },
};

use crate::finding::ConditionBlock;

/// A block of SCON.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) enum Block<T> {
    /// Nothing was given since the start or since SCON/INIT.
    #[default]
    Missing,
    /// The last statement for it has a mistake.
    Spoiled,
    /// A legal statement was given.
    Valid(Arc<T>),
}

impl<T> Block<T> {
    /// A valid block.
    pub(super) fn valid(condition: T) -> Self {
        Block::Valid(Arc::new(condition))
    }

    /// The condition, if the block is valid.
    pub(super) fn get(&self) -> Option<&T> {
        match self {
            Block::Valid(condition) => Some(condition),
            Block::Missing | Block::Spoiled => None,
        }
    }

    fn is_spoiled(&self) -> bool {
        matches!(self, Block::Spoiled)
    }

    fn is_valid(&self) -> bool {
        matches!(self, Block::Valid(_))
    }
}

/// What regional milling remembers from statement to statement.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct RegionalState {
    pub(super) guide: Block<GuideCondition>,
    pub(super) part: Block<PartCondition>,
    pub(super) axis: Block<AxisCondition>,
    pub(super) feed: Block<FeedCondition>,
    pub(super) clearance: Block<Plane>,
    pub(super) stepover: Block<StepoverCondition>,
    pub(super) checked: CheckedSurfaces,
    pub(super) avoidance: AvoidanceControl,
    /// GOUGCK/ON.
    pub(crate) check_chords: bool,
    /// PRINT/AVPRT,ON.
    pub(crate) list_avoidance: bool,
}

impl RegionalState {
    /// The blocks that are valid, in their order.
    pub(super) fn valid_blocks(&self) -> Vec<ConditionBlock> {
        ConditionBlock::ALL.into_iter().filter(|block| self.is(*block, |_, valid| valid)).collect()
    }

    /// Whether the last statement for a block had a mistake.
    pub(super) fn is_spoiled(&self, block: ConditionBlock) -> bool {
        self.is(block, |spoiled, _| spoiled)
    }

    fn is(&self, block: ConditionBlock, asked: fn(bool, bool) -> bool) -> bool {
        let (spoiled, valid) = match block {
            ConditionBlock::Guide => (self.guide.is_spoiled(), self.guide.is_valid()),
            ConditionBlock::Part => (self.part.is_spoiled(), self.part.is_valid()),
            ConditionBlock::Axis => (self.axis.is_spoiled(), self.axis.is_valid()),
            ConditionBlock::Feed => (self.feed.is_spoiled(), self.feed.is_valid()),
            ConditionBlock::Clearance => (self.clearance.is_spoiled(), self.clearance.is_valid()),
            ConditionBlock::Stepover => (self.stepover.is_spoiled(), self.stepover.is_valid()),
        };
        asked(spoiled, valid)
    }

    /// SCON/INIT of one block, or of all.
    pub(super) fn forget(&mut self, word: &str) {
        let all = word == "ALL";
        if all || word == "DS" {
            self.guide = Block::Missing;
        }
        if all || word == "PS" {
            self.part = Block::Missing;
        }
        if all || word == "AXIS" {
            self.axis = Block::Missing;
        }
        if all || word == "FEED" {
            self.feed = Block::Missing;
            self.clearance = Block::Missing;
        }
        if all || word == "STEPOV" {
            self.stepover = Block::Missing;
        }
    }

    /// Marks the block that a word names as spoiled; SCON/FEED may mean either of two.
    pub(super) fn spoil(&mut self, word: &str, with_plane: bool) {
        match word {
            "DS" => self.guide = Block::Spoiled,
            "PS" => self.part = Block::Spoiled,
            "AXIS" => self.axis = Block::Spoiled,
            "FEED" if with_plane => self.clearance = Block::Spoiled,
            "FEED" => self.feed = Block::Spoiled,
            "STEPOV" => self.stepover = Block::Spoiled,
            _ => {}
        }
    }
}
