//! Figures in random places: the arguments of a definition, which can be moved and scaled as a whole.

use apt_geometry::Vec3;
use apt_geometry::canonical::matrix::CoordinatePlane;
use apt_geometry::canonical::{Geometry, GeometryKind, Matrix, Plane, Quadric, TabulatedCylinder};
use apt_geometry::definition::{Argument, DefinitionContext, DefinitionError, Impossible, Modifier, define};
use proptest::prelude::*;
use proptest::test_runner::TestCaseError;

/// Error of a defining condition that is allowed, as a fraction of the size of the figure.
pub(crate) const EXACT: f64 = 1e-10;
/// Roundings that a condition may take at the distance of the figure from the origin.
const ROUNDINGS: f64 = 256.0;
/// Condition above which the tolerances of the language (coincidence, tangency) may decide in one place and not in
/// another, because they are lengths and not fractions.
const NEAR_A_TOLERANCE: f64 = 50.0;
/// Disagreement of two results, per unit of condition, that rounding explains.
const AGREEMENT: f64 = 1e-11;
/// A disagreement that shows nothing any more.
const MEANINGLESS: f64 = 1e-3;

pub(crate) type Verdict = Result<(), TestCaseError>;

/// Where a figure stands and how big it is, in program units.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Setting {
    pub(crate) at: Vec3,
    pub(crate) size: f64,
}

impl Setting {
    /// A place of the unit figure.
    pub(crate) fn place(&self, unit: [f64; 3]) -> Vec3 {
        self.at + Vec3::from(unit) * self.size
    }

    /// The same on the plane z = 0.
    pub(crate) fn flat(&self, unit: [f64; 3]) -> Vec3 {
        self.place([unit[0], unit[1], 0.0])
    }

    pub(crate) fn length(&self, unit: f64) -> f64 {
        unit * self.size
    }

    /// Error that a place at `reach` from the middle of the figure may have.
    pub(crate) fn allowed(&self, reach: f64) -> f64 {
        EXACT * self.size.max(reach) + ROUNDINGS * f64::EPSILON * (self.at.norm() + reach)
    }

    /// Fails when an error is more than rounding at a place of the figure.
    pub(crate) fn holds(&self, what: &str, error: f64, at: &Vec3) -> Verdict {
        let reach = (at - self.at).norm();
        prop_assert!(
            error.abs() <= self.allowed(reach),
            "{what}: off by {error:e}, {:e} allowed; {self:?}, at {at:?}",
            self.allowed(reach)
        );
        Ok(())
    }

    fn moved(&self, matrix: &Matrix, factor: f64) -> Setting {
        Setting { at: matrix.apply_point(&self.at), size: self.size * factor }
    }
}

/// Figures of a tenth to a thousand units, at the origin, beside it and ten thousand times their size away.
pub(crate) fn setting() -> impl Strategy<Value = Setting> {
    let far = prop::sample::select(vec![0.0, 1.0, 30.0, 1e4]);
    (-1..=3i32, far, [-1.0..1.0f64, -1.0..1.0, -1.0..1.0]).prop_map(|(power, far, toward)| {
        let size = 10f64.powi(power);
        Setting { at: Vec3::from(toward) * (far * size), size }
    })
}

/// The same for figures whose canonical form holds squares of coordinates: ten times their size away at most.
pub(crate) fn near_setting() -> impl Strategy<Value = Setting> {
    (-1..=3i32, 0.0..10.0f64, [-1.0..1.0f64, -1.0..1.0, -1.0..1.0]).prop_map(|(power, far, toward)| {
        let size = 10f64.powi(power);
        Setting { at: Vec3::from(toward) * (far * size), size }
    })
}

/// Settings in the xy-plane.
pub(crate) fn flat_setting() -> impl Strategy<Value = Setting> {
    setting().prop_map(flattened)
}

/// Settings in the xy-plane not far from the origin.
pub(crate) fn near_flat_setting() -> impl Strategy<Value = Setting> {
    near_setting().prop_map(flattened)
}

fn flattened(setting: Setting) -> Setting {
    Setting { at: Vec3::new(setting.at.x, setting.at.y, 0.0), ..setting }
}

