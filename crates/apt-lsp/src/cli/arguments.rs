//! What can be typed.

use std::path::PathBuf;

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{Args, Parser, Subcommand, ValueEnum};

use crate::analysis::ClDialect;

/// Language server, motion engine and checks for APT part programs.
///
/// Without a command and without --check it is a language server on standard input and output.
#[derive(Debug, Parser)]
#[command(name = "apt-lsp", version, about, long_about)]
pub(super) struct Arguments {
    /// Language server on standard input and output (as without arguments)
    #[arg(long, conflicts_with = "check")]
    pub stdio: bool,
    /// Process id of the editor; some editors pass it, the server gets it in the protocol
    #[arg(long = "clientProcessId", hide = true)]
    pub client_process_id: Option<u32>,
    /// Diagnostics of files and folders (as the command `check`)
    #[arg(long, requires = "paths")]
    pub check: bool,
    /// What --check looks at: files and folders; `-` is standard input
    #[arg(value_name = "PATH", requires = "check")]
    pub paths: Vec<PathBuf>,
    #[command(flatten)]
    pub check_options: CheckOptions,
    /// When to colour
    #[arg(long, value_enum, default_value_t = Color::Auto, global = true, value_name = "WHEN")]
    pub color: Color,
    #[command(subcommand)]
    pub command: Option<Command>,
}

/// When to colour.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Color {
    /// On a terminal, unless NO_COLOR is set
    Auto,
    /// Always
    Always,
    /// Never
    Never,
}

/// The calls.
#[derive(Debug, Subcommand)]
pub(super) enum Command {
    /// Diagnostics of files and folders
    Check(CheckCall),
    /// Run a program: statements, canonical forms, CL points, totals
    Run(RunCall),
    /// Make the control tape of a program
    Post(PostCall),
    /// A program with macros and loops unrolled, each line with its origin
    Expand(ExpandCall),
    /// Give programs the style of their project
    Fmt(FmtCall),
    /// The path as a stand-alone page or picture
    View(ViewCall),
    /// Where the paths of two programs or CL files differ
    Diff(DiffCall),
    /// The cutter locations of a program or CL file in another CL dialect
    Convert(ConvertCall),
    /// What a diagnostic means, with a wrong and a right sample
    Explain(ExplainCall),
    /// The syntax tree of a program
    Tree(ProgramArgument),
    /// The machines that a tape can be made for
    Machines(MachinesCall),
}

/// Machines.
#[derive(Debug, Args)]
pub(super) struct MachinesCall {
    /// Print the definition of this one, to make another one of it
    #[arg(value_name = "NAME")]
    pub name: Option<String>,
}

/// A program and how to read it.
#[derive(Debug, Args)]
pub(super) struct ProgramArgument {
    /// The program; `-` is standard input
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    #[command(flatten)]
    pub reading: ReadingOptions,
}

/// Settings that can be typed, for every call that reads a program.
#[derive(Debug, Clone, Args)]
pub(super) struct ReadingOptions {
    /// Dialect: free, apt3, apt4, cl … (default: project file, first line, detection)
    #[arg(long, value_name = "NAME")]
    pub dialect: Option<String>,
    /// How grave a diagnostic is: off, hint, information, warning or error (repeatable)
    #[arg(long = "severity", value_name = "CODE=SEVERITY", value_parser = SeverityOption::parse)]
    pub severities: Vec<SeverityOption>,
}

/// The severity of one diagnostic.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct SeverityOption {
    /// The code, APTnnnn.
    pub code: String,
    /// What the setting `severity` takes.
    pub severity: String,
}

impl SeverityOption {
    fn parse(text: &str) -> Result<Self, String> {
        match text.split_once('=') {
            Some((code, severity)) if !code.is_empty() && !severity.is_empty() => {
                Ok(Self { code: code.to_ascii_uppercase(), severity: severity.to_ascii_lowercase() })
            }
            _ => Err("not CODE=SEVERITY, for example APT0951=off".to_owned()),
        }
    }
}

/// How findings are told by `check`.
#[derive(Debug, Clone, Args)]
pub(super) struct CheckOptions {
    #[command(flatten)]
    pub reading: ReadingOptions,
    /// How to tell the findings
    #[arg(long, value_enum, default_value_t = CheckFormat::Human)]
    pub format: CheckFormat,
    /// Leave out motion: syntax, names and geometry only
    #[arg(long)]
    pub no_motion: bool,
    /// Warnings count as findings in the exit code
    #[arg(long)]
    pub deny_warnings: bool,
}

