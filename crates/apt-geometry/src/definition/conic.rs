//! ELLIPS, HYPERB, GCONIC and QADRIC (language reference 4.6, 4.8, 4.13). As in APT III nothing is said of a conic that falls
//! apart or of a quadric that is none.

use super::format::{Format, Parameter};
use super::given::Given;
use super::{DefinitionError, Modifier};
use crate::canonical::matrix::sine_cosine_degrees;
use crate::canonical::{Geometry, GeometryKind, Quadric};

use Parameter::{Entity, Scalar, Word};

const CENTER: Parameter = Word(Modifier::Center);
const POINT: Parameter = Entity("center", &[GeometryKind::Point]);

pub(super) static ELLIPSE_FORMATS: &[Format] = &[Format {
    parameters: &[CENTER, POINT, Scalar("semi-major"), Scalar("semi-minor"), Scalar("angle")],
    help: "by center, half axes and the angle of the first axis",
    build: |given| Ok(Geometry::Ellipse(central(given, 1.0)?)),
}];

pub(super) static HYPERBOLA_FORMATS: &[Format] = &[Format {
    parameters: &[CENTER, POINT, Scalar("half-transverse"), Scalar("half-conjugate"), Scalar("angle")],
    help: "by center, half axes and the angle of the transverse axis",
    build: |given| Ok(Geometry::Hyperbola(central(given, -1.0)?)),
}];

pub(super) static GENERAL_FORMATS: &[Format] = &[
    Format {
        parameters: &[Scalar("a"), Scalar("b"), Scalar("c"), Scalar("d"), Scalar("e"), Scalar("f")],
        help: "ax² + bxy + cy² + dx + ey + f = 0",
        build: |given| {
            let [a, b, c] = [given.scalar(0)?, given.scalar(1)?, given.scalar(2)?];
            let [d, e, f] = [given.scalar(3)?, given.scalar(4)?, given.scalar(5)?];
            general([a, c, f, b / 2.0, d / 2.0, e / 2.0])
        },
    },
    Format {
        parameters: &[Scalar("p"), Scalar("q"), Scalar("r"), Scalar("s"), Scalar("t")],
        help: "y = px + q ± √(rx² + sx + t)",
        build: |given| general(alternate(given)?),
    },
    Format {
        parameters: &[
            Scalar("p"),
            Scalar("q"),
            Scalar("r"),
            Scalar("s"),
            Scalar("t"),
            Word(Modifier::FunctionOfY),
        ],
        help: "x = py + q ± √(ry² + sy + t)",
        build: |given| {
            let [a, b, d, h, p, q] = alternate(given)?;
            general([b, a, d, h, q, p])
        },
    },
];

pub(super) static QUADRIC_FORMATS: &[Format] = &[Format {
    parameters: &[
        Scalar("a"),
        Scalar("b"),
        Scalar("c"),
        Scalar("f"),
        Scalar("g"),
        Scalar("h"),
        Scalar("p"),
        Scalar("q"),
        Scalar("r"),
        Scalar("d"),
    ],
    help: "ax² + by² + cz² + fyz + gxz + hxy + px + qy + rz + d = 0",
    build: |given| {
        let mut coefficients = [
            given.scalar(0)?,
            given.scalar(1)?,
            given.scalar(2)?,
            given.scalar(9)?,
            0.0,
            0.0,
            0.0,
            0.0,
            0.0,
            0.0,
        ];
        for (slot, index) in (4..10).zip(3..9) {
            coefficients[slot] = given.scalar(index)? / 2.0;
        }
        Ok(Geometry::Quadric(Quadric { coefficients }))
    },
}];

/// An ellipse (`sign` 1) or hyperbola (`sign` −1): `b² X² + sign·a² Y² = a² b²` in the axes of the conic.
fn central(given: &Given<'_>, sign: f64) -> Result<Quadric, DefinitionError> {
    let center = given.flat(1)?;
    let (a, b) = (given.scalar(2)?, given.scalar(3)?);
    let (sine, cosine) = sine_cosine_degrees(given.scalar(4)?);
    let (bb, aa) = (b * b, sign * a * a);
    let xx = bb * cosine * cosine + aa * sine * sine;
    let yy = bb * sine * sine + aa * cosine * cosine;
    let xy = sine * cosine * (bb - aa);
    let along = center.x * cosine + center.y * sine;
    let across = center.x * sine - center.y * cosine;
    Ok(Quadric::plane_conic(
        xx,
        yy,
        bb * along * along + aa * across * across - a * a * bb,
        xy,
        -xx * center.x - xy * center.y,
        -xy * center.x - yy * center.y,
    ))
}

/// `A, B, D, H, P, Q` of `y = px + q ± √(rx² + sx + t)`.
fn alternate(given: &Given<'_>) -> Result<[f64; 6], DefinitionError> {
    let [p, q, r] = [given.scalar(0)?, given.scalar(1)?, given.scalar(2)?];
    let [s, t] = [given.scalar(3)?, given.scalar(4)?];
    Ok([p * p - r, 1.0, q * q - t, -p, (2.0 * p * q - s) / 2.0, -q])
}

fn general([a, b, d, h, p, q]: [f64; 6]) -> Result<Geometry, DefinitionError> {
    Ok(Geometry::GeneralConic(Quadric::plane_conic(a, b, d, h, p, q)))
}
