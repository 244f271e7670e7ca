//! The pictures hold what the scene holds, whatever it is.

use std::sync::Arc;

use apt_geometry::{
    Vec3,
    canonical::{Cone, Cylinder, Geometry, Plane, Quadric, Remembering, Sphere},
    parametric::{CurveArc, Mesh, Patch, SculpturedSurface, SpaceCurve},
};

use super::{Scene, SceneSurface, Segment, SegmentKind, html, projection::Bounds, svg, wireframe};

fn segment(from: [f64; 3], to: [f64; 3], kind: SegmentKind, isn: u32) -> Segment {
    Segment { from, to, kind, isn }
}

fn surface(name: &str, role: &str, geometry: Geometry) -> SceneSurface {
    SceneSurface { name: name.to_owned(), geometry, role: role.to_owned() }
}

/// A part with all kinds of motion and surfaces.
fn sample() -> Scene {
    let mut segments = vec![
        segment([-4.0, -4.0, 3.0], [0.0, -3.25, 3.0], SegmentKind::Rapid, 5),
        segment([0.0, -3.25, 3.0], [0.0, -3.25, 0.0], SegmentKind::Start, 7),
    ];
    let ring = |k: u32| {
        let (s, c) = (f64::from(k) / 60.0 * std::f64::consts::TAU).sin_cos();
        [3.25 * s, -3.25 * c, 0.0]
    };
    segments.extend((0..60).map(|k| segment(ring(k), ring(k + 1), SegmentKind::Feed, 9)));
    let dome = |k: u32| {
        let (s, c) = (f64::from(k) / 40.0 * 2.0 - 1.0).sin_cos();
        [2.4 * s, 0.6, 2.4 * c]
    };
    segments.push(segment(ring(60), [ring(60)[0], ring(60)[1], 3.0], SegmentKind::Rapid, 11));
    segments.push(segment([ring(60)[0], ring(60)[1], 3.0], dome(0), SegmentKind::Rapid, 12));
    segments.extend((0..40).map(|k| segment(dome(k), dome(k + 1), SegmentKind::Feed, 14)));
    segments.push(segment(dome(40), [4.0, 4.0, 3.0], SegmentKind::Rapid, 16));
    let plane = |n: Vec3, d: f64| Geometry::Plane(Plane { normal: n, distance: d });
    Scene {
        title: "Dome & flange <test>".to_owned(),
        segments,
        surfaces: vec![
            surface("PS", "part", plane(Vec3::z(), 0.0)),
            surface("BALL", "part", Geometry::Sphere(Sphere { center: Vec3::zeros(), radius: 2.15 })),
            surface(
                "RIM",
                "drive",
                Geometry::Circle(Cylinder { point: Vec3::zeros(), axis: Vec3::z(), radius: 3.0 }),
            ),
            surface("L1", "check", Geometry::Line(Plane { normal: Vec3::x(), distance: 0.0 })),
            surface(
                "CN",
                "check",
                Geometry::Cone(Cone { vertex: Vec3::new(3.0, 3.0, 3.0), axis: -Vec3::z(), cosine: 0.9 }),
            ),
            surface(
                "Q",
                "drive",
                Geometry::Quadric(Quadric {
                    coefficients: [1.0, 4.0, 1.0, -9.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
                }),
            ),
        ],
        units: Some("in".to_owned()),
        cutter_diameter: Some(0.5),
    }
}

/// Every element that is opened is closed, in order.
fn well_formed(text: &str) {
    let mut open: Vec<&str> = Vec::new();
    let mut rest = text;
    while let Some(at) = rest.find('<') {
        let end = rest[at..].find('>').expect("a tag ends") + at;
        let tag = &rest[at + 1..end];
        let name = tag.trim_start_matches('/').split([' ', '/', '>']).next().unwrap();
        if tag.starts_with('/') {
            assert_eq!(open.pop(), Some(name));
        } else if !tag.ends_with('/') {
            open.push(name);
        }
        rest = &rest[end + 1..];
    }
    assert!(open.is_empty(), "{open:?}");
}

#[test]
fn the_drawing_is_well_formed_and_has_four_views() {
    let picture = svg(&sample());
    well_formed(&picture);
    for name in ["Top · XY", "Isometric", "Front · XZ", "Right side · YZ"] {
        assert!(picture.contains(name), "{name}");
    }
    for class in ["path feed", "path rapid", "path start", "surface part", "surface drive", "surface check"] {
        assert!(picture.matches(&format!("\"{class}\"")).count() >= 4, "{class}");
    }
    assert!(picture.contains("Dome &amp; flange &lt;test&gt;") && picture.contains("part surface PS, BALL"));
    assert!(!picture.contains("NaN") && !picture.contains("inf"));
}

#[test]
fn the_page_holds_the_data_and_nothing_from_the_network() {
    let page = html(&sample());
    let start = page.find("application/json\">").unwrap() + "application/json\">".len();
    let end = start + page[start..].find("</script>").unwrap();
    let data: serde_json::Value = serde_json::from_str(&page[start..end]).unwrap();
    assert_eq!(data["title"], "Dome & flange <test>");
    let path = data["path"].as_array().unwrap();
    let kinds: Vec<&str> = path.iter().map(|s| s["kind"].as_str().unwrap()).collect();
    assert_eq!(kinds, ["rapid", "start", "feed", "rapid", "rapid", "feed", "rapid"]);
    assert_eq!(path[2]["isn"], 9);
    assert_eq!(path[2]["points"].as_array().unwrap().len(), 61);
    assert_eq!(data["surfaces"].as_array().unwrap().len(), 6);
    assert!(!page.contains("http://") && !page.contains("https://") && !page.contains("src="));
}

#[test]
fn the_scene_is_plain_json() {
    let scene = serde_json::to_value(sample()).unwrap();
    assert_eq!(scene["segments"][0]["kind"], "rapid");
    assert_eq!(scene["segments"][0]["to"], serde_json::json!([0.0, -3.25, 3.0]));
    assert_eq!(scene["surfaces"][2]["role"], "drive");
}

#[test]
fn paths_without_extent_or_without_sense_make_pictures_too() {
    let empty = Scene {
        title: String::new(),
        segments: vec![],
        surfaces: vec![],
        units: None,
        cutter_diameter: None,
    };
    let mut point = empty.clone();
    point.segments.push(segment([1.0; 3], [1.0; 3], SegmentKind::Feed, 1));
    let mut line = empty.clone();
    line.segments.push(segment([0.0; 3], [0.0, 0.0, 7.0], SegmentKind::Feed, 1));
    let mut broken = sample();
    broken.segments[3].to[1] = f64::NAN;
    broken.segments[4].from[0] = f64::INFINITY;
    broken.cutter_diameter = Some(f64::NAN);
    let mut huge = line.clone();
    huge.segments[0].to = [1e25, 3.0, -1e-9];
    let mut tiny = line.clone();
    tiny.segments[0].to = [1e-200, 0.0, 0.0];
    for scene in [empty, point, line, broken, huge, tiny] {
        let picture = svg(&scene);
        well_formed(&picture);
        assert!(!picture.contains("=\"NaN") && !picture.contains("=\"inf"), "{picture}");
        assert!(html(&scene).contains("</html>"));
    }
}

#[test]
fn a_long_path_makes_a_small_drawing() {
    let mut scene = sample();
    let at = |k: u32| {
        let t = f64::from(k) * 1e-3;
        [t.sin() * 3.0, (1.7 * t).cos() * 3.0, (0.3 * t).sin()]
    };
    scene.segments = (0..200_000).map(|k| segment(at(k), at(k + 1), SegmentKind::Feed, k)).collect();
    let picture = svg(&scene);
    assert!(picture.len() < 4_000_000, "{}", picture.len());
    well_formed(&picture);
}

#[test]
fn surface_lines_lie_on_their_surfaces_and_in_the_box() {
    let bounds = Bounds { low: [-2.0, -3.0, -1.0], high: [4.0, 3.0, 2.5] };
    for s in sample().surfaces {
        let lines = wireframe::lines(&s.geometry, &bounds);
        assert!(!lines.is_empty(), "{}", s.name);
        for p in lines.iter().flatten() {
            for i in 0..3 {
                assert!(p[i] >= bounds.low[i] - 1e-9 && p[i] <= bounds.high[i] + 1e-9, "{} {p:?}", s.name);
            }
            let x = Vec3::from(*p);
            let off = match &s.geometry {
                Geometry::Plane(g) | Geometry::Line(g) => g.normal.dot(&x) - g.distance,
                Geometry::Sphere(g) => (x - g.center).norm() - g.radius,
                Geometry::Circle(g) => x.xy().norm() - g.radius,
                Geometry::Cone(g) => (x - g.vertex).dot(&g.axis) - g.cosine * (x - g.vertex).norm(),
                _ => (x.x * x.x + 4.0 * x.y * x.y + x.z * x.z - 9.0) / 10.0,
            };
            // Chords of circles and of grid cells.
            assert!(off.abs() < 1e-2, "{}: {off}", s.name);
        }
    }
}

/// Writes the sample pictures for a look at them: `APT_PICTURES=DIR cargo test -p apt-ide picture`.
#[test]
fn sample_pictures_can_be_looked_at() {
    let (picture, page) = (svg(&sample()), html(&sample()));
    assert!(picture.len() > 5_000 && page.len() > 10_000);
    if let Ok(folder) = std::env::var("APT_PICTURES") {
        std::fs::write(format!("{folder}/sample.svg"), picture).unwrap();
        std::fs::write(format!("{folder}/sample.html"), page).unwrap();
    }
}

#[test]
fn patches_are_drawn_by_their_edges_and_middles() {
    let bounds = Bounds { low: [-5.0; 3], high: [9.0; 3] };
    let patch = |shift: f64| {
        Patch::from_points(&std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                Vec3::new(shift + i as f64, j as f64, (shift + i as f64) * j as f64 * 0.2)
            })
        }))
    };
    let patches = vec![patch(0.0), patch(3.0)];
    let surface = SculpturedSurface::assembled(patches, Some((2, 1)), Vec::new(), 1.0, Mesh::default());
    let lines = wireframe::lines(&Geometry::Sculptured(Remembering::new(surface.clone())), &bounds);
    // Four edges and two middles of each, the common edge once.
    assert_eq!(lines.len(), 11);
    for place in lines.iter().flatten() {
        let off =
            surface.nearest(&Vec3::from(*place)).map(|near| (near.position - Vec3::from(*place)).norm());
        assert!(off.is_ok_and(|off| off < 1e-9), "{place:?}");
    }
    let curve = SpaceCurve::of_arcs(vec![CurveArc::segment(&Vec3::zeros(), &Vec3::new(1.0, 2.0, 3.0))]);
    assert_eq!(wireframe::lines(&Geometry::SpaceCurve(Arc::new(curve)), &bounds).len(), 1);
}

#[test]
fn the_page_has_every_part_that_its_script_asks_for() {
    let page = html(&sample());
    let script = include_str!("viewer.js");
    let asked: Vec<&str> = script
        .split("getElementById(\"")
        .skip(1)
        .filter_map(|rest| rest.split_once('"').map(|(id, _)| id))
        .collect();
    assert!(asked.contains(&"step") && asked.contains(&"at"), "the motion can be stepped through: {asked:?}");
    for id in asked {
        assert!(page.contains(&format!("id=\"{id}\"")), "there is no element {id}");
    }
}
