//! Comments behind the statements of adjacent lines begin in the same column.

use apt_geometry::patience::Patience;
use apt_syntax::record::Layout;

use super::line::Line;
use crate::{Cancelled, go_on};

/// A line whose code is longer does not move the comments of its neighbours.
const LONGEST_ALIGNED: usize = 60;

/// The columns in which the signs and comments of adjacent lines begin.
///
/// # Errors
///
/// [`Cancelled`] when who waits has given up before the end.
pub(super) fn columns<'a>(
    lines: impl Iterator<Item = Option<&'a Line>>,
    align: bool,
    layout: &Layout,
    patience: Patience<'_>,
) -> Result<Vec<usize>, Cancelled> {
    let lines = lines.map(|line| go_on(patience, 1).map(|()| line));
    let lines = lines.collect::<Result<Vec<Option<&Line>>, Cancelled>>()?;
    let own = |line: &Option<&Line>| go_on(patience, 1).map(|()| line.map_or(0, Line::own_column));
    let mut columns = lines.iter().map(own).collect::<Result<Vec<usize>, Cancelled>>()?;
    if !align {
        return Ok(columns);
    }
    let joins = |line: &Option<&Line>| {
        line.is_some_and(|line| line.has_trailing_comment() && line.width() <= LONGEST_ALIGNED)
    };
    let mut from = 0;
    while from < lines.len() {
        let length = lines.get(from..).unwrap_or_default().iter().take_while(|line| joins(line)).count();
        let (Some(group), Some(own)) = (lines.get(from..from + length), columns.get_mut(from..from + length))
        else {
            break;
        };
        let column = own.iter().copied().max().unwrap_or(0);
        let fits = group.iter().flatten().all(|line| line.length(column) <= line.limit(layout));
        if fits {
            own.fill(column);
        }
        from += length.max(1);
        go_on(patience, length.max(1))?;
    }
    Ok(columns)
}
