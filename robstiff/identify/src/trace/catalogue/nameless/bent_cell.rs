//! A load cell whose line is bent: of what it reads as `f` there acts `f (1 + bend |f| / most)`,
//! `most` being the largest force of the campaign. A gear that hardens or softens does much the
//! same, but each about its own torque.

use std::vec;
use std::vec::Vec;

use super::super::{Form, Kind, Offers, Place, Scene};
use super::of_loads;

/// The kind.
pub static KIND: Kind = Kind {
    name: "bent_load_cell",
    of_rig: true,
    words: |_| "a load cell that does not read in proportion to the force".into(),
    explanation: "",
    offer,
    on_axes: None,
};

/// A cell that is off by more than this is broken (1).
const MOST: f64 = 0.5;

fn offer(scene: &Scene<'_>, offers: &mut Offers<'_>) {
    let size = |row: usize| scene.samples.rows[row].wrench.fixed_rows::<3>(0).norm();
    let sizes: Vec<f64> = (0..scene.samples.rows.len()).map(size).collect();
    let most = sizes.iter().copied().fold(0.0, f64::max);
    if most <= 0.0 {
        return;
    }
    let bend = of_loads("bend", MOST, sizes.iter().map(|size| size / most));
    offers.add(Place::Rig, vec![bend], vec![Form::of([0])]);
}
