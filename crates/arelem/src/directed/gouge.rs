//! Where the tool would cut into a surface besides the contact that the path follows: in a neck, or in a corner narrower than
//! the tool. GOUGCK/ON asks for it, where no cut vector goes on and over the length of a motion that was computed.
//!
//! Cut vectors keep the bands of part and drive surface with the whole tool. What they are not bound to is looked at here: the
//! body of a tool whose end is ON the part surface, a check surface on the way to a tangency with it, and the tool at a
//! surface whose cut vectors are not proven.

use apt_geometry::Vec3;

use super::{
    Prepared, is_tangent,
    neck::{Neck, Place},
    stop::graze::{least, least_value},
};
use crate::{
    attitude::Sweep,
    clearance::{Contact, Gauge, Tool},
    error::{ContactPoints, MotionFailure, MotionWarning, RoleName, TurnsBack},
    role::{ROUNDING, Working},
    sequence::CutSequence,
};

/// How far ahead is looked, as a share of the tool's radius.
const LOOK_AHEAD: f64 = 0.05;
/// Directions around the tool in which it is measured.
const AROUND: usize = 120;
/// Places on the corner arc.
const ON_ARC: usize = 6;
/// Most places that are told.
const MOST: usize = 4;

/// A place of the tool below a surface.
struct Cut {
    depth: f64,
    tool: Vec3,
}

/// What keeps the tool from going on, where a motion failed on its way.
pub(super) fn where_stuck(prepared: &Prepared, failure: &MotionFailure) -> Vec<MotionWarning> {
    match failure {
        MotionFailure::NoAdmissibleVector { role, tip, .. } => ahead(prepared, *role, tip),
        MotionFailure::IterationLimit { tip, .. } | MotionFailure::NoProgress { tip, .. } => {
            let roles = [RoleName::Part, RoleName::Drive];
            roles.into_iter().flat_map(|role| ahead(prepared, role, tip)).collect()
        }
        MotionFailure::NeverMet { turns_back: Some(corner), .. } => {
            let Prepared { part, drive, .. } = prepared;
            let roles = [[part, drive], [drive, part]];
            roles.into_iter().flat_map(|roles| beyond(prepared, roles, corner)).collect()
        }
        _ => Vec::new(),
    }
}

/// Least step along a vector, as a share of its length.
const LEAST_STEP: f64 = 1.0 / 128.0;

/// The places where the tool cuts deeper than INTOL into a surface that its cut vectors are not bound to, the deepest of
/// every stretch.
pub(super) fn along(prepared: &Prepared, sequence: &CutSequence) -> Vec<MotionWarning> {
    let mut found = Vec::new();
    let check = sequence.stop.as_ref().and_then(|stop| Some((prepared.checks.get(stop.index)?, stop)));
    if prepared.part.gauge.on {
        found.extend(stretches(prepared, &prepared.part, prepared.part.gauge.side, sequence));
    }
    if let Some((check, stop)) = check
        && is_tangent(check.relation)
        && !check.gauge.on
    {
        found.extend(stretches(prepared, check, stop.role.side, sequence));
    }
    for role in [&prepared.part, &prepared.drive] {
        if !role.gauge.on && sampled_only(role) {
            found.extend(stretches(prepared, role, role.gauge.side, sequence));
        }
    }
    found.sort_by(|a, b| depth_of(b).total_cmp(&depth_of(a)));
    found.truncate(MOST);
    found
}

fn depth_of(warning: &MotionWarning) -> f64 {
    match warning {
        MotionWarning::Gouge { depth, .. } => *depth,
        _ => 0.0,
    }
}

/// True for surfaces whose distances bend by an unknown amount.
fn sampled_only(role: &Working) -> bool {
    matches!(
        role.gauge.surface,
        apt_geometry::surface::Surface::Ruled(_) | apt_geometry::surface::Surface::PolyConic(_)
    )
}

