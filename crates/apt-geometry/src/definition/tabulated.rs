//! TABCYL (language reference 4.14): reading the data into the plane across the generatrix.

use std::sync::Arc;

use super::choice::ZERO_COMPONENT;
use super::format::{Format, Parameter};
use super::given::Given;
use super::tabulated_curve::{self, Curve, Sample};
use super::{DefinitionError, Impossible, Modifier};
use crate::Vec3;
use crate::canonical::matrix::sine_cosine_degrees;
use crate::canonical::{Geometry, GeometryKind, Matrix, TabulatedCylinder};

use Parameter::{Choice, Entity, Repeated, Scalar, Word};

/// Component of the generatrix along z above which the v axis is laid near y, else the w-z plane gives it (APT III).
const STEEP: f64 = 0.707;

const POINT: Parameter = Entity("point", &[GeometryKind::Point]);
const PLACE: Parameter = Choice(&[&[POINT], &[Scalar("first"), Scalar("second")]]);
const SPATIAL_PLACE: Parameter = Choice(&[&[POINT], &[Scalar("x"), Scalar("y"), Scalar("z")]]);
const FORMAT: Parameter = Choice(&[
    &[Word(Modifier::NoX)],
    &[Word(Modifier::NoY)],
    &[Word(Modifier::NoZ)],
    &[Word(Modifier::RadiusAngle)],
    &[Word(Modifier::AngleRadius)],
]);
const TRANSFORM: Parameter =
    Choice(&[&[], &[Word(Modifier::Transform), Entity("matrix", &[GeometryKind::Matrix])]]);
const GENERATRIX: Parameter = Entity("generatrix", &[GeometryKind::Vector]);
const MAYBE_SLOPE: Parameter = Choice(&[
    &[],
    &[Word(Modifier::Slope), Scalar("slope")],
    &[Word(Modifier::Normal), Scalar("normal angle")],
]);

pub(super) static FORMATS: &[Format] = &[
    Format {
        parameters: &[FORMAT, Word(Modifier::Spline), TRANSFORM, Repeated(&[PLACE, MAYBE_SLOPE])],
        help: "smooth curve of continuous curvature through points of a coordinate plane",
        build,
    },
    Format {
        parameters: &[FORMAT, Word(Modifier::TwoPoint), TRANSFORM, Repeated(&[PLACE, MAYBE_SLOPE])],
        help: "curve through points; slopes not given are those of circles through three neighbours",
        build,
    },
    Format {
        parameters: &[FORMAT, Word(Modifier::FourPoint), TRANSFORM, Repeated(&[PLACE])],
        help: "curve through points, each interval from the cubic through four neighbours",
        build,
    },
    Format {
        parameters: &[FORMAT, Word(Modifier::PointSlope), TRANSFORM, Repeated(&[PLACE, Scalar("slope")])],
        help: "curve through points with the slope at every point",
        build,
    },
    Format {
        parameters: &[
            FORMAT,
            Word(Modifier::PointNormal),
            TRANSFORM,
            Repeated(&[PLACE, Scalar("normal angle")]),
        ],
        help: "curve through points with the angle of the normal at every point",
        build,
    },
    Format {
        parameters: &[
            Word(Modifier::Xyz),
            Choice(&[&[Word(Modifier::Spline)], &[Word(Modifier::TwoPoint)], &[Word(Modifier::FourPoint)]]),
            TRANSFORM,
            GENERATRIX,
            Repeated(&[SPATIAL_PLACE]),
        ],
        help: "curve through points of space, ruled along a vector",
        build,
    },
];

/// How the numbers of a point are meant.
#[derive(Clone, Copy, PartialEq, Eq)]
enum DataFormat {
    /// The two coordinates with these indices; the third is that of the generatrix.
    Plane([usize; 2]),
    RadiusAngle,
    AngleRadius,
    Spatial,
}

impl DataFormat {
    fn from_word(word: Modifier) -> Option<DataFormat> {
        Some(match word {
            Modifier::NoX => DataFormat::Plane([1, 2]),
            Modifier::NoY => DataFormat::Plane([2, 0]),
            Modifier::NoZ => DataFormat::Plane([0, 1]),
            Modifier::RadiusAngle => DataFormat::RadiusAngle,
            Modifier::AngleRadius => DataFormat::AngleRadius,
            Modifier::Xyz => DataFormat::Spatial,
            _ => return None,
        })
    }

    /// The coordinate axes of the plane of the data.
    fn axes(self) -> [usize; 2] {
        match self {
            DataFormat::Plane(axes) => axes,
            _ => [0, 1],
        }
    }
}

