//! What numbers along a path mean less than they seem to, said before they are.

use robstiff_machining::deviation::{Deviation, DeviationPoint, width};
use robstiff_machining::milling::Forces;

use crate::output::complain;
use crate::text::{decimals, micrometres};

/// Displacements that are small against an arm end here (m).
const SMALL: f64 = 0.01;

/// A displacement of more than this share of the chip's section changes the force in another
/// proportion than at first.
const PART: f64 = 0.5;

/// Whether nobody knows on which side the wall is: of forces without a model, and of a cut that
/// meets no wall. A slot has one on either side.
pub fn lacks_wall(forces: Option<&Forces>) -> bool {
    match forces {
        Some(Forces::Model(cut)) => cut.engagement.wall().is_none() && !cut.engagement.is_slot(),
        Some(Forces::Measured { .. }) | None => true,
    }
}

/// Says where displacements are so large that what they are computed with does not hold.
pub fn complain_of_size(name: &str, forces: Option<&Forces>, deviation: &Deviation) {
    let worst = deviation.distances().map_or(0.0, |distances| distances.worst.abs());
    if worst > SMALL {
        complain(format_args!(
            "warning: {name} pushes the tool off by {} mm: compliances are those of small displacements; are forces in \
             another unit?",
            decimals(1e3 * worst, 1)
        ));
        return;
    }
    let Some(Forces::Model(cut)) = forces else { return };
    let most = |axis: usize| {
        let along = |point: &DeviationPoint| point.components.map_or(0.0, |components| components[axis].abs());
        deviation.points.iter().map(along).fold(0.0, f64::max)
    };
    // A slot is as wide as the tool wherever that is.
    let width = cut.engagement.wall().map(|_| ("width", width(cut), most(1)));
    let sections = width.into_iter().chain([("depth", cut.depth, most(2))]);
    if let Some((what, section, off)) = sections.into_iter().find(|(_, section, off)| *off > PART * section) {
        complain(format_args!(
            "warning: {name} pushes the tool off by {} um, of a {what} of {} um: the force is taken to change in \
             proportion, as it does at first, and is smaller than that",
            micrometres(off),
            micrometres(section)
        ));
    }
}