/// Every stretch of the motion on which the whole tool is deeper than INTOL in a surface.
fn stretches(prepared: &Prepared, role: &Working, side: f64, sequence: &CutSequence) -> Vec<MotionWarning> {
    let surface = role.gauge.surface.clone();
    let gauge = Gauge { surface, on: false, side, memory: Default::default(), ..role.gauge.clone() };
    let limit = -role.inside - ROUNDING * prepared.size;
    let mut found = Vec::new();
    let mut worst: Option<(f64, Contact, Vec3)> = None;
    let mut from = &sequence.start;
    for to in &sequence.points {
        let sweep = Sweep::new(&prepared.tool, (&from.tip, &from.axis), (&to.tip, &to.axis));
        let contact = |x: f64| {
            let (tip, tool) = sweep.at(x);
            (gauge.contact(&tool, &tip), tip)
        };
        let floor = LEAST_STEP * sweep.length;
        let (mut before, mut x) = (0.0, 0.0);
        loop {
            if prepared.tool.patience.is_over() {
                return found;
            }
            let (here, tip) = contact(x);
            if here.clearance < limit {
                if worst.as_ref().is_none_or(|known| here.clearance < known.0) {
                    let around = [before, (x + floor).min(sweep.length)];
                    let deepest = least(around, &|x| Some(contact(x).0.clearance));
                    let (at, tip) = deepest.map_or((here, tip), |(x, _)| contact(x));
                    worst = Some((at.clearance.min(here.clearance), at, tip));
                }
            } else if let Some(known) = worst.take() {
                found.push(told(role, known));
            }
            if x >= sweep.length {
                break;
            }
            before = x;
            x = (x + ((here.clearance - limit) / sweep.stretch(gauge.reach(&prepared.tool))).max(floor))
                .min(sweep.length);
        }
        from = to;
    }
    found.extend(worst.map(|known| told(role, known)));
    found
}

fn told(role: &Working, (clearance, contact, tip): (f64, Contact, Vec3)) -> MotionWarning {
    let contact = ContactPoints { tip, tool: contact.tool, surface: contact.surface };
    MotionWarning::Gouge { role: role.name, depth: -clearance, contact, on: role.gauge.on, ahead: false }
}

/// The places where the tool would cut deeper than INTOL into a role's surface a little ahead of a position, the deepest
/// first. Ahead is the way on which it cuts.
pub(super) fn ahead(prepared: &Prepared, name: RoleName, tip: &Vec3) -> Vec<MotionWarning> {
    let Ok(posture) = prepared.attitude.posture(tip) else { return Vec::new() };
    let role = if name == RoleName::Part { &prepared.part } else { &prepared.drive };
    if role.gauge.on {
        return Vec::new();
    }
    let normals = [&prepared.part, &prepared.drive].map(|one| posture.contact(&one.gauge, tip).gradient);
    let Some(tangent) = normals[0].cross(&normals[1]).try_normalize(1e-9) else { return Vec::new() };
    let reach = LOOK_AHEAD * posture.tool.radius();
    let deepest = |cuts: &[Cut]| cuts.first().map_or(0.0, |cut| cut.depth);
    let ways = [reach, -reach].map(|reach| {
        let ahead = tip + tangent * reach;
        (ahead, cuts(&posture.tool, role, &ahead))
    });
    let [forward, back] = ways;
    let (at, cuts) = if deepest(&back.1) > deepest(&forward.1) { back } else { forward };
    ahead_at(role, &at, cuts)
}

/// The places where the tool would cut into a role's surface if the path went on where it turns back: where the neck is
/// narrowest, or a little ahead if it grows ever narrower.
fn beyond(prepared: &Prepared, [role, other]: [&Working; 2], corner: &TurnsBack) -> Vec<MotionWarning> {
    let Some(neck) = Neck::new(prepared, [role, other], *corner) else { return Vec::new() };
    let limit = -role.inside - ROUNDING * prepared.size;
    let narrowest = neck.narrowest().map(|(_, place)| place).filter(|place| place.clearance < limit);
    let Some(Place { tip, .. }) = narrowest.or_else(|| neck.first_below(limit)) else { return Vec::new() };
    let Ok(posture) = prepared.attitude.posture(&tip) else { return Vec::new() };
    ahead_at(role, &tip, cuts(&posture.tool, role, &tip))
}

