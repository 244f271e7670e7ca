//! Axes that come to their end between two positions, both of which they reach.

use apt_post::{PostFindingKind, machine};

use super::{HEAD, found};

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
