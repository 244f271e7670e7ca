//! A part that is turned, shifted, mirrored or drawn in another unit is the same part: its path moves along.

use apt_ide::{Analysis, Settings};
use apt_run::settings::Units;
use apt_tests::runs::{path_of, report};

/// Where a part lies: mirrored in y first, then turned about z, enlarged, shifted.
#[derive(Debug, Clone, Copy)]
struct Frame {
    mirrored: bool,
    /// Radians.
    turn: f64,
    scale: f64,
    shift: [f64; 3],
}

const HOME: Frame = Frame { mirrored: false, turn: 0.0, scale: 1.0, shift: [0.0; 3] };

/// How well end points of motions agree, for parts of the size of ten.
const AGREEMENT: f64 = 1e-6;

impl Frame {
    fn direction(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let y = if self.mirrored { -y } else { y };
        let (sine, cosine) = self.turn.sin_cos();
        [x * cosine - y * sine, x * sine + y * cosine, z]
    }

    fn moved(&self, point: [f64; 3]) -> [f64; 3] {
        let turned = self.direction(point);
        std::array::from_fn(|axis| turned[axis] * self.scale + self.shift[axis])
    }

    fn point(&self, x: f64, y: f64, z: f64) -> String {
        numbers(&self.moved([x, y, z]))
    }

    fn vector(&self, x: f64, y: f64, z: f64) -> String {
        numbers(&self.direction([x, y, z]))
    }

    fn step(&self, x: f64, y: f64, z: f64) -> String {
        numbers(&self.direction([x, y, z]).map(|value| value * self.scale))
    }

    fn length(&self, value: f64) -> String {
        numbers(&[value * self.scale])
    }

    fn line(&self, from: [f64; 2], to: [f64; 2]) -> String {
        let end = |[x, y]: [f64; 2]| numbers(&self.moved([x, y, 0.0])[..2]);
        format!("LINE/{},{}", end(from), end(to))
    }

    /// The plane with `normal · p = distance`; the normal need not be of unit length.
    fn plane(&self, normal: [f64; 3], distance: f64) -> String {
        let size = normal.iter().map(|value| value * value).sum::<f64>();
        let on = self.moved(normal.map(|value| value * distance / size));
        let normal = self.direction(normal);
        let distance: f64 = normal.iter().zip(on).map(|(a, b)| a * b).sum();
        format!("PLANE/{},{}", numbers(&normal), numbers(&[distance]))
    }

    fn circle(&self, center: [f64; 2], radius: f64) -> String {
        let at = self.moved([center[0], center[1], 0.0]);
        format!("CIRCLE/{},{}", numbers(&at[..2]), self.length(radius))
    }

