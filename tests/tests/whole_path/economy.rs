//! The number of cut vectors against what no sequence within the tolerances can beat, where that number is known.
//!
//! A path in a ring of radii `inner` to `outer` that turns by an angle needs at least so many chords: none may leave the
//! ring, so none subtends more than the angle of a tangent to the inner circle between its ends.

use apt_tests::{
    oracle, run_report,
    runs::{analysis, path_of, report},
};

/// Positions at the end of a motion are found to a millionth; a bound at the edge of a whole number must not flip.
const ROUNDING: f64 = 1e-9;

/// A motion along a ring: its last statement but FINI is the one that counts.
struct Row {
    name: &'static str,
    program: String,
    /// Coordinates in the plane of the ring, centre at the origin.
    plane: fn([f64; 3]) -> [f64; 2],
    inner: f64,
    outer: f64,
}

/// Least number of chords between two positions in a ring.
fn least(row: &Row, points: &[[f64; 2]]) -> u64 {
    let radius = |point: &[f64; 2]| point[0].hypot(point[1]).clamp(row.inner, row.outer);
    let turned: f64 = points
        .windows(2)
        .map(|pair| {
            let cross = pair[0][0] * pair[1][1] - pair[0][1] * pair[1][0];
            let dot = pair[0][0] * pair[1][0] + pair[0][1] * pair[1][1];
            cross.atan2(dot)
        })
        .sum();
    let tangent = |radius: f64| (row.inner / radius).min(1.0).acos();
    let ends = tangent(radius(&points[0])) + tangent(radius(&points[points.len() - 1]));
    let rest = turned.abs() - ends;
    if rest <= ROUNDING { 1 } else { 1 + (rest / (2.0 * tangent(row.outer)) - ROUNDING).ceil() as u64 }
}

/// The cut vectors of the last motion and their least number.
fn measured(row: &Row) -> (u64, u64) {
    let report = report(&analysis(&row.program, "free")).unwrap();
    assert_eq!(report["ok"], true, "{}: {}", row.name, report["diagnostics"]);
    let motion = report["motions"].as_array().unwrap().last().unwrap();
    assert_eq!(motion["verified"], true, "{}: {motion}", row.name);
    let path = path_of(&report);
    let isn = motion["isn"].as_u64().unwrap();
    let first = path.iter().position(|location| location.isn == isn).unwrap();
    let points: Vec<[f64; 2]> = path[first - 1..].iter().map(|location| (row.plane)(location.at)).collect();
    let vectors = motion["cut_vectors"].as_u64().unwrap();
    assert_eq!(vectors as usize + 1, points.len(), "{}", row.name);
    (vectors, least(row, &points))
}

const TOLERANCE: &str = "INTOL/.001\nOUTTOL/.001\n";
const T: f64 = 0.001;

fn circle_rows() -> Vec<Row> {
    let flat = |at: [f64; 3]| [at[0], at[1]];
    let around =
        |name, start: &str, travel: &str, statements: &str, radius: f64, intol: f64, outtol: f64| Row {
            name,
            program: format!("CUTTER/.5\n{statements}C1=CIRCLE/0,0,2\n{start}GO/TO,C1\n{travel}\nFINI\n"),
            plane: flat,
            inner: radius - intol,
            outer: radius + outtol,
        };
    let outside = "FROM/5,0,0\n";
    let inside = "FROM/0,0,0\nINDIRV/1,0,0\n";
    let quarter = "TLLFT,GOLFT/C1,ON,(LINE/YAXIS)";
    let turn = "TLLFT,GOLFT/C1,ON,2,INTOF,(LINE/XAXIS)";
    vec![
        around("circle outside", outside, quarter, TOLERANCE, 2.25, T, T),
        around("circle outside, a turn", outside, turn, TOLERANCE, 2.25, T, T),
        around(
            "circle outside, inside tolerance",
            outside,
            quarter,
            "INTOL/.002\nOUTTOL/0\n",
            2.25,
            0.002,
            0.0,
        ),
        around(
            "circle outside, outside tolerance",
            outside,
            turn,
            "INTOL/0\nOUTTOL/.002\n",
            2.25,
            0.0,
            0.002,
        ),
        around(
            "circle outside, fine",
            outside,
            turn,
            "NUMPTS/2000\nINTOL/.00001\nOUTTOL/.00002\n",
            2.25,
            1e-5,
            2e-5,
        ),
        around("circle outside, thick", outside, turn, &format!("{TOLERANCE}THICK/0,.1,0\n"), 2.35, T, T),
        // Inside, stock is towards the centre.
        around("circle inside", inside, quarter, TOLERANCE, 1.75, T, T),
        around("circle inside, a turn", inside, turn, "INTOL/.0005\nOUTTOL/.002\n", 1.75, 0.002, 0.0005),
        around("circle inside, thick", inside, turn, &format!("{TOLERANCE}THICK/0,.1,0\n"), 1.65, T, T),
        around(
            "circle, calculated in three dimensions",
            outside,
            turn,
            &format!("{TOLERANCE}3DCALC\n"),
            2.25,
            T,
            T,
        ),
    ]
}

