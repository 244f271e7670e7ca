//! `post` and `machines`: the control tape.

use serde_json::Value;

use super::Outcome;
use super::arguments::{MachinesCall, PostCall, ProgramArgument, Punch};
use super::console::Console;
use super::findings::{self, Checked};
use super::program::Program;
use crate::analysis::{DEFINITION_ENDING, Language, Product, Refusal, TapeCode, length_inches};

/// In which lengths of tape are told.
const INCHES_PER_FOOT: f64 = 12.0;
const METERS_PER_INCH: f64 = 0.0254;

/// Makes the tape of a program. Of a punched one the length is told; one that cannot be punched as a whole is not written.
pub(super) fn post(call: &PostCall, console: &Console, language: &dyn Language) -> Outcome {
    if call.list_machines {
        return list_machines(console, language);
    }
    let Some(file) = call.file.clone() else { return Outcome::Unusable };
    let argument = ProgramArgument { file, reading: call.reading.clone() };
    let Some(program) = Program::read(&argument, console, language) else { return Outcome::Unusable };
    let of_settings = program.settings.program.get("machine").and_then(Value::as_str).map(str::to_owned);
    let (control, bar) = console.control(&program.name);
    let both = match call.machine.as_deref().map(typed_machine).or(of_settings) {
        Some(machine) => Ok(Some(machine)),
        None => program.document.machine_of_program(&control).map_err(Refusal::from),
    };
    let both = both.and_then(|machine| {
        let machine = machine.ok_or(Refusal::NoMachine)?;
        let punch = call.punch.map(code);
        let found = program.document.tape_diagnostics(&machine, punch, &control)?;
        match program.document.product(&Product::Tape { machine, punch }, &control) {
            Err(Refusal::Found) => Ok((found, None)),
            made => Ok((found, Some(made?))),
        }
    });
    bar.finish_and_clear();
    let (diagnostics, tape) = match both {
        Ok(both) => both,
        Err(refusal) => {
            console.error(&format!("{}: {refusal}", program.name));
            return Outcome::Unusable;
        }
    };
    let checked = Checked { program, diagnostics };
    let Some(tape) = tape else { return findings::tell(checked, call.deny_warnings, console) };
    if call.punch.is_some() {
        let inches = length_inches(&tape);
        let (feet, meters) = (inches / INCHES_PER_FOOT, inches * METERS_PER_INCH);
        let name = &checked.program.name;
        let told = format!("{name}: {feet:.3} ft ({meters:.3} m) of tape with leader and trailer");
        console.note(&told);
    }
    let written = console.write(&tape, call.output.as_deref());
    written.max(findings::tell(checked, call.deny_warnings, console))
}

fn code(punch: Punch) -> TapeCode {
    match punch {
        Punch::Eia => TapeCode::Eia,
        Punch::Iso => TapeCode::Iso,
    }
}

/// Prints the machines, or the definition of one.
pub(super) fn machines(call: &MachinesCall, console: &Console, language: &dyn Language) -> Outcome {
    let Some(name) = &call.name else { return list_machines(console, language) };
    match language.machine_definition(name) {
        Ok(definition) => console.print(&definition),
        Err(refusal) => {
            console.error(&refusal.to_string());
            Outcome::Unusable
        }
    }
}

/// A machine as it was typed: the path of a definition file begins where the shell is.
fn typed_machine(name: &str) -> String {
    let whole = std::path::absolute(name).ok().filter(|_| name.ends_with(DEFINITION_ENDING));
    whole.map_or_else(|| name.to_owned(), |path| path.to_string_lossy().into_owned())
}

/// Prints the machines, one per line.
fn list_machines(console: &Console, language: &dyn Language) -> Outcome {
    let line = |machine: crate::analysis::MachineInfo| {
        format!("{:<20} {} ({})\n", machine.name, machine.title, machine.control)
    };
    console.print(&language.machines().into_iter().map(line).collect::<String>())
}
