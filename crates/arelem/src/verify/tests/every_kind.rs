//! Nothing is accepted by construction: over every kind of surface, in every role, with every shape of cutter, upright or
//! with a turning axis, a path is accepted as it is and rejected with one thing broken.

use apt_geometry::{
    Vec3,
    canonical::{Geometry, Remembering},
    cutter::Cutter,
    motion::{DriveSide, Relation},
    parametric::{Mesh, Patch, SculpturedSurface},
};

use super::{
    super::{
        Rule,
        clearance::{Clearance, Reading, Surface},
        tool::Profile,
        verify,
    },
    cone, cutter, cylinder,
    paths::BAND,
    plane, quadric, role, sphere, tabulated,
};
use crate::sequence::{CutSequence, Role, Stop, ToolPosition};

/// Numbers of vectors that are tried until one is enough.
const COUNTS: [usize; 14] = [1, 3, 4, 5, 7, 9, 12, 16, 21, 27, 35, 46, 60, 80];
/// Where in the band the positions lie: in its middle.
const AIM: f64 = 0.5 * (BAND.1 - BAND.0);
/// Width of the band.
const TAU: f64 = BAND.0 + BAND.1;

/// A surface, a way over it, and a height from which a tool comes down to it.
struct Ground {
    name: &'static str,
    geometry: Geometry,
    from: [f64; 2],
    to: [f64; 2],
    height: f64,
}

fn ground(name: &'static str, height: f64, geometry: Geometry) -> Ground {
    Ground { name, geometry, from: [-0.8, 0.4], to: [0.8, 0.3], height }
}

fn unnamed_quadric(coefficients: [f64; 10]) -> apt_geometry::canonical::Quadric {
    apt_geometry::canonical::Quadric { coefficients }
}

fn closed_forms() -> Vec<Ground> {
    let Geometry::Plane(flat) = plane([0.2, 0.0, 1.0], 0.0) else { panic!("a plane") };
    let Geometry::Cylinder(round) = cylinder([0.0, 0.0, -2.0], [0.0, 1.0, 0.0], 2.0) else {
        panic!("a cylinder")
    };
    vec![
        ground("plane", 3.0, plane([0.1, 0.2, 1.0], 0.0)),
        ground("line", 3.0, Geometry::Line(flat)),
        ground("circle", 3.0, Geometry::Circle(round)),
        ground("cylinder", 3.0, cylinder([0.0, 0.0, -2.0], [0.3, 1.0, 0.1], 2.0)),
        ground("hollow cylinder", 2.0, cylinder([0.0, 0.0, 4.0], [0.2, 1.0, 0.0], 4.0)),
        ground("sphere", 3.0, sphere([0.0, 0.0, -3.0], 3.0)),
        ground("hollow sphere", 2.0, sphere([0.0, 0.0, 4.0], 4.0)),
        ground("cone", 4.0, cone([0.0, -2.5, 1.5], [0.0, 0.2, -1.0], 55.0)),
        ground("hollow cone", 1.0, cone([0.3, -1.0, -3.0], [0.0, 0.1, 1.0], 50.0)),
    ]
}

fn quadrics() -> Vec<Ground> {
    let bare = [0.0; 3];
    let form = |squares: [f64; 3], constant: f64, rise: f64| {
        let [a, b, c] = squares;
        let [f, g, h] = bare;
        [a, b, c, constant, f, g, h, 0.0, 0.0, rise]
    };
    let conic = |squares, constant, rise| unnamed_quadric(form(squares, constant, rise));
    vec![
        ground("ellipsoid", 4.0, quadric(form([1.0 / 16.0, 1.0 / 9.0, 0.25], -1.0, 0.0))),
        ground("dish", 2.0, quadric(form([0.1, 0.05, 0.0], -1.0, -0.5))),
        ground("saddle", 3.0, quadric([0.2, -0.15, 0.0, 0.0, 0.0, 0.0, 0.05, 0.0, 0.0, 0.5])),
        ground("hyperboloid", 4.0, quadric(form([-1.0 / 9.0, 0.25, 0.25], -1.0, 0.0))),
        ground("two sheets", 4.0, quadric(form([-0.25, -0.25, 0.25], -1.0, 0.0))),
        ground("ellipse", 3.0, Geometry::Ellipse(conic([0.25, 0.0, 1.0], -1.0, 0.0))),
        ground("hyperbola", 3.0, Geometry::Hyperbola(conic([-0.25, 0.0, 1.0], -1.0, 0.0))),
        ground("parabola", 3.0, Geometry::GeneralConic(conic([0.3, 0.0, 0.0], 0.0, 0.5))),
        ground("loft conic", 3.0, Geometry::LoftConic(conic([-0.2, 0.0, 0.0], 0.0, 0.5))),
    ]
}

