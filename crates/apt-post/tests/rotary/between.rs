//! Axes that come to their end between two positions, both of which they reach.

use apt_post::{PostFindingKind, Severity, machine};

use super::{HEAD, changed, found};

#[test]
fn an_end_between_two_positions_is_told() {
    let mill = machine("linuxcnc-mill5").unwrap();
    // Both lean by about ninety-eight degrees; the great circle between them leads by under the table.
    let text = format!(
        "{HEAD}RAPID\nGOTO/0,0,50,.937340547,-.328234369,-.116854175\nGOTO/0,0,0,-.765505657,.626200391,-.147899153\nFINI\n"
    );
    let kinds = found(&mill, &text);
    let [PostFindingKind::RotaryLimit { axis, angle, least, greatest, positions: 1 }] = &kinds[..] else {
        panic!("{kinds:?}")
    };
    assert_eq!((axis.as_str(), *least, *greatest), ("A", -120.0, 120.0));
    assert!(*angle > 120.0 && *angle < 180.0, "{angle}");
}

/// A table that would have to leave the upright tool from beyond its end.
#[test]
fn an_end_at_an_upright_tool_is_told() {
    let changes = [
        ("vector = [1.0, 0.0, 0.0]", "vector = [0.0, 1.0, 1.0]"),
        ("# Without limits_degrees it turns without end.", "limits_degrees = [-200.0, 200.0]"),
    ];
    let text = format!(
        "{HEAD}RAPID\nGOTO/0,0,0,.008726535,0,.999961923\nGOTO/0,0,0,-.006170592,.006170592,.999961923\n\
         GOTO/0,0,0,0,0,1\nGOTO/0,0,0,-.664463024,-.664463024,.342020143\nFINI\n"
    );
    let kinds = found(&changed("linuxcnc-mill5", &changes).unwrap(), &text);
    let errors: Vec<_> = kinds.iter().filter(|kind| kind.severity() == Severity::Error).collect();
    assert!(matches!(errors[..], [PostFindingKind::RotaryLimit { axis, .. }] if axis == "C"), "{kinds:?}");
}
