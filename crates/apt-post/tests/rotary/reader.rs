//! The text of a tape of a machine with rotary axes, read as its control reads it.

use std::collections::BTreeMap;

use super::mill::{Joints, Mill};

/// What a block moves.
#[derive(Debug, Clone)]
pub(super) struct Step {
    pub(super) block: String,
    pub(super) rapid: bool,
    /// Where the joints start, if all of them are known.
    pub(super) start: Option<Joints>,
    pub(super) end: Joints,
    /// Sense of an arc about the axis across its plane, and its centre.
    pub(super) arc: Option<Arc>,
    /// F, and whether it is the inverse of the time.
    pub(super) feed: f64,
    pub(super) inverse: bool,
    pub(super) tool: u32,
    /// Whether the control follows the tool end.
    pub(super) followed: bool,
}

#[derive(Debug, Clone, Copy)]
pub(super) struct Arc {
    across: usize,
    center: [f64; 2],
    sweep: f64,
}

#[derive(Default)]
struct Control {
    joints: [Option<f64>; 5],
    motion: String,
    across: usize,
    feed: f64,
    inverse: bool,
    incremental: bool,
    followed: bool,
    tool: u32,
    to_initial: bool,
    cycle: BTreeMap<char, f64>,
    initial: f64,
}

/// The steps of a tape.
pub(super) fn read(mill: &Mill, tape: &str) -> Vec<Step> {
    let mut control = Control { across: 2, ..Control::default() };
    let mut steps = Vec::new();
    for line in tape.lines() {
        let block = line.split('(').next().unwrap_or_default();
        control.block(mill, block, &mut steps);
    }
    steps
}

impl Control {
    fn block(&mut self, mill: &Mill, block: &str, steps: &mut Vec<Step>) {
        let mut words = BTreeMap::new();
        let (mut machine, mut home) = (false, false);
        let before = self.motion.clone();
        for word in block.split_whitespace() {
            let Some(letter) = word.chars().next().filter(char::is_ascii_uppercase) else { continue };
            match word {
                "G0" | "G1" | "G2" | "G3" | "G80" | "G81" => self.motion = word.to_owned(),
                "G17" => self.across = 2,
                "G18" => self.across = 1,
                "G19" => self.across = 0,
                "G90" => self.incremental = false,
                "G91" => self.incremental = true,
                "G93" => self.inverse = true,
                "G94" => self.inverse = false,
                "G98" => self.to_initial = true,
                "G99" => self.to_initial = false,
                "G43.4" => self.followed = true,
                "G43" | "G49" => self.followed = false,
                "G53" => machine = true,
                "G28" => home = true,
                "G4" => return,
                _ if "GMNSHO".contains(letter) => {}
                _ => {
                    words.insert(letter, word[1..].parse::<f64>().unwrap());
                }
            }
        }
        if let Some(tool) = words.remove(&'T') {
            self.tool = tool as u32;
            self.joints[..3].fill(None);
        }
        if let Some(feed) = words.get(&'F') {
            self.feed = *feed;
        }
        if machine || home {
            for (index, letter) in ['X', 'Y', 'Z'].into_iter().enumerate() {
                if words.contains_key(&letter) {
                    self.joints[index] = None;
                }
            }
            return;
        }
        let cycles = self.motion == "G81";
        let letters = ['X', 'Y', 'Z', mill.axes[0].letter, mill.axes[1].letter];
        if !letters.iter().any(|letter| words.contains_key(letter)) {
            return;
        }
        assert!(!self.incremental, "{block}");
        if cycles {
            if before != "G81" {
                self.initial = self.joints[2].unwrap();
            }
            self.cycle.extend(words.clone());
            return self.drill(block, &words, steps);
        }
        let mut to = self.joints;
        for (index, letter) in letters.into_iter().enumerate() {
            let Some(value) = words.get(&letter) else { continue };
            to[index] = Some(match index.checked_sub(3) {
                Some(axis) if mill.axes[axis].wraps => {
                    assert!((0.0..360.0).contains(value), "{block}");
                    // The shorter way.
                    let here = self.joints[index].unwrap_or(0.0);
                    let turned = (value - here + 180.0).rem_euclid(360.0) - 180.0;
                    assert!(turned.abs() < 179.0 || self.motion == "G0", "{block} {turned}");
                    here + turned
                }
                _ => *value,
            });
        }
        let arc = matches!(self.motion.as_str(), "G2" | "G3").then(|| self.arc(&words, &to));
        self.go(block, self.motion == "G0", to, arc, steps);
    }

    fn arc(&self, words: &BTreeMap<char, f64>, to: &[Option<f64>; 5]) -> Arc {
        let (u, v) = ((self.across + 1) % 3, (self.across + 2) % 3);
        let offset = |index: usize| words.get(&['I', 'J', 'K'][index]).copied().unwrap_or(0.0);
        let start = [self.joints[u].unwrap(), self.joints[v].unwrap()];
        let center = [start[0] + offset(u), start[1] + offset(v)];
        let angle = |place: [f64; 2]| (place[1] - center[1]).atan2(place[0] - center[0]).to_degrees();
        let turned = angle([to[u].unwrap(), to[v].unwrap()]) - angle(start);
        let full =
            |turned: f64| if turned.rem_euclid(360.0) < 1e-9 { 360.0 } else { turned.rem_euclid(360.0) };
        let sweep = if self.motion == "G3" { full(turned) } else { -full(-turned) };
        Arc { across: self.across, center, sweep }
    }

    fn drill(&mut self, block: &str, words: &BTreeMap<char, f64>, steps: &mut Vec<Step>) {
        let clear = self.cycle[&'R'];
        let mut to = self.joints;
        for (index, letter) in ['X', 'Y'].into_iter().enumerate() {
            to[index] = words.get(&letter).copied().or(to[index]);
        }
        self.go(block, true, to, None, steps);
        to[2] = Some(clear);
        self.go(block, true, to, None, steps);
        to[2] = Some(self.cycle[&'Z']);
        self.go(block, false, to, None, steps);
        to[2] = Some(if self.to_initial { self.initial } else { clear });
        self.go(block, true, to, None, steps);
    }

    fn go(
        &mut self,
        block: &str,
        rapid: bool,
        to: [Option<f64>; 5],
        arc: Option<Arc>,
        steps: &mut Vec<Step>,
    ) {
        let whole = |joints: [Option<f64>; 5]| -> Option<Joints> {
            let known: Vec<f64> = joints.into_iter().flatten().collect();
            known.try_into().ok()
        };
        let start = whole(std::mem::replace(&mut self.joints, to));
        let Some(end) = whole(to) else { return };
        steps.push(Step {
            block: block.to_owned(),
            rapid,
            start,
            end,
            arc,
            feed: self.feed,
            inverse: self.inverse,
            tool: self.tool,
            followed: self.followed,
        });
    }
}

impl Step {
    /// The joints at a share of the way.
    pub(super) fn at(&self, share: f64) -> Joints {
        let start = self.start.unwrap_or(self.end);
        let mut joints: Joints =
            std::array::from_fn(|index| start[index] + (self.end[index] - start[index]) * share);
        if let Some(arc) = self.arc {
            let (u, v) = ((arc.across + 1) % 3, (arc.across + 2) % 3);
            let (sine, cosine) = (arc.sweep * share).to_radians().sin_cos();
            let (x, y) = (start[u] - arc.center[0], start[v] - arc.center[1]);
            joints[u] = arc.center[0] + x * cosine - y * sine;
            joints[v] = arc.center[1] + x * sine + y * cosine;
        }
        joints
    }
}