/// What is told of places at which the tool would cut a surface ahead.
fn ahead_at(role: &Working, tip: &Vec3, cuts: Vec<Cut>) -> Vec<MotionWarning> {
    let warning = |cut: Cut| {
        let surface = role.gauge.surface.foot(&cut.tool).point;
        let contact = ContactPoints { tip: *tip, tool: cut.tool, surface };
        MotionWarning::Gouge { role: role.name, depth: cut.depth, contact, on: false, ahead: true }
    };
    cuts.into_iter().map(warning).collect()
}

/// The places around the tool where it is deepest below the surface.
fn cuts(tool: &Tool, role: &Working, tip: &Vec3) -> Vec<Cut> {
    let (tool, tip) = &role.gauge.body(tool, tip);
    let surface = role.gauge.met(tool);
    let profile = profile(tool);
    // Along a wall the lowest place is told, not one that only rounding has made deeper.
    let rounding = ROUNDING * (tip.norm() + tool.reach());
    let at = |angle: f64| {
        let (sin, cos) = angle.sin_cos();
        let radial = tool.across[0] * cos + tool.across[1] * sin;
        let mut deepest = Cut { depth: f64::NEG_INFINITY, tool: *tip };
        for (radius, height) in &profile {
            let point = tip + radial * *radius + tool.axis * *height;
            let above = role.gauge.side * surface.signed_distance(&point);
            let depth = role.gauge.thickness - above;
            if depth > deepest.depth + rounding {
                deepest = Cut { depth, tool: point };
            }
        }
        deepest
    };
    let step = std::f64::consts::TAU / AROUND as f64;
    let depths: Vec<f64> = (0..AROUND).map(|index| at(step * index as f64).depth).collect();
    let depth = |index: usize| depths.get(index % AROUND).copied().unwrap_or(f64::NEG_INFINITY);
    // Between two directions the tool reaches farther than in both.
    let least = role.inside - tool.radius() * (1.0 - (0.5 * step).cos());
    let summit = |index: &usize| {
        depth(*index) > least
            && depth(*index) > depth(index + AROUND - 1)
            && depth(*index) >= depth(index + 1)
    };
    let about = |index: usize| {
        let around = [index as f64 - 1.0, index as f64 + 1.0].map(|index| step * index);
        at(least_value(around, &|angle| -at(angle).depth).0)
    };
    let mut found: Vec<Cut> =
        (0..AROUND).filter(summit).map(about).filter(|cut| cut.depth > role.inside).collect();
    found.sort_by(|a, b| b.depth.total_cmp(&a.depth));
    found.truncate(MOST);
    found
}

/// Places on the tool's profile: radius and height.
fn profile(tool: &Tool) -> Vec<(f64, f64)> {
    let profile = &tool.profile;
    let mut places: Vec<(f64, f64)> = [profile.lower, profile.upper, profile.top]
        .iter()
        .map(|place| (place.radius, place.height))
        .collect();
    for index in 0..=ON_ARC {
        let [from, to] = profile.fan;
        let (sin, cos) = (from + (to - from) * index as f64 / ON_ARC as f64).sin_cos();
        places.push((profile.center.radius + profile.arc * sin, profile.center.height - profile.arc * cos));
    }
    places.retain(|(radius, _)| *radius > 0.0);
    places
}

#[cfg(test)]
mod tests {
    use apt_geometry::motion::{DriveSide, MotionCommand, PartSide, Relation, Turn};

    use crate::{
        error::{MotionFailure, MotionWarning, RoleName},
        tests::{Program, cylinder, line, motion, named, plane, quadric, v},
    };

    const TOLERANCE: f64 = 0.006;

