//! A reader of dialogue tapes that knows nothing of the post-processor: it follows straight blocks, centres, arcs and helices from
//! place to place.

use std::f64::consts::{PI, TAU};

/// How far the ends of an arc may be at other distances from its centre than each other: controls take three times as much, millimetres.
const RADII: f64 = 5e-3;
/// What computing takes from a place; one that is farther from another is another one.
const SAME: f64 = 1e-9;

/// Where the axes stand: X, Y, Z, and B, C in degrees.
pub(crate) type Place = [f64; 5];
const AXES: [&str; 5] = ["X", "Y", "Z", "B", "C"];

/// A way that the tape tells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Step {
    pub(crate) start: Place,
    pub(crate) end: Place,
    /// Feed; none of a rapid.
    pub(crate) feed: Option<f64>,
    pub(crate) arc: Option<Arc>,
}

/// Round a centre, by a signed angle in radians.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Arc {
    pub(crate) center: [f64; 2],
    pub(crate) sweep: f64,
}

impl Step {
    /// The place after a part of the angle of an arc.
    pub(crate) fn after(&self, angle: f64) -> Place {
        let Some(Arc { center: [x, y], sweep }) = self.arc else { panic!("{self:?} has no angle") };
        let (sine, cosine) = angle.sin_cos();
        let (u, v) = (self.start[0] - x, self.start[1] - y);
        let rise = (self.end[2] - self.start[2]) * angle / sweep;
        let [_, _, z, b, c] = self.start;
        [x + u * cosine - v * sine, y + u * sine + v * cosine, z + rise, b, c]
    }
}

/// The ways of a tape from its first place with all of X, Y and Z on. Every line is numbered, from 0 on.
pub(crate) fn read(tape: &str) -> Vec<Step> {
    let mut reader = Reader::default();
    for (number, line) in tape.lines().enumerate() {
        let (told, block) = line.split_once(' ').unwrap_or((line, ""));
        assert_eq!(told, number.to_string(), "{line}");
        reader.block(block);
    }
    assert!(tape.starts_with("0 BEGIN PGM ") && tape.lines().last().unwrap().contains(" END PGM "), "{tape}");
    reader.steps
}

#[derive(Default)]
struct Reader {
    place: [Option<f64>; 5],
    center: Option<[f64; 2]>,
    feed: Option<f64>,
    steps: Vec<Step>,
}

impl Reader {
    fn block(&mut self, block: &str) {
        let words: Vec<&str> = block.split(' ').collect();
        let value = |address: &str| {
            let mut values =
                words[1..].iter().filter_map(|word| word.strip_prefix(address)?.parse::<f64>().ok());
            let found = values.next();
            assert!(values.next().is_none(), "{block}");
            found
        };
        // Places of the machine are none of the part.
        if words.contains(&"M91") {
            self.place = [None; 5];
            return;
        }
        let rapid = words.contains(&"FMAX");
        if !rapid && matches!(words[0], "L" | "C" | "CP") {
            self.feed = value("F").or(self.feed);
        }
        match words[0] {
            "CC" => self.center = Some([value("X").unwrap(), value("Y").unwrap()]),
            "L" => {
                let side = words.iter().filter(|word| matches!(**word, "R0" | "RL" | "RR")).count();
                let mut end = self.place;
                for (axis, name) in AXES.iter().enumerate() {
                    end[axis] = value(name).or(end[axis]);
                }
                assert_eq!(side, usize::from(words.len() > 2), "{block}");
                if end != self.place {
                    self.go(end, rapid, None);
                }
            }
            "C" => {
                let [x, y] = self.center.unwrap();
                let (end_x, end_y) = (value("X").unwrap(), value("Y").unwrap());
                let [start_x, start_y] = [self.place[0].unwrap(), self.place[1].unwrap()];
                let radii = [(start_x - x).hypot(start_y - y), (end_x - x).hypot(end_y - y)];
                assert!((radii[0] - radii[1]).abs() < RADII, "{block}: {radii:?}");
                let turned = (end_y - y).atan2(end_x - x) - (start_y - y).atan2(start_x - x);
                // From a place to itself is once round.
                let turned = if (end_x - start_x).hypot(end_y - start_y) < SAME { 0.0 } else { turned };
                let sweep = match (words.contains(&"DR+"), turned.rem_euclid(TAU)) {
                    (true, 0.0) => TAU,
                    (false, 0.0) => -TAU,
                    (true, angle) => angle,
                    (false, angle) => angle - TAU,
                };
                let mut end = self.place;
                (end[0], end[1]) = (Some(end_x), Some(end_y));
                self.go(end, false, Some(Arc { center: [x, y], sweep }));
            }
            "CP" => {
                let sweep = value("IPA").unwrap() * PI / 180.0;
                assert_eq!(sweep > 0.0, words.contains(&"DR+"), "{block}");
                let center = self.center.unwrap();
                let arc = Arc { center, sweep };
                let start = self.place.map(Option::unwrap_or_default);
                let mut end = start;
                end[2] += value("IZ").unwrap();
                end = Step { start, end, feed: None, arc: Some(arc) }.after(sweep);
                self.go(end.map(Some), false, Some(arc));
            }
            "BEGIN" | "END" | ";" | "TOOL" | "CYCL" | "STOP" => {}
            other => panic!("{other} in {block}"),
        }
    }

    fn go(&mut self, end: [Option<f64>; 5], rapid: bool, arc: Option<Arc>) {
        let known = |place: &[Option<f64>; 5]| place[..3].iter().all(Option::is_some);
        if known(&self.place) && known(&end) {
            let [start, end] = [self.place, end].map(|place| place.map(Option::unwrap_or_default));
            let feed = if rapid { None } else { self.feed };
            self.steps.push(Step { start, end, feed, arc });
        }
        self.place = end;
    }
}
