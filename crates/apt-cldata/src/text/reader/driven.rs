//! A circle that stands in a motion statement: the form in which CATIA, Creo (`APT_FORMAT`) and their kin write arcs.
//!
//! `TLON,GOFWD/(CIRCLE/c,r),ON,(LINE/c,e)` in a plane across z, and in any plane
//! `TLON,GOFWD/(CYLNDR/c,n,r),ON,(PLANE/PERPTO,(PLANE/(POINT/c),PERPTO,(VECTOR/n)),(POINT/c),(POINT/e))`. All data are in the statement, and
//! the last numbers of the check surface are the end `e`. `2,INTOF,` before the check surface says that it is met for the second time, which
//! follows from `e` as well.

use apt_geometry::Vec3;

use super::super::words::number;

/// A circle as drive surface, and the place where the motion ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Driven {
    pub(super) center: Vec3,
    /// As it is written, not yet of unit length.
    pub(super) axis: Vec3,
    pub(super) radius: f64,
    pub(super) end: Vec3,
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
    let rest = rest.strip_prefix(",ON,")?;
    let rest = match rest.split_once(",INTOF,") {
        Some((count, check)) if count.bytes().all(|byte| byte.is_ascii_digit()) => check,
        _ => rest,
    };
    let (check, rest) = parenthesised(rest)?;
    if !rest.is_empty() {
        return None;
    }
    let (center, axis, radius) = drive_surface(drive)?;
    Some(Driven { center, axis, radius, end: end(check)? })
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

/// The last three numbers of a line through two places, or of a plane through them.
fn end(text: &str) -> Option<Vec3> {
    let known = ["LINE/", "PLANE/PERPTO,"].iter().any(|start| text.starts_with(start));
    let inner = text.trim_end_matches(')');
    let list = inner.rsplit('/').next().filter(|_| known)?;
    let numbers: Vec<f64> = list.split(',').map(number).collect::<Option<_>>()?;
    match numbers[..] {
        [_, _, _, x, y, z] if text.starts_with("LINE/") => Some(Vec3::new(x, y, z)),
        [x, y, z] if text.starts_with("PLANE/") => Some(Vec3::new(x, y, z)),
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
        let (center, end) = (Vec3::new(10.0, 60.0, -5.0), Vec3::new(10.0, 80.0, -5.0));
        let wanted = Driven { center, axis: Vec3::z(), radius: 20.0, end };
        assert_eq!(driven(flat), Some(wanted));
        assert_eq!(driven(&flat.replace("ON,(LINE", "ON,2,INTOF,(LINE")), Some(wanted));
        let tilted = "GOFWD/(CYLNDR/0,0,37,1,0,0,50),ON,(PLANE/PERPTO,(PLANE/(POINT/0,0,37),PERPTO,(VECTOR/1,0,0)),(POINT/0,0,37),(POINT/0,50,37))";
        let wanted = Driven {
            center: Vec3::new(0.0, 0.0, 37.0),
            axis: Vec3::x(),
            radius: 50.0,
            end: Vec3::new(0.0, 50.0, 37.0),
        };
        assert_eq!(driven(tilted), Some(wanted));
        for other in
            ["GOFWD/C1", "GOFWD/(CIRCLE/0,0,1),ON,(LINE/0,0,0,1)", "GOFWD/(CIRCLE/0,0,0,1", "(", ")("]
        {
            assert_eq!(driven(other), None, "{other}");
        }
    }
}
