//! How closely contacts are asked for.

use apt_geometry::canonical::{Cylinder, Remembering, RuledSurface};

use super::*;
use crate::clearance::{Enough, JUDGED};

/// A ruled surface from a circle to a point.
fn pointed() -> Geometry {
    let circle = Cylinder {
        point: v(10.716618839695734, 7.224740459039711, -7.027718658888466),
        axis: v(0.19350158462073175, 0.3444258197362644, 0.9186555347072525),
        radius: 11.784147740886375,
    };
    Geometry::RuledSurface(Remembering::new(RuledSurface {
        parts: vec![
            Geometry::Circle(circle),
            Geometry::Point(v(-0.5149057805288124, 2.637107179396912, -6.207588440056615)),
            Geometry::Point(v(4.81110309787589, -3.233895557505254, -5.128257031062322)),
            Geometry::Vector(v(-0.7206473454808197, -0.5854893995093903, 0.37130791334629787)),
            Geometry::Point(v(3.258712037418091, 2.862215258955314, 2.7100805099853758)),
        ],
    }))
}

/// Ends of a tool whose corner is below the point.
const TIPS: [[f64; 3]; 5] = [
    [3.158250451906833, 2.6044561282464818, 2.9386310696747504],
    [3.1590323676871876, 2.604310088839709, 2.9393423767507514],
    [3.16020524135772, 2.6040910297295494, 2.940409337364753],
    [3.1604007203028086, 2.604054519877856, 2.9405871641337535],
    [3.1606459301077425, 2.6040087217300925, 2.940810230957236],
];

/// Below the point of a surface several places of that are equally near to what is deepest of the tool, and no slope leads there: it is come
/// nearer to again and again. A vector is proven by what leaves a share of the band open.
#[test]
fn what_is_deepest_below_a_point_is_told_to_what_is_asked() {
    let numbers =
        [0.7353997849358207, 0.0, 0.36769989246791035, 0.0, 0.0, 4.002784056061772, 2.329127031778759];
    let cutter = Cutter::from_numbers(&numbers, 1.0).expect("a cutter");
    let tool = Tool::new(cutter, v(-0.4865970237603663, -0.452703467146241, -0.7471833157273561));
    let gauge = gauge(&pointed(), 1.0);
    let (mut close, mut asked) = (0, 0);
    for (k, [x, y, z]) in TIPS.into_iter().enumerate() {
        let tip = v(x, y, z);
        let enough = Enough { lowest: -0.01, slack: 1.5e-7, share: 0.0 };
        let counted = |enough: Enough| {
            let before = JUDGED.get();
            let found =
                Gauge { memory: Memory::default(), ..gauge.clone() }.contact_within(&tool, &tip, enough);
            (found, JUDGED.get() - before)
        };
        let ((all, _), count) = counted(Enough::ALL);
        close += count;
        let ((contact, missed), count) = counted(enough);
        asked += count;
        if contact.clearance >= enough.lowest {
            assert!(contact.clearance - missed <= all.clearance, "{k}: {contact:?} {missed} {all:?}");
            assert!(missed <= 0.011 * (contact.clearance - enough.lowest), "{k}: {missed}");
        }
    }
    assert!(3 * asked < close, "{asked} patches looked at, {close} for what is deepest");
}
