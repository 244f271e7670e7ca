//! One random motion: a tool at a place, surfaces laid against it, and the commands that a part program would give.

use apt_geometry::{
    Vec3,
    canonical::{Geometry, Matrix},
    cutter::Cutter,
    motion::{
        CheckSurface, Delta, Direction, DriveSide, MotionCommand, NamedSurface, PartSide, PerRole, Relation,
        StartSurface, Turn,
    },
    surface::Surface,
};
use nalgebra::{Rotation3, Unit};

use crate::{
    judge::Budget,
    kinds::{self, Kind},
    search::{Reader, Wanted},
    support::{Random, named},
    tools,
};

/// Share of the motions whose surfaces are laid anywhere near the tool, so that nothing says that there is a path.
const LOOSE: f64 = 0.15;
/// Sine between part and drive surface at least, and between drive surface and tool axis plane.
const LEAST_SINE: f64 = 0.3;
/// Share of the check surfaces to which distances are searched for: with one of them a motion takes a hundred times as long.
const SLOW_STOPS: f64 = 0.01;
/// Share of the motions from a sure place that stop at a tangency.
const TANGENT: f64 = 0.12;
/// How far before and after a tangency it is looked whether there is one.
const TANGENT_WAY: f64 = 0.05;
/// Half the difference of the curvatures along the path that makes a tangency.
const LEAST_BEND: f64 = 0.02;
/// Share of the check surfaces that are met a second time, if they can be.
const RETURNS: f64 = 0.12;
/// Share of the start-ups that go past the drive surface.
const PASSES: f64 = 0.1;
/// Share of the motions with a GODLTA before the start-up.
const DELTAS: f64 = 0.2;
/// Draws of a case before another seed is taken.
const DRAWS: u32 = 200;
/// Draws of a case that must be as wished.
const WISHED_DRAWS: u32 = 2000;
/// Draws of a place to come from.
const APPROACHES: u32 = 40;

/// Cosine between the axis of a tool that stands beside a drive surface and the normal of that.
const BESIDE: f64 = 0.3;

/// How the tool stands on the part surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Stance {
    /// However it is drawn.
    Any,
    /// Along the normal.
    Square,
    /// Along the normal, with its end ON the surface.
    SquareOn,
    /// However it is drawn on the part surface, but nearly along the drive surface.
    Beside,
}

impl Stance {
    fn is_square(self) -> bool {
        matches!(self, Self::Square | Self::SquareOn)
    }
}

/// A surface in its role.
#[derive(Debug, Clone)]
pub(crate) struct Placed {
    pub(crate) geometry: Geometry,
    pub(crate) relation: Relation,
    /// Side of the natural normal on which the tool ends.
    pub(crate) side: f64,
    /// As check surface: which position stops the motion.
    pub(crate) occurrence: u32,
    /// THICK for it.
    pub(crate) thickness: f64,
}

/// What a case must be like, with a path for sure; what is not said is drawn.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Wish {
    /// Shape of the tool.
    pub(crate) shape: Option<&'static str>,
    /// No line and no point.
    pub(crate) is_wide: bool,
    /// TLONPS or TLOFPS.
    pub(crate) part_on: Option<bool>,
    pub(crate) drive: Option<DriveSide>,
    /// THICK of part, drive and check surface.
    pub(crate) thickness: Option<[f64; 3]>,
    /// The check surface, its relation and the count before INTOF.
    pub(crate) stop: Option<(Kind, Relation, u32)>,
    /// The third surface of the start-up.
    pub(crate) first: Option<(Kind, Relation)>,
    /// Surfaces of the start-up.
    pub(crate) surfaces: Option<usize>,
    /// Whether the start-up goes past the drive surface.
    pub(crate) passes_drive: Option<bool>,
}

impl Wish {
    /// A tool with a diameter, so that every stock has a meaning.
    pub(crate) fn wide() -> Self {
        Self { is_wide: true, ..Self::default() }
    }
}