fn tabulated_cylinder() -> Vec<Ground> {
    let wave = |k: i32| {
        let u = 0.5 * f64::from(k);
        [u, 0.3 * u.sin(), 0.3 * u.cos()]
    };
    let nodes: Vec<[f64; 3]> = (-6..=6).map(wave).collect();
    vec![ground("tabulated cylinder", 2.0, tabulated([Vec3::x(), Vec3::z(), -Vec3::y()], &nodes))]
}

/// A hill of one patch.
fn sculptured() -> Vec<Ground> {
    let heights =
        [[-0.9, -0.3, -0.4, -1.0], [-0.2, 0.5, 0.4, -0.4], [-0.1, 0.6, 0.3, -0.2], [-0.8, -0.2, -0.5, -1.2]];
    let hill = Patch::from_points(&std::array::from_fn(|i| {
        std::array::from_fn(|j| Vec3::new(1.6 * i as f64 - 2.4, 1.4 * j as f64 - 2.1, heights[i][j]))
    }));
    let surface = SculpturedSurface::assembled(vec![hill], None, Vec::new(), 1.0, Mesh::default());
    vec![ground("patch", 2.0, Geometry::Sculptured(Remembering::new(surface)))]
}

/// All shapes of cutters, so short that they fit into the hollow surfaces when they lie.
fn cutters() -> Vec<(&'static str, Cutter)> {
    [
        ("ball", [0.5, 0.25, 0.0, 0.25, 0.0, 0.0, 1.2]),
        ("flat", [0.5, 0.0, 0.25, 0.0, 0.0, 0.0, 1.2]),
        ("bull", [0.5, 0.1, 0.15, 0.1, 0.0, 0.0, 1.2]),
        ("tapered", [0.4, 0.0, 0.2, 0.0, 0.0, 10.0, 1.2]),
        ("drill", [0.5, 0.0, 0.25, 0.25 * 31f64.to_radians().tan(), 31.0, 0.0, 1.2]),
        ("bell", [0.6, 0.11, 0.2, 0.13, 10.0, 5.0, 1.2]),
        ("lens", [1.0, 0.1875, 0.33, 0.22, 8.0, 5.0, 1.2]),
        ("line", [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.2]),
    ]
    .map(|(name, numbers)| (name, cutter(&numbers)))
    .into()
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Way {
    /// Over the surface as part surface, the tool upright.
    Part,
    /// The same, the axis turning.
    Turning,
    /// Along the surface as drive surface, the tool lying.
    Drive,
}

/// A tool over a ground.
struct Course<'a> {
    ground: &'a Ground,
    cutter: Cutter,
    profile: Profile,
    surface: Surface,
    side: f64,
    way: Way,
}

impl<'a> Course<'a> {
    fn new(ground: &'a Ground, cutter: Cutter, way: Way) -> Self {
        let surface = Surface::of(&ground.geometry).unwrap();
        let [x, y] = ground.from;
        let mut above = Vec3::new(x, y, ground.height);
        // The side that is up where the surface is.
        let (distance, normal) = surface.point_distance(&above).unwrap();
        above -= normal * (0.9 * distance);
        let side = surface.point_distance(&above).unwrap().1.z.signum();
        Self { ground, cutter, profile: Profile::of(&cutter).unwrap(), surface, side, way }
    }

    fn forward(&self) -> Vec3 {
        let ([x, y], [u, v]) = (self.ground.from, self.ground.to);
        Vec3::new(u - x, v - y, 0.0)
    }

    fn across(&self) -> Vec3 {
        Vec3::z().cross(&self.forward()).normalize()
    }

    fn axis(&self, share: f64) -> Vec3 {
        match self.way {
            Way::Part => Vec3::z(),
            Way::Turning => Vec3::new(0.3 * share - 0.1, 0.1, 1.0).normalize(),
            Way::Drive => self.across(),
        }
    }

    fn reading(&self, place: &ToolPosition) -> Reading {
        let clearance = Clearance::new(&self.surface, &self.profile, self.side);
        clearance.at(&place.tip, &place.axis).unwrap()
    }