/// Over a horizontal cylinder along y with radius 2, top at z = 0.
fn over_cylinder(
    name: &'static str,
    cutter: &str,
    drive: &str,
    plane: fn([f64; 3]) -> [f64; 2],
    radius: f64,
) -> Row {
    Row {
        name,
        program: format!(
            "CUTTER/{cutter}\n{TOLERANCE}PS=CYLNDR/0,0,-2,0,1,0,2\nDS={drive}\nFROM/-3,0,3\n\
             GO/ON,DS,TO,PS,ON,(PLANE/1,0,0,-1.2)\nINDIRV/1,0,0\nTLON,GOFWD/DS,ON,(PLANE/1,0,0,1.2)\nFINI\n"
        ),
        plane,
        inner: radius - T,
        outer: radius + T,
    }
}

fn cylinder_rows() -> Vec<Row> {
    // The centre of the corner runs in the ring; the flat of a cutter adds no turning.
    let ball = |at: [f64; 3]| [at[0], at[2] + 0.25 + 2.0];
    let corner = |at: [f64; 3]| [at[0] - at[0].signum() * at[0].abs().min(0.15), at[2] + 0.1 + 2.0];
    let end = |at: [f64; 3]| [at[0] - at[0].signum() * at[0].abs().min(0.25), at[2] + 2.0];
    vec![
        over_cylinder("cylinder across, ball", ".5,.25", "PLANE/0,1,0,0", ball, 2.25),
        over_cylinder("cylinder at an angle, ball", ".5,.25", "PLANE/.6,.8,0,0", ball, 2.25),
        over_cylinder("cylinder at another angle, ball", ".5,.25", "PLANE/-.8,.6,0,.3", ball, 2.25),
        over_cylinder("cylinder across, corner", ".5,.1", "PLANE/0,1,0,0", corner, 2.1),
        over_cylinder("cylinder across, flat end", ".5", "PLANE/0,1,0,0", end, 2.0),
    ]
}

fn sphere_row(
    name: &'static str,
    cutter: &str,
    at: f64,
    plane: fn([f64; 3]) -> [f64; 2],
    radius: f64,
) -> Row {
    Row {
        name,
        program: format!(
            "CUTTER/{cutter}\n{TOLERANCE}PS=SPHERE/0,0,-2,2\nDS=PLANE/0,1,0,{at}\nFROM/-3,0,3\n\
             GO/ON,DS,TO,PS,ON,(PLANE/1,0,0,-1.2)\nINDIRV/1,0,0\nTLON,GOFWD/DS,ON,(PLANE/1,0,0,1.2)\nFINI\n"
        ),
        plane,
        inner: ((radius - T).powi(2) - at * at).sqrt(),
        outer: ((radius + T).powi(2) - at * at).sqrt(),
    }
}

fn sphere_rows() -> Vec<Row> {
    let ball = |at: [f64; 3]| [at[0], at[2] + 0.25 + 2.0];
    let corner = |at: [f64; 3]| [at[0] - at[0].signum() * at[0].abs().min(0.15), at[2] + 0.1 + 2.0];
    vec![
        sphere_row("sphere through the centre, ball", ".5,.25", 0.0, ball, 2.25),
        sphere_row("sphere beside the centre, ball", ".5,.25", 0.8, ball, 2.25),
        sphere_row("sphere through the centre, corner", ".5,.1", 0.0, corner, 2.1),
    ]
}

fn cone_rows() -> Vec<Row> {
    let flat = |at: [f64; 3]| [at[0], at[1]];
    let (sine, cosine) = 30.0_f64.to_radians().sin_cos();
    // Vertex at z = 4, axis down, tool end on z = 0; the clearance is measured across the side of the cone.
    let row = |name, cutter: &str, edge: f64, corner: f64| {
        let at = ((4.0 - corner) * sine + corner) / cosine + edge;
        Row {
            name,
            program: format!(
                "CUTTER/{cutter}\n{TOLERANCE}CN=CONE/(POINT/0,0,4),(VECTOR/0,0,-1),30\nPS=PLANE/0,0,1,0\nFROM/5,-.5,1\n\
                 GO/TO,CN,TO,PS\nTLRGT,GORGT/CN,ON,(PLANE/1,0,0,0)\nFINI\n"
            ),
            plane: flat,
            inner: at - T / cosine,
            outer: at + T / cosine,
        }
    };
    vec![
        row("cone at constant height, flat end", ".5", 0.25, 0.0),
        row("cone at constant height, corner", ".5,.1", 0.15, 0.1),
        row("cone at constant height, ball", ".5,.25", 0.0, 0.25),
    ]
}

