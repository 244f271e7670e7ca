//! From the numbers of a CUTTER statement to a checked cutter.

use super::{Cutter, Profile};

/// Default height of the one- and two-number forms, inches.
const DEFAULT_HEIGHT_INCHES: f64 = 5.0;
/// Tangency of the corner arc is accepted within this length, inches (APT III: e and f must be given accurately).
const TANGENCY_INCHES: f64 = 1e-5;

/// Why numbers are no cutter; lengths in program units, angles in degrees as given.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the fields repeat the parameters of the statement")]
pub enum CutterError {
    #[error("CUTTER takes 1, 2 or 7 numbers, not {found}")]
    Count { found: usize },
    #[error("parameter {position} is not finite")]
    NotFinite { position: usize },
    #[error("negative diameter {diameter}")]
    Diameter { diameter: f64 },
    #[error("negative height {height}")]
    Height { height: f64 },
    #[error("angles {alpha} and {beta} sum to a right angle or more")]
    Angles { alpha: f64, beta: f64 },
    #[error("negative lower angle {alpha}")]
    Alpha { alpha: f64 },
    #[error("height {height} below the lower line's end at {least}")]
    HeightBelowLine { height: f64, least: f64 },
    #[error("negative upper angle {beta}")]
    Beta { beta: f64 },
    #[error("negative corner radius {radius}")]
    CornerRadius { radius: f64 },
    #[error("corner centre at height {height}, below {least}")]
    CornerBelowLine { height: f64, least: f64 },
    #[error("corner arc inconsistent with the tip")]
    ArcAtTip { along: f64 },
    #[error(
        "corner arc misses the lower line: distance {distance}, radius {radius}, meets at {along} of {length}"
    )]
    ArcMissesLowerLine { distance: f64, radius: f64, along: f64, length: f64 },
    #[error("corner arc misses the upper line: distance {distance}, radius {radius}, meets at {along}")]
    ArcMissesUpperLine { distance: f64, radius: f64, along: f64 },
    #[error("corner arc inconsistent with the top: reaches {reached} of {height}")]
    ArcAtTop { reached: f64, height: f64 },
    #[error("corner centre {distance} from the corner, nearer than the radius {radius}")]
    CornerTooNear { distance: f64, radius: f64 },
}

impl CutterError {
    /// The APT III diagnostic number.
    pub fn apt3(&self) -> Option<u16> {
        Some(match self {
            Self::Count { .. } => 129,
            Self::NotFinite { .. } => return None,
            Self::Diameter { .. } => 401,
            Self::Height { .. } => 402,
            Self::Angles { .. } => 403,
            Self::Alpha { .. } => 404,
            Self::HeightBelowLine { .. } => 405,
            Self::Beta { .. } => 406,
            Self::CornerRadius { .. } => 407,
            Self::CornerBelowLine { .. } => 408,
            Self::ArcAtTip { .. } => 409,
            Self::ArcMissesLowerLine { .. } => 410,
            Self::ArcMissesUpperLine { .. } => 411,
            Self::ArcAtTop { .. } => 412,
            Self::CornerTooNear { .. } => 417,
        })
    }
}

/// Doubtful but usable numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum CutterWarning {
    /// The corner arc itself reaches the tool axis instead of the lower line (APT III 415).
    ArcReachesAxis,
    /// The corner arc itself reaches the top instead of the upper line (APT III 416).
    ArcReachesTop,
}

impl CutterWarning {
    /// The APT III diagnostic number.
    pub fn apt3(&self) -> Option<u16> {
        Some(match self {
            Self::ArcReachesAxis => 415,
            Self::ArcReachesTop => 416,
        })
    }
}

impl Cutter {
    /// The cutter of a CUTTER statement: one, two or seven numbers, angles in degrees. `units_per_inch` scales the
    /// default height and the tangency tolerance (1 for inches, 25.4 for millimetres).
    ///
    /// # Errors
    /// [`CutterError`] with the APT III numbers 401 to 417.
    pub fn from_numbers(numbers: &[f64], units_per_inch: f64) -> Result<Self, CutterError> {
        Self::with_warnings(numbers, units_per_inch).map(|(cutter, _)| cutter)
    }

