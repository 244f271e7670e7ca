//! What a motion statement gave, in a hover.

use arelem::{section2::Output, verify::Extent};

use super::number;
use crate::{Analysis, Cancel, Cancelled};

/// Positions shown; the rest is counted.
const POSITIONS_SHOWN: usize = 4;

impl Analysis {
    /// The result of the motion statement with this number; empty if it gave none.
    pub(super) fn motion_markdown(&self, isn: u32, cancel: Cancel<'_>) -> Result<String, Cancelled> {
        let result = self.result(cancel, &mut |_, _| {})?;
        let mut text = String::new();
        let mut turns = result.motions.iter().filter(|motion| motion.origin.isn == isn);
        let count = turns.clone().count();
        let Some(motion) = turns.next_back() else { return Ok(text) };
        let Some(Output::Sequence(sequence)) = &motion.computed.execution.output else { return Ok(text) };
        let vectors = sequence.points.len();
        let plural = if vectors == 1 { "" } else { "s" };
        text.push_str(&format!("**{vectors} cut vector{plural}**"));
        if let Some(minimum) = sequence.minimum {
            text.push_str(&format!(" (no fewer than {minimum} are possible)"));
        }
        if count > 1 {
            text.push_str(&format!(", the last of {count} times"));
        }
        let evidence = motion.computed.evidence.as_ref().and_then(|evidence| evidence.as_ref().ok());
        text.push_str(match evidence {
            Some(evidence) if evidence.verified => " — verified\n\n",
            Some(_) => " — **not verified**\n\n",
            None => "\n\n",
        });
        if let Some(evidence) = evidence {
            text.push_str("| surface | clearance | allowed |\n|---|---|---|\n");
            for (role, extent) in
                [("part", evidence.part), ("drive", evidence.drive), ("check", evidence.check)]
            {
                text.push_str(&extent.map(|extent| row(role, &extent)).unwrap_or_default());
            }
            text.push('\n');
        }
        for point in sequence.points.iter().take(POSITIONS_SHOWN) {
            let at = point.tip;
            text.push_str(&format!("`GOTO/{},{},{}`  \n", number(at.x), number(at.y), number(at.z)));
        }
        if vectors > POSITIONS_SHOWN {
            text.push_str(&format!("… {} more  \n", vectors - POSITIONS_SHOWN));
        }
        text.push_str("\n---\n");
        Ok(text)
    }
}

fn row(role: &str, extent: &Extent) -> String {
    format!(
        "| {role} | {} … {} | {} … {} |\n",
        number(extent.min),
        number(extent.max),
        number(-extent.intol),
        number(extent.outtol)
    )
}