#[test]
fn at_most_one_cut_vector_more_than_any_sequence_needs() {
    let rows = circle_rows().into_iter().chain(cylinder_rows()).chain(sphere_rows()).chain(cone_rows());
    let mut wrong = Vec::new();
    for row in rows {
        let (vectors, least) = measured(&row);
        println!("{:<44}{vectors:>6} of at least {least}", row.name);
        if vectors > least + 1 || vectors < least {
            wrong.push(format!("{}: {vectors} cut vectors, the least is {least}", row.name));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn straight_paths_take_one_cut_vector() {
    let up_to = |part: &str, drive: &str, end: &str| {
        format!(
            "CUTTER/.5,.25\n{TOLERANCE}PS={part}\nDS={drive}\nFROM/.5,-3,3\nGO/ON,DS,TO,PS,ON,(PLANE/0,1,0,-1.5)\n\
             INDIRV/0,1,0\nTLON,GOFWD/DS,ON,(PLANE/0,1,0,{end})\nFINI\n"
        )
    };
    let over = |part: &str, drive: &str| up_to(part, drive, "-.5");
    let cone = "CONE/(POINT/0,0,2),(VECTOR/0,0,-1),40";
    for (name, program) in [
        ("cylinder along its axis", over("CYLNDR/0,0,-2,0,1,0,2", "PLANE/1,0,0,.5")),
        ("cone along a line of it", over(cone, "PLANE/1,0,0,0")),
        ("cone along a line of it, nearly to its vertex", up_to(cone, "PLANE/1,0,0,0", "-.2")),
        ("plane", over("PLANE/.1,.2,1,-1", "PLANE/1,.5,0,0")),
        ("plane with a quadric of one coefficient", over("QADRIC/0,0,0,0,0,0,0,0,1,0", "PLANE/1,.5,0,0")),
    ] {
        let report = report(&analysis(&program, "free")).unwrap();
        assert_eq!(report["ok"], true, "{name}: {}", report["diagnostics"]);
        let motion = report["motions"].as_array().unwrap().last().unwrap();
        let vectors = motion["cut_vectors"].as_u64().unwrap();
        assert!(vectors == 1 && motion["verified"] == true, "{name}: {motion}");
    }
}

/// The one program of the corpus in which a vector of the peer is longer than its MAXDP, and that MAXDP.
const TOO_LONG_FOR_MAXDP: (&str, f64) = ("maxdp", 0.2);

/// Length of the longest vector between points.
fn longest(points: &[serde_json::Value]) -> f64 {
    let at = |point: &serde_json::Value, axis: usize| point[axis].as_f64().unwrap();
    points
        .windows(2)
        .map(|pair| (0..3).map(|axis| (at(&pair[1], axis) - at(&pair[0], axis)).powi(2)).sum::<f64>().sqrt())
        .fold(0.0, f64::max)
}

#[test]
fn the_corpus_takes_no_more_cut_vectors_than_the_peer() {
    let mut compared = 0;
    for group in ["motion2d", "motion3d", "multaxis"] {
        for path in oracle::programs(group) {
            let text = std::fs::read_to_string(path.with_extension("json")).unwrap();
            let peer: serde_json::Value = serde_json::from_str(&text).unwrap();
            let ours = run_report(&path, "free");
            let name = path.file_stem().unwrap().to_string_lossy().into_owned();
            for motion in ours["motions"].as_array().unwrap() {
                let of_peer = peer["cl"].as_array().unwrap().iter();
                let Some(location) =
                    of_peer.filter(|entry| entry["type"] == "go").find(|entry| entry["isn"] == motion["isn"])
                else {
                    continue;
                };
                let points_of_peer = location["points"].as_array().unwrap();
                let of_peer = points_of_peer.len() as u64;
                let vectors = motion["cut_vectors"].as_u64().unwrap();
                let minimum = motion["minimum"].as_u64().unwrap_or(1);
                assert!(
                    minimum <= vectors,
                    "{name} at {}: {vectors} vectors, bound {minimum}",
                    motion["isn"]
                );
                let place = format!("{name} at {}: {vectors} vectors, the peer {of_peer}", motion["isn"]);
                if name == TOO_LONG_FOR_MAXDP.0 && vectors > of_peer {
                    assert!(longest(points_of_peer) > 1.05 * TOO_LONG_FOR_MAXDP.1, "{place}");
                    assert_eq!(vectors, of_peer + 1, "{place}");
                } else {
                    assert!(vectors <= of_peer, "{place}");
                }
                compared += 1;
            }
        }
    }
    assert!(compared > 100, "only {compared} motions compared");
}
