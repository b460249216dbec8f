//! What arms and rigs are known to have and the catalogue has no name for: what comes to rest
//! with time, gives way with warmth, with another joint's angle or torque or one way more than the
//! other, is loose in its seat; a load that is not what is read of it.
//!
//! No description has a word for any of it, so none is ever named. It is what names are
//! held against where structure is left: a search for what is missing names the effect most
//! like it, and where something of this list accounts for more, that name is a wrong one.
//! The list is no catalogue either; on what is in neither, names are still taken back by
//! what they leave (see [`verdict`](crate::trace::verdict)).

mod bent_cell;
mod foreign_angle;
mod friction;
mod gain_of_angle;
mod growth;
mod lag;
mod loose_tool;
mod one_sided;
mod soft_base;
mod stray_coupling;
mod uneven_base;
mod warmth;

use std::sync::Arc;

pub use self::lag::KIND as LAG;
pub use self::stray_coupling::KIND as STRAY_COUPLING;
use super::{Kind, Number};
use crate::identify::setup::Setup;

/// Every kind without a name, in the order of precedence among exact aliases.
pub static NAMELESS: [&Kind; 12] = [
    &bent_cell::KIND,
    &friction::KIND,
    &growth::KIND,
    &loose_tool::KIND,
    &soft_base::KIND,
    &uneven_base::KIND,
    &lag::KIND,
    &one_sided::KIND,
    &gain_of_angle::KIND,
    &warmth::KIND,
    &foreign_angle::KIND,
    &stray_coupling::KIND,
];

/// By how much of itself the load of each row is another, times this number, between `-most` and
/// `most` (1).
fn of_loads(name: &'static str, most: f64, factors: impl Iterator<Item = f64>) -> Number {
    let factors: Arc<[f64]> = factors.collect();
    let own = Arc::clone(&factors);
    let enters = move |setup: &mut Setup, share: f64| setup.loads.push((share, Arc::clone(&own)));
    Number::of_setup(name, "1", most, enters, move |point, _| point.of_loads(&factors))
}