/// A motion, and what is asked of it. Lengths in program units.
#[derive(Debug, Clone)]
pub(crate) struct Case {
    pub(crate) cutter: Vec<f64>,
    pub(crate) shape: &'static str,
    pub(crate) axis: Vec3,
    /// Where the tool comes from.
    pub(crate) from: Vec3,
    /// Where it is meant to touch part and drive surface first; where the motion stops at a tangency, there.
    pub(crate) place: Vec3,
    pub(crate) part: Placed,
    pub(crate) drive: Placed,
    /// The plane that the start-up ends on, if it has three surfaces.
    pub(crate) first: Placed,
    /// Surfaces of the start-up; with one the part surface is implied.
    pub(crate) surfaces: usize,
    /// The tool comes from the other side of the drive surface: PAST at start-up.
    pub(crate) passes_drive: bool,
    /// GODLTA before the start-up.
    pub(crate) delta: Option<Vec3>,
    pub(crate) stop: Placed,
    /// Distances to the check surface are searched for.
    pub(crate) has_slow_stop: bool,
    /// What may be spent on the motion.
    pub(crate) budget: Budget,
    pub(crate) inside: f64,
    pub(crate) outside: f64,
    pub(crate) drive_side: DriveSide,
    pub(crate) forward: Vec3,
    /// How far along the path the check surface was laid.
    pub(crate) reach: f64,
    pub(crate) maximum_step: f64,
    /// True if `place` satisfies the start-up.
    pub(crate) is_certain: bool,
}

impl Case {
    /// The motion that a seed stands for; None if no draw was a case.
    pub(crate) fn draw(part: Kind, drive: Kind, seed: u64) -> Option<Self> {
        Self::draw_standing(part, drive, Stance::Any, seed)
    }

    /// The same for a tool that stands on the part surface in a certain way.
    pub(crate) fn draw_standing(part: Kind, drive: Kind, stance: Stance, seed: u64) -> Option<Self> {
        let mut random = Random(seed);
        (0..DRAWS).find_map(|_| Self::attempt((part, drive), stance, None, &mut random))
    }

    /// A case that is as wished.
    pub(crate) fn wished(part: Kind, drive: Kind, wish: &Wish, seed: u64) -> Option<Self> {
        let mut random = Random(seed);
        (0..WISHED_DRAWS).find_map(|_| Self::attempt((part, drive), Stance::Any, Some(wish), &mut random))
    }

