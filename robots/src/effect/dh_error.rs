//! `dh_error`: a length or twist of the DH table is off.
//!
//! The value adds to the entry. `theta` of a joint that turns is its
//! [`joint_zero_offset`](super::joint_zero_offset).

use super::Place;
use super::physics::*;

/// A correction of one entry of the DH table.
pub struct DhError;

impl Physics<1> for DhError {
    const ABOUT: About = About {
        kind: "dh_error",
        at: At::Entry,
        kinematic: true,
        noun: "the error of {}",
        explanation: "The arm was not made to the table's numbers exactly. A kinematic calibration finds the error, \
            and the corrected description takes it out.",
        typical: "",
        parameters: &[Parameter {
            name: "value",
            symbol: "ERROR",
            what: "Error",
            quantity: Quantity::Entry,
            range: Range::Any,
            default: None,
            example: "0.3 mm",
        }],
    };

    fn correct([value]: [f64; 1], place: Place, row: &mut Row) {
        if let Place::Entry(entry) = place {
            *row.entry(entry) += value;
        }
    }
}