/// A place of the unit figure.
pub(crate) fn unit() -> impl Strategy<Value = [f64; 3]> {
    [-1.0..1.0f64, -1.0..1.0, -1.0..1.0]
}

/// A fraction that is often very small: how near a figure is to being degenerate.
pub(crate) fn narrow() -> impl Strategy<Value = f64> {
    (-4.0..0.0f64, any::<bool>())
        .prop_map(|(power, minus)| 10f64.powf(power) * if minus { -1.0 } else { 1.0 })
}

pub(crate) fn which() -> impl Strategy<Value = Modifier> {
    use Modifier::{XLarge, XSmall, YLarge, YSmall};
    prop::sample::select(vec![XLarge, XSmall, YLarge, YSmall])
}

/// How far `vector` goes toward a selector.
pub(crate) fn toward(word: Modifier, vector: &Vec3) -> f64 {
    use Modifier::{
        NegativeX, NegativeY, NegativeZ, PositiveX, PositiveY, PositiveZ, XLarge, XSmall, YLarge, YSmall,
        ZLarge, ZSmall,
    };
    match word {
        XLarge | PositiveX => vector.x,
        XSmall | NegativeX => -vector.x,
        YLarge | PositiveY => vector.y,
        YSmall | NegativeY => -vector.y,
        ZLarge | PositiveZ => vector.z,
        ZSmall | NegativeZ => -vector.z,
        other => panic!("{other:?} is no selector"),
    }
}

pub(crate) fn direction(degrees: f64) -> Vec3 {
    let (sine, cosine) = degrees.to_radians().sin_cos();
    Vec3::new(cosine, sine, 0.0)
}

/// The line through `place` with its normal at an angle.
pub(crate) fn line_through(place: &Vec3, normal_degrees: f64) -> Plane {
    let flat = Vec3::new(place.x, place.y, 0.0);
    Plane::through(flat, direction(normal_degrees)).expect("a unit normal")
}

/// One argument with its meaning, so that it can be moved and scaled.
#[derive(Debug, Clone)]
pub(crate) enum Part {
    Entity(Geometry),
    Word(Modifier),
    Length(f64),
    /// Degrees from the x axis.
    Heading(f64),
    Number(f64),
    /// Two or three numbers that are a place.
    Place(Vec3, usize),
    /// Three numbers that are a vector.
    Components(Vec3),
}

pub(crate) fn point(place: Vec3) -> Part {
    Part::Entity(Geometry::Point(place))
}

pub(crate) fn line(line: Plane) -> Part {
    Part::Entity(Geometry::Line(line))
}

pub(crate) fn plane(plane: Plane) -> Part {
    Part::Entity(Geometry::Plane(plane))
}

/// Which turns leave the meaning of the words as they are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Turns {
    /// The words name axes or planes: shifts and scales only.
    None,
    /// Selectors turn with quarter turns about z.
    Quarter,
    /// Any turn about z.
    Flat,
    /// Any turn.
    Space,
}

/// A definition that can be moved.
#[derive(Debug, Clone)]
pub(crate) struct Figure {
    pub(crate) kind: GeometryKind,
    pub(crate) parts: Vec<Part>,
    pub(crate) setting: Setting,
    pub(crate) turns: Turns,
    /// Whether the figure lives in the xy-plane: it is not moved along z then.
    pub(crate) flat: bool,
    /// How much the result moves for a move of its parts; at least 1. One over the distance from being degenerate.
    pub(crate) condition: f64,
}

impl Figure {
    pub(crate) fn flat(kind: GeometryKind, setting: Setting, turns: Turns, parts: Vec<Part>) -> Figure {
        Figure { kind, parts, setting, turns, flat: true, condition: 1.0 }
    }

    pub(crate) fn space(kind: GeometryKind, setting: Setting, turns: Turns, parts: Vec<Part>) -> Figure {
        Figure { kind, parts, setting, turns, flat: false, condition: 1.0 }
    }

    pub(crate) fn condition(self, condition: f64) -> Figure {
        Figure { condition: condition.abs().max(1.0), ..self }
    }