    /// A word that names a side; mirroring makes left of right.
    fn side(&self, word: &'static str) -> &'static str {
        match (self.mirrored, word) {
            (true, "GOLFT") => "GORGT",
            (true, "GORGT") => "GOLFT",
            (true, "TLLFT") => "TLRGT",
            (true, "TLRGT") => "TLLFT",
            _ => word,
        }
    }

    /// INTOL and OUTTOL, and MAXDP where the standard one of ten inches would be short for so large a part.
    fn tolerances(&self, inside: f64, outside: f64) -> String {
        let longest =
            if self.scale > 25.4 { format!("MAXDP/{}\n", self.length(10.0)) } else { String::new() };
        format!("INTOL/{}\nOUTTOL/{}\n{longest}", self.length(inside), self.length(outside))
    }
}

fn numbers(values: &[f64]) -> String {
    // The dialect takes sixteen digits.
    let number = |value: &f64| {
        let digits = value.abs().max(1.0).log10().floor() as usize + 1;
        format!("{value:.*}", 15 - digits)
    };
    values.iter().map(number).collect::<Vec<_>>().join(",")
}

/// Lines and circles in two dimensions: start-up, corners, tangencies.
fn contour(f: &Frame) -> String {
    format!(
        "{}CUTTER/{}\nL1={}\nC1={}\nL2={}\nC2={}\nL3={}\nV={}\nPS={}\nFROM/{}\nGO/TO,L1,TO,PS,TO,L3\n{},{}/L1,TANTO,C1\n\
         GOFWD/C1,TANTO,L2\nGOFWD/L2,TO,C2\n{}/C2,ON,V\nGOFWD/C2,TO,L2\n{}/L2,PAST,L3\n{}/L3,PAST,L1\nGODLTA/{}\nFINI\n",
        f.tolerances(0.001, 0.002),
        f.length(0.5),
        f.line([0.0, 0.0], [5.0, 0.0]),
        f.circle([7.0, 2.0], 2.0),
        f.line([7.0, 4.0], [0.0, 4.0]),
        f.circle([3.0, 4.0], 1.0),
        f.line([0.0, 4.0], [0.0, 0.0]),
        f.line([3.0, 0.0], [3.0, 1.0]),
        f.plane([0.0, 0.0, 1.0], 0.5),
        f.point(-2.0, -2.0, 3.0),
        f.side("TLRGT"),
        f.side("GORGT"),
        f.side("GORGT"),
        f.side("GORGT"),
        f.side("GOLFT"),
        f.step(0.5, 0.25, 2.0),
    )
}

/// Ball and corner cutters over a sphere and a cylinder, along planes.
fn domes(f: &Frame) -> String {
    let sphere = format!("SPHERE/{},{}", f.point(0.0, 0.0, -2.0), f.length(2.0));
    let cylinder =
        format!("CYLNDR/{},{},{}", f.point(6.0, 0.0, -1.0), f.vector(0.0, 1.0, 0.0), f.length(1.0));
    format!(
        "{}CUTTER/{},{}\nS={sphere}\nD={}\nA={}\nB={}\nFROM/{}\nGO/ON,D,TO,S,ON,A\nINDIRV/{}\nTLON,GOFWD/D,ON,B\n\
         GOTO/{}\nC={cylinder}\nE={}\nG={}\nCUTTER/{},{}\nGO/ON,D,TO,C,ON,E\nINDIRV/{}\nTLON,GOFWD/D,ON,G\nFINI\n",
        f.tolerances(0.001, 0.001),
        f.length(0.5),
        f.length(0.25),
        f.plane([0.1, 1.0, 0.0], 0.3),
        f.plane([1.0, 0.0, 0.0], -1.2),
        f.plane([1.0, 0.2, 0.0], 1.1),
        f.point(-3.0, 0.0, 3.0),
        f.vector(1.0, 0.0, 0.0),
        f.point(4.0, 0.0, 3.0),
        f.plane([1.0, 0.0, 0.0], 5.4),
        f.plane([1.0, 0.0, 0.0], 6.5),
        f.length(0.5),
        f.length(0.1),
        f.vector(1.0, 0.0, 0.0),
    )
}

/// Round a cone and along canted planes, with stock.
fn cone(f: &Frame) -> String {
    let cone = format!("CONE/(POINT/{}),(VECTOR/{}),30", f.point(0.0, 0.0, 4.0), f.vector(0.0, 0.0, -1.0));
    format!(
        "{}CUTTER/{}\nCN={cone}\nPS={}\nH={}\nFROM/{}\nGO/TO,CN,TO,PS\n{},{}/CN,ON,H\nTHICK/{},{},{}\nK={}\nL={}\n\
         GODLTA/{}\nGO/TO,K,TO,PS\n{},{}/K,TO,L\nFINI\n",
        f.tolerances(0.0005, 0.001),
        // All seven, for the height of a cutter does not shrink with a part.
        ["0.5", "0.1", "0.15", "0.1"].map(|value| f.length(value.parse().unwrap())).join(",")
            + ",0,0,"
            + &f.length(5.0),
        f.plane([0.02, 0.03, 1.0], 0.0),
        f.plane([1.0, 0.0, 0.0], 0.0),
        f.point(5.0, -0.5, 1.0),
        f.side("TLRGT"),
        f.side("GORGT"),
        f.length(0.02),
        f.length(0.05),
        f.length(0.1),
        f.plane([0.1, 1.0, 0.2], 8.0),
        f.plane([1.0, 0.3, 0.1], -6.0),
        f.step(0.0, 0.5, 1.0),
        f.side("TLRGT"),
        f.side("GOLFT"),
    )
}

/// From point to point with a macro, a loop and definitions that depend on each other.
fn points(f: &Frame) -> String {
    format!(
        "P=POINT/{}\nQ=POINT/{}\nR=POINT/INTOF,({}),({}),({})\nM=MACRO/A,B\nGOTO/A\nGODLTA/{}\nGOTO/B\nTERMAC\n\
         FROM/{}\nI=0\nLOOPST\nX)I=I+1\nCALL/M,A=P,B=Q\nGOTO/R\nIF(I-3)X,Y,Y\nY)LOOPND\nFINI\n",
        f.point(1.0, 2.0, 3.0),
        f.point(-2.0, 5.0, 1.0),
        f.plane([1.0, 0.2, 0.0], 1.0),
        f.plane([0.0, 1.0, 0.5], 2.0),
        f.plane([0.3, 0.1, 1.0], 3.0),
        f.step(0.25, -0.5, 1.0),
        f.point(0.0, 0.0, 9.0),
    )
}

fn path(program: &str, units: Units) -> (Vec<u64>, Vec<[f64; 3]>) {
    let settings = Settings { dialect: Some("free".to_owned()), units, ..Settings::default() };
    let report = report(&Analysis::new(program, None, &settings.into())).unwrap();
    assert_eq!(report["ok"], true, "{}\n{program}", report["diagnostics"]);
    for motion in report["motions"].as_array().unwrap() {
        assert_eq!(motion["verified"], true, "{motion}\n{program}");
    }
    // The last position of each motion record is where it ends.
    let entries = report["cl"].as_array().unwrap();
    let moves = entries.iter().filter(|entry| entry["type"] == "go" || entry["type"] == "from");
    let counts = moves.map(|entry| entry["points"].as_array().unwrap().len() as u64).collect();
    (counts, path_of(&report).iter().map(|location| location.at).collect())
}

/// The path of a program in a frame is the path at home, moved.
fn moves_along(name: &str, program: fn(&Frame) -> String, frame: &Frame, units: Units) {
    let (home_counts, home) = path(&program(&HOME), Units::Inch);
    let (counts, there) = path(&program(frame), units);
    assert_eq!(counts.len(), home_counts.len(), "{name}, {frame:?}");
    let (mut at_home, mut at) = (0, 0);
    for (index, (home_count, count)) in home_counts.iter().zip(&counts).enumerate() {
        at_home += home_count;
        at += count;
        assert!(home_count.abs_diff(*count) <= 1, "{name}, {frame:?}: {count} for {home_count} at {index}");
        let wanted = frame.moved(home[at_home as usize - 1]);
        let found = there[at as usize - 1];
        let off = wanted.iter().zip(found).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(off <= AGREEMENT * frame.scale, "{name}, {frame:?}: {found:?} for {wanted:?} at {index}");
    }
}

/// A program written in a frame.
type Written = fn(&Frame) -> String;

const PROGRAMS: [(&str, Written); 4] =
    [("contour", contour), ("domes", domes), ("cone", cone), ("points", points)];

#[test]
fn turned_and_shifted_parts() {
    for degrees in [0.0_f64, 17.0, 45.0, 90.0, 123.4, 180.0, 251.0, 270.0, 359.0] {
        for shift in [[0.0; 3], [3.0, -4.0, 1.5], [-80.0, 55.0, -21.0]] {
            let frame = Frame { turn: degrees.to_radians(), shift, ..HOME };
            for (name, program) in PROGRAMS {
                moves_along(name, program, &frame, Units::Inch);
            }
        }
    }
}

#[test]
fn mirrored_parts() {
    for degrees in [0.0_f64, 30.0, 90.0, 200.0] {
        let frame = Frame { mirrored: true, turn: degrees.to_radians(), shift: [1.0, 2.0, 3.0], ..HOME };
        for (name, program) in PROGRAMS {
            moves_along(name, program, &frame, Units::Inch);
        }
    }
}

#[test]
fn the_same_part_in_millimeters() {
    let frame = Frame { scale: 25.4, ..HOME };
    for (name, program) in PROGRAMS {
        moves_along(name, program, &frame, Units::Mm);
        moves_along(name, program, &Frame { turn: 0.3, shift: [100.0, 50.0, 20.0], ..frame }, Units::Mm);
    }
}

#[test]
fn parts_of_any_size() {
    for scale in [0.01, 0.1, 7.0, 100.0] {
        for (name, program) in PROGRAMS {
            moves_along(name, program, &Frame { scale, ..HOME }, Units::Inch);
        }
    }
}
