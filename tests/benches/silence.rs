//! How long who cancels may wait: the longest processor time of a thread between two questions whether to go on, the
//! time before the first question and after the last one included, and the time from the answer that the work is given up
//! to its end. It decides nothing; what decides counts questions.
//!
//! Words after `--` choose the works whose names contain one of them. With `APT_SILENT` a question that comes later than
//! so many microseconds tells from where it was asked.

#![allow(missing_docs, reason = "a benchmark")]
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a benchmark may stop at once, and tells what it measured"
)]

#[cfg(unix)]
mod silence {
    pub(crate) mod clock;
    pub(crate) mod works;
}

#[cfg(unix)]
fn main() {
    let wanted: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with("--")).collect();
    println!("{:<58}{:>10}{:>10}{:>12}{:>10}", "work", "longest", "given up", "questions", "all");
    for (name, work) in silence::works::all() {
        if !wanted.is_empty() && !wanted.iter().any(|word| name.contains(word.as_str())) {
            continue;
        }
        for (step, heard) in work() {
            let times = [heard.longest, heard.given_up, heard.all].map(|time| 1e3 * time.as_secs_f64());
            let ([longest, given_up, all], title) = (times, format!("{name}: {step}"));
            println!("{title:<58}{longest:>10.2}{given_up:>10.2}{:>12}{all:>10.1}", heard.questions);
        }
    }
}

#[cfg(not(unix))]
fn main() {
    println!("only Unix has the clock of a thread");
}
