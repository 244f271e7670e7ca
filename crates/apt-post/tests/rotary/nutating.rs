//! A table about an axis that leans by half a right angle: on the way to an upright tool both axes turn.

use super::{HEAD, changed, tape_for};

#[test]
fn a_cut_comes_to_an_upright_tool_with_both_axes_where_they_lead() {
    let vector = ("vector = [1.0, 0.0, 0.0]", "vector = [0.0, 0.7071, 0.7071]");
    let mill = changed("linuxcnc-mill5", &[vector]).unwrap();
    let leaning = "GOTO/0,0,10,.87274395,0,.488178245";
    for cut in [format!("{leaning}\nGOTO/0,-60,10,0,0,1"), format!("GOTO/0,-60,10,0,0,1\n{leaning}")] {
        let tape = tape_for(&mill, &format!("{HEAD}RAPID\nGOTO/0,0,150,0,0,1\nRAPID\n{cut}\nFINI\n"));
        assert!(tape.findings.is_empty(), "{:?}", tape.findings);
        // No block turns it on the spot.
        let turning =
            tape.text().lines().filter(|line| line.contains(" F")).map(str::to_owned).collect::<Vec<_>>();
        assert!(turning.iter().all(|line| line.contains('Y')), "{turning:#?}");
    }
}