    fn attempt(
        (part_kind, drive_kind): (Kind, Kind),
        stance: Stance,
        asked: Option<&Wish>,
        random: &mut Random,
    ) -> Option<Self> {
        let wish = asked.copied().unwrap_or_default();
        let (shape, numbers) = tools::wished(wish.shape, random);
        if wish.shape.is_some_and(|wished| wished != shape) || wish.is_wide && numbers[0] == 0.0 {
            return None;
        }
        let cutter = Cutter::from_numbers(&numbers, 1.0).ok()?;
        let is_certain = random.next() >= LOOSE || asked.is_some();
        let place =
            Vec3::new(random.between(-2.0, 2.0), random.between(-2.0, 2.0), random.between(-2.0, 2.0));
        let (axis, up) = axis_and_part_normal(part_kind, random)?;
        let axis = if stance.is_square() { up } else { axis };
        let out = drive_normal(drive_kind, &axis, &up, random)?;
        if stance == Stance::Beside && out.dot(&axis).abs() > BESIDE {
            return None;
        }
        let along = up.cross(&out).normalize() * random.pick(&[1.0, -1.0]);
        let sine = along.cross(&out).dot(&axis);
        if sine.abs() < LEAST_SINE {
            return None;
        }
        let part_on = random.next() < 0.15 || stance == Stance::SquareOn;
        let drive_on = random.next() < 0.25;
        let part_on = wish.part_on.unwrap_or(part_on);
        let drive_on = wish.drive.map_or(drive_on, |side| side == DriveSide::On);
        let thickness = if random.next() < 0.25 { random.between(0.01, 0.2) } else { 0.0 };
        let [part_thickness, drive_thickness, check_thickness] = wish.thickness.unwrap_or([thickness; 3]);
        let is_tangent = is_certain && random.next() < TANGENT;
        let is_tangent = wish.stop.map_or(is_tangent, |(_, relation, _)| is_tangency(relation));
        // At a tangency all three surfaces meet at clearance zero, which must not be the limit of a band.
        let (inside, outside) = if is_tangent {
            random.pick(&[(0.001, 0.001), (0.01, 0.005), (0.00002, 0.00003)])
        } else {
            random.pick(&[
                (0.0, 0.001),
                (0.001, 0.001),
                (0.0005, 0.0),
                (0.01, 0.005),
                (0.0, 0.0001),
                (0.00002, 0.00003),
            ])
        };
        let relation = |on: bool| if on { Relation::On } else { Relation::To };
        let laid = |kind: Kind,
                    normal: &Vec3,
                    (relation, thickness): (Relation, f64),
                    tip: &Vec3,
                    random: &mut Random| {
            let mut touch = *tip;
            if relation != Relation::On {
                touch += tools::support(&cutter, &axis, &-normal) - normal * thickness;
            }
            if !is_certain {
                touch += normal * random.between(-0.5, 0.1);
            }
            let (geometry, side) = kinds::through(kind, random, &touch, normal)?;
            Some(Placed { geometry, relation, side, occurrence: 1, thickness })
        };
        let part = laid(part_kind, &up, (relation(part_on), part_thickness), &place, random)?;
        let drive = laid(drive_kind, &out, (relation(drive_on), drive_thickness), &place, random)?;
        let reach = random.between(0.2, 2.5);
        let entry = if is_tangent { place - along * reach } else { place };
        let (relation_of_first, toward) = (
            random.pick(&[Relation::On, Relation::On, Relation::To, Relation::Past]),
            random.pick(&[1.0, -1.0]),
        );
        let (kind_of_first, relation_of_first) = wish.first.unwrap_or((Kind::Plane, relation_of_first));
        let facing_first = if relation_of_first == Relation::On { along } else { along * toward };
        let facing_first = match kind_of_first {
            Kind::Plane => facing_first,
            kind => facing(kind, &facing_first, random)?,
        };
        let first = laid(kind_of_first, &facing_first, (relation_of_first, check_thickness), &entry, random)?;
        let surfaces = if is_tangent { 3 } else { random.pick(&[1, 2, 3, 3, 3, 3, 3, 3, 3, 3]) };
        let surfaces = wish.surfaces.unwrap_or(surfaces);
        let until = random.pick(&[Relation::On, Relation::To, Relation::Past]);
        let is_slow = random.next() < SLOW_STOPS;
        let kinds: Vec<Kind> = Kind::ALL.into_iter().filter(|kind| kind.is_slow() == is_slow).collect();
        let stop_kind = random.pick(&kinds);
        let (until, stop_kind) = wish.stop.map_or((until, stop_kind), |(kind, until, _)| (until, kind));
        let stop = if is_tangent {
            // Against the surface that it is tangent to, or beyond it.
            let to_part = random.next() < 0.4;
            let to_part = if wish.stop.is_some() { until == Relation::TangentToPart } else { to_part };
            let (along_what, on) = if to_part { (&up, part_on) } else { (&out, drive_on) };
            let stop_kind =
                if stop_kind.is_upright() && along_what.z.abs() > 1e-12 { Kind::Cylinder } else { stop_kind };
            let facing = along_what * random.pick(&[1.0, -1.0]);
            let stop = laid(stop_kind, &facing, (relation(on), check_thickness), &place, random)?;
            Placed {
                relation: if to_part { Relation::TangentToPart } else { Relation::TangentToDrive },
                ..stop
            }
        } else {
            let facing =
                facing(stop_kind, &along, random)? * if until == Relation::Past { 1.0 } else { -1.0 };
            let stop = laid(stop_kind, &facing, (until, check_thickness), &(place + along * reach), random)?;
            let may_return = !matches!(stop_kind, Kind::Plane | Kind::Line);
            let occurrence = if may_return && random.next() < RETURNS { 2 } else { 1 };
            Placed { occurrence: wish.stop.map_or(occurrence, |(_, _, count)| count), ..stop }
        };
        let mut case = Self {
            cutter: numbers,
            shape,
            axis,
            from: place,
            place,
            part,
            drive,
            first,
            surfaces,
            passes_drive: wish.passes_drive.unwrap_or(!drive_on && random.next() < PASSES),
            delta: (random.next() < DELTAS)
                .then(|| up * random.between(-0.5, 0.5) + out * random.between(-0.5, 0.5)),
            stop,
            has_slow_stop: stop_kind.is_slow(),
            budget: Budget::of([part_kind, drive_kind, stop_kind].into_iter().any(Kind::is_slow)),
            inside,
            outside,
            drive_side: match (drive_on, sine > 0.0) {
                (true, _) => DriveSide::On,
                (false, true) => DriveSide::Left,
                (false, false) => DriveSide::Right,
            },
            forward: along,
            reach,
            maximum_step: 10.0,
            is_certain,
        };
        if wish.drive.is_some_and(|side| side != case.drive_side) {
            return None;
        }
        case.approach(&cutter, random, [&up, &out, &along])?;
        let first_fits = wish.first.is_none() || case.stands_at_first();
        (!is_certain
            || case.stands_at_place() && case.is_tangent_there(&Reader::new(&case), &along) && first_fits)
            .then_some(case)
    }

