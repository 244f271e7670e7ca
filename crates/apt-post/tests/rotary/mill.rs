//! Random machines with rotary axes, made of bundled definitions, and where their joints take the tool on the part.

use apt_geometry::Vec3;
use apt_post::{MachineDefinition, definition_file};
use proptest::prelude::*;

/// What the words of a control are: X, Y, Z and the angles of the chain, that nearest to the part first.
pub(super) type Joints = [f64; 5];

/// A rotary axis.
#[derive(Debug, Clone)]
pub(super) struct Axis {
    pub(super) letter: char,
    vector: Vec3,
    pub(super) head: bool,
    center_mm: Vec3,
    pub(super) limits: Option<[f64; 2]>,
    pub(super) wraps: bool,
    pub(super) most: f64,
}

/// A machine with two rotary axes.
#[derive(Debug, Clone)]
pub(super) struct Mill {
    pub(super) axes: [Axis; 2],
    /// Whether the definition begins with linuxcnc-mill5; otherwise with fanuc-mill5.
    pub(super) linuxcnc: bool,
    /// Whether the control follows the tool end.
    pub(super) follows: bool,
    pivot_mm: f64,
    retracts: bool,
    pub(super) inches: bool,
}

fn about(vector: Vec3, degrees: f64, of: Vec3) -> Vec3 {
    let (sine, cosine) = degrees.to_radians().sin_cos();
    of * cosine + vector.cross(&of) * sine + vector * (vector.dot(&of) * (1.0 - cosine))
}

pub(super) fn any_mill() -> impl Strategy<Value = Mill> {
    let center = || {
        prop_oneof![
            Just(Vec3::zeros()),
            [-80..80_i32, -80..80, -120..40].prop_map(|at| Vec3::from(at.map(f64::from)))
        ]
    };
    let carried = prop_oneof![Just([false, false]), Just([false, true]), Just([true, true])];
    let chain = prop_oneof![
        Just([('C', [0.0, 0.0, 1.0]), ('A', [1.0, 0.0, 0.0])]),
        Just([('C', [0.0, 0.0, 1.0]), ('B', [0.0, 1.0, 0.0])]),
        Just([('A', [1.0, 0.0, 0.0]), ('B', [0.0, 1.0, 0.0])]),
        Just([('C', [0.0, 0.0, 1.0]), ('B', [0.0, 1.0, 1.0])]),
    ];
    let ends = prop_oneof![4 => Just((None, false)), 2 => Just((Some([-200.0, 200.0]), false)), 2 => Just((None, true))];
    let tilts =
        prop_oneof![2 => Just(Some([-120.0, 120.0])), 1 => Just(Some([-181.0, 181.0])), 1 => Just(None)];
    let modes = (any::<bool>(), prop::bool::weighted(0.3), any::<bool>(), any::<bool>());
    (chain, carried, [center(), center()], ends, tilts, 0.0..150.0_f64, modes).prop_map(
        |(chain, carried, centers, (limits, wraps), tilts, pivot, (linuxcnc, follows, retracts, inches))| {
            let axis = |index: usize, limits, wraps, most| Axis {
                letter: chain[index].0,
                vector: Vec3::from(chain[index].1).normalize(),
                head: carried[index],
                center_mm: centers[index],
                limits,
                wraps,
                most,
            };
            Mill {
                axes: [axis(0, limits, wraps, 5400.0), axis(1, tilts, false, 3600.0)],
                linuxcnc,
                follows: follows && !linuxcnc,
                pivot_mm: pivot.round(),
                retracts,
                inches,
            }
        },
    )
}

impl Mill {
    /// A millimetre on the tape.
    pub(super) fn unit(&self) -> f64 {
        if self.inches { 25.4_f64.recip() } else { 1.0 }
    }

    /// By how much the first axis turns at most while the tool goes along a great circle, or turns in place to begin one: by half a turn and by what the
    /// other one takes the tool round it, as far as that is not square to it.
    pub(super) fn most_of_first(&self) -> f64 {
        180.0 + 2.0 * self.axes[0].vector.dot(&self.axes[1].vector).asin().to_degrees()
    }

    /// What the last decimal of a length is, tape units.
    pub(super) fn last_decimal(&self) -> f64 {
        match (self.linuxcnc, self.inches) {
            (true, false) | (false, true) => 1e-4,
            (true, true) => 1e-5,
            (false, false) => 1e-3,
        }
    }

    /// What the last decimal of an angle is.
    pub(super) fn last_of_angles(&self) -> f64 {
        if self.linuxcnc { 1e-4 } else { 1e-3 }
    }