    pub(crate) fn define(&self) -> Result<Geometry, DefinitionError> {
        let mut arguments = Vec::new();
        for part in &self.parts {
            match part {
                Part::Entity(geometry) => arguments.push(Argument::Geometry(geometry.clone())),
                Part::Word(word) => arguments.push(Argument::Modifier(*word)),
                Part::Length(value) | Part::Heading(value) | Part::Number(value) => {
                    arguments.push(Argument::Scalar(*value));
                }
                Part::Place(place, count) => {
                    arguments.extend(place.iter().take(*count).map(|value| Argument::Scalar(*value)));
                }
                Part::Components(vector) => {
                    arguments.extend(vector.iter().map(|value| Argument::Scalar(*value)));
                }
            }
        }
        define(self.kind, &arguments, &DefinitionContext::standard())
    }

    /// What the figure defines, checked; a refusal must be one that `refusal` explains. Then the same in another
    /// place, turned, and in another unit.
    pub(crate) fn hold(
        &self,
        travel: Travel,
        refusal: impl Fn(&Impossible) -> bool,
        check: impl Fn(&Geometry) -> Verdict,
    ) -> Verdict {
        let found = match self.define() {
            Ok(found) => found,
            Err(DefinitionError::Impossible { reason }) if refusal(&reason) => return Ok(()),
            Err(other) => return Err(TestCaseError::fail(format!("{other:?} for {self:?}"))),
        };
        check(&found)?;
        for (matrix, quarters, turn, factor) in travel.journeys(self) {
            self.agrees(&found, &matrix, quarters, turn, factor)?;
        }
        Ok(())
    }

    fn agrees(&self, found: &Geometry, matrix: &Matrix, quarters: u8, turn: f64, factor: f64) -> Verdict {
        let moved = Figure {
            parts: self.parts.iter().map(|part| moved_part(part, matrix, quarters, turn, factor)).collect(),
            setting: self.setting.moved(matrix, factor),
            ..self.clone()
        };
        let near = self.condition > NEAR_A_TOLERANCE;
        let there = match moved.define() {
            Ok(there) => there,
            Err(_) if near => return Ok(()),
            Err(other) => return Err(TestCaseError::fail(format!("moved: {other:?} for {moved:?}"))),
        };
        let expected = found.transform(matrix).expect("a similarity moves everything");
        let far =
            (self.setting.at.norm() / self.setting.size).max(moved.setting.at.norm() / moved.setting.size);
        let allowed = self.condition * (AGREEMENT + ROUNDINGS * f64::EPSILON * (1.0 + far));
        let apart = apart(&there, &expected, &moved.setting);
        prop_assert!(
            apart <= allowed || (near && allowed.max(self.condition * 1e-5) > MEANINGLESS),
            "moved results differ by {apart:e}, {allowed:e} allowed:\n{there:?}\n{expected:?}\nfor {self:?}"
        );
        Ok(())
    }
}

/// How a figure is moved.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Travel {
    shift: Vec3,
    turn: f64,
    tilt: f64,
    quarters: u8,
    factor: f64,
}

pub(crate) fn travel() -> impl Strategy<Value = Travel> {
    let factor = prop::sample::select(vec![25.4, 25.4f64.recip(), 10.0, 0.5]);
    (unit(), -180.0..180.0f64, -180.0..180.0f64, 1..4u8, factor).prop_map(
        |(shift, turn, tilt, quarters, factor)| Travel {
            shift: Vec3::from(shift),
            turn,
            tilt,
            quarters,
            factor,
        },
    )
}

impl Travel {
    /// The same move without a change of unit.
    pub(crate) fn rigid(self) -> Travel {
        Travel { factor: 1.0, ..self }
    }

    /// The same move with a change to a smaller unit, where lengths are greater numbers.
    pub(crate) fn enlarging(self) -> Travel {
        Travel { factor: self.factor.max(self.factor.recip()), ..self }
    }

    /// The same move without a tilt.
    pub(crate) fn upright(self) -> Travel {
        Travel { tilt: 0.0, ..self }
    }

