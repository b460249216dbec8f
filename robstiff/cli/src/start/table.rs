//! The table to fill in: poses and loads, and no readings yet.

use std::fmt::Write as _;

use robstiff_identify::plan::first::First;
use robstiff_robots::Description;

/// A row for each load, in the base frame.
pub fn table(robot: &Description, found: &First) -> String {
    let mut csv = String::from("pose,visit");
    for (number, joint) in (1..).zip(&robot.joints) {
        write!(csv, ",q{number} [{}]", joint.people_unit()).expect("a string takes any text");
    }
    csv += ",Fx [N],Fy [N],Fz [N],dx [um],dy [um],dz [um]\n";
    for (number, visit) in (1..).zip(&found.visits) {
        for load in &visit.loads {
            write!(csv, "{number},{number}").expect("a string takes any text");
            let q = visit.q.iter().zip(&robot.joints).map(|(&q, joint)| joint.for_people(q) + 0.0);
            for value in q.chain(load[..3].iter().copied()) {
                write!(csv, ",{value}").expect("a string takes any text");
            }
            csv += ",,,\n";
        }
    }
    csv
}