    /// As [`Cutter::from_numbers`], with what is doubtful about the numbers.
    ///
    /// # Errors
    /// As [`Cutter::from_numbers`].
    pub fn with_warnings(
        numbers: &[f64],
        units_per_inch: f64,
    ) -> Result<(Self, Vec<CutterWarning>), CutterError> {
        if let Some(position) = numbers.iter().position(|n| !n.is_finite()) {
            return Err(CutterError::NotFinite { position });
        }
        let default_height = DEFAULT_HEIGHT_INCHES * units_per_inch;
        match *numbers {
            [d] => plain(d, 0.0, default_height),
            [d, r] => plain(d, r, default_height),
            [d, r, e, f, alpha, beta, h] => {
                let h = if h == 0.0 { default_height.max(r) } else { h };
                let plain_corner = e == 0.0 && f == 0.0 && alpha == 0.0 && beta == 0.0;
                let (e, f) = if plain_corner { (0.5 * d - r, r) } else { (e, f) };
                let cutter = Self {
                    diameter: d,
                    corner_radius: r,
                    corner_offset: e,
                    corner_height: f,
                    alpha: alpha.to_radians(),
                    beta: beta.to_radians(),
                    height: h,
                };
                check(&cutter, alpha, beta, TANGENCY_INCHES * units_per_inch)
            }
            _ => Err(CutterError::Count { found: numbers.len() }),
        }
    }
}

/// The forms with one and two numbers: a flat or bull-nosed end mill, a ball when `r = d/2`.
fn plain(
    diameter: f64,
    corner_radius: f64,
    default_height: f64,
) -> Result<(Cutter, Vec<CutterWarning>), CutterError> {
    if diameter < 0.0 {
        return Err(CutterError::Diameter { diameter });
    }
    if corner_radius < 0.0 {
        return Err(CutterError::CornerRadius { radius: corner_radius });
    }
    let radius = 0.5 * diameter;
    if corner_radius > radius * (1.0 + 1e-9) {
        return Err(CutterError::CornerTooNear { distance: radius, radius: corner_radius });
    }
    let cutter = Cutter {
        diameter,
        corner_radius,
        corner_offset: (radius - corner_radius).max(0.0),
        corner_height: corner_radius,
        alpha: 0.0,
        beta: 0.0,
        height: default_height.max(corner_radius),
    };
    Ok((cutter, Vec::new()))
}

fn check(
    cutter: &Cutter,
    alpha: f64,
    beta: f64,
    tangency: f64,
) -> Result<(Cutter, Vec<CutterWarning>), CutterError> {
    let Cutter { diameter, corner_radius: r, corner_offset: e, corner_height: f, height, .. } = *cutter;
    if diameter < 0.0 {
        return Err(CutterError::Diameter { diameter });
    }
    if height < 0.0 {
        return Err(CutterError::Height { height });
    }
    if alpha + beta >= 90.0 || alpha >= 90.0 || beta >= 90.0 {
        return Err(CutterError::Angles { alpha, beta });
    }
    if alpha < 0.0 {
        return Err(CutterError::Alpha { alpha });
    }
    let knee = cutter.knee_height();
    if height + tangency < knee {
        return Err(CutterError::HeightBelowLine { height, least: knee });
    }
    if beta < 0.0 {
        return Err(CutterError::Beta { beta });
    }
    if r < 0.0 {
        return Err(CutterError::CornerRadius { radius: r });
    }
    if r > 0.0 {
        check_corner(cutter, tangency).map(|warnings| (*cutter, warnings))
    } else if e + f > tangency && (e - cutter.radius()).hypot(f - knee) > tangency.max(1e-9 * diameter) {
        // Without a radius the "corner" is the knee itself; anything else contradicts the two lines.
        Err(CutterError::CornerTooNear { distance: (e - cutter.radius()).hypot(f - knee), radius: r })
    } else {
        Ok((*cutter, Vec::new()))
    }
}

