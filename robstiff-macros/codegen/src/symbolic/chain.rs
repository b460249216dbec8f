//! A description as a chain of elementary steps from the base to the TCP.

use robstiff_robots::angle::{quarter_turns, sin_cos_of_turns};
use robstiff_robots::{Description, Placement};

pub use super::step::{Step, Tilt};
pub use super::upright::upright;
use super::upright::{Series, deviations, steps};
use super::weight;
use crate::graph::{Graph, Sym};

/// The steps of a description, base first, with every joint where it stands.
pub fn chain<'g>(g: &'g Graph, robot: &Description) -> Vec<Step<'g>> {
    let aside = deviations(g, robot);
    let upright = steps(g, robot, &aside, Series::Short);
    let Some(sag) = weight::sag(g, robot, &upright) else { return upright };
    let both = |(aside, sag): (&Option<Sym<'g>>, Sym<'g>)| Some(aside.map_or(sag, |aside| aside + sag));
    steps(g, robot, &aside.iter().zip(sag).map(both).collect::<Vec<_>>(), Series::Long)
}

/// The homogeneous matrix of a placement by rows, with exact quarter turns.
pub fn homogeneous(placement: &Placement) -> [f64; 16] {
    let [(sr, cr), (sp, cp), (sy, cy)] = placement.rpy.map(|angle| match quarter_turns(angle) {
        Some(turns) => sin_cos_of_turns(turns),
        None => angle.sin_cos(),
    });
    let [x, y, z] = placement.xyz;
    [
        [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr, x],
        [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr, y],
        [-sp, cp * sr, cp * cr, z],
        [0.0, 0.0, 0.0, 1.0],
    ]
    // -0 would be printed as such.
    .map(|row| row.map(|entry| entry + 0.0))
    .concat()
    .try_into()
    .expect("four rows of four")
}
