//! What the post-processor knows of each word: whether it makes something of it, and which arguments may stand.

use apt_cldata::record::ClWord;
use smol_str::SmolStr;

use crate::{finding::PostFindingKind, words::Arguments};

/// What becomes of a post-processor word.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Treatment {
    /// It makes blocks, or changes those that follow.
    OnTape,
    /// It speaks to listings, plotters, the tape punch or the processor; a machine tool has nothing to do for it.
    Silent,
    /// It needs a device that none of the machines that are described has; it stays on the CL file.
    NotSupported,
}

/// Words that the engine acts on.
const ON_TAPE: [&str; 51] = [
    "ARCDAT", "ARCMOV", "ARCSLP", "AUXFUN", "CLEARP", "CLRSRF", "COOLNT", "CUTCOM", "CYCLE", "DELAY",
    "DELETE", "DISPLY", "DWELL", "END", "FEDRAT", "GOCLER", "GOHOME", "INSERT", "ISTOP", "LOAD", "LOADTL",
    "MCHTOL", "MOVARC", "OFSTNO", "OPSKIP", "OPSTOP", "ORIGIN", "PARTNO", "PLUNGE", "PPRINT", "PREFUN",
    "RAPID", "RETRCT", "REWIND", "SELCTL", "SELECT", "SEQNO", "SET", "SPINDL", "STOP", "TOOLNO", "TPRINT",
    "TRANS", "TURRET", "UNLOAD", "LINTOL", "MAXDPM", "PIVOTZ", "ROTABL", "ROTATE", "ROTHED",
];
/// Words of the processor, of listings, of plots and of the punch.
const SILENT: [&str; 37] = [
    "CALSUB",
    "CAMERA",
    "CLPRNT",
    "COPY",
    "DEFSUB",
    "DMIS",
    "DRAFT",
    "DRAWLI",
    "END-OF-PATH",
    "ENDSUB",
    "INDEX",
    "LEADER",
    "LETTER",
    "LPRINT",
    "MACHIN",
    "MCHFIN",
    // Its chords are the path.
    "MOVNRB",
    "MSYS",
    "NOPOST",
    "OVPLOT",
    "PAINT",
    "PATH",
    "PENDWN",
    "PENUP",
    "PLABEL",
    "PLOT",
    "PPLOT",
    "PPTOL",
    "REGBRK",
    "REMARK",
    "TITLES",
    "TLDATA",
    "TOOL",
    // An operation of NX begins.
    "TOOL PATH",
    "TRACUT",
    // Section 3 has carried them out.
    "VTLAXS",
    "WCORN",
];
/// Words for which no machine that is described has anything.
const NOT_SUPPORTED: [&str; 48] = [
    "AIR", "ALIGN", "ASLOPE", "BREAK", "CAM", "CHECK", "CHUCK", "CLAMP", "CORNFD", "COUPLE", "DRESS",
    "FACEML", "HEAD", "IFRO", "INTCOD", "LOCKX", "MAGTAP", "MAXVEL", "MDEND", "MDWRIT", "MODE", "MOVETO",
    "PALLET", "PBS", "PICKUP", "PITCH", "POSITN", "POSMAP", "POSTN", "PPFUN", "PROBX", "PROBY", "QUILL",
    "RESET", "REVERS", "SADDLE", "SAFETY", "SLOWDN", "SMOOTH", "SWITCH", "TAILST", "THREAD", "TLAXIS",
    "TMARK", "ULOCKX", "VACUUM", "ZERO", "POD",
];

/// What becomes of a word; `None` for one that the post-processor does not know.
pub fn treatment(word: &str) -> Option<Treatment> {
    if ON_TAPE.contains(&word) {
        Some(Treatment::OnTape)
    } else if SILENT.contains(&word) {
        Some(Treatment::Silent)
    } else {
        NOT_SUPPORTED.contains(&word).then_some(Treatment::NotSupported)
    }
}

/// The arguments that a word takes.
struct Form {
    word: &'static str,
    /// Numbers that stand by themselves, at most.
    numbers: usize,
    /// Minor words that are read.
    minors: &'static [&'static str],
}

