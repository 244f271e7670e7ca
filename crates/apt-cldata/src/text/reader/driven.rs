//! A circle that stands in a motion statement: the form in which CATIA, Creo (`APT_FORMAT`) and their kin write arcs.
//!
//! `TLON,GOFWD/(CIRCLE/c,r),ON,(LINE/c,e)` in a plane across z, and in any plane
//! `TLON,GOFWD/(CYLNDR/c,n,r),ON,(PLANE/PERPTO,(PLANE/(POINT/c),PERPTO,(VECTOR/n)),(POINT/c),(POINT/e))`. All data are in the statement, and
//! the last numbers of the check surface are the end `e` if they lie on the circle. Else the motion ends where the circle meets the line for
//! the first time, or with `2,INTOF,` before it for the second; or with `TANTO` where it touches the line.

use apt_geometry::Vec3;

use super::super::words::number;
use crate::geometry::SpaceCircle;

/// Distance, relative to the radius, within which the start of an arc is where its circle crosses a line.
const SAME_POINT_FRACTION: f64 = 1e-6;

/// A circle as drive surface, and the place where the motion ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Driven {
    pub(super) center: Vec3,
    /// As it is written, not yet of unit length.
    pub(super) axis: Vec3,
    pub(super) radius: f64,
    /// The last place that the check surface names.
    pub(super) named: Vec3,
    /// The place before it, where the check surface is a line.
    pub(super) line_from: Option<Vec3>,
    pub(super) meeting: Meeting,
}

/// How the circle meets the check surface where the motion ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Meeting {
    /// It crosses it for this time, from 1.
    Crossing(usize),
    /// It touches it.
    Touch,
}

impl Driven {
    /// Where the motion from `start` ends that turns about the axis of the circle by the right hand; `slack` is how far a place of
    /// the circle may be off it.
    pub(super) fn end(&self, circle: &SpaceCircle, start: &Vec3, slack: f64) -> Vec3 {
        let Some(from) = self.line_from else { return self.named };
        let along = self.named - from;
        let in_plane = along - circle.axis * circle.axis.dot(&along);
        let squared = in_plane.norm_squared();
        let on_circle = circle.deviation(&self.named).abs() <= slack;
        if squared == 0.0 || on_circle && self.meeting != Meeting::Touch {
            return self.named;
        }
        // The place of the line that is nearest to the axis.
        let nearest = from - along * (in_plane.dot(&circle.in_plane(&from)) / squared);
        let Meeting::Crossing(time) = self.meeting else { return nearest };
        let half = circle.radius.powi(2) - circle.in_plane(&nearest).norm_squared();
        if half < 0.0 {
            return self.named;
        }
        let same = circle.radius * SAME_POINT_FRACTION;
        let reach = along * (half / squared).sqrt();
        let mut crossings = [nearest - reach, nearest + reach];
        crossings.sort_by(|a, b| {
            circle.positive_sweep(start, a, same).total_cmp(&circle.positive_sweep(start, b, same))
        });
        time.checked_sub(1).and_then(|index| crossings.get(index)).copied().unwrap_or(self.named)
    }
}

/// What a statement of this form says; `None` for any other.
pub(super) fn driven(text: &str) -> Option<Driven> {
    if !text.contains('(') {
        return None;
    }
    let compact: String =
        text.chars().filter(|c| !c.is_whitespace()).collect::<String>().to_ascii_uppercase();
    let rest = compact.strip_prefix("TLON,").unwrap_or(&compact).strip_prefix("GOFWD/")?;
    let (drive, rest) = parenthesised(rest)?;
    let (rest, meeting) = match rest.strip_prefix(",TANTO,") {
        Some(rest) => (rest, Meeting::Touch),
        None => crossing(rest.strip_prefix(",ON,")?),
    };
    let (check, rest) = parenthesised(rest)?;
    if !rest.is_empty() {
        return None;
    }
    let (center, axis, radius) = drive_surface(drive)?;
    let (line_from, named) = check_surface(check)?;
    if meeting == Meeting::Touch && line_from.is_none() {
        return None;
    }
    Some(Driven { center, axis, radius, named, line_from, meeting })
}