/// `check`.
#[derive(Debug, Args)]
pub(super) struct CheckCall {
    /// Files and folders; `-` is standard input
    #[arg(value_name = "PATH", required = true)]
    pub paths: Vec<PathBuf>,
    #[command(flatten)]
    pub options: CheckOptions,
}

/// Formats of findings.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum CheckFormat {
    /// With excerpts of the source, for people
    Human,
    /// JSON
    Json,
    /// SARIF 2.1.0
    Sarif,
    /// Annotations of GitHub workflows
    Github,
}

/// Formats of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum RunFormat {
    /// A listing for people
    Human,
    /// JSON
    Json,
    /// SARIF 2.1.0 (findings only)
    Sarif,
    /// Annotations of GitHub workflows (findings only)
    Github,
    /// CL text
    Cl,
    /// The binary CLTAPE of APT III
    Cltape,
}

/// `run`.
#[derive(Debug, Args)]
pub(super) struct RunCall {
    #[command(flatten)]
    pub program: ProgramArgument,
    /// What to print (default: by the name of OUT, else human)
    #[arg(long, value_enum)]
    pub format: Option<RunFormat>,
    /// Write to a file instead of standard output, which `-` is too
    #[arg(short, long, value_name = "OUT")]
    pub output: Option<PathBuf>,
    /// Tell how each motion was computed and why each cut vector ends where it does (human and JSON)
    #[arg(long)]
    pub explain_motion: bool,
    /// Warnings count as findings in the exit code
    #[arg(long)]
    pub deny_warnings: bool,
}

/// `post`.
#[derive(Debug, Args)]
pub(super) struct PostCall {
    /// The program; `-` is standard input
    #[arg(value_name = "FILE", required_unless_present = "list_machines")]
    pub file: Option<PathBuf>,
    #[command(flatten)]
    pub reading: ReadingOptions,
    /// The machine, or a definition file (.toml) of one (default: project file, then MACHIN of the program)
    #[arg(long, value_name = "NAME")]
    pub machine: Option<String>,
    /// Print the machines there are
    #[arg(long)]
    pub list_machines: bool,
    /// Write the image of the punched tape in this code instead of text
    #[arg(long, value_enum, value_name = "CODE")]
    pub punch: Option<Punch>,
    /// Warnings count as findings in the exit code
    #[arg(long)]
    pub deny_warnings: bool,
    /// Write to a file instead of standard output, which `-` is too
    #[arg(short, long, value_name = "OUT")]
    pub output: Option<PathBuf>,
}

/// Codes of punched tape.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Punch {
    /// EIA RS-244, odd parity
    Eia,
    /// ISO 840 (ASCII), even parity
    Iso,
}

/// `expand`.
#[derive(Debug, Args)]
pub(super) struct ExpandCall {
    #[command(flatten)]
    pub program: ProgramArgument,
    /// Only the macro call or loop at this line (from 1), and column (from 1)
    #[arg(long, value_name = "LINE[:COL]", value_parser = Place::parse)]
    pub at: Option<Place>,
    /// Levels of macros and loops to unroll (default: all)
    #[arg(long, value_name = "LEVELS")]
    pub depth: Option<u32>,
    /// Warnings count as findings in the exit code
    #[arg(long)]
    pub deny_warnings: bool,
}

/// A place as people count: from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Place {
    /// The line.
    pub line: u32,
    /// The column, in characters.
    pub column: u32,
}

impl Place {
    fn parse(text: &str) -> Result<Self, String> {
        let (line, column) = text.split_once(':').unwrap_or((text, "1"));
        match (line.parse(), column.parse()) {
            (Ok(line), Ok(column)) if line > 0 && column > 0 => Ok(Self { line, column }),
            _ => Err("not LINE or LINE:COL, both from 1".to_owned()),
        }
    }
}

/// `fmt`.
#[derive(Debug, Args)]
pub(super) struct FmtCall {
    /// Files and folders, formatted in place; `-` formats standard input to standard output
    #[arg(value_name = "PATH", required = true)]
    pub paths: Vec<PathBuf>,
    /// Change nothing; print the names of the files that would change
    #[arg(long)]
    pub check: bool,
    #[command(flatten)]
    pub reading: ReadingOptions,
}

/// `view`.
#[derive(Debug, Args)]
pub(super) struct ViewCall {
    #[command(flatten)]
    pub program: ProgramArgument,
    /// The page or picture; its name ends with .html, .svg or .png
    #[arg(short, long, value_name = "OUT")]
    pub output: PathBuf,
    /// Warnings count as findings in the exit code
    #[arg(long)]
    pub deny_warnings: bool,
}

