//! What arms are known to have and the catalogue has no name for: what comes to rest with
//! time, gives way with warmth or with another joint's angle, is loose in its seat.
//!
//! No description has a word for any of it, so none is ever named. It is what names are
//! held against where structure is left: a search for what is missing names the effect most
//! like it, and where something of this list accounts for more, that name is a wrong one.
//! The list is no catalogue either; on what is in neither, names are still taken back by
//! what they leave (see [`verdict`](crate::trace::verdict)).

mod foreign_angle;
mod growth;
mod lag;
mod loose_tool;
mod soft_base;
mod warmth;

pub use self::lag::KIND as LAG;
use super::Kind;

/// Every kind without a name, in the order of precedence among exact aliases.
pub static NAMELESS: [&Kind; 6] =
    [&growth::KIND, &loose_tool::KIND, &soft_base::KIND, &lag::KIND, &warmth::KIND, &foreign_angle::KIND];
