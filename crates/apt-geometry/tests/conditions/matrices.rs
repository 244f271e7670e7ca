//! MATRIX: what the maps do to points.

use apt_geometry::Vec3;
use apt_geometry::canonical::matrix::CoordinatePlane;
use apt_geometry::canonical::{Geometry, GeometryKind, Matrix, Plane};
use apt_geometry::definition::{Argument, DefinitionContext, DefinitionError, Impossible, Modifier, define};
use proptest::prelude::*;

use crate::figure::{Verdict, narrow, setting, unit};

fn run(arguments: &[Argument]) -> Result<Matrix, DefinitionError> {
    match define(GeometryKind::Matrix, arguments, &DefinitionContext::standard())? {
        Geometry::Matrix(matrix) => Ok(matrix),
        other => panic!("{other:?} is no matrix"),
    }
}

fn word(word: Modifier) -> Argument {
    Argument::Modifier(word)
}

fn same(what: &str, found: &Vec3, expected: &Vec3, size: f64) -> Verdict {
    prop_assert!((found - expected).norm() <= 1e-10 * size, "{what}: {found:?} is not {expected:?}");
    Ok(())
}

/// One factor of a product: its arguments, what it does, and whether it is a rotation or translation given directly.
#[derive(Debug, Clone)]
struct Factor {
    arguments: Vec<Argument>,
    matrix: Matrix,
    turns: bool,
    shifts: bool,
}

fn rotation() -> impl Strategy<Value = (Modifier, CoordinatePlane)> {
    prop::sample::select(vec![
        (Modifier::XyRotation, CoordinatePlane::Xy),
        (Modifier::YzRotation, CoordinatePlane::Yz),
        (Modifier::ZxRotation, CoordinatePlane::Zx),
    ])
}

fn factor() -> impl Strategy<Value = Factor> {
    (0..5usize, unit(), rotation(), -720.0..720.0f64).prop_map(|(form, at, (turn, plane), angle)| {
        let at = Vec3::from(at) * 10.0;
        let [x, y, z] = [at.x, at.y, at.z].map(Argument::Scalar);
        let (arguments, matrix) = match form {
            0 => (vec![word(Modifier::Translate), x, y], Matrix::translation(Vec3::new(at.x, at.y, 0.0))),
            1 => (vec![word(Modifier::Translate), x, y, z], Matrix::translation(at)),
            2 => (vec![word(turn), Argument::Scalar(angle)], Matrix::rotation(plane, angle)),
            3 => (vec![word(Modifier::Scale), Argument::Scalar(at.x)], Matrix::scaling(at.x)),
            _ => {
                let matrix = Matrix::translation(at).multiply(&Matrix::rotation(plane, angle));
                (vec![Argument::Geometry(Geometry::Matrix(matrix))], matrix)
            }
        };
        Factor { arguments, matrix, turns: form == 2, shifts: form < 2 }
    })
}

