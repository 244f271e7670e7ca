//! What the contacts at both ends of a straight way tell about the clearance all along it.

use super::{
    halves::{cone_under_x, least_of_boundary},
    *,
};

/// A quadric with these squares and constant, and half linear coefficients.
pub(super) fn quadric(squares: [f64; 3], linear: [f64; 3], constant: f64) -> Geometry {
    let mut coefficients = [0.0; 10];
    coefficients[..3].copy_from_slice(&squares);
    coefficients[3] = constant;
    coefficients[7..].copy_from_slice(&linear);
    Geometry::Quadric(Quadric { coefficients })
}

/// The tool end moved along the gradient until the clearance is about a given one.
pub(super) fn laid(gauge: &Gauge, tool: &Tool, mut tip: Vec3, clearance: f64) -> (Vec3, Contact) {
    for _ in 0..4 {
        let contact = gauge.contact(tool, &tip);
        tip -= contact.gradient * (contact.clearance - clearance);
    }
    (tip, gauge.contact(tool, &tip))
}

/// Another part of the tool beside the vertex, where distances bend without bound, does not keep the contacts from telling.
#[test]
fn a_way_past_a_vertex_is_clear_by_its_contacts() {
    for width in [0.4, 2.5] {
        let (tool, gauge) = (tool(&[1.0, 0.1]), gauge(&cone_under_x(width), 1.0));
        for [from, to] in [[0.7, 0.6], [0.6, 0.55]] {
            let tips = [from, to].map(|x| v(x, 0.0, 1e-4));
            let [first, last] = tips.map(|tip| gauge.contact(&tool, &tip));
            let contacts = [(&tips[0], &first), (&tips[1], &last)];
            let middle = 0.5 * (tips[0] + tips[1]);
            assert!(
                gauge.keeps_between(&tool, contacts, &middle, 5e-5),
                "from {from} to {to}, width {width}"
            );
            assert!(!gauge.keeps_between(&tool, contacts, &middle, 2e-4));
        }
    }
}

