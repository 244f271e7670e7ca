//! Random programs on random machines, whose tapes are followed back to the part by a kinematics that does not know the engine.

use std::{cell::Cell, f64::consts::TAU};

use apt_cldata::text::read_text;
use apt_geometry::Vec3;
use apt_post::{PostFindingKind, PostOptions, Severity, post};
use proptest::{prelude::*, test_runner::TestRunner};

use super::{
    follow::{Goal, How, Place, follow},
    mill::{Mill, any_mill},
    reader::read,
};

/// Millimetres: of the holes, and of the plane to which RETRCT goes.
const DEPTH: f64 = 5.0;
const CLEARANCE: f64 = 2.0;
const CLEAR_PLANE: f64 = 250.0;
/// Millimetres a minute.
const FEED: f64 = 600.0;
const DRILL_FEED: f64 = 150.0;
/// Degrees between the points of a circle.
const CIRCLE_STEP: f64 = 6.0;

/// A place in millimetres and a direction.
type Stand = ([f64; 3], Vec3);

/// Statements that belong together.
#[derive(Debug, Clone)]
enum Part {
    /// By rapid to the first one, and cuts to the others.
    Cuts(Vec<Stand>),
    Rapids(Vec<Stand>),
    /// Along one direction by cuts, and round a circle square to the tool.
    Fixed {
        axis: Vec3,
        places: Vec<[f64; 3]>,
        radius: f64,
        steps: u32,
    },
    Holes {
        axis: Vec3,
        places: Vec<[f64; 3]>,
    },
    /// An axis that is turned by statement, and places in the coordinates behind it.
    Turned {
        which: usize,
        angle: i32,
        with_table: bool,
        places: Vec<[f64; 3]>,
    },
    Tool(u32),
    /// Round a cone that leans by so many degrees, in steps and from an angle in degrees.
    Cone {
        lean: f64,
        from: f64,
        step: f64,
        steps: u32,
    },
    /// RETRCT and PLUNGE from the last of some cuts.
    Retract(Vec<Stand>),
}

fn any_axis() -> impl Strategy<Value = Vec3> {
    let lean = prop_oneof![2 => Just(0.0), 6 => 0.5..70.0_f64, 1 => Just(45.0), 1 => 70.0..100.0_f64];
    let round = prop_oneof![3 => 0.0..TAU, 1 => (0..8_u32).prop_map(|eighth| f64::from(eighth) * TAU / 8.0)];
    (lean, round).prop_map(|(lean, round): (f64, f64)| {
        let (sine, cosine) = lean.to_radians().sin_cos();
        Vec3::new(sine * round.cos(), sine * round.sin(), cosine)
    })
}

fn any_place() -> impl Strategy<Value = [f64; 3]> {
    [-80.0..80.0_f64, -80.0..80.0, -10.0..60.0]
}

fn any_part() -> impl Strategy<Value = Part> {
    let stands = |most| prop::collection::vec((any_place(), any_axis()), 2..most);
    let places = || prop::collection::vec(any_place(), 2..5);
    prop_oneof![
        5 => stands(7).prop_map(Part::Cuts),
        2 => stands(4).prop_map(Part::Rapids),
        2 => (any_axis(), places(), 5.0..30.0_f64, 10..60_u32)
            .prop_map(|(axis, places, radius, steps)| Part::Fixed { axis, places, radius, steps }),
        2 => (any_axis(), places()).prop_map(|(axis, places)| Part::Holes { axis, places }),
        1 => places().prop_map(|places| Part::Cuts(places.into_iter().map(|place| (place, Vec3::z())).collect())),
        2 => (0..2_usize, -60..60_i32, any::<bool>(), places())
            .prop_map(|(which, angle, with_table, places)| Part::Turned { which, angle, with_table, places }),
        1 => (1..4_u32).prop_map(Part::Tool),
        1 => stands(4).prop_map(Part::Retract),
        1 => (0.5..60.0_f64, -180.0..180.0_f64, prop_oneof![-40.0..-5.0_f64, 5.0..40.0], 3..20_u32)
            .prop_map(|(lean, from, step, steps)| Part::Cone { lean, from, step, steps }),
    ]
}

/// The length of a tool of the program, millimetres.
fn length_of(tool: u32) -> f64 {
    60.0 + 15.0 * f64::from(tool)
}

/// The text of a program, and its goals.
struct Program<'a> {
    mill: &'a Mill,
    text: String,
    goals: Vec<Goal>,
}