    /// The text of the definition.
    pub(super) fn text(&self) -> String {
        let base = definition_file(if self.linuxcnc { "linuxcnc-mill5" } else { "fanuc-mill5" }).unwrap();
        let (from, to) = (base.find("[rotary.").unwrap(), base.find("[kinematics]").unwrap());
        let rotary: String = self.axes.iter().map(Axis::text).collect();
        let mut text = format!("{}{rotary}{}", &base[..from], &base[to..]);
        let [first, second] = [0, 1].map(|index| self.axes[index].letter);
        let lines = text
            .lines()
            .filter(|line| !["pivot_mm", "coordinates", "chain"].iter().any(|key| line.starts_with(key)));
        text = lines.flat_map(|line| [line, "\n"]).collect();
        let coordinates = if self.follows { "tip" } else { "slides" };
        let rules = format!(
            "[kinematics]\nchain = [\"{first}\", \"{second}\"]\ncoordinates = \"{coordinates}\"\npivot_mm = {:.1}\n{}",
            self.pivot_mm,
            if self.retracts { "retract_mm = 25.0\n" } else { "" }
        );
        text = text.replace("[kinematics]\n", &rules);
        let own = if self.linuxcnc { 'A' } else { 'B' };
        let missing = if self.linuxcnc { 'B' } else { 'A' };
        let register =
            text.lines().find(|line| line.starts_with(&format!("{own} = {{ address"))).unwrap().to_owned();
        let other = register.replace(&format!("\"{own}\""), &format!("\"{missing}\"")).replacen(
            own,
            &missing.to_string(),
            1,
        );
        text = text.replace(&register, &format!("{register}\n{other}"));
        text = text.replace(&format!("\"Z\", \"{own}\", \"C\","), "\"Z\", \"A\", \"B\", \"C\",");
        text = text.replace(&format!("prefer = {{ {own} ="), &format!("prefer = {{ {second} ="));
        text = text.replace(&format!("{{{own}}} {{C}}"), &format!("{{{first}}} {{{second}}}"));
        if !self.follows {
            text = text.replace("follow_on = [\"G43.4 {!H}\"]\n", "").replace("follow_off = [\"G49\"]\n", "");
        }
        text
    }

    pub(super) fn definition(&self) -> MachineDefinition {
        let text = self.text();
        MachineDefinition::from_toml(&text).unwrap_or_else(|error| panic!("{error:?}\n{text}"))
    }

    /// Direction of the tool on the part.
    pub(super) fn direction(&self, joints: &Joints) -> Vec3 {
        let [first, second] = &self.axes;
        about(first.vector, joints[3], about(second.vector, joints[4], Vec3::z()))
    }

    /// A place of the machine as the part has it, the one that turns with the tables.
    pub(super) fn off_machine(&self, place: Vec3, joints: &Joints) -> Vec3 {
        let tables = self.axes.iter().zip(&joints[3..]).rev().filter(|(axis, _)| !axis.head);
        tables.fold(place, |place, (axis, angle)| {
            let center = axis.center_mm * self.unit();
            about(axis.vector, *angle, place - center) + center
        })
    }

    /// Tool end on the part, with a tool of some length in the head.
    pub(super) fn tip(&self, joints: &Joints, length: f64) -> Vec3 {
        let words = Vec3::new(joints[0], joints[1], joints[2]);
        if self.follows {
            return words;
        }
        let heads = self.axes.iter().zip(&joints[3..]).rev().filter(|(axis, _)| axis.head);
        let spindle = heads.fold(Vec3::z(), |way, (axis, angle)| about(axis.vector, *angle, way));
        let hangs = self.pivot_mm * self.unit() + length;
        self.off_machine(words + (Vec3::z() - spindle) * hangs, joints)
    }
}

impl Axis {
    fn text(&self) -> String {
        let list = |of: Vec3| format!("[{:.9}, {:.9}, {:.9}]", of.x, of.y, of.z);
        let ends = match self.limits {
            Some([least, greatest]) => format!("limits_degrees = [{least:.1}, {greatest:.1}]\n"),
            None if self.wraps => "wraps = true\n".to_owned(),
            None => String::new(),
        };
        format!(
            "[rotary.{}]\nvector = {}\ncarried = \"{}\"\n{ends}center_mm = {}\nmost_degrees_per_minute = {:.1}\n\n",
            self.letter,
            list(self.vector),
            if self.head { "head" } else { "table" },
            list(self.center_mm),
            self.most
        )
    }
}