    /// A rigid move of figures of a size, and a change of unit.
    pub(crate) fn matrices(self, size: f64) -> [Matrix; 2] {
        let rigid = Matrix::translation(self.shift * size)
            .multiply(&Matrix::rotation(CoordinatePlane::Zx, self.tilt))
            .multiply(&Matrix::rotation(CoordinatePlane::Xy, self.turn));
        [rigid, Matrix::scaling(self.factor)]
    }

    /// Matrix, quarter turns, turn about z and scale of every journey: a rigid move and a change of unit.
    fn journeys(&self, figure: &Figure) -> Vec<(Matrix, u8, f64, f64)> {
        let (quarters, turn) = match figure.turns {
            Turns::None => (0, 0.0),
            Turns::Quarter => (self.quarters, 90.0 * f64::from(self.quarters)),
            Turns::Flat | Turns::Space => (0, self.turn),
        };
        let tilt = if figure.turns == Turns::Space { self.tilt } else { 0.0 };
        let mut shift = self.shift * (3.0 * figure.setting.size);
        if figure.flat {
            shift.z = 0.0;
        }
        let rigid = Matrix::translation(shift)
            .multiply(&Matrix::rotation(CoordinatePlane::Zx, tilt))
            .multiply(&Matrix::rotation(CoordinatePlane::Xy, turn));
        vec![(rigid, quarters, turn, 1.0), (Matrix::scaling(self.factor), 0, 0.0, self.factor)]
    }
}

fn moved_part(part: &Part, matrix: &Matrix, quarters: u8, turn: f64, factor: f64) -> Part {
    match part {
        Part::Entity(geometry) => Part::Entity(geometry.transform(matrix).expect("a similarity")),
        Part::Word(word) => Part::Word((0..quarters).fold(*word, |word, _| turned(word))),
        Part::Length(value) => Part::Length(value * factor),
        Part::Heading(value) => Part::Heading(value + turn),
        Part::Number(value) => Part::Number(*value),
        Part::Place(place, count) => Part::Place(matrix.apply_point(place), *count),
        Part::Components(vector) => Part::Components(matrix.apply_vector(vector)),
    }
}

/// A selector after a quarter turn about z.
fn turned(word: Modifier) -> Modifier {
    use Modifier::{NegativeX, NegativeY, PositiveX, PositiveY, XLarge, XSmall, YLarge, YSmall};
    match word {
        XLarge => YLarge,
        YLarge => XSmall,
        XSmall => YSmall,
        YSmall => XLarge,
        PositiveX => PositiveY,
        PositiveY => NegativeX,
        NegativeX => NegativeY,
        NegativeY => PositiveX,
        other => other,
    }
}

/// How far two entities of one type are apart, relative to the size of the figure and to how far they reach out of it.
fn apart(found: &Geometry, expected: &Geometry, setting: &Setting) -> f64 {
    let place = |a: &Vec3, b: &Vec3| (a - b).norm() / setting.size.max((b - setting.at).norm());
    match (found, expected) {
        (Geometry::Point(a), Geometry::Point(b)) => place(a, b),
        (Geometry::Vector(a), Geometry::Vector(b)) => (a - b).norm() / b.norm(),
        (Geometry::Line(a), Geometry::Line(b)) | (Geometry::Plane(a), Geometry::Plane(b)) => {
            let (at_a, at_b) = (a.signed_distance(&setting.at), b.signed_distance(&setting.at));
            (a.normal - b.normal).norm().max((at_a - at_b).abs() / setting.size.max(at_b.abs()))
        }
        (Geometry::Circle(a), Geometry::Circle(b)) | (Geometry::Cylinder(a), Geometry::Cylinder(b)) => {
            let reach = setting.size.max((b.point - setting.at).norm()).max(b.radius);
            let radius = (a.radius - b.radius).abs() / reach;
            ((a.point - b.point).norm() / reach).max(radius).max((a.axis - b.axis).norm())
        }
        (Geometry::Sphere(a), Geometry::Sphere(b)) => {
            let reach = setting.size.max((b.center - setting.at).norm()).max(b.radius);
            ((a.center - b.center).norm().max((a.radius - b.radius).abs())) / reach
        }
        (Geometry::Cone(a), Geometry::Cone(b)) => {
            place(&a.vertex, &b.vertex).max((a.axis - b.axis).norm()).max((a.cosine - b.cosine).abs())
        }
        (Geometry::TabulatedCylinder(a), Geometry::TabulatedCylinder(b)) => {
            curve_places(a).iter().zip(curve_places(b)).fold(0.0f64, |most, (a, b)| most.max(place(a, &b)))
        }
        (Geometry::Pattern(a), Geometry::Pattern(b)) => {
            assert_eq!((a.points.len(), a.column, a.arrangement), (b.points.len(), b.column, b.arrangement));
            a.points.iter().zip(&b.points).fold(0.0f64, |most, (a, b)| most.max(place(a, b)))
        }
        (Geometry::RuledSurface(a), Geometry::RuledSurface(b)) => {
            assert_eq!(a.parts.len(), b.parts.len());
            let pairs = a.parts.iter().zip(&b.parts);
            pairs.fold(0.0f64, |most, (a, b)| most.max(self::apart(a, b, setting)))
        }
        (a, b) => {
            assert_eq!(a.kind(), b.kind());
            conic_apart(&quadric(a), &quadric(b), setting)
        }
    }
}