    /// A tool of radius .75 inside the ellipse x² + y²/.64 = 1, whose ends have a radius of curvature of .64: the part surface. In both ends the
    /// path turns by 120°, and these are .42 apart, nearer than one turn on the spot may be to another one in bands as wide: the second one
    /// ends it.
    fn into_narrow_ends(check: bool) -> (Program, MotionFailure) {
        let ellipse = quadric([1.0, 1.0 / 0.64, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        let floor = plane(0.0, 0.0, 1.0, 0.0);
        let mut p = Program::new();
        p.tolerance(TOLERANCE, TOLERANCE).cutter(&[1.5]).from(0.0, 0.0, 0.0);
        p.run(&MotionCommand::GougeCheck(check));
        p.indirv(0.0, -1.0, 0.0).go(&[(Relation::To, &ellipse), (Relation::To, &floor)]);
        let command = motion(Turn::Left, &floor, &[(Relation::On, 1, &line(0.9, 0.0, 0.9, 1.0))]);
        p.run(&MotionCommand::PartSurface(named(&ellipse))).part_side(PartSide::Offset).side(DriveSide::On);
        let failure = p.attempt(&command).expect_err("both ends are narrower than the tool");
        (p, failure)
    }

    #[test]
    fn a_corner_narrower_than_the_tool_is_told_with_place_and_depth() {
        let (p, failure) = into_narrow_ends(true);
        let MotionFailure::NoAdmissibleVector { role: RoleName::Part, clearance, .. } = failure else {
            panic!("{failure:?}")
        };
        assert!(clearance < -TOLERANCE, "{clearance}");
        let gouges: Vec<_> = p
            .warnings
            .iter()
            .filter_map(|warning| match warning {
                MotionWarning::Gouge { role: RoleName::Part, depth, contact, ahead: true, .. } => {
                    Some((*depth, *contact))
                }
                _ => None,
            })
            .collect();
        assert!(!gouges.is_empty(), "{:?}", p.warnings);
        for (depth, contact) in gouges {
            assert!(depth > TOLERANCE && depth < 0.1, "{depth}");
            assert!(
                contact.surface.y.abs() > 0.5 && contact.tip.x < 0.0,
                "at a wall of the second end: {contact:?}"
            );
            assert!(contact.tool.y.abs() > contact.surface.y.abs(), "the tool is beyond it: {contact:?}");
        }
    }

    #[test]
    fn nothing_is_told_unless_it_is_asked_for() {
        let (p, failure) = into_narrow_ends(false);
        assert_eq!((failure.apt3(), p.warnings.len()), (Some(801), 0));
    }

    /// A flat tool whose end is ON the bottom of a hollow cylinder of radius 5.
    fn along_a_trough(check: bool) -> Program {
        let (trough, middle) = (cylinder(v(0.0, 0.0, 5.0), v(1.0, 0.0, 0.0), 5.0), plane(0.0, 1.0, 0.0, 0.0));
        let x = |d: f64| plane(1.0, 0.0, 0.0, d);
        let mut p = Program::new();
        p.tolerance(0.001, 0.001).cutter(&[0.5]).from(-1.0, 0.0, 1.0).run(&MotionCommand::GougeCheck(check));
        p.part_side(PartSide::On);
        p.go(&[(Relation::On, &middle), (Relation::On, &trough), (Relation::On, &x(0.0))]);
        p.indirv(1.0, 0.0, 0.0).drive(Turn::Forward, &middle, Relation::On, &x(2.0));
        p
    }

    #[test]
    fn the_body_of_a_tool_on_a_hollow_part_surface_is_told() {
        let p = along_a_trough(true);
        let [MotionWarning::Gouge { role: RoleName::Part, depth, contact, on: true, ahead: false }] =
            p.warnings[..]
        else {
            panic!("{:?}", p.warnings)
        };
        // The edge of the bottom is .25 from the middle.
        let expected = 5f64 - (25f64 - 0.0625).sqrt();
        assert!((depth - expected).abs() < 0.002, "{depth} {expected}");
        assert!((contact.tool.y.abs() - 0.25).abs() < 1e-6, "{contact:?}");
        assert_eq!(along_a_trough(false).warnings, []);
    }
}
