//! Which readings of a check surface are on a way parallel to it.

use apt_geometry::Vec3;

use super::{OnWay, Reading};
use crate::{clearance::Contact, directed::march::Vertex};

fn vertex(x: f64) -> Vertex {
    let tip = Vec3::new(x, 0.0, 0.0);
    let contact = |gradient: Vec3| Contact { clearance: 0.0, gradient, tool: tip, surface: tip };
    let (part, drive) = (contact(Vec3::z()), contact(Vec3::y()));
    Vertex { tip, axis: Vec3::z(), part, drive, tangent: Vec3::x() }
}

fn reading(x: f64, slope: f64) -> Reading {
    Reading { x, vertex: vertex(x), slope, gap: 0.0, side: 1.0 }
}

/// A needle that lies along both surfaces, a ten thousandth of its band away, tells the slope to some 1e-5 only. The tangency just ahead of such a place
/// was lost there, and the motion went on to the end of its part surface.
#[test]
fn a_way_is_not_left_before_its_tangency_by_rounding() {
    let mut way = OnWay { slope: 0.0, stop: Some((vertex(1.0), 1.0)) };
    let ends = [vertex(0.0), vertex(2.0)];
    for (x, slope) in [(0.5, 0.0), (0.7, 1e-5), (0.9, -1e-5)] {
        assert!(way.stop_before([&ends[0], &ends[1]], x, 1e-4).is_none(), "{x}");
        assert!(way.has(&reading(x, slope)), "{x}");
    }
    // A bend leaves it, and what it comes to is its tangency.
    assert!(!way.has(&reading(0.9, 1e-3)));
    assert!(way.stop_before([&ends[0], &ends[1]], 1.1, 1e-4).is_some());
    assert!(way.has(&reading(1.1, 0.0)) && !way.has(&reading(1.1, 1e-5)));
}