/// The corner arc against both lines (APT III 408 to 417).
fn check_corner(cutter: &Cutter, tangency: f64) -> Result<Vec<CutterWarning>, CutterError> {
    let Cutter { corner_radius: r, corner_offset: e, corner_height: f, height, .. } = *cutter;
    let knee = cutter.knee_height();
    if f < knee - tangency {
        return Err(CutterError::CornerBelowLine { height: f, least: knee });
    }
    let lines = Profile::corner_lines(cutter);
    let length = cutter.radius() / cutter.alpha.cos();
    if lines.lower_distance > r + tangency || lines.lower_along > length + tangency {
        return Err(CutterError::ArcMissesLowerLine {
            distance: lines.lower_distance,
            radius: r,
            along: lines.lower_along,
            length,
        });
    }
    let mut warnings = Vec::new();
    if lines.lower_along < -tangency {
        if e > tangency {
            return Err(CutterError::ArcAtTip { along: lines.lower_along });
        }
        warnings.push(CutterWarning::ArcReachesAxis);
    }
    if lines.upper_distance > r + tangency || lines.upper_along < -tangency {
        return Err(CutterError::ArcMissesUpperLine {
            distance: lines.upper_distance,
            radius: r,
            along: lines.upper_along,
        });
    }
    let reached = knee + lines.upper_along * cutter.beta.cos();
    if reached > height + tangency {
        if f > height + tangency {
            return Err(CutterError::ArcAtTop { reached, height });
        }
        warnings.push(CutterWarning::ArcReachesTop);
    }
    let distance = (e - cutter.radius()).hypot(f - knee);
    if e + f > 0.0 && distance < r - tangency && e < cutter.radius() - tangency {
        return Err(CutterError::CornerTooNear { distance, radius: r });
    }
    Ok(warnings)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn every_invalid_number_has_its_apt3_diagnostic() {
        let table: &[(&[f64], u16)] = &[
            (&[-1.0], 401),
            (&[1.0, 0.0, 0.0, 0.0, 0.0, 0.0, -2.0], 402),
            (&[1.0, 0.0, 0.0, 0.0, 60.0, 30.0, 2.0], 403),
            (&[1.0, 0.0, 0.0, 0.0, -5.0, 0.0, 2.0], 404),
            (&[1.0, 0.0, 0.5, 0.1, 45.0, 0.0, 0.2], 405),
            (&[1.0, 0.0, 0.0, 0.0, 0.0, -5.0, 2.0], 406),
            (&[1.0, -0.1], 407),
            (&[1.0, 0.1, 0.4, 0.05, 30.0, 0.0, 2.0], 408),
            (&[0.5, 0.1, 0.4, 0.1, 0.0, 10.0, 3.0], 410),
            (&[1.0, 0.1, 0.1, 0.1, 0.0, 0.0, 3.0], 411),
            (&[2.0, 1.2, 0.5, 1.15, 0.0, 0.0, 0.05], 412),
            (&[1.0, 0.6], 417),
        ];
        for (numbers, expected) in table {
            let error = Cutter::from_numbers(numbers, 1.0).expect_err("invalid");
            assert_eq!(error.apt3(), Some(*expected), "{numbers:?}: {error}");
        }
    }

    #[test]
    fn legal_shapes_are_accepted_without_warning() {
        let table: &[&[f64]] = &[
            &[0.0],
            &[0.5],
            &[1.0, 0.5],
            &[1.0, 0.1875, 0.33, 0.22, 10.0, 5.0, 2.0],
            &[1.0, 0.1, 0.4, 0.210707, 15.0, 0.0, 3.0],
            &[1.0, 0.2, 0.3, 0.2, 0.0, 0.0, 4.0],
            &[1.0, 0.2, 0.0, 0.0, 0.0, 0.0, 0.0],
        ];
        for numbers in table {
            let (_, warnings) = Cutter::with_warnings(numbers, 1.0).expect("legal");
            assert!(warnings.is_empty(), "{numbers:?}: {warnings:?}");
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(256))]
        /// Of a corner in front of the axis the arc ends there, too; one above the lower line and inside the upper line that
        /// is no higher than the top ends below it: 408, 410 and 411 come first.
        #[test]
        fn arcs_never_end_behind_the_axis_nor_above_the_top(
            d in 0.0f64..3.0, r in 0.001f64..2.0, e in -1.0f64..3.0, f in 0.0f64..3.0,
            alpha in 0.0f64..60.0, beta in 0.0f64..60.0, h in 0.01f64..5.0,
        ) {
            match Cutter::with_warnings(&[d, r, e, f, alpha, beta, h], 1.0) {
                Ok((_, warnings)) => prop_assert!(!warnings.contains(&CutterWarning::ArcReachesTop)),
                Err(error) => prop_assert!(!matches!(error.apt3(), Some(409 | 413 | 414 | 416)), "{error}"),
            }
        }
    }

    #[test]
    fn default_height_scales_with_the_unit() {
        assert_eq!(Cutter::from_numbers(&[10.0], 25.4).expect("legal").height, 127.0);
        assert_eq!(Cutter::from_numbers(&[14.0, 6.0], 1.0).expect("legal").height, 6.0);
    }
}
