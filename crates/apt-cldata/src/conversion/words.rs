//! Tools, cutters, feed rates and spindle speeds in the words of another system.

use smol_str::SmolStr;

use crate::{
    record::ClWord,
    text::dialects::{CutterForm, Form, ToolForm},
};

/// Units of feed rates.
pub(super) const FEED_UNITS: [&str; 8] = ["IPM", "IPR", "MMPM", "MMPR", "FPM", "FPR", "PERMIN", "PERREV"];
/// Words before the number of an offset register.
const REGISTERS: [&str; 3] = ["ADJUST", "OFFSET", "OSETNO"];

pub(super) fn word(text: &str) -> ClWord {
    ClWord::Word(SmolStr::new(text))
}

pub(super) fn is_word(word: &ClWord, texts: &[&str]) -> bool {
    matches!(word, ClWord::Word(one) if texts.contains(&one.as_str()))
}

/// One number and the words around it in the order of the target: value and unit, whatever else there is behind them. Any other list stays
/// as it is.
pub(super) fn value_and_unit(arguments: &[ClWord], units: &[&str], value_first: bool) -> Vec<ClWord> {
    let numbers = arguments.iter().filter(|argument| matches!(argument, ClWord::Number(_))).count();
    let mut named = arguments.iter().filter(|argument| is_word(argument, units));
    let (Some(unit), None, 1) = (named.next(), named.next(), numbers) else { return arguments.to_vec() };
    let (value, rest): (Vec<&ClWord>, Vec<&ClWord>) =
        arguments.iter().filter(|one| *one != unit).partition(|one| matches!(one, ClWord::Number(_)));
    let mut ordered = vec![unit];
    ordered.splice(if value_first { 0..0 } else { 1..1 }, value);
    ordered.into_iter().chain(rest).cloned().collect()
}

/// A call or choice of a tool.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Tool {
    number: f64,
    length: Option<f64>,
    register: Option<f64>,
    rest: Vec<ClWord>,
}

impl Tool {
    /// What LOADTL, LOAD, SELCTL or SELECT says in a form; none where it does not begin with a number.
    pub(super) fn read(arguments: &[ClWord], form: &Form) -> Option<Self> {
        let list = match arguments {
            [first, list @ ..] if is_word(first, &["TOOL"]) => list,
            list => list,
        };
        let (ClWord::Number(number), mut list) = list.split_first()? else { return None };
        let mut tool = Tool { number: *number, length: None, register: None, rest: Vec::new() };
        if let (ToolForm::Positions, [ClWord::Number(_), ClWord::Number(length), more @ ..]) =
            (form.tool, list)
        {
            tool.length = Some(*length);
            list = more;
            if let [ClWord::Number(register), more @ ..] = list {
                tool.register = Some(*register);
                list = more;
            }
        }
        while let [first, more @ ..] = list {
            match (first, more) {
                (first, [ClWord::Number(value), more @ ..]) if is_word(first, &["LENGTH"]) => {
                    tool.length = Some(*value);
                    list = more;
                }
                (first, [ClWord::Number(value), more @ ..]) if is_word(first, &REGISTERS) => {
                    tool.register = Some(*value);
                    list = more;
                }
                _ => {
                    tool.rest.push(first.clone());
                    list = more;
                }
            }
        }
        Some(tool)
    }

    /// The parameters in a form, and those that it has no place for.
    pub(super) fn write(self, form: &Form) -> (Vec<ClWord>, Vec<ClWord>) {
        let number = ClWord::Number(self.number);
        let couple = |name: &str, value: Option<f64>| {
            value.map_or(Vec::new(), |value| vec![word(name), ClWord::Number(value)])
        };
        let (mut list, left) = match (form.tool, self.length, self.register) {
            (ToolForm::LoadTool, length, register) => {
                let list = [vec![word("TOOL"), number], couple("ADJUST", register)].concat();
                (list, couple("LENGTH", length))
            }
            (ToolForm::Positions, Some(length), register) => {
                let mut list = vec![number, ClWord::Number(0.0), ClWord::Number(length)];
                list.extend(register.map(ClWord::Number));
                (list, Vec::new())
            }
            (ToolForm::Positions, None, register) => {
                ([vec![number], couple("ADJUST", register)].concat(), Vec::new())
            }
            (ToolForm::Couples { register: name }, length, register) => {
                ([vec![number], couple("LENGTH", length), couple(name, register)].concat(), Vec::new())
            }
        };
        list.extend(self.rest);
        (list, left)
    }
}

/// The word that calls (`true`) or chooses a tool.
pub(super) fn tool_word(form: &Form, calls: bool) -> &'static str {
    match (form.tool == ToolForm::LoadTool, calls) {
        (true, true) => "LOAD",
        (true, false) => "SELECT",
        (false, true) => "LOADTL",
        (false, false) => "SELCTL",
    }
}

/// Whether a statement calls (`true`) or chooses a tool.
pub(super) fn calls_tool(name: &str, arguments: &[ClWord]) -> Option<bool> {
    let of_tool = arguments.first().is_some_and(|first| is_word(first, &["TOOL"]));
    match name {
        "LOADTL" => Some(true),
        "SELCTL" => Some(false),
        "LOAD" if of_tool => Some(true),
        "SELECT" if of_tool => Some(false),
        _ => None,
    }
}

/// `CUTTER/d,r,e,f,a,b,h` that says the same as `TLDATA/MILL,d,r,length,taper,tip`: the corner is a quarter circle that is tangent to the
/// bottom and to the side.
pub(super) fn cutter_of_tool_data(arguments: &[ClWord]) -> Option<Vec<ClWord>> {
    let (kind, list) = arguments.split_first()?;
    let numbers = numbers(list)?;
    match (is_word(kind, &["MILL"]), &numbers[..]) {
        (true, &[diameter, radius, length, taper, tip]) => {
            let center = diameter / 2.0 - radius;
            Some([diameter, radius, center, radius, tip, taper, length].map(ClWord::Number).into())
        }
        _ => None,
    }
}

/// The other way round.
pub(super) fn tool_data_of_cutter(arguments: &[ClWord]) -> Option<Vec<ClWord>> {
    let numbers = numbers(arguments)?;
    let &[diameter, radius, across, up, tip, taper, length] = &numbers[..] else { return None };
    let square = across == diameter / 2.0 - radius && up == radius;
    // Some write a square end mill with all numbers zero that follow from the others.
    let plain = radius == 0.0 && across == 0.0 && up == 0.0 && tip == 0.0 && taper == 0.0;
    let list = [diameter, radius, length, taper, tip].map(ClWord::Number);
    (square || plain).then(|| [vec![word("MILL")], list.into()].concat())
}

/// Whether CUTTER is a statement of the form.
pub(super) fn states_cutter(form: &Form) -> bool {
    form.cutter == CutterForm::Statement
}

pub(super) fn numbers(list: &[ClWord]) -> Option<Vec<f64>> {
    let number = |argument: &ClWord| match argument {
        ClWord::Number(number) => Some(*number),
        ClWord::Word(_) => None,
    };
    list.iter().map(number).collect()
}
