//! Number formats of word addresses. Rounding works on decimal digits: half goes away from zero, once.

use serde::{Deserialize, Serialize};

/// How a number is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Style {
    /// With a decimal point, no zeros that are not needed: `12.5`, `.5`, `100.`.
    Point,
    /// Whole numbers bare, a zero before the point: `12.5`, `0.5`, `100`.
    Plain,
    /// All decimals: `12.500`.
    Fixed,
    /// No point, leading zeros left out: `12.5` as `12500` with three decimals.
    LeadingZerosSuppressed,
    /// No point, padded on the left, trailing zeros left out: `12.5` as `0125`.
    TrailingZerosSuppressed,
    /// A whole number.
    Integer,
}

/// When a sign is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Sign {
    /// Only minus.
    #[default]
    Minus,
    /// Plus and minus, plus for zero.
    Always,
}

/// Format of the number of one register.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct NumberFormat {
    /// How it is written.
    pub style: Style,
    /// Digits before the point that the control takes.
    pub left: u8,
    /// Decimals.
    pub right: u8,
    /// Digits before the point that are written at least.
    pub least_left: u8,
    /// Sign.
    pub sign: Sign,
}

/// Most digits that are worked with: all those of a double that count.
const MOST_DIGITS: usize = 18;
/// Decimals beyond which a format is cut.
const MOST_DECIMALS: u8 = 12;

/// Why a number cannot be written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum FormatError {
    /// Not a finite number.
    #[error("not a finite number")]
    NotFinite,
    /// More digits before the point than the control takes.
    #[error("too many digits")]
    TooManyDigits,
}

impl NumberFormat {
    /// The number in units of its last decimal.
    ///
    /// # Errors
    /// A number that is not finite or has too many digits.
    pub fn scaled(&self, value: f64) -> Result<i64, FormatError> {
        let right = self.decimals();
        let units = round_decimal(value, right)?;
        let limit =
            10_i64.checked_pow(u32::from(self.left) + u32::from(right)).ok_or(FormatError::TooManyDigits)?;
        if units.abs() >= limit { Err(FormatError::TooManyDigits) } else { Ok(units) }
    }

    /// The value that the control reads.
    ///
    /// # Errors
    /// As [`Self::scaled`].
    pub fn rounded(&self, value: f64) -> Result<f64, FormatError> {
        let units = self.scaled(value)?;
        Ok(units as f64 / 10_f64.powi(i32::from(self.decimals())))
    }

    /// The size of the last decimal.
    pub fn resolution(&self) -> f64 {
        10_f64.powi(-i32::from(self.decimals()))
    }

    /// The largest number that can be written.
    pub fn greatest(&self) -> f64 {
        10_f64.powi(i32::from(self.left)) - self.resolution()
    }

    /// The number as text, without address.
    ///
    /// # Errors
    /// As [`Self::scaled`].
    pub fn text(&self, value: f64) -> Result<String, FormatError> {
        let units = self.scaled(value)?;
        let right = usize::from(self.decimals());
        let digits = format!("{:0>width$}", units.unsigned_abs(), width = right + 1);
        let (whole, part) = digits.split_at(digits.len() - right);
        let whole = whole.trim_start_matches('0');
        let least = usize::from(self.least_left);
        let body = match self.style {
            Style::Point | Style::Plain => {
                let part = part.trim_end_matches('0');
                let plain = self.style == Style::Plain;
                let least = if plain || part.is_empty() { least.max(1) } else { least };
                let point = if plain && part.is_empty() { "" } else { "." };
                format!("{whole:0>least$}{point}{part}")
            }
            Style::Fixed => format!("{whole:0>least$}.{part}", least = least.max(1)),
            Style::LeadingZerosSuppressed => {
                let all = format!("{whole}{part}");
                let bare = all.trim_start_matches('0');
                format!("{bare:0>least$}", least = least.max(1))
            }
            Style::TrailingZerosSuppressed => {
                let all = format!("{whole:0>left$}{part}", left = usize::from(self.left));
                let bare = all.trim_end_matches('0');
                if bare.is_empty() { "0".to_owned() } else { bare.to_owned() }
            }
            Style::Integer => format!("{whole:0>least$}", least = least.max(1)),
        };
        let sign = match (units < 0, self.sign) {
            (true, _) => "-",
            (false, Sign::Always) => "+",
            (false, Sign::Minus) => "",
        };
        Ok(format!("{sign}{body}"))
    }