    /// Finds a place to come from with the observer on the sides on which the tool is meant to end.
    fn approach(&mut self, cutter: &Cutter, random: &mut Random, [up, out, along]: [&Vec3; 3]) -> Option<()> {
        let middle = self.axis * (0.5 * cutter.height);
        let (drive_side, first_side) = (
            if self.passes_drive { -1.0 } else { 1.0 },
            if self.first.relation == Relation::Past { -1.0 } else { 1.0 },
        );
        let roles: Vec<(Surface, f64)> =
            [(&self.part, 1.0), (&self.drive, drive_side), (&self.first, first_side)]
                .iter()
                .filter(|(role, _)| role.relation != Relation::On || !std::ptr::eq(*role, &self.first))
                .map(|(role, side)| Some((Surface::from_geometry(&role.geometry).ok()?, role.side * side)))
                .collect::<Option<_>>()?;
        for _ in 0..APPROACHES {
            let from = self.place
                + up * random.between(0.0, 1.0)
                + out * random.between(0.0, 1.0) * drive_side
                + along * random.between(-0.6, 0.6);
            let sees =
                |(surface, side): &(Surface, f64)| surface.signed_distance(&(from + middle)) * side > 1e-3;
            if roles.iter().all(sees) {
                self.from = from;
                return Some(());
            }
        }
        None
    }

    /// Whether the whole tool is clear of both surfaces but for the contacts at the place.
    fn stands_at_place(&self) -> bool {
        let reader = Reader::new(self);
        let read = reader.read(&self.place, Wanted::PathOnly);
        read.is_some_and(|[part, drive, _]| part.abs() < 1e-5 && drive.abs() < 1e-5)
    }

    /// Whether the whole tool is clear of the third surface of the start-up but for the contact at the place.
    fn stands_at_first(&self) -> bool {
        let read = Reader::new(self).read(&self.place, Wanted::First);
        read.is_some_and(|[.., first]| first.abs() < 1e-5)
    }

    /// For a motion that stops at a tangency: whether the tool touches the check surface at the place, and the path leaves it
    /// there to the same side before and after.
    pub(crate) fn is_tangent_there(&self, reader: &Reader<'_>, along: &Vec3) -> bool {
        let to_part = match self.stop.relation {
            Relation::TangentToPart => true,
            Relation::TangentToDrive => false,
            _ => return true,
        };
        let sense = self.sense_of_tangency();
        let apart = |way: f64| {
            let read = reader.read(&(self.place + along * way), Wanted::Stop(self.stop.side))?;
            let [part, drive, stop] = read;
            // The path keeps to its partner, on whichever side of the check surface that is.
            Some(stop - sense? * if to_part { part } else { drive })
        };
        let there = reader.read(&self.place, Wanted::Stop(self.stop.side)).map(|[_, _, stop]| stop);
        let least = LEAST_BEND * TANGENT_WAY * TANGENT_WAY;
        match (there, apart(TANGENT_WAY), apart(-TANGENT_WAY)) {
            (Some(there), Some(a), Some(b)) => {
                there.abs() < 1e-5 && a * b > 0.0 && a.abs().min(b.abs()) > least
            }
            _ => false,
        }
    }