proptest! {
    #![proptest_config(crate::figure::config())]

    #[test]
    fn twelve_numbers(rows in [[-1e3..1e3f64, -1e3..1e3, -1e3..1e3, -1e3..1e3], [-1e3..1e3f64, -1e3..1e3, -1e3..1e3, -1e3..1e3], [-1e3..1e3f64, -1e3..1e3, -1e3..1e3, -1e3..1e3]]) {
        let arguments: Vec<Argument> = rows.concat().into_iter().map(Argument::Scalar).collect();
        prop_assert_eq!(run(&arguments).expect("a matrix").rows, rows);
    }

    #[test]
    fn single_factors(factor in factor(), at in unit()) {
        prop_assume!(!matches!(factor.arguments[0], Argument::Geometry(_)));
        let place = Vec3::from(at) * 10.0;
        same("image", &run(&factor.arguments).expect("a matrix").apply_point(&place), &factor.matrix.apply_point(&place), 100.0)?;
    }

    #[test]
    fn rotations_turn_axes_into_axes((turn, plane) in rotation(), angle in -720.0..720.0f64) {
        let matrix = run(&[word(turn), Argument::Scalar(angle)]).expect("a matrix");
        let [first, second, third] = plane.axes();
        let axis = |index: usize| { let mut axis = Vec3::zeros(); axis[index] = 1.0; axis };
        let (sine, cosine) = angle.to_radians().sin_cos();
        same("first axis", &matrix.apply_vector(&axis(first)), &(axis(first) * cosine + axis(second) * sine), 1e-3)?;
        same("second axis", &matrix.apply_vector(&axis(second)), &(axis(second) * cosine - axis(first) * sine), 1e-3)?;
        prop_assert_eq!(matrix.apply_vector(&axis(third)), axis(third));
    }

    /// The second factor acts first, but a rotation and a translation given directly act as they are written.
    #[test]
    fn products(factors in [factor(), factor()], at in unit()) {
        let arguments = factors.iter().flat_map(|factor| factor.arguments.clone()).collect::<Vec<_>>();
        let [first, second] = &factors;
        let as_written = (first.turns && second.shifts) || (first.shifts && second.turns);
        let (inner, outer) = if as_written { (first, second) } else { (second, first) };
        let place = Vec3::from(at) * 10.0;
        let expected = outer.matrix.apply_point(&inner.matrix.apply_point(&place));
        same("image", &run(&arguments).expect("a matrix").apply_point(&place), &expected, 1e3)?;
    }

    #[test]
    fn inverses(factors in [factor(), factor()], scale in 1e-3..1e3f64, at in unit()) {
        let matrix = factors[0].matrix.multiply(&Matrix::scaling(scale)).multiply(&factors[1].matrix);
        prop_assume!(matrix.linear().determinant().abs() > 1e-6 * scale.powi(3));
        let inverse = run(&[word(Modifier::Inverse), Argument::Geometry(Geometry::Matrix(matrix))]).expect("regular");
        let place = Vec3::from(at) * 10.0;
        let image = matrix.apply_point(&place);
        let shrink = inverse.linear().norm();
        same("back again", &inverse.apply_point(&image), &place, 10.0 + 1e-4 * shrink * image.norm())?;
    }

    /// The columns are the normals; the origin of the new system lies on all three planes.
    #[test]
    fn of_three_planes(setting in setting(), at in unit(), turns in [-180.0..180.0f64, -180.0..180.0]) {
        let frame = Matrix::rotation(CoordinatePlane::Zx, turns[0]).multiply(&Matrix::rotation(CoordinatePlane::Xy, turns[1]));
        let origin = setting.place(at);
        let planes = [Vec3::x(), Vec3::y(), Vec3::z()].map(|axis| Plane::through(origin, frame.apply_vector(&axis)).expect("a normal"));
        let arguments = planes.map(|plane| Argument::Geometry(Geometry::Plane(plane)));
        let matrix = run(&arguments).expect("a matrix");
        setting.holds("origin", (matrix.shift() - origin).norm(), &origin)?;
        for (plane, axis) in planes.iter().zip([Vec3::x(), Vec3::y(), Vec3::z()]) {
            prop_assert!((matrix.apply_vector(&axis) - plane.normal).norm() < 1e-15);
        }
    }

    #[test]
    fn of_a_point_and_two_vectors(setting in setting(), at in unit(), along in unit(), beside in unit(), lean in narrow(), lengths in [1e-3..1e3f64, 1e-3..1e3]) {
        let along = Vec3::from(along);
        prop_assume!(along.norm() > 0.1);
        let second = along + Vec3::from(beside) * lean;
        prop_assume!(second.norm() > 0.1);
        let sine = along.normalize().cross(&second.normalize()).norm();
        let origin = setting.place(at);
        let arguments = [Geometry::Point(origin), Geometry::Vector(along * lengths[0]), Geometry::Vector(second * lengths[1])].map(Argument::Geometry);
        match run(&arguments) {
            Ok(matrix) => {
                prop_assert_eq!(matrix.shift(), origin);
                let columns = [Vec3::x(), Vec3::y(), Vec3::z()].map(|axis| matrix.apply_vector(&axis));
                prop_assert!((columns[0] - along.normalize()).norm() < 1e-13);
                for (i, j) in [(0, 1), (0, 2), (1, 2)] {
                    prop_assert!(columns[i].dot(&columns[j]).abs() < 1e-13, "not at a right angle: {:e}", columns[i].dot(&columns[j]));
                }
                prop_assert!((columns[2] - columns[0].cross(&columns[1])).norm() < 1e-13);
                // The second vector lies in the new xy-plane, toward its y axis.
                prop_assert!(second.normalize().dot(&columns[2]).abs() < 1e-10 && second.dot(&columns[1]) > 0.0);
            }
            Err(DefinitionError::Impossible { reason: Impossible::Parallel }) => prop_assert!(sine <= 1.01e-5),
            Err(DefinitionError::Impossible { reason: Impossible::ZeroVector }) => prop_assert!(lengths[0].min(lengths[1]) < 1e-4),
            Err(other) => prop_assert!(false, "{other:?}"),
        }
    }

    #[test]
    fn mirror_images(setting in setting(), places in [unit(), unit()], normal in unit(), flat in any::<bool>(), words in prop::collection::vec(0..3usize, 1..4)) {
        let mut normal = Vec3::from(normal);
        if flat { normal.z = 0.0; }
        prop_assume!(normal.norm() > 0.1);
        let (on, place) = (setting.place(places[0]), setting.place(places[1]));
        let plane = Plane::through(on, normal).expect("a normal");
        let geometry = if flat { Geometry::Line(plane) } else { Geometry::Plane(plane) };
        let matrix = run(&[word(Modifier::Mirror), Argument::Geometry(geometry)]).expect("a matrix");
        let image = matrix.apply_point(&place);
        // The plane halves the way to the image at a right angle.
        setting.holds("in the middle", plane.signed_distance(&((place + image) / 2.0)), &place)?;
        setting.holds("at a right angle", (image - place).cross(&plane.normal).norm(), &place)?;
        // Mirroring in coordinate planes changes signs, however often a plane is named.
        let names = [(Modifier::YzPlane, 0), (Modifier::ZxPlane, 1), (Modifier::XyPlane, 2)];
        let mut arguments = vec![word(Modifier::Mirror)];
        let mut expected = place;
        for index in words {
            arguments.push(word(names[index].0));
            expected[names[index].1] = -expected[names[index].1];
        }
        prop_assert_eq!(run(&arguments).expect("a matrix").apply_point(&place), expected);
    }
}