/// Words whose arguments are few enough to be listed. The statements of FEDRAT, SPINDL, COOLNT, CUTCOM and CYCLE know
/// their own minor words and are left out when one is unknown.
const FORMS: [Form; 30] = [
    Form { word: "LINTOL", numbers: 1, minors: &["ON", "OFF"] },
    Form { word: "MAXDPM", numbers: 1, minors: &[] },
    Form { word: "PIVOTZ", numbers: 1, minors: &[] },
    Form { word: "ROTABL", numbers: 1, minors: ANY },
    Form { word: "ROTHED", numbers: 1, minors: ANY },
    Form { word: "ROTATE", numbers: 1, minors: ANY },
    Form { word: "SPINDL", numbers: 1, minors: ANY },
    Form { word: "COOLNT", numbers: 0, minors: ANY },
    Form { word: "CUTCOM", numbers: 1, minors: ANY },
    // A feed, the distance from a check surface, and the feed from there on.
    Form { word: "FEDRAT", numbers: 3, minors: ANY },
    Form { word: "SELCTL", numbers: 1, minors: &["TOOL"] },
    Form { word: "SELECT", numbers: 1, minors: &["TOOL"] },
    Form { word: "UNLOAD", numbers: 1, minors: &["TOOL"] },
    Form { word: "OFSTNO", numbers: 1, minors: &["ADJUST"] },
    Form { word: "LEADER", numbers: 1, minors: &[] },
    Form { word: "DELAY", numbers: 1, minors: &["REV"] },
    Form { word: "DWELL", numbers: 1, minors: &["REV"] },
    Form { word: "CLEARP", numbers: 4, minors: &["XYPLAN", "YZPLAN", "ZXPLAN", "TOOL", "AVOID"] },
    Form { word: "CLRSRF", numbers: 4, minors: &["XYPLAN", "YZPLAN", "ZXPLAN", "TOOL", "AVOID", "NORMAL"] },
    Form { word: "RETRCT", numbers: 0, minors: &[] },
    Form { word: "GOCLER", numbers: 0, minors: &[] },
    Form { word: "PLUNGE", numbers: 1, minors: &[] },
    Form { word: "ORIGIN", numbers: 3, minors: &[] },
    Form { word: "TRANS", numbers: 3, minors: &[] },
    // The first number, and after INCR's step every how many blocks.
    Form { word: "SEQNO", numbers: 2, minors: &["ON", "OFF", "INCR"] },
    Form { word: "OPSKIP", numbers: 1, minors: &["ON", "OFF"] },
    Form { word: "DELETE", numbers: 1, minors: &["ON", "OFF"] },
    Form { word: "AUXFUN", numbers: 1, minors: &["NOW"] },
    Form { word: "PREFUN", numbers: 1, minors: &["NOW"] },
    Form { word: "MCHTOL", numbers: 1, minors: &[] },
];
/// Minor words that the statement looks at itself.
const ANY: &[&str] = &["*"];

/// Minor words that take the number after them.
const WITH_NUMBER: [&str; 19] = [
    "ADJUST", "ATANGL", "AXIS", "CLEAR", "DEPTH", "DIAMTR", "DWELL", "FEDTO", "INCR", "LENGTH", "MAXIPM",
    "MAXRPM", "OFFSET", "OSETNO", "RADIUS", "RANGE", "RAPTO", "STEP", "TPI",
];
/// Minor words of which a statement may say one.
const EXCLUSIVE: [&[&str]; 9] = [
    &["ON", "OFF"],
    &["CLW", "CCLW"],
    &["LEFT", "RIGHT"],
    &["RPM", "SFM", "SMM"],
    &["IPM", "MMPM", "IPR", "MMPR", "PERMIN", "PERREV"],
    &["FLOOD", "MIST", "TAPKUL", "AIR"],
    &["LOW", "MEDIUM", "HIGH"],
    &["NOW", "NEXT"],
    &["LARGE", "SMALL"],
];

/// What the arguments of a statement have that is none of its word's form, repeated, or contradicts itself. The
/// statement is carried out all the same.
pub(crate) fn check(arguments: &Arguments<'_>) -> Vec<PostFindingKind> {
    let mut found = Vec::new();
    let word = arguments.word;
    // LEADER speaks to the punch, which has a leader of its own; what it asks for is checked all the same.
    if treatment(word) != Some(Treatment::OnTape) && word != "LEADER" {
        return found;
    }
    let minors: Vec<&SmolStr> = minors(arguments).collect();
    for (index, minor) in minors.iter().enumerate() {
        if minors[..index].iter().filter(|other| other == &minor).count() == 1 {
            let argument = (*minor).clone();
            found.push(PostFindingKind::ArgumentRepeated { word: word.clone(), argument });
        }
    }
    for group in EXCLUSIVE {
        let mut said = group.iter().filter(|minor| arguments.has(minor));
        if let (Some(first), Some(second)) = (said.next(), said.next()) {
            let (first, second) = (SmolStr::new(first), SmolStr::new(second));
            found.push(PostFindingKind::ArgumentConflict { word: word.clone(), first, second });
        }
    }
    let Some(form) = FORMS.iter().find(|form| form.word == word.as_str()) else { return found };
    let unused = |argument: SmolStr| PostFindingKind::ArgumentNotUsed { word: word.clone(), argument };
    // Without a number to go by the statement is left out for the word that it cannot follow.
    let followed = !matches!(word.as_str(), "CLEARP" | "CLRSRF") || arguments.number().is_some();
    if form.minors != ANY && followed {
        let unknown = minors.iter().filter(|minor| !form.minors.contains(&minor.as_str()));
        found.extend(unknown.map(|minor| unused((*minor).clone())));
    }
    let surplus = bare_numbers(arguments).into_iter().skip(form.numbers);
    found.extend(surplus.map(|number| unused(SmolStr::from(number.to_string()))));
    found
}