    /// The tool let down until its clearance is in the middle of the band.
    fn place(&self, share: f64) -> ToolPosition {
        let start = Vec3::new(self.ground.from[0], self.ground.from[1], 0.0) + self.forward() * share;
        let mut place = ToolPosition { tip: start + Vec3::z() * self.ground.height, axis: self.axis(share) };
        for step in 0..100 {
            let reading = self.reading(&place);
            let left = reading.value - AIM;
            if left.abs() < 1e-7 {
                break;
            }
            let slope = if step < 6 { 1.0 } else { reading.normal.z.max(0.3) };
            place.tip.z -= left / slope;
        }
        place
    }

    fn plane_through(&self, normal: Vec3, place: &Vec3) -> Role {
        role(plane(normal.into(), normal.dot(place)), Relation::On, 1.0, BAND.0, BAND.1)
    }

    fn ground_role(&self, relation: Relation) -> Role {
        role(self.ground.geometry.clone(), relation, self.side, BAND.0, BAND.1)
    }

    fn sequence(&self, count: usize) -> CutSequence {
        let places: Vec<ToolPosition> = (0..=count).map(|k| self.place(k as f64 / count as f64)).collect();
        let (first, end) = (places[0], places[count]);
        let ours = self.ground_role(Relation::To);
        let wall = self.plane_through(self.across(), &first.tip);
        let (part, drive, drive_side) = match self.way {
            Way::Drive => (Role { relation: Relation::To, ..wall }, ours, DriveSide::Right),
            _ => (ours, wall, DriveSide::On),
        };
        CutSequence {
            start: first,
            points: places[1..].to_vec(),
            cutter: self.cutter,
            part: Some(part),
            drive: Some(drive),
            stop: Some(Stop {
                role: self.plane_through(self.forward().normalize(), &end.tip),
                occurrence: 1,
                index: 0,
            }),
            drive_side,
            start_up: false,
            forward: (places[1].tip - first.tip).normalize(),
            maximum_step: 10.0,
            minimum: None,
        }
    }

    fn rule(&self) -> Rule {
        if self.way == Way::Drive { Rule::DriveBand } else { Rule::PartBand }
    }

    fn ours<'b>(&self, sequence: &'b mut CutSequence) -> &'b mut Role {
        let role = if self.way == Way::Drive { &mut sequence.drive } else { &mut sequence.part };
        role.as_mut().unwrap()
    }
}

fn rules(sequence: &CutSequence) -> Vec<Rule> {
    verify(sequence, &|| false).unwrap().violations.iter().map(|v| v.rule).collect()
}

/// What the mutations of one course showed.
#[derive(Default)]
struct Tally {
    courses: usize,
    dropped: usize,
}

fn break_one_thing(course: &Course<'_>, name: &str, tally: &mut Tally) {
    let enough = COUNTS.partition_point(|count| !rules(&course.sequence(*count)).is_empty());
    let sequence = course.sequence(*COUNTS.get(enough).unwrap_or(&104));
    let evidence = verify(&sequence, &|| false).unwrap();
    assert!(evidence.verified, "{name}: {evidence:?}");
    let (wanted, count) = (course.rule(), sequence.points.len());
    for (index, sense) in [(0, 1.5), (count / 2, 1.5), (count / 2, -1.5), (count - 1, -1.5)] {
        let normal = course.reading(&sequence.points[index]).normal;
        let mut broken = sequence.clone();
        broken.points[index].tip += normal * (sense * TAU);
        assert!(rules(&broken).contains(&wanted), "{name}: shifted by {sense} at {index} of {count}");
    }
    let mut turned = sequence.clone();
    course.ours(&mut turned).side *= -1.0;
    assert!(rules(&turned).contains(&wanted), "{name}: on the other side");
    if course.way == Way::Drive {
        let mut turned = sequence.clone();
        turned.drive_side = DriveSide::Left;
        assert!(rules(&turned).contains(&Rule::Side), "{name}: left and right");
    }
    if count > 3 {
        // The path needs so many positions: at least where it is bent most none can be left out.
        let needed = (0..count - 1).any(|index| {
            let mut broken = sequence.clone();
            broken.points.remove(index);
            rules(&broken).contains(&wanted)
        });
        assert!(needed, "{name}: each of {count} positions can be left out");
        tally.dropped += 1;
    }
    let mut short = sequence.clone();
    short.points.pop();
    if count > 1 {
        assert!(rules(&short).contains(&Rule::CheckBand), "{name}: without the last position");
    }
    tally.courses += 1;
}