impl Program<'_> {
    fn line(&mut self, line: &str) {
        self.text += line;
        self.text.push('\n');
    }

    fn scaled(&self, place: [f64; 3]) -> Vec3 {
        Vec3::from(place.map(|value| (value * self.mill.unit() * 1e6).round() / 1e6))
    }

    fn goto(&mut self, tip: Vec3, axis: Vec3, how: How) {
        let line =
            format!("GOTO/{:.6},{:.6},{:.6},{:.9},{:.9},{:.9}", tip.x, tip.y, tip.z, axis.x, axis.y, axis.z);
        self.line(&line);
        self.goals.push(Goal { unsure: 0.0, how, place: Place::Part(tip, axis) });
    }

    fn rapid(&mut self, (place, axis): Stand) {
        self.line("RAPID");
        let tip = self.scaled(place);
        self.goto(tip, axis, How::Rapid);
    }

    fn cut(&mut self, (place, axis): Stand) {
        let tip = self.scaled(place);
        self.goto(tip, axis, How::Cut);
    }

    fn tool(&mut self, tool: u32) {
        let length = length_of(tool) * self.mill.unit();
        self.line(&format!("LOADTL/{tool},LENGTH,{length:.6}\nSPINDL/1000,CLW"));
    }

    fn part(&mut self, part: &Part) {
        match part {
            Part::Cuts(stands) => self.cuts(stands),
            Part::Rapids(stands) => stands.iter().for_each(|stand| self.rapid(*stand)),
            Part::Fixed { axis, places, radius, steps } => {
                self.cuts(&places.iter().map(|place| (*place, *axis)).collect::<Vec<Stand>>());
                self.circle(places[places.len() - 1], *axis, *radius, *steps);
            }
            Part::Cone { lean, from, step, steps } => {
                let stand = |number: u32| {
                    let (sine, cosine) = (from + step * f64::from(number)).to_radians().sin_cos();
                    let (out, up) = lean.to_radians().sin_cos();
                    ([40.0 * cosine, 40.0 * sine, 10.0], Vec3::new(out * cosine, out * sine, up))
                };
                self.cuts(&(0..*steps).map(stand).collect::<Vec<Stand>>());
            }
            Part::Holes { axis, places } => self.holes(*axis, places),
            Part::Turned { which, angle, with_table, places } => {
                self.turned(*which, *angle, *with_table, places);
            }
            Part::Tool(tool) => {
                self.tool(*tool);
                self.goals.push(Goal { unsure: 0.0, how: How::Anyhow, place: Place::Nowhere });
            }
            Part::Retract(stands) => {
                self.cuts(stands);
                let (place, axis) = stands[stands.len() - 1];
                let (tip, plane) = (self.scaled(place), CLEAR_PLANE * self.mill.unit());
                self.line("RETRCT");
                let way = (plane - tip.z) / axis.z;
                let off = tip + axis * way;
                // The last decimals of the angles turn the tool about its end.
                let unsure = way * self.mill.last_of_angles().to_radians() / axis.z;
                self.goals.push(Goal { unsure, how: How::Rapid, place: Place::Part(off, axis) });
                self.line("PLUNGE");
                self.goals.push(Goal { unsure, how: How::Rapid, place: Place::Part(tip, axis) });
            }
        }
    }

    fn cuts(&mut self, stands: &[Stand]) {
        self.rapid(stands[0]);
        stands[1..].iter().for_each(|stand| self.cut(*stand));
    }

    fn circle(&mut self, from: [f64; 3], axis: Vec3, radius: f64, steps: u32) {
        let (start, radius) = (self.scaled(from), radius * self.mill.unit());
        let aside = axis.cross(&Vec3::ith(axis.iamin(), 1.0)).normalize();
        let center = start - aside * radius;
        let line = format!(
            "CIRCLE/{:.6},{:.6},{:.6},{:.9},{:.9},{:.9},{radius:.6}",
            center.x, center.y, center.z, axis.x, axis.y, axis.z
        );
        self.line(&line);
        for step in 1..=steps {
            let (sine, cosine) = (f64::from(step) * CIRCLE_STEP).to_radians().sin_cos();
            let tip = center + (aside * cosine + axis.cross(&aside) * sine) * radius;
            self.goto(tip, axis, How::Round { center, radius });
        }
    }

    fn holes(&mut self, axis: Vec3, places: &[[f64; 3]]) {
        let unit = self.mill.unit();
        let above = self.scaled(places[0]) + axis * (100.0 * unit);
        self.line("RAPID");
        self.goto(above, axis, How::Rapid);
        let (word, depth, clearance, feed) = (
            if self.mill.inches { "IPM" } else { "MMPM" },
            DEPTH * unit,
            CLEARANCE * unit,
            DRILL_FEED * unit,
        );
        self.line(&format!("CYCLE/DRILL,{depth:.6},{word},{feed:.6},{clearance:.6}"));
        for place in places {
            let top = self.scaled(*place);
            self.goto(top, axis, How::Drill);
            if let Some(goal) = self.goals.last_mut() {
                goal.place = Place::Part(top - axis * depth, axis);
            }
        }
        self.line("CYCLE/OFF");
        self.goals.push(Goal { unsure: 0.0, how: How::Anyhow, place: Place::Nowhere });
    }

    fn turned(&mut self, which: usize, angle: i32, with_table: bool, places: &[[f64; 3]]) {
        let word = |axis: usize| {
            let axis = &self.mill.axes[axis];
            format!("{}/{}AXIS", if axis.head { "ROTHED" } else { "ROTABL" }, axis.letter)
        };
        let words = [word(0), word(1)];
        let reference = if with_table { ",ROTREF" } else { "" };
        self.rapid(([0.0, 0.0, 150.0], Vec3::z()));
        // What states no direction keeps that of the machine.
        self.line("MULTAX/OFF");
        words.iter().for_each(|word| self.line(&format!("{word},ATANGL,0")));
        self.line(&format!("{},ATANGL,{angle}{reference}", words[which]));
        for (number, place) in places.iter().enumerate() {
            let place = self.scaled(*place);
            if number == 0 {
                self.line("RAPID");
            }
            self.line(&format!("GOTO/{:.6},{:.6},{:.6}", place.x, place.y, place.z));
            let mut angles = [0.0; 2];
            angles[which] = f64::from(angle);
            let how = if number == 0 { How::Anyhow } else { How::Cut };
            self.goals.push(Goal { unsure: 0.0, how, place: Place::Turned { place, angles, with_table } });
        }
        words.iter().for_each(|word| self.line(&format!("{word},ATANGL,0")));
        self.line("MULTAX");
        self.goals.push(Goal { unsure: 0.0, how: How::Anyhow, place: Place::Nowhere });
        self.rapid(([0.0, 0.0, 150.0], Vec3::z()));
    }
}

