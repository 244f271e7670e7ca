//! Which CL dialect a text is written in.

use std::str::FromStr;

use serde::{Deserialize, Serialize};

use super::dialects::{Deep, Form};

/// Dialects of CL files, and what is not CL text.
///
/// [`ClDialect::ALL`] is the one table of those that are read and written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ClDialect {
    /// CATIA APT source.
    Catia,
    /// Siemens NX CLSF.
    Nx,
    /// Creo, Pro/ENGINEER.
    Creo,
    /// NCL / PostWorks text.
    Ncl,
    /// Autodesk HSM "Common ISO 4343".
    Hsm,
    /// FROM, GOTO and post-processor words without a system's marks.
    Generic,
    /// The binary CLTAPE of APT III: no text.
    Cltape,
    /// Mastercam NCI: not APT.
    Nci,
    /// An APT part program: it defines geometry or moves along surfaces.
    PartProgram,
}

impl ClDialect {
    /// Whether CYCLE/DEEP lifts the drill a little between its steps, so that chips break; otherwise the drill is withdrawn
    /// from the hole. None where the system does not say.
    pub fn deep_breaks_chips(self) -> Option<bool> {
        Form::of(self).cycle.deep.map(|deep| deep == Deep::BreaksChips)
    }

    /// Those that are read and written, in the order in which they are shown.
    pub const ALL: [ClDialect; 7] = [
        ClDialect::Generic,
        ClDialect::Cltape,
        ClDialect::Catia,
        ClDialect::Creo,
        ClDialect::Hsm,
        ClDialect::Ncl,
        ClDialect::Nx,
    ];

    /// The name on the command line.
    pub fn as_str(self) -> &'static str {
        match self {
            ClDialect::Generic => "cl",
            ClDialect::Cltape => "cltape",
            ClDialect::Catia => "catia",
            ClDialect::Creo => "creo",
            ClDialect::Hsm => "hsm",
            ClDialect::Ncl => "ncl",
            ClDialect::Nx => "nx",
            ClDialect::Nci => "nci",
            ClDialect::PartProgram => "apt",
        }
    }

    /// What it is, for people.
    pub fn title(self) -> &'static str {
        match self {
            ClDialect::Generic => "APT CL text without the marks of a system",
            ClDialect::Cltape => "the binary CLTAPE of APT III",
            ClDialect::Catia => "CATIA APT source",
            ClDialect::Creo => "Creo and Pro/ENGINEER CL file",
            ClDialect::Hsm => "Autodesk HSM and Fusion, ISO 4343",
            ClDialect::Ncl => "NCL and PostWorks text",
            ClDialect::Nx => "Siemens NX CLSF",
            ClDialect::Nci => "Mastercam NCI",
            ClDialect::PartProgram => "APT part program",
        }
    }
}

/// A dialect that is not written, or not known at all.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("there is no CL dialect {name}; there are {}", known())]
pub struct UnknownClDialect {
    /// What was asked for.
    pub name: String,
}

fn known() -> String {
    ClDialect::ALL.map(ClDialect::as_str).join(", ")
}

impl FromStr for ClDialect {
    type Err = UnknownClDialect;

    fn from_str(name: &str) -> Result<Self, UnknownClDialect> {
        let named = |dialect: &ClDialect| dialect.as_str().eq_ignore_ascii_case(name.trim());
        ClDialect::ALL.into_iter().find(named).ok_or_else(|| UnknownClDialect { name: name.to_owned() })
    }
}

/// Non-blank lines that are looked at.
const LINES_READ: usize = 50;

/// Recognises the dialect from the first lines; `None` when nothing in them looks like CL data.
///
/// Some marks decide at once; otherwise the dialect with most marks wins, and a file with cutter locations but
/// without marks is generic.
pub fn detect(text: &str) -> Option<ClDialect> {
    let lines: Vec<&str> =
        text.lines().map(str::trim).filter(|line| !line.is_empty()).take(LINES_READ).collect();
    let upper: Vec<String> = lines.iter().map(|line| line.to_ascii_uppercase()).collect();
    if is_nci(&lines) {
        return Some(ClDialect::Nci);
    }
    let decisive = upper.iter().find_map(|line| decisive_mark(line));
    if decisive.is_some() {
        return decisive;
    }
    if upper.iter().any(|line| is_part_program_line(line)) {
        return Some(ClDialect::PartProgram);
    }
    let candidates = [ClDialect::Catia, ClDialect::Nx, ClDialect::Creo, ClDialect::Ncl, ClDialect::Hsm];
    let counted =
        candidates.map(|dialect| (dialect, upper.iter().filter(|line| mark(line, dialect)).count()));
    let best = counted.iter().fold(None, |best: Option<(ClDialect, usize)>, &(dialect, count)| match best {
        Some((_, most)) if most >= count => best,
        _ => (count > 0).then_some((dialect, count)).or(best),
    });
    if let Some((dialect, _)) = best {
        return Some(dialect);
    }
    let locations = upper.iter().any(|line| {
        let compact: String = line.chars().filter(|c| !c.is_whitespace()).collect();
        compact.starts_with("GOTO/") || compact.starts_with("FROM/") || compact.starts_with("GODLTA/")
    });
    locations.then_some(ClDialect::Generic)
}

