//! TABCYL: the curve through its data, in every format and with every option.

use apt_geometry::Vec3;
use apt_geometry::canonical::matrix::CoordinatePlane;
use apt_geometry::canonical::{Geometry, GeometryKind, Interval, Matrix, TabulatedCylinder};
use apt_geometry::definition::Modifier;
use proptest::prelude::*;

use crate::figure::{Figure, Part, Setting, Turns, Verdict, curve_places, near_setting, point, travel, unit};

/// Stations per interval among which changes of sign are looked for.
const STATIONS: u32 = 200;

/// Heights of a gentle wave over equal steps, and a station on it between 0 and 1.
pub(crate) fn wave() -> impl Strategy<Value = (Vec<f64>, f64)> {
    (prop::collection::vec(-0.15..0.15f64, 5..9), 0.1..0.9f64)
}

pub(crate) fn surface(geometry: &Geometry) -> &TabulatedCylinder {
    match geometry {
        Geometry::TabulatedCylinder(surface) => surface,
        other => panic!("{other:?} is no tabcyl"),
    }
}

/// Place and direction of an interval at `s` along its chord.
fn at(surface: &TabulatedCylinder, index: usize, s: f64) -> (Vec3, Vec3) {
    let interval = &surface.intervals[index];
    let end = surface.intervals.get(index + 1).map_or(surface.last, |next| [next.u, next.v]);
    let Interval { u, v, a, b, length, .. } = *interval;
    let (du, dv) = ((end[0] - u) / length, (end[1] - v) / length);
    let height = s * (s - length) * (a * (s + length) + b);
    let slope = 3.0 * a * s * s + 2.0 * b * s - (a * length + b) * length;
    let [u_axis, v_axis, _] = surface.axes;
    let place = u_axis * (u + s * du - height * dv) + v_axis * (v + s * dv + height * du);
    let direction = u_axis * (du - slope * dv) + v_axis * (dv + slope * du);
    (place, direction.normalize())
}

/// The SPLINE through a wave, a place of it, and the direction there.
pub(crate) fn place_on_wave(setting: &Setting, heights: &[f64], station: f64) -> (Geometry, Vec3, Vec3) {
    let mut parts = vec![Part::Word(Modifier::NoZ), Part::Word(Modifier::Spline)];
    let step = 2.0 / (heights.len() - 1) as f64;
    for (index, height) in heights.iter().enumerate() {
        parts.push(Part::Place(setting.place([-1.0 + step * index as f64, *height, 0.0]), 2));
    }
    let geometry = Figure::flat(GeometryKind::TabulatedCylinder, *setting, Turns::Flat, parts)
        .define()
        .expect("a curve");
    let inner = heights.len() - 1;
    let along = station * inner as f64;
    let index = (along as usize).min(inner - 1);
    let curve = surface(&geometry);
    let (place, direction) = at(curve, index + 1, (along - index as f64) * curve.intervals[index + 1].length);
    (geometry, place, direction)
}

/// Places of the curve where a function of place and direction is zero.
pub(crate) fn places_where(geometry: &Geometry, function: impl Fn(Vec3, Vec3) -> f64) -> Vec<Vec3> {
    let curve = surface(geometry);
    let mut places = turning_places(curve, &function);
    for (index, interval) in curve.intervals.iter().enumerate() {
        let value = |s: f64| {
            let (place, direction) = at(curve, index, s);
            function(place, direction)
        };
        let station = |part: u32| interval.length * f64::from(part) / f64::from(STATIONS);
        for part in 0..STATIONS {
            let (mut low, mut high) = (station(part), station(part + 1));
            if value(low).signum() == value(high).signum() {
                continue;
            }
            let sign = value(low).signum();
            for _ in 0..80 {
                let middle = 0.5 * (low + high);
                if value(middle).signum() == sign { low = middle } else { high = middle }
            }
            places.push(at(curve, index, 0.5 * (low + high)).0);
        }
        // Between intervals the direction may jump within rounding over a zero.
        places.push(at(curve, index, 0.0).0);
    }
    places
}