fn minors<'a>(arguments: &'a Arguments<'_>) -> impl Iterator<Item = &'a SmolStr> {
    arguments.items.iter().filter_map(|item| match item {
        ClWord::Word(word) if !word.is_empty() => Some(word),
        _ => None,
    })
}

/// The numbers that no minor word before them takes.
pub(crate) fn bare_numbers(arguments: &Arguments<'_>) -> Vec<f64> {
    let mut taken = false;
    let mut numbers = Vec::new();
    for item in arguments.items {
        match item {
            ClWord::Word(word) => taken = WITH_NUMBER.contains(&word.as_str()),
            ClWord::Number(number) => {
                if !std::mem::take(&mut taken) {
                    numbers.push(*number);
                }
            }
        }
    }
    numbers
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(word: &str, items: &[&str]) -> Vec<String> {
        let items: Vec<ClWord> = items
            .iter()
            .map(|item| item.parse().map_or_else(|_| ClWord::Word((*item).into()), ClWord::Number))
            .collect();
        check(&Arguments { word: &word.into(), items: &items }).iter().map(ToString::to_string).collect()
    }

    #[test]
    fn no_word_is_treated_in_two_ways() {
        let mut all: Vec<&str> = ON_TAPE.iter().chain(&SILENT).chain(&NOT_SUPPORTED).copied().collect();
        all.sort_unstable();
        let count = all.len();
        all.dedup();
        assert_eq!(all.len(), count);
        assert_eq!(treatment("SPINDL"), Some(Treatment::OnTape));
        assert_eq!(treatment("CHIPCV"), None);
    }

    #[test]
    fn forms_of_the_language_are_silent() {
        let cases: [(&str, &[&str]); 12] = [
            ("SPINDL", &["1000", "CLW"]),
            ("SPINDL", &["SFM", "200", "CCLW", "RADIUS", "10", "MAXRPM", "3000"]),
            ("FEDRAT", &["20", "1", "10"]),
            ("FEDRAT", &["IPR", ".01", "MAXIPM", "20"]),
            ("COOLNT", &["MIST"]),
            ("SEQNO", &["10", "INCR", "5"]),
            ("OPSKIP", &["ON"]),
            ("DELAY", &["2", "REV"]),
            ("CUTCOM", &["LEFT", "3"]),
            ("CLEARP", &["XYPLAN", "10"]),
            ("LOADTL", &["1", "LENGTH", "4.5", "OFFSET", "1"]),
            ("CYCLE", &["DRILL", "DEPTH", "1", "IPM", "5", "CLEAR", ".1"]),
        ];
        for (word, items) in cases {
            assert_eq!(found(word, items), Vec::<String>::new(), "{word} {items:?}");
        }
    }

    #[test]
    fn what_stands_twice_or_too_much_or_against_itself_is_found() {
        assert_eq!(found("SPINDL", &["1000", "CLW", "CCLW"]), ["SPINDL: CLW and CCLW exclude each other"]);
        assert_eq!(found("SPINDL", &["1000", "2000"]), ["SPINDL: 2000 has no effect here"]);
        assert_eq!(
            found("CYCLE", &["DRILL", "DEPTH", "1", "DEPTH", "2"]),
            ["CYCLE: DEPTH is given twice; the last one counts"]
        );
        assert_eq!(found("DELAY", &["2", "RPM"]), ["DELAY: RPM has no effect here"]);
        assert_eq!(found("COOLNT", &["FLOOD", "3"]), ["COOLNT: 3 has no effect here"]);
        // What is nothing to a mill may have any arguments.
        assert_eq!(found("PLOT", &["1", "1", "ON", "OFF"]), Vec::<String>::new());
    }
}
