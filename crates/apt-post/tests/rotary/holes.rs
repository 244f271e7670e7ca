//! Holes along a head that leans.

use apt_post::machine;

use super::{HEAD, tape_for};

/// A hole without steps is made in one, and one of two steps in two, whatever the last bits of heights along the tool are.
#[test]
fn no_pass_is_made_twice() {
    let mill = machine("fanuc-mill5").unwrap();
    for (cycle, passes) in [("DRILL,5,MMPM,100,2", 1), ("DEEP,8,MMPM,100,2,STEP,5", 2)] {
        for lean in 1..60 {
            let (sine, cosine) = f64::from(lean).to_radians().sin_cos();
            let axis = format!("{sine:.9},0,{cosine:.9}");
            let text = format!(
                "{HEAD}RAPID\nGOTO/60,0,120,{axis}\nCYCLE/{cycle}\nGOTO/10.123,0,7.7,{axis}\nGOTO/0,3.3,1.9,{axis}\nCYCLE/OFF\nFINI\n"
            );
            let tape = tape_for(&mill, &text);
            assert!(tape.is_ok(), "{:?}", tape.findings);
            assert_eq!(tape.text().matches("G1 ").count(), 2 * passes, "{}", tape.text());
        }
    }
}