    fn decimals(&self) -> u8 {
        if self.style == Style::Integer { 0 } else { self.right.min(MOST_DECIMALS) }
    }
}

/// Rounds the shortest decimal notation of a number to `decimals` places, half away from zero, in units of the last.
fn round_decimal(value: f64, decimals: u8) -> Result<i64, FormatError> {
    if !value.is_finite() {
        return Err(FormatError::NotFinite);
    }
    let text = format!("{:e}", value.abs());
    let (mantissa, exponent) = text.split_once('e').ok_or(FormatError::NotFinite)?;
    let exponent: i32 = exponent.parse().map_err(|_| FormatError::NotFinite)?;
    let digits: Vec<u8> = mantissa.bytes().filter(u8::is_ascii_digit).map(|byte| byte - b'0').collect();
    // The first digit stands for 10^exponent; this many digits belong to the whole units.
    let kept = exponent + 1 + i32::from(decimals);
    if kept > MOST_DIGITS as i32 {
        return if value == 0.0 { Ok(0) } else { Err(FormatError::TooManyDigits) };
    }
    if kept < 0 {
        return Ok(0);
    }
    let kept = kept as usize;
    let mut units: i64 = 0;
    for at in 0..kept {
        units = units * 10 + i64::from(digits.get(at).copied().unwrap_or(0));
    }
    if digits.get(kept).is_some_and(|next| *next >= 5) {
        units += 1;
    }
    Ok(if value < 0.0 { -units } else { units })
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn format(style: Style, left: u8, right: u8) -> NumberFormat {
        NumberFormat { style, left, right, least_left: 0, sign: Sign::Minus }
    }

    #[test]
    fn table_of_number_rules() {
        let values = [12.5, 0.5, -0.05, 100.0, 0.0];
        let rows: [(NumberFormat, [&str; 5]); 6] = [
            (format(Style::Point, 5, 3), ["12.5", ".5", "-.05", "100.", "0."]),
            (format(Style::Plain, 5, 3), ["12.5", "0.5", "-0.05", "100", "0"]),
            (format(Style::Fixed, 5, 3), ["12.500", "0.500", "-0.050", "100.000", "0.000"]),
            (format(Style::LeadingZerosSuppressed, 3, 4), ["125000", "5000", "-500", "1000000", "0"]),
            (format(Style::TrailingZerosSuppressed, 3, 4), ["0125", "0005", "-00005", "1", "0"]),
            (format(Style::Integer, 5, 0), ["13", "1", "0", "100", "0"]),
        ];
        for (format, texts) in rows {
            for (value, text) in values.iter().zip(texts) {
                assert_eq!(format.text(*value).unwrap(), text, "{value} as {:?}", format.style);
            }
        }
    }

    #[test]
    fn half_goes_away_from_zero_and_never_to_minus_zero() {
        let three = format(Style::Point, 5, 3);
        for (value, text) in [
            (1.0005, "1.001"),
            (-1.0005, "-1.001"),
            (18.8026, "18.803"),
            (0.0004999, "0."),
            (-0.0004, "0."),
            (0.0005, ".001"),
            (9.9995, "10."),
            (1e-300, "0."),
        ] {
            assert_eq!(three.text(value).unwrap(), text, "{value}");
        }
    }

    #[test]
    fn limits_are_errors() {
        let small = format(Style::Point, 3, 3);
        assert_eq!(small.text(999.9994).unwrap(), "999.999");
        assert_eq!(small.text(999.9996), Err(FormatError::TooManyDigits));
        assert_eq!(small.text(1e300), Err(FormatError::TooManyDigits));
        assert_eq!(small.text(f64::NAN), Err(FormatError::NotFinite));
        let signed = NumberFormat { sign: Sign::Always, ..format(Style::Fixed, 4, 3) };
        assert_eq!(signed.text(12.5).unwrap(), "+12.500");
        assert_eq!(signed.text(-0.0).unwrap(), "+0.000");
    }

    proptest! {
        #[test]
        fn written_numbers_read_back_within_half_a_unit(value in -9999.0..9999.0_f64, right in 0_u8..7) {
            for style in [Style::Point, Style::Plain, Style::Fixed] {
                let format = format(style, 5, right);
                let text = format.text(value).unwrap();
                let read: f64 = text.parse().unwrap();
                prop_assert!((read - value).abs() <= format.resolution() * (0.5 + 1e-9), "{text}");
                prop_assert_eq!(read, format.rounded(value).unwrap());
                prop_assert!(!(read == 0.0 && text.starts_with('-')));
            }
        }
    }
}