/// `diff`.
#[derive(Debug, Args)]
pub(super) struct DiffCall {
    /// A program or CL file; `-` is standard input
    #[arg(value_name = "A")]
    pub first: PathBuf,
    /// Another one
    #[arg(value_name = "B")]
    pub second: PathBuf,
    #[command(flatten)]
    pub reading: ReadingOptions,
    /// How far tools on the same path may be from each other, in the unit of A (default: a millionth of the extent)
    #[arg(long, value_name = "T", value_parser = above_zero)]
    pub tolerance: Option<f64>,
    /// How far their axes may be turned from each other, in degrees (default: .00018)
    #[arg(long, value_name = "DEGREES", value_parser = above_zero)]
    pub axis_tolerance: Option<f64>,
    /// How to tell the differences
    #[arg(long, value_enum, default_value_t = DiffFormat::Human)]
    pub format: DiffFormat,
    /// Warnings count as findings in the exit code
    #[arg(long)]
    pub deny_warnings: bool,
}

/// `convert`.
///
/// Numbers are written with as many digits as it takes to read the same ones back. What the dialect has no words for stands in remarks
/// that begin with `$$ |`, and is told.
#[derive(Debug, Args)]
pub(super) struct ConvertCall {
    #[command(flatten)]
    pub program: ProgramArgument,
    /// The dialect to write; those that are written are read, too
    #[arg(long, value_name = "DIALECT", value_parser = cl_dialects())]
    pub to: ClDialect,
    /// Warnings count as findings in the exit code
    #[arg(long)]
    pub deny_warnings: bool,
    /// Write to a file instead of standard output, which `-` is too
    #[arg(short, long, value_name = "OUT")]
    pub output: Option<PathBuf>,
}

/// The CL dialects, with what they are.
fn cl_dialects() -> impl TypedValueParser<Value = ClDialect> {
    let named = |dialect: ClDialect| PossibleValue::new(dialect.as_str()).help(dialect.title());
    PossibleValuesParser::new(ClDialect::ALL.map(named)).try_map(|name| name.parse::<ClDialect>())
}

fn above_zero(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value > 0.0 && value.is_finite() => Ok(value),
        _ => Err("not a number above zero".to_owned()),
    }
}

/// Formats of a comparison.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum DiffFormat {
    /// For people
    Human,
    /// JSON
    Json,
}

/// `explain`.
#[derive(Debug, Args)]
pub(super) struct ExplainCall {
    /// The code, APTnnnn
    #[arg(value_name = "CODE")]
    pub code: String,
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::*;

    #[test]
    fn the_definition_is_sound() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn check_is_an_option_and_a_command() {
        let parse = |words: &[&str]| Arguments::try_parse_from([&["apt-lsp"], words].concat()).unwrap();
        // Options and paths come in any order.
        for words in [
            &["--check", "a", "b", "--format", "sarif", "--no-motion"][..],
            &["--check", "--no-motion", "a", "--format", "sarif", "b"],
            &["--check", "--format=sarif", "--no-motion", "a", "b"],
            &["--no-motion", "--format", "sarif", "--check", "a", "b"],
            &["a", "--no-motion", "b", "--check", "--format", "sarif"],
        ] {
            let option = parse(words);
            assert!(option.check && option.check_options.no_motion, "{words:?}");
            assert_eq!(
                (option.paths.len(), option.check_options.format),
                (2, CheckFormat::Sarif),
                "{words:?}"
            );
        }
        for words in [&["--check"][..], &["--check", "--no-motion"], &["a"], &["--stdio", "--check", "a"]] {
            assert!(Arguments::try_parse_from([&["apt-lsp"], words].concat()).is_err(), "{words:?}");
        }
        let Some(Command::Check(call)) = parse(&["check", "a", "--deny-warnings"]).command else {
            panic!("no call")
        };
        assert_eq!((call.paths.len(), call.options.deny_warnings), (1, true));
        assert!(parse(&["--stdio"]).command.is_none());
    }

    #[test]
    fn severities_are_codes_with_a_word() {
        let parsed = SeverityOption::parse("apt0951=Off").unwrap();
        assert_eq!((parsed.code.as_str(), parsed.severity.as_str()), ("APT0951", "off"));
        for wrong in ["", "APT0951", "=off", "APT0951=", "off"] {
            assert!(SeverityOption::parse(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn places_count_from_one() {
        assert_eq!(Place::parse("3"), Ok(Place { line: 3, column: 1 }));
        assert_eq!(Place::parse("3:7"), Ok(Place { line: 3, column: 7 }));
        for wrong in ["", "0", "1:0", "a", "1:", "-1", "1:2:3"] {
            assert!(Place::parse(wrong).is_err(), "{wrong}");
        }
    }
}
