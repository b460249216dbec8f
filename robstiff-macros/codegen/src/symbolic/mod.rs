//! The mathematics, on symbols.
//!
//! - `step`: the elementary steps of a chain;
//! - `parameters`: the numbers of joints and effects, under the names that generated
//!   code has for them;
//! - [`elastic`]: what yields, under the names that generated code has for it;
//! - `upright`: a description as elementary steps from base to TCP, without a sag;
//! - [`chain`](mod@chain): the same where every joint stands;
//! - [`turning`]: what is turned on the way, parallel axes as one angle;
//! - [`forward`](mod@forward): frames and levers, from the base to the TCP;
//! - [`waist`]: the first joint's turn, left for the end where that is cheaper;
//! - [`kinematics`]: transform, frames, Jacobian, torques and deflection;
//! - [`beam`]: how a link yields;
//! - [`weight`]: what the arm's own weight puts on its joints;
//! - [`compliance`](mod@compliance): the Cartesian compliance, carried from the TCP to the
//!   base;
//! - [`columns`]: frames, Jacobian and all together once more, of whole [`mod@column`]s.

pub mod beam;
pub mod chain;
pub mod column;
pub mod columns;
pub mod compliance;
pub mod elastic;
pub mod forward;
pub mod kinematics;
mod parameters;
mod step;
pub mod turning;
mod upright;
pub mod vector;
pub mod waist;
pub mod weight;

pub use chain::{Step, Tilt, chain};
pub use compliance::compliance;
pub use elastic::Elastic;
pub use forward::{Forward, forward};
pub use kinematics::{deflection, deflection_with, jacobian, joint_torques, link_frames, plays, preload, transform};

use robstiff_robots::{Description, Effect};

use crate::graph::{Graph, Sym};

/// Transform (16 entries), Jacobian (6 a joint) and compliance (36), which share
/// what they have in common by being in one graph.
pub fn statics<'g>(g: &'g Graph, robot: &Description) -> Vec<Sym<'g>> {
    waist::cheapest(g, robot, |g, start| {
        let transform = kinematics::transform_from(g, start);
        [transform, kinematics::jacobian_from(g, start, robot), compliance(g, robot)].concat()
    })
}

/// How the entries of a result are calculated.
pub type Algorithm = for<'g> fn(&'g Graph, &Description) -> Vec<Sym<'g>>;

/// Whether a robot's gears carry its own weight before any load.
pub fn preloads(robot: &Description) -> bool {
    robot.effects.iter().any(|effect| matches!(effect, Effect::GravityPreload { .. }))
}

/// Whether a robot's deflection depends on the loads before.
pub fn remembers(robot: &Description) -> bool {
    robot.effects.iter().any(|effect| effect.plays_in_use() > 0)
}
