//! `post` and `machines`: the control tape.

use serde_json::Value;

use super::Outcome;
use super::arguments::{PostCall, ProgramArgument, Punch};
use super::console::Console;
use super::program::Program;
use crate::analysis::{Language, Product, PunchCode, Refusal};

/// Makes the tape of a program.
pub(super) fn post(call: &PostCall, console: &Console, language: &dyn Language) -> Outcome {
    if call.list_machines {
        return list_machines(console, language);
    }
    let Some(file) = call.file.clone() else { return Outcome::Unusable };
    let argument = ProgramArgument { file, dialect: call.dialect.clone() };
    let Some(program) = Program::read(&argument, console, language) else { return Outcome::Unusable };
    let of_settings = program.settings.program.get("machine").and_then(Value::as_str).map(str::to_owned);
    let Some(machine) = call.machine.clone().or(of_settings) else {
        console.error(&Refusal::NoMachine.to_string());
        return Outcome::Unusable;
    };
    let punch = call.punch.map(|code| match code {
        Punch::Eia => PunchCode::Eia,
        Punch::Iso => PunchCode::Iso,
    });
    let (control, bar) = console.control(&program.name);
    let tape = program.document.product(&Product::Tape { machine, punch }, &control);
    bar.finish_and_clear();
    match tape {
        Ok(bytes) => console.write(&bytes, call.output.as_deref()),
        Err(refusal) => {
            console.error(&format!("{}: {refusal}", program.name));
            Outcome::Unusable
        }
    }
}

/// Prints the machines, one per line.
pub(super) fn list_machines(console: &Console, language: &dyn Language) -> Outcome {
    let line = |machine: crate::analysis::MachineInfo| {
        format!("{:<20} {} ({})\n", machine.name, machine.title, machine.control)
    };
    console.print(&language.machines().into_iter().map(line).collect::<String>())
}