pub(crate) fn quadric(of: &Geometry) -> Quadric {
    match of {
        Geometry::Ellipse(quadric)
        | Geometry::Hyperbola(quadric)
        | Geometry::GeneralConic(quadric)
        | Geometry::LoftConic(quadric)
        | Geometry::Quadric(quadric) => *quadric,
        other => panic!("{other:?} is no quadric"),
    }
}

/// Greatest difference of the coefficients in the coordinates of the figure, both divided by their greatest.
fn conic_apart(found: &Quadric, expected: &Quadric, setting: &Setting) -> f64 {
    let local = Matrix::scaling(setting.size.recip()).multiply(&Matrix::translation(-setting.at));
    let values = |of: &Quadric| {
        let moved = Geometry::Quadric(*of).transform(&local).expect("a similarity");
        let values = moved.canonical_values();
        let most =
            values.iter().fold(0.0f64, |most, value| if value.abs() > most.abs() { *value } else { most });
        (values, most)
    };
    let ((a, _), (b, most)) = (values(found), values(expected));
    // The coefficients of both have the sense of the same greatest one.
    let index = b.iter().position(|value| *value == most).expect("the greatest");
    let ratio = most / a[index];
    a.iter().zip(&b).fold(0.0f64, |worst, (a, b)| worst.max((a * ratio - b).abs() / most.abs()))
}

/// Places along the directrix of a tabulated cylinder, in part coordinates; the extensions, whose length is fixed,
/// are left out.
pub(crate) fn curve_places(surface: &TabulatedCylinder) -> Vec<Vec3> {
    let [u_axis, v_axis, _] = surface.axes;
    let inner = surface.intervals.get(1..surface.intervals.len() - 1).expect("extensions at both ends");
    let ends = surface.intervals.iter().skip(2).map(|next| [next.u, next.v]);
    let mut places = Vec::new();
    for (interval, end) in inner.iter().zip(ends) {
        let length = interval.length;
        let (du, dv) = ((end[0] - interval.u) / length, (end[1] - interval.v) / length);
        for part in 0..=4 {
            let s = length * f64::from(part) / 4.0;
            let h = s * (s - length) * (interval.a * (s + length) + interval.b);
            let (u, v) = (interval.u + s * du - h * dv, interval.v + s * dv + h * du);
            places.push(u_axis * u + v_axis * v);
        }
    }
    places
}

/// The cases as `PROPTEST_CASES` says; failing ones are printed and not kept in files.
pub(crate) fn config() -> ProptestConfig {
    ProptestConfig { failure_persistence: None, max_global_rejects: 10_000_000, ..ProptestConfig::default() }
}

#[test]
fn without_the_variable_there_are_256_cases_per_form() {
    let wanted = std::env::var("PROPTEST_CASES").ok().and_then(|cases| cases.parse().ok()).unwrap_or(256);
    assert_eq!(config().cases, wanted);
}