/// Places where a function has a least magnitude without a change of sign between the stations: two zeros may lie
/// there.
pub(crate) fn turning_places(curve: &TabulatedCylinder, function: impl Fn(Vec3, Vec3) -> f64) -> Vec<Vec3> {
    let mut places = Vec::new();
    for (index, interval) in curve.intervals.iter().enumerate() {
        let value = |s: f64| {
            let (place, direction) = at(curve, index, s);
            function(place, direction)
        };
        let station = |part: u32| interval.length * f64::from(part) / f64::from(STATIONS);
        for part in 1..STATIONS {
            let around = [part - 1, part, part + 1].map(|part| value(station(part)));
            let turns = around[1].abs() <= around[0].abs() && around[1].abs() <= around[2].abs();
            if !turns || around.iter().any(|value| value.signum() != around[1].signum()) {
                continue;
            }
            let (mut low, mut high) = (station(part - 1), station(part + 1));
            for _ in 0..120 {
                let (first, second) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
                let sense = around[1].signum();
                if value(first) * sense < value(second) * sense { high = second } else { low = first }
            }
            let middle = 0.5 * (low + high);
            places.push(at(curve, index, middle).0);
            // Behind a turning point below zero there are two zeros.
            if value(middle).signum() != around[1].signum() {
                for (mut outer, mut inner) in [(station(part - 1), middle), (station(part + 1), middle)] {
                    for _ in 0..80 {
                        let between = 0.5 * (outer + inner);
                        if value(between).signum() == around[1].signum() {
                            outer = between;
                        } else {
                            inner = between;
                        }
                    }
                    places.push(at(curve, index, outer).0);
                }
            }
        }
    }
    places
}

/// Direction of the curve at its place nearest to another one.
pub(crate) fn direction_at(geometry: &Geometry, near: &Vec3) -> Vec3 {
    let curve = surface(geometry);
    let mut best = (f64::INFINITY, Vec3::x());
    for (index, interval) in curve.intervals.iter().enumerate() {
        for part in 0..=STATIONS {
            let (place, direction) =
                at(curve, index, interval.length * f64::from(part) / f64::from(STATIONS));
            let distance = (place - near).norm();
            if distance < best.0 {
                best = (distance, direction);
            }
        }
    }
    best.1
}

/// Distance of a place from the curve.
pub(crate) fn distance(geometry: &Geometry, from: &Vec3) -> f64 {
    let feet = places_where(geometry, |place, direction| (place - from).dot(&direction));
    feet.iter().map(|foot| (foot - from).norm()).fold(f64::INFINITY, f64::min)
}

/// One data point: where it is in space and its slope or normal angle, if any.
#[derive(Debug, Clone, Copy)]
struct Datum {
    first: f64,
    second: f64,
    /// Angle of the curve with the first axis, in degrees.
    angle: f64,
}

/// Data that run on, never steep: `first` grows.
fn data(least: usize) -> impl Strategy<Value = Vec<Datum>> {
    prop::collection::vec((0.3..1.0f64, -0.3..0.3f64, -15.0..15.0f64), least..8).prop_map(|steps| {
        let mut first = -1.0;
        let mut last = 0.0;
        let mut data = Vec::new();
        for (step, second, lean) in steps {
            first += step;
            let chord = f64::atan2(second - last, step).to_degrees();
            data.push(Datum { first, second: 0.3 * second, angle: 0.3 * chord + lean });
            last = second;
        }
        data
    })
}

/// How the data are given.
#[derive(Debug, Clone, Copy)]
struct Layout {
    word: Modifier,
    axes: [usize; 2],
}

fn layout() -> impl Strategy<Value = Layout> {
    prop::sample::select(vec![
        Layout { word: Modifier::NoZ, axes: [0, 1] },
        Layout { word: Modifier::NoX, axes: [1, 2] },
        Layout { word: Modifier::NoY, axes: [2, 0] },
    ])
}

