//! The least number of cut vectors that is told, beside the least that dynamic programming finds where part and drive surface both bend. Clearances
//! are told by the closed forms of a ball about its centre here, not by the engine.

use DriveSide::{Left, Right};
use Relation::{On, To};

use super::{random::Random, *};

/// Radius of the ball cutter, small against all surfaces.
const BALL: f64 = 0.1;
/// Motions that are tried.
const CASES: u32 = 72;
/// Places along the path for each vector of the engine, and clearances of each role, between which vectors are looked for.
const PLACES: usize = 12;
const ACROSS: usize = 7;
/// Columns of places that a vector may miss before others that it leads to.
const MISSED: u32 = 2;
/// Places of a vector at which its clearances are measured: a parabola sags between them by a 1600th of what it does in all.
const SAMPLES: u32 = 40;
/// Steps of a bisection, after which no digit changes.
const STEPS: u32 = 60;
/// What a clearance may be beyond a limit by rounding, a millionth of the narrowest band.
const ROUNDING: f64 = 5e-10;
/// Half width of the band of the check surface.
const CHECK: f64 = 1e-4;

/// Share of the vectors found that are told to be needed, over all cases.
const TOLD: f64 = 0.95;

/// A surface about which the centre of the ball is at a distance.
enum Round {
    Ball {
        center: Vec3,
        radius: f64,
    },
    Tube {
        point: Vec3,
        axis: Vec3,
        radius: f64,
        inside: bool,
    },
    /// An ellipse in x and y with its centre and half axes, the tool outside.
    Ellipse {
        center: [f64; 2],
        half: [f64; 2],
    },
}

impl Round {
    fn geometry(&self) -> Geometry {
        match *self {
            Self::Ball { center, radius } => sphere(center.x, center.y, center.z, radius),
            Self::Tube { point, axis, radius, .. } => cylinder(point, axis, radius),
            Self::Ellipse { center: [x, y], half: [a, b] } => {
                let (a, b) = (a.powi(-2), b.powi(-2));
                let rest = a * x * x + b * y * y - 1.0;
                quadric([a, b, 0.0, rest, 0.0, 0.0, 0.0, -a * x, -b * y, 0.0])
            }
        }
    }

    /// The clearance of a tool whose ball is at a place.
    fn clearance(&self, ball: &Vec3) -> f64 {
        match self {
            Self::Ball { center, radius } => (ball - center).norm() - radius - BALL,
            Self::Tube { point, axis, radius, inside } => {
                let away = (ball - point).cross(axis).norm() - radius;
                if *inside { -away - BALL } else { away - BALL }
            }
            Self::Ellipse { center, half } => {
                beside_ellipse([ball.x - center[0], ball.y - center[1]], *half) - BALL
            }
        }
    }
}

/// Distance from an ellipse of a place outside of it: the nearest place is x·a²/(a² + t), y·b²/(b² + t), with the t ≥ 0 that is on it.
fn beside_ellipse([x, y]: [f64; 2], [a, b]: [f64; 2]) -> f64 {
    let at = |t: f64| [x * a * a / (a * a + t), y * b * b / (b * b + t)];
    let beyond = |t: f64| {
        let [u, v] = at(t);
        (u / a).powi(2) + (v / b).powi(2) - 1.0
    };
    // Convex and falling: Newton's method comes from the left and does not lead past.
    let mut t = 0.0;
    for _ in 0..STEPS {
        let slope = -2.0 * ((x * a).powi(2) / (a * a + t).powi(3) + (y * b).powi(2) / (b * b + t).powi(3));
        let next = t - beyond(t) / slope;
        if next <= t {
            break;
        }
        t = next;
    }
    let [u, v] = at(t);
    (x - u).hypot(y - v)
}

