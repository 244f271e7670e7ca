//! Numbers as they stand in CL text.

/// Longest fixed notation; longer numbers are written with an exponent.
const LONGEST_FIXED: usize = 24;
/// Smaller numbers are written with an exponent as well: their zeros would hide them.
const SMALLEST_FIXED: f64 = 1e-6;

/// How a system lays out the numbers of one kind. The digits are always as many as it takes to read the same bits back; what differs is
/// how many decimals stand there at least, and where.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Field {
    /// Decimals that are written at least.
    pub(crate) decimals: usize,
    /// Columns that are taken at least; shorter numbers stand to the right.
    pub(crate) width: usize,
    /// Whether blanks stand for the zeros that only fill up the decimals.
    pub(crate) blank_zeros: bool,
}

impl Field {
    /// Decimals that are filled up with zeros.
    pub(crate) const fn decimals(decimals: usize) -> Self {
        Field { decimals, width: 0, blank_zeros: false }
    }

    /// The same in columns.
    pub(crate) const fn wide(self, width: usize) -> Self {
        Field { width, ..self }
    }

    /// The same with blanks for zeros.
    pub(crate) const fn blank(self) -> Self {
        Field { blank_zeros: true, ..self }
    }

    /// A number as APT reads it: always with a decimal point, never `-0.0`.
    pub(crate) fn text(self, value: f64) -> String {
        let plain = shortest(value);
        let text = match plain.split_once('.') {
            Some((whole, fraction)) if !fraction.contains('E') => {
                let digits = if fraction == "0" { "" } else { fraction };
                let fill = self.decimals.saturating_sub(digits.len());
                format!("{whole}.{digits}{}", if self.blank_zeros { " " } else { "0" }.repeat(fill))
            }
            _ => plain,
        };
        let width = self.width;
        format!("{text:>width$}")
    }
}

/// The shortest text that reads back to the same bits, with a decimal point (an exponent needs one), never `-0.0`.
pub(crate) fn shortest(value: f64) -> String {
    // Adding zero takes the sign off a zero.
    let value = value + 0.0;
    if value == 0.0 || value.abs() >= SMALLEST_FIXED {
        let fixed = format!("{value}");
        let fixed = if fixed.contains('.') || !value.is_finite() { fixed } else { format!("{fixed}.0") };
        if fixed.len() <= LONGEST_FIXED {
            return fixed;
        }
    }
    let scientific = format!("{value:E}");
    match scientific.split_once('E') {
        Some((mantissa, exponent)) if !mantissa.contains('.') => format!("{mantissa}.0E{exponent}"),
        _ => scientific,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_carry_a_point_and_no_negative_zero() {
        let cases = [
            (1.0, "1.0"),
            (-0.0, "0.0"),
            (0.1, "0.1"),
            (-12.5, "-12.5"),
            (1e-17, "1.0E-17"),
            (1.5e300, "1.5E300"),
            (3.313708498984761, "3.313708498984761"),
        ];
        for (value, text) in cases {
            assert_eq!(shortest(value), text, "{value}");
        }
    }

    #[test]
    fn fields_fill_up_and_never_cut_off() {
        let catia = Field::decimals(5).wide(11);
        assert_eq!(catia.text(-12.0), "  -12.00000");
        assert_eq!(catia.text(1.0 / 3.0), "0.3333333333333333");
        assert_eq!(catia.text(1e-9), "     1.0E-9");
        let rows = Field::decimals(8).wide(14).blank();
        assert_eq!(rows.text(0.0), "    0.        ");
        assert_eq!(rows.text(-1.5), "   -1.5       ");
        assert_eq!(Field::decimals(0).text(3600.0), "3600.");
        assert_eq!(Field::decimals(1).text(3600.0), "3600.0");
    }
}