    /// Whether the tool stands on the same side of the check surface as of the one that this is tangent to: where it stands between
    /// both they are parallel only as long as it does not turn.
    pub(crate) fn is_tangent_on_one_side(&self) -> bool {
        !is_tangency(self.stop.relation) || self.sense_of_tangency().is_some_and(|sense| sense > 0.0)
    }

    /// Whether the sides of the check surface and of the one that it is tangent to point the same way: 1, or opposite ways: −1.
    fn sense_of_tangency(&self) -> Option<f64> {
        let partner = if self.stop.relation == Relation::TangentToPart { &self.part } else { &self.drive };
        let normal = |role: &Placed| {
            let surface = Surface::from_geometry(&role.geometry).ok()?;
            Some(surface.foot(&self.place).normal * role.side)
        };
        Some(normal(&self.stop)?.dot(&normal(partner)?).signum())
    }

    /// Commands up to the start-up, and the directed motion.
    pub(crate) fn commands(&self) -> Vec<MotionCommand> {
        let mut commands = self.settings();
        let position = self.from - self.delta.unwrap_or_default();
        commands.push(MotionCommand::From { position, axis: Some(self.axis), name: String::new() });
        commands.extend(
            self.delta.map(|delta| MotionCommand::GoDelta {
                delta: Delta::Vector(delta, None),
                name: String::new(),
            }),
        );
        let start = |name: &str, role: &Placed| StartSurface {
            relation: role.relation,
            surface: named(name, role.geometry.clone()),
        };
        let mut drive = start("DS", &self.drive);
        if self.passes_drive {
            drive.relation = Relation::Past;
        }
        let mut all = vec![drive, start("PS", &self.part), start("ST", &self.first)];
        all.truncate(self.surfaces);
        if self.surfaces == 1 {
            commands.push(MotionCommand::PartSurface(named("PS", self.part.geometry.clone())));
        }
        commands.push(MotionCommand::Start(all));
        commands.extend(self.onward(&self.forward, &self.stop));
        commands
    }

    pub(crate) fn settings(&self) -> Vec<MotionCommand> {
        let part_side = if self.part.relation == Relation::On { PartSide::On } else { PartSide::Offset };
        vec![
            MotionCommand::Cutter(self.cutter.clone()),
            MotionCommand::InsideTolerance(PerRole::all(self.inside)),
            MotionCommand::OutsideTolerance(PerRole::all(self.outside)),
            MotionCommand::Thickness(PerRole {
                part: self.part.thickness,
                drive: self.drive.thickness,
                check: [self.stop.thickness; 2],
            }),
            MotionCommand::MaximumStep(self.maximum_step),
            MotionCommand::MaximumPoints(POINTS),
            MotionCommand::PartSide(part_side),
        ]
    }

    /// The directed motion, from where the tool is.
    pub(crate) fn onward(&self, forward: &Vec3, stop: &Placed) -> Vec<MotionCommand> {
        vec![
            MotionCommand::DriveSide(self.drive_side),
            MotionCommand::Direction([Some(Direction::Vector(*forward)), None, None]),
            MotionCommand::Drive {
                turn: Turn::Forward,
                drive: named("DS", self.drive.geometry.clone()),
                checks: vec![CheckSurface {
                    relation: stop.relation,
                    occurrence: stop.occurrence,
                    surface: named("CS", stop.geometry.clone()),
                    label: None,
                }],
            },
        ]
    }

    /// The numbers of the cutter in a unit of which one old unit has `factor`.
    fn cutter_times(&self, factor: f64) -> Vec<f64> {
        let cutter = Cutter::from_numbers(&self.cutter, 1.0).expect("a cutter");
        let lengths = [cutter.diameter, cutter.corner_radius, cutter.corner_offset, cutter.corner_height];
        let mut numbers: Vec<f64> = lengths.iter().map(|x| x * factor).collect();
        numbers.extend([cutter.alpha.to_degrees(), cutter.beta.to_degrees(), cutter.height * factor]);
        numbers
    }