/// Where a function that rises is a value, between two places.
fn where_it_is(value: f64, [mut low, mut high]: [f64; 2], rising: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..STEPS {
        let middle = 0.5 * (low + high);
        if rising(middle) < value { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// A motion with the tool on the part surface and beside the drive surface, from one x to another.
struct Case {
    part: Round,
    drive: Round,
    side: DriveSide,
    /// Half the length of the motion.
    reach: f64,
    /// The clearances that part and drive surface allow.
    bands: [[f64; 2]; 2],
}

impl Case {
    fn random(seed: u32) -> Self {
        let mut numbers = Random(u64::from(seed) + 1);
        let mut random = |from: f64, to: f64| numbers.between(from, to);
        let radius = random(1.0, 4.0);
        let below = v(random(-0.2, 0.2), random(-0.2, 0.2), -radius);
        let (s, c) = random(-1.5, 1.5).sin_cos();
        let part = if seed.is_multiple_of(2) {
            Round::Tube { point: below, axis: v(c, s, 0.0), radius, inside: false }
        } else {
            Round::Ball { center: below, radius }
        };
        let (wide, deep) = (random(1.0, 4.0), random(1.0, 4.0));
        let inside = seed % 3 == 1;
        let drive = if seed % 3 == 2 {
            Round::Ellipse { center: [0.0, -deep], half: [wide, deep] }
        } else {
            let point = v(0.0, if inside { deep } else { -deep }, 0.0);
            Round::Tube { point, axis: v(0.0, 0.0, 1.0), radius: deep, inside }
        };
        let mut band = || {
            let (width, below) = (10f64.powf(random(-3.3, -2.0)), random(0.0, 1.0));
            [-below * width, (1.0 - below) * width]
        };
        let bands = [band(), band()];
        let reach = random(0.3, 0.6) * deep.min(wide).min(radius);
        Self { part, drive, side: if inside { Right } else { Left }, reach, bands }
    }

    /// The motion as the engine makes it.
    fn run(&self) -> CutSequence {
        let [[part_in, part_out], [drive_in, drive_out]] = self.bands;
        let per_role = |part: f64, drive: f64| PerRole { part, drive, check: [CHECK; 2] };
        let (part, drive) = (self.part.geometry(), self.drive.geometry());
        let mut p = Program::new();
        p.run(&MotionCommand::MaximumPoints(10_000)).cutter(&[2.0 * BALL, BALL]);
        p.run(&MotionCommand::InsideTolerance(per_role(-part_in, -drive_in)));
        p.run(&MotionCommand::OutsideTolerance(per_role(part_out, drive_out)));
        let near = self.place(-self.reach, [0.0; 2]) - Vec3::z() * BALL;
        p.from(near.x, near.y + 0.05, near.z + 0.05);
        p.go(&[(To, &drive), (To, &part), (On, &x(-self.reach))]);
        p.indirv(1.0, 0.0, 0.0).side(self.side).drive(Turn::Forward, &drive, On, &x(self.reach));
        p.last().clone()
    }

    /// The centre of the ball with an x and clearances from part and drive surface.
    fn place(&self, x: f64, [part, drive]: [f64; 2]) -> Vec3 {
        let near = 2.0 * BALL;
        let beside = |y: f64| self.drive.clearance(&v(x, y, 0.0));
        // The walls touch the x axis, from below or, around the tool, from above.
        let y = match &self.drive {
            Round::Tube { radius, inside: true, .. } => where_it_is(drive, [0.0, *radius], beside),
            Round::Tube { radius, .. } => where_it_is(drive, [-radius, near], beside),
            Round::Ellipse { half, .. } => where_it_is(drive, [-0.9 * half[1], near], beside),
            Round::Ball { .. } => unreachable!("no wall"),
        };
        let (Round::Tube { radius, .. } | Round::Ball { radius, .. }) = &self.part else {
            unreachable!("no part surface")
        };
        v(x, y, where_it_is(part, [-radius, near], |z| self.part.clearance(&v(x, y, z))))
    }

    /// Whether a vector keeps both bands. Its ends do.
    fn keeps(&self, from: &Vec3, to: &Vec3) -> bool {
        // The middle first, where it leaves them most.
        let mut shares = std::iter::once(SAMPLES / 2).chain(1..SAMPLES);
        shares.all(|k| {
            let share = f64::from(k) / f64::from(SAMPLES);
            let place = from + (to - from) * share;
            [(&self.part, self.bands[0]), (&self.drive, self.bands[1])].into_iter().all(
                |(surface, [low, high])| {
                    let clearance = surface.clearance(&place);
                    clearance >= low - ROUNDING && clearance <= high + ROUNDING
                },
            )
        })
    }

    /// The fewest vectors from a place to the band of the check surface, between places that lie as far apart as a share of the path and at
    /// clearances from limit to limit of both bands, and those that a sequence leads to.
    fn fewest(&self, start: Vec3, led_to: &[Vec3], places: usize) -> u32 {
        let level = |[low, high]: [f64; 2], j: usize| low + (high - low) * j as f64 / (ACROSS - 1) as f64;
        let column = |x: f64| -> Vec<Vec3> {
            let both = (0..ACROSS).flat_map(|j| (0..ACROSS).map(move |k| [j, k]));
            both.map(|[j, k]| self.place(x, [level(self.bands[0], j), level(self.bands[1], k)])).collect()
        };
        let end = self.reach - CHECK;
        let along =
            |i: usize| if i == places { end } else { start.x + (end - start.x) * i as f64 / places as f64 };
        let mut columns: Vec<Vec<Vec3>> = (1..=places).map(|i| column(along(i))).collect();
        columns.extend(led_to.iter().map(|place| vec![*place]));
        columns.sort_by(|a, b| a[0].x.total_cmp(&b[0].x));
        let mut seen: Vec<Vec<bool>> = columns.iter().map(|column| vec![false; column.len()]).collect();
        let mut layer = vec![(0, start)];
        for vectors in 1.. {
            let mut next = Vec::new();
            for (begin, from) in &layer {
                // How many columns one after the other no vector leads to; one with a single place may be missed.
                let mut missed = 0;
                for (i, column) in columns.iter().enumerate().skip(*begin) {
                    missed += 1;
                    for (place, seen) in column.iter().zip(&mut seen[i]) {
                        // One that is reached already may still be one that this vector leads to.
                        if *seen {
                            missed = 0;
                        } else if self.keeps(from, place) {
                            (*seen, missed) = (true, 0);
                            next.push((i + 1, *place));
                        }
                    }
                    if missed > MISSED {
                        break;
                    }
                }
            }
            if next.iter().any(|(_, place): &(usize, Vec3)| place.x >= end) {
                return vectors;
            }
            assert!(!next.is_empty(), "no vector leads on after {vectors}");
            layer = next;
        }
        unreachable!("layers end")
    }
}

/// No sequence between any places of the bands has fewer vectors than the engine tells to be needed, whichever surfaces bend.
#[test]
fn no_sequence_beside_two_bent_surfaces_has_fewer_vectors_than_are_told() {
    let (mut tight, mut told, mut found, mut made) = (0, 0, 0, 0);
    for seed in 0..CASES {
        let case = Case::random(seed);
        let sequence = case.run();
        let (count, least) = (sequence.points.len() as u32, sequence.minimum.expect("a bound"));
        let ball = |position: &ToolPosition| position.tip + Vec3::z() * BALL;
        let led_to: Vec<Vec3> = sequence.points.iter().map(ball).collect();
        for place in &led_to {
            // The closed forms are those of the surfaces that the engine has been told.
            for (surface, [low, high]) in [(&case.part, case.bands[0]), (&case.drive, case.bands[1])] {
                let clearance = surface.clearance(place);
                assert!(clearance >= low - ROUNDING && clearance <= high + ROUNDING, "{seed}: {clearance}");
            }
        }
        let fewest = case.fewest(ball(&sequence.start), &led_to, PLACES * count as usize);
        assert!(least <= fewest, "{seed}: {least} told, {fewest} found, {count} made");
        (tight, told, found, made) =
            (tight + u32::from(least == fewest), told + least, found + fewest, made + count);
    }
    println!("{told} told, {found} found, {made} made; all of {tight} of {CASES}");
    assert!(f64::from(told) >= TOLD * f64::from(found), "{told} told, {found} found");
}
