//! Friction on the way from the load cell to the tool, in a pulley or a joint of the rod: what
//! acts is `f (1 - share)` while the load grows and `f (1 + share)` while it falls. The arm then
//! seems to come back late, as one whose gears have hysteresis or creep does, but all of it alike.

use std::vec;
use std::vec::Vec;

use super::super::{Form, Kind, Number, Offers, Place, Scene};
use super::of_loads;
use crate::campaign::{Displacements, Observation};

/// The kind.
pub static KIND: Kind = Kind {
    name: "load_friction",
    of_rig: true,
    words: |_| "friction between the load cell and the tool".into(),
    explanation: "",
    offer,
    on_axes: None,
};

/// A rope that holds back more than this does not run (1).
const MOST: f64 = 0.5;

/// Loads that differ by less than this part are one load, which neither grows nor falls.
const SAME: f64 = 0.01;

fn offer(scene: &Scene<'_>, offers: &mut Offers<'_>) {
    let ways = ways(scene.data);
    if !(ways.contains(&1.0) && ways.contains(&-1.0)) {
        // What holds back all loads alike is another scale.
        return;
    }
    let held_back = of_loads("share", MOST, ways.iter().map(|way| -way));
    let share = Number { range: [0.0, MOST], ..held_back };
    offers.add(Place::Rig, vec![share], vec![Form::of([0])]);
}

/// Whether the load of each row grew to what it is, or fell: 1 or -1. A visit begins unloaded.
fn ways(data: &Displacements) -> Vec<f64> {
    let mut last = vec![(0.0, 1.0); data.visits.len()];
    let way = |row: &Observation| {
        let (size, way) = &mut last[row.visit];
        let now = row.wrench[..3].iter().map(|force| force * force).sum::<f64>().sqrt();
        if (now - *size).abs() > SAME * now.max(*size) {
            *way = if now > *size { 1.0 } else { -1.0 };
        }
        *size = now;
        *way
    };
    data.rows.iter().map(way).collect()
}