    /// The case after a rigid motion, a reflection or a change of scale of everything in it.
    pub(crate) fn under(&self, matrix: &Matrix) -> Self {
        let factor = matrix.linear().determinant().abs().cbrt();
        let mirrored = matrix.linear().determinant() < 0.0;
        let image = |role: &Placed| {
            let geometry = role.geometry.transform(matrix).expect("an image");
            Placed { geometry, thickness: role.thickness * factor, ..role.clone() }
        };
        let direction = |v: &Vec3| matrix.apply_vector(v).normalize();
        Self {
            cutter: if factor == 1.0 { self.cutter.clone() } else { self.cutter_times(factor) },
            axis: direction(&self.axis),
            from: matrix.apply_point(&self.from),
            place: matrix.apply_point(&self.place),
            part: image(&self.part),
            drive: image(&self.drive),
            first: image(&self.first),
            stop: image(&self.stop),
            inside: self.inside * factor,
            outside: self.outside * factor,
            drive_side: if mirrored { other(self.drive_side) } else { self.drive_side },
            forward: direction(&self.forward),
            reach: self.reach * factor,
            delta: self.delta.map(|delta| matrix.apply_vector(&delta)),
            maximum_step: self.maximum_step * factor,
            ..self.clone()
        }
    }
}

/// NUMPTS of every motion: what bounds its time.
pub(crate) const POINTS: u32 = 1500;

/// The other side of the drive surface.
pub(crate) fn other(side: DriveSide) -> DriveSide {
    match side {
        DriveSide::Left => DriveSide::Right,
        DriveSide::Right => DriveSide::Left,
        DriveSide::On => DriveSide::On,
    }
}

fn is_tangency(relation: Relation) -> bool {
    matches!(relation, Relation::TangentToDrive | Relation::TangentToPart)
}

pub(crate) fn surface(role: &Placed) -> NamedSurface {
    named("", role.geometry.clone())
}

/// A unit vector at most `degrees` away.
pub(crate) fn near(direction: &Vec3, degrees: f64, random: &mut Random) -> Vec3 {
    let across = apt_geometry::surface::perpendicular(direction);
    let about = Rotation3::from_axis_angle(
        &Unit::new_normalize(*direction),
        random.between(0.0, std::f64::consts::TAU),
    );
    let angle = random.between(0.0, degrees.to_radians());
    (direction * angle.cos() + about * across * angle.sin()).normalize()
}

/// The normal of the part surface is within 65° of the tool axis, which is upright in most cases.
fn axis_and_part_normal(kind: Kind, random: &mut Random) -> Option<(Vec3, Vec3)> {
    if kind.is_upright() {
        let angle = random.between(0.0, std::f64::consts::TAU);
        let up = Vec3::new(angle.cos(), angle.sin(), 0.0);
        return Some((near(&up, 60.0, random), up));
    }
    let axis = if random.next() < 0.6 { Vec3::z() } else { near(&Vec3::z(), 60.0, random) };
    let up = if random.next() < 0.2 { axis } else { near(&axis, 65.0, random) };
    Some((axis, up))
}

/// The normal of the drive surface lies within 40° of the plane across the tool axis, and not along the part's normal.
fn drive_normal(kind: Kind, axis: &Vec3, up: &Vec3, random: &mut Random) -> Option<Vec3> {
    for _ in 0..20 {
        let angle = random.between(0.0, std::f64::consts::TAU);
        let flat = if kind.is_upright() {
            Vec3::new(angle.cos(), angle.sin(), 0.0)
        } else {
            let u = apt_geometry::surface::perpendicular(axis);
            u * angle.cos() + axis.cross(&u) * angle.sin()
        };
        let wall = random.next() < 0.5 || kind.is_upright();
        let out = if wall { flat } else { near(&flat, 40.0, random) };
        if up.cross(&out).norm() >= LEAST_SINE && out.dot(axis).abs() < 0.7 {
            return Some(out);
        }
    }
    None
}

/// The direction in which the check surface faces the path, up to its sense.
fn facing(kind: Kind, along: &Vec3, random: &mut Random) -> Option<Vec3> {
    if !kind.is_upright() {
        return Some(near(along, 35.0, random));
    }
    let flat = Vec3::new(along.x, along.y, 0.0);
    flat.try_normalize(0.5)
}
