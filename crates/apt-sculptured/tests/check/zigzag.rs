//! Zigzags over the surfaces of the reference with GOUGCK and CHKSRF: what checks cost a location (6.3), counted.

use apt_geometry::{Vec3, canonical::Geometry, cutter::Cutter, motion::NamedSurface, regional::*};
use apt_sculptured::mill::{Milled, Setting, mill};

use super::surfaces::{TestSurface, t14, t15};

/// A zigzag of a ball over all of a surface, passes a unit apart.
fn zigzag(surface: &TestSurface, extent: f64, radius: f64) -> Milled {
    let geometry = Geometry::Sculptured(surface.patches.clone());
    let surface = NamedSurface { name: "S".to_owned(), geometry };
    let range = ParameterRange { low: 0.0, high: extent };
    let pass = Pass { start: [0.0; 2], direction: FeedDirection::Spline, sense: Sense::Plus, skip: false };
    let command = RegionalMilling {
        command: RegionalCommand::Zigzag(Region {
            pass,
            stepover_sense: Sense::Plus,
            feed: FeedCondition { cutting: 0.0, stepover: 0.0, plunge: 0.0, rapid: 0.0 },
            stepover: StepoverCondition { scallop: 1.0, greatest: 0.0, lift: 0.0, passes: None },
        }),
        guide: GuideCondition {
            guide: Guide::Surface { surface: surface.clone(), u: range, v: range },
            contact: GuideContact::On,
            projection: Projection::Vector(-Vec3::z()),
        },
        part: PartCondition { relation: PartRelation::To, surface, side: Sense::Plus, thickness: 0.0 },
        axis: AxisCondition::Fixed(Vec3::z()),
        checked: CheckedSurfaces { part: true, named: Vec::new() },
        avoidance: AvoidanceControl::default(),
        check_chords: true,
        list_avoidance: false,
    };
    let cutter = Cutter::from_numbers(&[2.0 * radius, radius], 1.0).expect("a cutter");
    let setting = Setting { cutter: Some(cutter), inside: 0.01, outside: 0.01, maximum_step: 10.0 };
    mill(&command, &setting, &|| false)
}

#[test]
fn consecutive_locations_share_what_their_checks_find() {
    for (name, surface, extent, radius) in [("T14", t14(), 10.0, 5.0), ("T15", t15(), 30.0, 2.0)] {
        let milled = zigzag(&surface, extent, radius);
        assert!(milled.failure.is_none() && milled.unproved == 0, "{name}: {:?}", milled.failure);
        assert!(milled.encounters.is_empty(), "{name}: {:?}", milled.encounters);
        let locations = milled.locations().count() as f64;
        let (boxes, cells) = (milled.cost.boxes as f64 / locations, milled.cost.cells as f64 / locations);
        assert!(boxes <= 50.0 && cells <= 30.0, "{name}: {boxes} boxes and {cells} cells a location");
    }
}