/// Straight down to the surface, TO it, or straight up out of it, PAST it: each is not the other.
fn swap_to_and_past(ground: &Ground, name: &str, tool: Cutter) {
    let course = Course::new(ground, tool, Way::Part);
    let end = course.place(0.5);
    let at = |rise: f64| ToolPosition { tip: end.tip + Vec3::z() * rise, ..end };
    for (relation, other, from) in
        [(Relation::To, Relation::Past, 0.3), (Relation::Past, Relation::To, -0.15)]
    {
        let start = at(from);
        let sequence = CutSequence {
            start,
            points: vec![end],
            cutter: tool,
            part: Some(course.plane_through(course.across(), &end.tip)),
            drive: Some(course.plane_through(course.forward().normalize(), &end.tip)),
            stop: Some(Stop { role: course.ground_role(relation), occurrence: 1, index: 0 }),
            drive_side: DriveSide::On,
            start_up: false,
            forward: Vec3::z() * -from.signum(),
            maximum_step: 10.0,
            minimum: None,
        };
        assert_eq!(rules(&sequence), [], "{name}: {relation:?}");
        let mut swapped = sequence.clone();
        swapped.stop.as_mut().unwrap().role.relation = other;
        assert!(rules(&swapped).contains(&Rule::StopEvent), "{name}: {relation:?} called {other:?}");
        let mut turned = sequence.clone();
        turned.stop.as_mut().unwrap().role.side *= -1.0;
        assert!(rules(&turned).contains(&Rule::CheckBand), "{name}: {relation:?} from the other side");
        let mut moved = sequence;
        moved.points[0].tip += course.reading(&end).normal * (1.5 * TAU);
        assert!(rules(&moved).contains(&Rule::CheckBand), "{name}: {relation:?} shifted");
    }
}

fn try_all(grounds: &[Ground], ways: &[Way]) -> Tally {
    let mut tally = Tally::default();
    for ground in grounds {
        for (shape, tool) in cutters() {
            let name = format!("{shape} and {}", ground.name);
            // The general search has to settle pointed tools over saddles, and on quadrics a turning axis takes many of its
            // distances: these are left to the tools and ways that are quick.
            let saddle = ["saddle", "hyperboloid"].contains(&ground.name);
            let pointed = ["drill", "bell", "lens"].contains(&shape);
            let searched = saddle && pointed;
            // Patches are searched more slowly than other surfaces: one shape stands for all.
            let patches = matches!(ground.geometry, Geometry::Sculptured(_));
            if patches && shape != "ball" {
                continue;
            }
            let long = saddle || pointed && matches!(ground.geometry, Geometry::Quadric(_));
            let is_quick = |way: &&Way| match way {
                Way::Part => !searched,
                Way::Turning => !long,
                Way::Drive => true,
            };
            for way in ways.iter().filter(is_quick) {
                break_one_thing(&Course::new(ground, tool, *way), &format!("{name}, {way:?}"), &mut tally);
            }
            if ways.contains(&Way::Part) && tool.diameter > 0.0 && !searched {
                swap_to_and_past(ground, &name, tool);
            }
        }
    }
    tally
}

#[test]
fn closed_forms_in_every_role() {
    let tally = try_all(&closed_forms(), &[Way::Part, Way::Drive]);
    assert!(tally.courses == 144 && tally.dropped > 90, "{} {}", tally.courses, tally.dropped);
}

#[test]
fn closed_forms_with_a_turning_axis() {
    let tally = try_all(&closed_forms(), &[Way::Turning]);
    assert!(tally.courses == 72 && tally.dropped > 40, "{} {}", tally.courses, tally.dropped);
}

#[test]
fn quadrics_in_every_role() {
    let tally = try_all(&quadrics(), &[Way::Part, Way::Drive]);
    assert!(tally.courses == 138 && tally.dropped > 90, "{} {}", tally.courses, tally.dropped);
}

#[test]
fn quadrics_with_a_turning_axis() {
    let some: Vec<Ground> =
        quadrics().into_iter().filter(|g| ["ellipsoid", "dish", "parabola"].contains(&g.name)).collect();
    let tally = try_all(&some, &[Way::Turning]);
    assert!(tally.courses == 5 + 5 + 8 && tally.dropped > 8, "{} {}", tally.courses, tally.dropped);
}

#[test]
fn sculptured_surfaces_in_every_role() {
    let tally = try_all(&sculptured(), &[Way::Part, Way::Drive]);
    assert!(tally.courses == 2 && tally.dropped > 0, "{} {}", tally.courses, tally.dropped);
}

#[test]
fn tabulated_cylinders_in_every_role_and_with_a_turning_axis() {
    let tally = try_all(&tabulated_cylinder(), &[Way::Part, Way::Drive, Way::Turning]);
    assert!(tally.courses == 24 && tally.dropped > 12, "{} {}", tally.courses, tally.dropped);
}
