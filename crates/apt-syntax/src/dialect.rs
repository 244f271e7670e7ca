//! Dialects, as data.

/// A named dialect.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum DialectName {
    /// APT III meaning without column limits (unless the file carries sequence fields).
    #[default]
    Free,
    /// Strict cards of APT III: columns 1-72, sequence field 73-80, names of six characters.
    Apt3,
    /// The APT4 dialect (language reference 10.4).
    Apt4,
    /// CL files written by CAM systems.
    Cl,
}