/// The dialect whose sign the text of a remark is.
pub(crate) fn sign_of_remark(text: &str) -> Option<ClDialect> {
    let line = format!("$${text}").trim_end().to_ascii_uppercase();
    let candidates = [ClDialect::Catia, ClDialect::Creo];
    decisive_mark(&line).or_else(|| candidates.into_iter().find(|dialect| mark(&line, *dialect)))
}

/// Whether a remark is a line by which a dialect is recognised at once.
pub(crate) fn is_title(text: &str, dialect: ClDialect) -> bool {
    decisive_mark(&format!("$${text}").to_ascii_uppercase()) == Some(dialect)
}

fn decisive_mark(line: &str) -> Option<ClDialect> {
    let remark = line.strip_prefix("$$").map_or("", str::trim_start);
    if line.starts_with("$$*CATIA0") || remark.starts_with("CATIA APT VERSION") {
        Some(ClDialect::Catia)
    } else if line.starts_with("$$*") && line.contains("CLFILE") {
        Some(ClDialect::Creo)
    } else if line.starts_with("TOOL PATH/") || line.starts_with("END-OF-PATH") {
        Some(ClDialect::Nx)
    } else {
        None
    }
}

fn mark(line: &str, dialect: ClDialect) -> bool {
    match dialect {
        ClDialect::Catia => {
            line.starts_with("$$ OPERATION NAME")
                || line.starts_with("TPRINT/")
                || line.starts_with("GOTO  /")
        }
        ClDialect::Nx => ["TLDATA/", "MSYS/", "PAINT/"].iter().any(|start| line.starts_with(start)),
        ClDialect::Creo => line.starts_with("$$->"),
        ClDialect::Ncl => is_ncl_row(line),
        ClDialect::Hsm => {
            line.starts_with("MOVARC/") || line.starts_with("PARTNO/'") || line.starts_with("PPRINT/'")
        }
        ClDialect::Generic | ClDialect::Cltape | ClDialect::Nci | ClDialect::PartProgram => false,
    }
}

/// `N12   , WORD/...` or a continuation row `C12   , ...`.
fn is_ncl_row(line: &str) -> bool {
    let Some(rest) = line.strip_prefix(['N', 'C']) else { return false };
    let digits = rest.bytes().take_while(u8::is_ascii_digit).count();
    digits > 0 && rest[digits..].trim_start().starts_with(',')
}

/// NCI comes in pairs of lines, the first a bare whole number.
fn is_nci(lines: &[&str]) -> bool {
    let pairs = lines.chunks_exact(2);
    let code = |line: &str| !line.is_empty() && line.bytes().all(|byte| byte.is_ascii_digit());
    lines.len() >= 4 && pairs.len() >= 2 && pairs.clone().all(|pair| code(pair[0]))
}

fn is_part_program_line(line: &str) -> bool {
    const TYPES: [&str; 17] = [
        "POINT", "LINE", "CIRCLE", "PLANE", "VECTOR", "MATRIX", "SPHERE", "CYLNDR", "CONE", "QADRIC",
        "ELLIPS", "HYPERB", "GCONIC", "LCONIC", "TABCYL", "RLDSRF", "PATERN",
    ];
    const MOTION: [&str; 7] = ["GOLFT/", "GORGT/", "GOFWD/", "GOBACK/", "GOUP/", "GODOWN/", "GO/"];
    let compact: String = line.chars().filter(|c| !c.is_whitespace()).collect();
    if compact.starts_with("$$") {
        return false;
    }
    let defines = compact.split_once('=').is_some_and(|(name, body)| {
        !name.is_empty()
            && name.bytes().all(|byte| byte.is_ascii_alphanumeric() || matches!(byte, b'(' | b')'))
            && TYPES.iter().any(|kind| body.strip_prefix(kind).is_some_and(|rest| rest.starts_with('/')))
    });
    defines || MOTION.iter().any(|word| compact.starts_with(word)) || compact.contains("=MACRO")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dialects_by_their_marks() {
        let cases = [
            ("$$ x\n$$*CATIA0\nGOTO  /1,2,3\n", Some(ClDialect::Catia)),
            ("$$*         Pro/CLfile  Version\nGOTO / 1,2,3\n", Some(ClDialect::Creo)),
            ("TOOL PATH/MILL,TOOL,EM\nGOTO/1,2,3\n", Some(ClDialect::Nx)),
            ("N1     , PARTNO X\nN2   , GOTO/ 1.,2.,3.\n", Some(ClDialect::Ncl)),
            ("MACHIN/X\nPARTNO/'A'\nGOTO/1,2,3\n", Some(ClDialect::Hsm)),
            ("FROM / 0,0,0\nGOTO / 1,2,3\n", Some(ClDialect::Generic)),
            ("1050\n0 0 0\n1001\n1 2 3\n", Some(ClDialect::Nci)),
            ("PARTNO X\nP1=POINT/1,2,3\nGOTO/P1\n", Some(ClDialect::PartProgram)),
            ("PARTNO X\nGOLFT/L1,PAST,L2\n", Some(ClDialect::PartProgram)),
            ("hello\nworld\n", None),
            ("", None),
        ];
        for (text, dialect) in cases {
            assert_eq!(detect(text), dialect, "{text:?}");
        }
    }
}