impl Layout {
    fn place(&self, first: f64, second: f64) -> Vec3 {
        let mut place = Vec3::zeros();
        (place[self.axes[0]], place[self.axes[1]]) = (first, second);
        place
    }
}

/// Fails unless the curve goes through the places, in order, one interval from each to the next, with straight
/// extensions that go on smoothly at both ends, and the stored extremes hold.
fn interpolates(surface: &TabulatedCylinder, places: &[Vec3], size: f64) -> Verdict {
    prop_assert_eq!(surface.intervals.len(), places.len() + 1);
    for (index, place) in places.iter().enumerate() {
        let (start, _) = at(surface, index + 1, 0.0);
        let across = surface.axes[2];
        let flat = |place: &Vec3| place - across * across.dot(place);
        prop_assert!((start - flat(place)).norm() <= 1e-10 * size.max(place.norm()), "misses {place:?}");
        let before = &surface.intervals[index];
        let (end, _) = at(surface, index, before.length);
        prop_assert!((end - start).norm() <= 1e-10 * size.max(place.norm()), "a gap at {place:?}");
    }
    for interval in &surface.intervals {
        for part in 0..=20 {
            let s = interval.length * f64::from(part) / 20.0;
            let relative = s * (s - interval.length) * (interval.a * (s + interval.length) + interval.b)
                / interval.length;
            prop_assert!(relative <= interval.maximum + 1e-10 && relative >= interval.minimum - 1e-10);
        }
    }
    for index in [0, surface.intervals.len() - 2] {
        prop_assert!(jump(surface, index) < 1e-10, "the extension does not go on");
    }
    Ok(())
}

/// Sine of the angle between the directions at the end of an interval and at the start of the next.
fn jump(surface: &TabulatedCylinder, index: usize) -> f64 {
    let (_, end) = at(surface, index, surface.intervals[index].length);
    let (_, start) = at(surface, index + 1, 0.0);
    end.cross(&start).norm()
}

fn smooth(surface: &TabulatedCylinder) -> Verdict {
    for index in 0..surface.intervals.len() - 1 {
        prop_assert!(
            jump(surface, index) < 1e-10,
            "a corner after interval {index}: {:e}",
            jump(surface, index)
        );
    }
    Ok(())
}