fn build(given: &Given<'_>) -> Result<Geometry, DefinitionError> {
    let format = DataFormat::from_word(given.modifier(0)?).ok_or_else(|| given.unknown())?;
    let option = given.modifier(1)?;
    let mut reader = Reader { given, format, option, next: 2 };
    let matrix = reader.transform()?;
    let generatrix = reader.generatrix(&matrix)?;
    let axes = local_axes(&generatrix)?;
    let mut samples = Vec::new();
    while reader.next < given.count() {
        let (place, tangent) = reader.point()?;
        let place = matrix.apply_point(&place);
        let flat = |vector: Vec3| [axes[0].dot(&vector), axes[1].dot(&vector)];
        let tangent = tangent.map(|tangent| flat(matrix.apply_vector(&tangent)));
        samples.push(Sample { place: flat(place), tangent });
    }
    let Curve { intervals, last } = tabulated_curve::build(&samples, option)?;
    Ok(Geometry::TabulatedCylinder(Arc::new(TabulatedCylinder { axes, kind: 0.0, intervals, last })))
}

/// The u, v and w axes for a generatrix along w: u in the xy-plane for flat generatrices, v in the yz-plane for steep
/// ones (APREPR).
fn local_axes(generatrix: &Vec3) -> Result<[Vec3; 3], Impossible> {
    if generatrix.amax() <= ZERO_COMPONENT {
        return Err(Impossible::ZeroVector);
    }
    let w = generatrix.try_normalize(0.0).ok_or(Impossible::ZeroVector)?;
    let u = if w.z.abs() > STEEP { Vec3::new(w.z, 0.0, -w.x) } else { Vec3::new(w.y, -w.x, 0.0) };
    let u = u.try_normalize(0.0).ok_or(Impossible::ZeroVector)?;
    Ok([u, w.cross(&u), w])
}

/// Takes the data in turn.
struct Reader<'a, 'b> {
    given: &'a Given<'b>,
    format: DataFormat,
    option: Modifier,
    next: usize,
}

impl Reader<'_, '_> {
    fn scalar(&mut self) -> Result<f64, DefinitionError> {
        let value = self.given.scalar(self.next)?;
        self.next += 1;
        Ok(value)
    }

    fn transform(&mut self) -> Result<Matrix, DefinitionError> {
        if self.given.word_at(self.next) != Some(Modifier::Transform) {
            return Ok(Matrix::identity());
        }
        let matrix = self.given.matrix(self.next + 1)?;
        self.next += 2;
        Ok(matrix)
    }

    /// The rulings of the plane formats keep their coordinate axis under TRFORM; a given vector is transformed.
    fn generatrix(&mut self, matrix: &Matrix) -> Result<Vec3, DefinitionError> {
        match self.format {
            DataFormat::Spatial => {
                let vector = self.given.place(self.next)?;
                self.next += 1;
                Ok(matrix.apply_vector(&vector))
            }
            _ => {
                let [first, second] = self.format.axes();
                let mut axis = Vec3::zeros();
                axis[3 - first - second] = 1.0;
                Ok(axis)
            }
        }
    }

    /// The next point, and its tangent if there is one.
    fn point(&mut self) -> Result<(Vec3, Option<Vec3>), DefinitionError> {
        let place = self.place()?;
        let tangent = match self.option {
            Modifier::PointSlope => Some(self.sloped()?),
            Modifier::PointNormal => Some(self.normal()?),
            _ => match self.given.word_at(self.next) {
                Some(Modifier::Slope) => {
                    self.next += 1;
                    Some(self.sloped()?)
                }
                Some(Modifier::Normal) => {
                    self.next += 1;
                    Some(self.normal()?)
                }
                _ => None,
            },
        };
        Ok((place, tangent))
    }

    fn place(&mut self) -> Result<Vec3, DefinitionError> {
        if let Ok(place) = self.given.place(self.next) {
            self.next += 1;
            let [first, second] = self.format.axes();
            let mut flat = Vec3::zeros();
            (flat[first], flat[second]) = (place[first], place[second]);
            return Ok(if self.format == DataFormat::Spatial { place } else { flat });
        }
        let (first, second) = (self.scalar()?, self.scalar()?);
        Ok(match self.format {
            DataFormat::Plane(axes) => {
                let mut place = Vec3::zeros();
                (place[axes[0]], place[axes[1]]) = (first, second);
                place
            }
            DataFormat::RadiusAngle => polar(first, second),
            DataFormat::AngleRadius => polar(second, first),
            DataFormat::Spatial => Vec3::new(first, second, self.scalar()?),
        })
    }

    /// The direction with a slope: second coordinate over first.
    fn sloped(&mut self) -> Result<Vec3, DefinitionError> {
        let slope = self.scalar()?;
        Ok(self.direction(1.0, slope))
    }

    /// The direction a quarter turn behind a normal.
    fn normal(&mut self) -> Result<Vec3, DefinitionError> {
        let (sine, cosine) = sine_cosine_degrees(self.scalar()? - 90.0);
        Ok(self.direction(cosine, sine))
    }

    fn direction(&self, along_first: f64, along_second: f64) -> Vec3 {
        let [first, second] = self.format.axes();
        let mut direction = Vec3::zeros();
        (direction[first], direction[second]) = (along_first, along_second);
        direction
    }
}

fn polar(radius: f64, degrees: f64) -> Vec3 {
    let (sine, cosine) = sine_cosine_degrees(degrees);
    Vec3::new(radius * cosine, radius * sine, 0.0)
}