/// `n,INTOF,` before the check surface, if it is there.
fn crossing(text: &str) -> (&str, Meeting) {
    match text.split_once(",INTOF,").and_then(|(count, check)| Some((count.parse().ok()?, check))) {
        Some((count, check)) => (check, Meeting::Crossing(count)),
        None => (text, Meeting::Crossing(1)),
    }
}

/// What stands in the parentheses at the beginning, and what behind them.
fn parenthesised(text: &str) -> Option<(&str, &str)> {
    let mut depth = 0_usize;
    for (at, byte) in text.bytes().enumerate() {
        match byte {
            b'(' => depth += 1,
            b')' => depth = depth.checked_sub(1)?,
            _ => {}
        }
        match depth {
            0 if at == 0 => return None,
            0 => return Some((&text[1..at], &text[at + 1..])),
            _ => {}
        }
    }
    None
}

fn drive_surface(text: &str) -> Option<(Vec3, Vec3, f64)> {
    let (kind, list) = text.split_once('/')?;
    let numbers: Vec<f64> = list.split(',').map(number).collect::<Option<_>>()?;
    match (kind, &numbers[..]) {
        ("CIRCLE", &[x, y, z, radius]) => Some((Vec3::new(x, y, z), Vec3::z(), radius)),
        ("CYLNDR", &[x, y, z, i, j, k, radius]) => Some((Vec3::new(x, y, z), Vec3::new(i, j, k), radius)),
        _ => None,
    }
}

/// The places of a line through two, or the last place of a plane through them.
fn check_surface(text: &str) -> Option<(Option<Vec3>, Vec3)> {
    let known = ["LINE/", "PLANE/PERPTO,"].iter().any(|start| text.starts_with(start));
    let inner = text.trim_end_matches(')');
    let list = inner.rsplit('/').next().filter(|_| known)?;
    let numbers: Vec<f64> = list.split(',').map(number).collect::<Option<_>>()?;
    match numbers[..] {
        [u, v, w, x, y, z] if text.starts_with("LINE/") => {
            Some((Some(Vec3::new(u, v, w)), Vec3::new(x, y, z)))
        }
        [x, y, z] if text.starts_with("PLANE/") => Some((None, Vec3::new(x, y, z))),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn circles_and_cylinders() {
        let flat =
            "TLON,GOFWD/ (CIRCLE/ 10.0, 60.0, -5.0, 20.0),ON,(LINE/ 10.0, 60.0, -5.0, 10.0, 80.0, -5.0)";
        let (center, named) = (Vec3::new(10.0, 60.0, -5.0), Vec3::new(10.0, 80.0, -5.0));
        let (line_from, meeting) = (Some(center), Meeting::Crossing(1));
        let wanted = Driven { center, axis: Vec3::z(), radius: 20.0, named, line_from, meeting };
        assert_eq!(driven(flat), Some(wanted));
        let second = Driven { meeting: Meeting::Crossing(2), ..wanted };
        assert_eq!(driven(&flat.replace("ON,(LINE", "ON,2,INTOF,(LINE")), Some(second));
        let touch = Driven { meeting: Meeting::Touch, ..wanted };
        assert_eq!(driven(&flat.replace("ON,(LINE", "TANTO,(LINE")), Some(touch));
        let tilted = "GOFWD/(CYLNDR/0,0,37,1,0,0,50),ON,(PLANE/PERPTO,(PLANE/(POINT/0,0,37),PERPTO,(VECTOR/1,0,0)),(POINT/0,0,37),(POINT/0,50,37))";
        let wanted = Driven {
            center: Vec3::new(0.0, 0.0, 37.0),
            axis: Vec3::x(),
            radius: 50.0,
            named: Vec3::new(0.0, 50.0, 37.0),
            line_from: None,
            meeting: Meeting::Crossing(1),
        };
        assert_eq!(driven(tilted), Some(wanted));
        for other in
            ["GOFWD/C1", "GOFWD/(CIRCLE/0,0,1),ON,(LINE/0,0,0,1)", "GOFWD/(CIRCLE/0,0,0,1", "(", ")("]
        {
            assert_eq!(driven(other), None, "{other}");
        }
    }
}