proptest! {
    #![proptest_config(crate::figure::config())]

    /// NOX, NOY, NOZ with points named or not, with TRFORM or without, and with every option.
    #[test]
    fn coordinate_planes(
        setting in near_setting(), layout in layout(), data in data(4), option in 0..5usize, named in any::<bool>(), given in any::<u8>(),
        transformed in any::<bool>(), turn in -180.0..180.0f64, normals in any::<bool>(), travel in travel(),
    ) {
        let option = [Modifier::Spline, Modifier::TwoPoint, Modifier::FourPoint, Modifier::PointSlope, Modifier::PointNormal][option];
        let mut parts = vec![Part::Word(layout.word), Part::Word(option)];
        // A turn about the rulings and a shift keep the rulings.
        let plane = [CoordinatePlane::Xy, CoordinatePlane::Yz, CoordinatePlane::Zx][[0, 1, 2].into_iter().find(|index| [Modifier::NoZ, Modifier::NoX, Modifier::NoY][*index] == layout.word).expect("a layout")];
        let matrix = Matrix::translation(Vec3::new(1.0, -2.0, 0.5) * setting.size).multiply(&Matrix::rotation(plane, turn));
        if transformed {
            parts.extend([Part::Word(Modifier::Transform), Part::Entity(Geometry::Matrix(matrix))]);
        }
        let mut places = Vec::new();
        let mut tangents = Vec::new();
        for (index, datum) in data.iter().enumerate() {
            let place = setting.at + layout.place(datum.first, datum.second) * setting.size;
            let (first, second) = (place[layout.axes[0]], place[layout.axes[1]]);
            if named {
                parts.push(point(place));
            } else {
                parts.extend([Part::Number(first), Part::Number(second)]);
            }
            let (slope, normal) = (datum.angle.to_radians().tan(), datum.angle + 90.0);
            let stated = match option {
                Modifier::PointSlope => { parts.push(Part::Number(slope)); true }
                Modifier::PointNormal => { parts.push(Part::Number(normal)); true }
                Modifier::FourPoint => false,
                _ if given & (1 << (index % 8)) != 0 => {
                    let (word, value) = if normals { (Modifier::Normal, normal) } else { (Modifier::Slope, slope) };
                    parts.extend([Part::Word(word), Part::Number(value)]);
                    true
                }
                _ => false,
            };
            let (sine, cosine) = datum.angle.to_radians().sin_cos();
            tangents.push(stated.then(|| layout.place(cosine, sine)));
            places.push(place);
        }
        if transformed {
            places = places.iter().map(|place| matrix.apply_point(place)).collect();
            tangents = tangents.iter().map(|tangent| tangent.map(|tangent| matrix.apply_vector(&tangent))).collect();
        }
        let figure = Figure::space(GeometryKind::TabulatedCylinder, setting, Turns::None, parts);
        let geometry = figure.define().map_err(|error| TestCaseError::fail(format!("{error:?}")))?;
        let curve = surface(&geometry);
        interpolates(curve, &places, setting.size)?;
        if option != Modifier::FourPoint {
            smooth(curve)?;
        }
        for (index, tangent) in tangents.iter().enumerate() {
            if let Some(tangent) = tangent {
                let (_, direction) = at(curve, index + 1, 0.0);
                prop_assert!(direction.cross(tangent).norm() < 1e-10, "the slope at point {index} is missed");
            }
        }
        let _ = travel;
    }

    /// Between two inner points the cubic of FOURPT goes through the four points around it.
    #[test]
    fn four_points(data in data(4)) {
        let mut parts = vec![Part::Word(Modifier::NoZ), Part::Word(Modifier::FourPoint)];
        let places: Vec<Vec3> = data.iter().map(|datum| Vec3::new(datum.first, datum.second, 0.0)).collect();
        parts.extend(places.iter().map(|place| Part::Place(*place, 2)));
        let setting = Setting { at: Vec3::zeros(), size: 1.0 };
        let geometry = Figure::flat(GeometryKind::TabulatedCylinder, setting, Turns::Flat, parts).define().expect("a curve");
        let curve = surface(&geometry);
        for index in 0..places.len() - 1 {
            let first = index.clamp(1, places.len() - 3) - 1;
            for place in &places[first..first + 4] {
                // The cubic of the interval, continued to the other points, in the system of the chord.
                let along = (places[index + 1] - places[index]).normalize();
                let s = (place - places[index]).dot(&along);
                let Interval { a, b, length, .. } = curve.intervals[index + 1];
                let height = s * (s - length) * (a * (s + length) + b);
                let expected = (place - places[index]).dot(&Vec3::new(-along.y, along.x, 0.0));
                prop_assert!((height - expected).abs() < 1e-10);
            }
        }
    }

    /// RTHETA and THETAR give the curve of the same places in x and y.
    #[test]
    fn polar_data(data in data(4), option in 0..3usize, order in any::<bool>()) {
        let option = [Modifier::Spline, Modifier::TwoPoint, Modifier::FourPoint][option];
        let setting = Setting { at: Vec3::zeros(), size: 1.0 };
        let format = if order { Modifier::RadiusAngle } else { Modifier::AngleRadius };
        let mut polar = vec![Part::Word(format), Part::Word(option)];
        let mut plane = vec![Part::Word(Modifier::NoZ), Part::Word(option)];
        for datum in &data {
            let place = Vec3::new(datum.first, 3.0 + datum.second, 0.0);
            let (radius, angle) = (place.norm(), place.y.atan2(place.x).to_degrees());
            polar.extend(if order { [Part::Length(radius), Part::Heading(angle)] } else { [Part::Heading(angle), Part::Length(radius)] });
            plane.push(Part::Place(place, 2));
        }
        let curve = |parts| Figure::flat(GeometryKind::TabulatedCylinder, setting, Turns::Flat, parts).define().expect("a curve");
        let (polar, plane) = (curve(polar), curve(plane));
        // SPLINE stops at a small jump of curvature, which rounding moves a little.
        for (a, b) in curve_places(surface(&polar)).iter().zip(curve_places(surface(&plane))) {
            prop_assert!((a - b).norm() < 1e-9, "{a:?} is not {b:?}");
        }
    }

    /// XYZ: the points seen along the generatrix; moving all moves the curve.
    #[test]
    fn points_of_space(setting in near_setting(), data in data(4), depths in prop::collection::vec(-1.0..1.0f64, 8), generatrix in unit(), option in 0..2usize, named in any::<bool>(), travel in travel()) {
        let generatrix = Vec3::from(generatrix) + Vec3::z() * 1.5;
        let option = [Modifier::TwoPoint, Modifier::FourPoint][option];
        let mut parts = vec![Part::Word(Modifier::Xyz), Part::Word(option), Part::Entity(Geometry::Vector(generatrix))];
        let places: Vec<Vec3> = data.iter().zip(&depths)
            .map(|(datum, depth)| setting.place([datum.first, datum.second, 0.0]) + generatrix * (setting.size * depth))
            .collect();
        parts.extend(places.iter().map(|place| if named { point(*place) } else { Part::Place(*place, 3) }));
        Figure::space(GeometryKind::TabulatedCylinder, setting, Turns::Flat, parts).condition(1e3).hold(travel.upright(), |_| false, |geometry| {
            let curve = surface(geometry);
            prop_assert!((curve.axes[2] - generatrix.normalize()).norm() < 1e-14);
            prop_assert!((curve.axes[0].cross(&curve.axes[1]) - curve.axes[2]).norm() < 1e-14);
            interpolates(curve, &places, setting.size)
        })?;
    }

    /// Curves of the xy-plane turn and grow with their points. SPLINE is left out: it stops at an absolute jump of
    /// curvature.
    #[test]
    fn curves_move_with_their_points(setting in near_setting(), data in data(4), option in 0..2usize, travel in travel()) {
        let option = [Modifier::TwoPoint, Modifier::FourPoint][option];
        let mut parts = vec![Part::Word(Modifier::NoZ), Part::Word(option)];
        parts.extend(data.iter().map(|datum| Part::Place(setting.place([datum.first, datum.second, 0.0]), 2)));
        Figure::flat(GeometryKind::TabulatedCylinder, setting, Turns::Flat, parts).condition(100.0).hold(travel, |_| false, |_| Ok(()))?;
    }

    /// The spline's jumps of curvature are below what the language leaves.
    #[test]
    fn splines_have_continuous_curvature(data in data(5)) {
        let mut parts = vec![Part::Word(Modifier::NoZ), Part::Word(Modifier::Spline)];
        parts.extend(data.iter().map(|datum| Part::Place(Vec3::new(10.0 * datum.first, 10.0 * datum.second, 0.0), 2)));
        let setting = Setting { at: Vec3::zeros(), size: 10.0 };
        let geometry = Figure::flat(GeometryKind::TabulatedCylinder, setting, Turns::Flat, parts).define().expect("a curve");
        let curve = surface(&geometry);
        let curvature = |interval: &Interval, s: f64| {
            let l = interval.length;
            let slope = 3.0 * interval.a * s * s + 2.0 * interval.b * s - (interval.a * l + interval.b) * l;
            (6.0 * interval.a * s + 2.0 * interval.b) / (1.0 + slope * slope).powf(1.5)
        };
        let inner = &curve.intervals[1..curve.intervals.len() - 1];
        // The last inner jump is not renewed when the free end behind it follows (as in APT III).
        for pair in inner.windows(2).take(inner.len().saturating_sub(2)) {
            let jump = curvature(&pair[0], pair[0].length) - curvature(&pair[1], 0.0);
            prop_assert!(jump.abs() <= 1.01e-3, "curvature jumps by {jump}");
        }
    }
}