/// Beside the deepest place of a way the clearance rises as the function that touches it there does, so that it keeps the very level of that place.
#[test]
fn a_way_from_its_deepest_place_is_clear_by_that_place_alone() {
    let gauge = gauge(&quadric([0.2, -0.15, 0.0], [0.0, 0.0, 0.5], 0.0), 1.0);
    let numbers: [&[f64]; 3] = [&[0.5, 0.25], &[0.5, 0.1], &[0.6, 0.11, 0.2, 0.13, 10.0, 5.0, 4.0]];
    for (numbers, x) in numbers.into_iter().flat_map(|numbers| [-0.7, 0.3].map(|x| (numbers, x))) {
        let tool = tool(numbers);
        let (deepest, contact) = laid(&gauge, &tool, v(x, 0.4, 0.3), 0.0);
        let along = contact.gradient.cross(&Vec3::y()).normalize();
        for length in [-0.008, 0.008] {
            let end = deepest + along * length;
            let middle = 0.5 * (deepest + end);
            let rise = gauge.contact(&tool, &end).clearance;
            let keeps = |level: f64| {
                let posed = quadric::Posed::new(&tool, &gauge.surface, 1.0, &deepest).expect("a quadric");
                posed.on_the_way_to(&middle).clears(level, &contact)
            };
            // A thousandth of how far the clearance rises is left below, and above it nothing is said.
            assert!(rise > 0.0 && keeps(contact.clearance - 1e-3 * rise), "{numbers:?} at {x} by {length}");
            assert!(!keeps(contact.clearance + 1e-3 * rise), "{numbers:?} at {x} by {length}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]
    /// No point of the tool comes nearer than it is said to keep, and the clearance is nowhere above the parabola by the bend of the
    /// distance of a point of contact.
    #[test]
    fn a_way_between_two_contacts_is_as_clear_as_they_tell(
        squares in [-3.0..3.0f64, -3.0..3.0f64, -3.0..3.0f64],
        linear in prop_oneof![Just([0.0; 3]), [-0.5..0.5f64, -0.5..0.5f64, -0.5..0.5f64]],
        constant in prop_oneof![Just(0.0), -1.0..1.0f64],
        (shape, side) in (0usize..7, prop_oneof![Just(-1.0), Just(1.0)]),
        from in [-2.0..2.0f64, -2.0..2.0f64, -2.0..2.0f64],
        towards in [-0.4..0.4f64, -0.4..0.4f64, -0.4..0.4f64],
        axis in [-1.0..1.0f64, -1.0..1.0f64, -1.0..1.0f64],
        (first, last, margin) in (0.0..0.03f64, 0.0..0.03f64, -0.02..0.03f64),
    ) {
        let geometry = quadric(squares, linear, constant);
        if Surface::from_geometry(&geometry).is_err() {
            return Ok(());
        }
        let gauge = gauge(&geometry, side);
        let Some(axis) = Vec3::from(axis).try_normalize(0.1) else { return Ok(()) };
        let tool = Tool::new(tools()[shape].cutter, axis);
        let start = Vec3::from(from);
        let (from, contact) = laid(&gauge, &tool, start, first);
        let (to, other) = laid(&gauge, &tool, from + Vec3::from(towards), last);
        if (to - from).norm() > 1.0 || (contact.clearance - first).abs() > 1e-6 {
            return Ok(());
        }
        let level = contact.clearance.min(other.clearance) - margin.max(0.0);
        let contacts = [(&from, &contact), (&to, &other)];
        let places = [0.0, 0.25, 0.5, 0.75, 1.0].map(|t| from + (to - from) * t);
        if gauge.keeps_between(&tool, contacts, &(0.5 * (from + to)), level) {
            for place in places {
                let least = least_of_boundary(&tool, &gauge, &place);
                prop_assert!(least >= level - 1e-9, "{least} below {level}");
            }
        }
        let way = to - from;
        if let Some(bend) = gauge.bend_at(&tool, &contact.tool, &way) {
            for place in places {
                let gone = place - from;
                let distance = side * gauge.surface.signed_distance(&(contact.tool + gone));
                let most = contact.clearance + contact.gradient.dot(&gone) + 0.5 * bend * gone.norm_squared();
                prop_assert!(distance <= most + 1e-7, "{distance} above {most}");
            }
        }
    }
}

/// A hanging bowl comes into the open top of a tool without touching it, but at the edge on one side and then on the other. Between
/// those it is farther away than a tool with a disc at its top would be.
#[test]
fn over_the_open_top_the_contacts_at_both_ends_tell_no_bound_that_is_too_low() {
    let (tool, height) = (tool(&[0.44, 0.0, 0.22, 0.0, 0.0, 0.0, 2.0]), 2.0);
    for low in [0.0, 0.01, 0.02] {
        let center: f64 = height + 1.0 - low;
        let bowl = quadric([1.0, 1.1, 1.0], [0.0, 0.0, -center], center * center - 1.0);
        let gauge = gauge(&bowl, 1.0);
        let tips = [-0.1, 0.1].map(|x| v(x, 0.0, -0.005));
        let [first, last] = tips.map(|tip| gauge.contact(&tool, &tip));
        let middle = gauge.contact(&tool, &v(0.0, 0.0, -0.005)).clearance;
        assert!(middle > first.clearance.max(last.clearance) + 1e-3, "{middle} {first:?} {last:?}");
        let most = gauge.at_most_between(&tool, [(&tips[0], &first), (&tips[1], &last)]);
        assert!(most.is_none_or(|most| most >= middle - 1e-12), "{most:?} below {middle}");
        assert!(tips.iter().zip([&first, &last]).all(|(tip, end)| gauge.touches_from_below(&tool, tip, end)));
    }
}