fn program<'a>(mill: &'a Mill, from: Option<Stand>, parts: &[Part]) -> Program<'a> {
    let mut program = Program { mill, text: String::new(), goals: Vec::new() };
    let unit = mill.unit();
    program.line(if mill.inches { "UNITS/INCHES" } else { "UNITS/MM" });
    program.line("MULTAX");
    program.tool(1);
    program.line(&format!("FEDRAT/{:.6}\nCLEARP/{:.6}", FEED * unit, CLEAR_PLANE * unit));
    if let Some((place, axis)) = from {
        let tip = program.scaled(place);
        program.line(&format!(
            "FROM/{:.6},{:.6},{:.6},{:.9},{:.9},{:.9}",
            tip.x, tip.y, tip.z, axis.x, axis.y, axis.z
        ));
    }
    program.rapid(([0.0, 0.0, 150.0], Vec3::z()));
    for part in parts {
        program.part(part);
    }
    program.line("FINI");
    program
}

fn any_case() -> impl Strategy<Value = (Mill, Option<Stand>, Vec<Part>)> {
    let from = prop::option::weighted(0.3, (any_place(), any_axis()));
    (any_mill(), from, prop::collection::vec(any_part(), 1..5))
}

/// The tape of a program, followed; none where it has errors. Any way can be divided, as far as no axis has an end on it.
fn check(mill: &Mill, from: Option<Stand>, parts: &[Part]) -> Option<Result<(), String>> {
    let program = program(mill, from, parts);
    let (records, errors) = read_text(&program.text);
    assert!(errors.is_empty(), "{errors:?}");
    let tape = post(&records, &mill.definition(), &PostOptions::default());
    let kinds = || tape.findings.iter().map(|finding| &finding.kind);
    let errors: Vec<&PostFindingKind> = kinds().filter(|kind| kind.severity() == Severity::Error).collect();
    // Behind a position that is left out nobody knows how far the axes have to turn.
    if !errors.is_empty() && errors.iter().all(|kind| matches!(kind, PostFindingKind::TooManyParts { .. })) {
        return Some(Err(format!("{errors:?}\n{}\n{}", program.text, tape.text())));
    }
    if !errors.is_empty() {
        return None;
    }
    let turned_back = kinds().any(|kind| matches!(kind, PostFindingKind::RotaryTurnedBack { .. }));
    let steps = read(mill, &tape.text());
    let length = |tool| length_of(tool) * mill.unit();
    let feeds = [FEED, DRILL_FEED].map(|feed| feed * mill.unit());
    let followed = follow(mill, &steps, &program.goals, &length, feeds, turned_back);
    Some(followed.map_err(|error| format!("{error}\n{:?}\n{}\n{}", tape.findings, program.text, tape.text())))
}

#[test]
fn the_tape_of_any_machine_leads_the_tool_along_the_program() {
    let cases = std::env::var("PROPTEST_CASES").ok().and_then(|text| text.parse().ok()).unwrap_or(300);
    let config = ProptestConfig { cases, failure_persistence: None, ..ProptestConfig::default() };
    let (all, left_out) = (Cell::new(0_u32), Cell::new(0_u32));
    let run = TestRunner::new(config).run(&any_case(), |(mill, from, parts)| {
        all.set(all.get() + 1);
        match check(&mill, from, &parts) {
            None => left_out.set(left_out.get() + 1),
            Some(followed) => followed.map_err(TestCaseError::fail)?,
        }
        Ok(())
    });
    run.unwrap_or_else(|error| panic!("{error}"));
    assert!(left_out.get() * 3 <= all.get(), "{} of {}", left_out.get(), all.get());
}
