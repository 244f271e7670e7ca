//! The two streams: what was asked for goes to standard output, everything else to standard error.

use std::io::{self, IsTerminal as _, Write};
use std::path::Path;

use anstream::{AutoStream, ColorChoice};
use indicatif::{ProgressBar, ProgressStyle};

use super::Outcome;
use super::arguments::Color;
use super::file;
use crate::analysis::{Control, Progress};

/// The file name that stands for standard output.
const STANDARD_OUTPUT: &str = "-";

/// Standard output and standard error with one decision about colours.
pub(super) struct Console {
    choice: ColorChoice,
}

impl Console {
    pub(super) fn new(color: Color) -> Self {
        let choice = match color {
            Color::Auto => ColorChoice::Auto,
            Color::Always => ColorChoice::Always,
            Color::Never => ColorChoice::Never,
        };
        Self { choice }
    }

    /// Prints text, with its colours if they are wanted.
    pub(super) fn print(&self, text: &str) -> Outcome {
        self.written(AutoStream::new(io::stdout(), self.choice).lock().write_all(text.as_bytes()))
    }

    /// Writes bytes to a file, all at once, or to standard output as they are; `-` is standard output too.
    pub(super) fn write(&self, bytes: &[u8], file: Option<&Path>) -> Outcome {
        let Some(path) = file.filter(|path| path.as_os_str() != STANDARD_OUTPUT) else {
            let mut output = io::stdout().lock();
            return self.written(output.write_all(bytes).and_then(|()| output.flush()));
        };
        match file::write(path, bytes) {
            Ok(()) => Outcome::Clean,
            Err(error) => {
                self.error(&format!("{}: {error}", path.display()));
                Outcome::Unusable
            }
        }
    }

    /// A reader who has seen enough is no fault.
    fn written(&self, result: io::Result<()>) -> Outcome {
        match result {
            Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
                self.error(&format!("standard output: {error}"));
                Outcome::Unusable
            }
            _ => Outcome::Clean,
        }
    }

    /// Tells something on standard error.
    pub(super) fn tell(&self, text: &str) {
        // There is nobody to tell if that fails.
        let _ = writeln!(AutoStream::new(io::stderr(), self.choice).lock(), "{text}");
    }

    /// Something worth knowing.
    pub(super) fn note(&self, text: &str) {
        self.tell(&format!("\u{1b}[1mnote\u{1b}[0m: {text}"));
    }

    /// Something that stops the call.
    pub(super) fn error(&self, text: &str) {
        self.tell(&format!("\u{1b}[1;31merror\u{1b}[0m: {text}"));
    }

    /// A control that shows progress if somebody watches.
    pub(super) fn control(&self, title: &str) -> (Control, ProgressBar) {
        if !io::stderr().is_terminal() {
            return (Control::unlimited(), ProgressBar::hidden());
        }
        let bar = ProgressBar::new_spinner();
        if let Ok(style) = ProgressStyle::with_template("{spinner} {prefix} {wide_bar} {pos}/{len} {msg}") {
            bar.set_style(style);
        }
        bar.set_prefix(title.to_owned());
        let shown = bar.clone();
        let control = Control::unlimited().with_progress(move |progress: Progress| {
            if let Some(total) = progress.total {
                shown.set_length(total);
            }
            shown.set_position(progress.done);
            shown.set_message(progress.message);
        });
        (control, bar)
    }
}
