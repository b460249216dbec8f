//! What numbers along a path mean less than they seem to, said before they are.

use robstiff_machining::cell::Cell;
use robstiff_machining::deviation::{Deviation, DeviationPoint, width};
use robstiff_machining::milling::{Cut, CutFile, Forces};
use robstiff_machining::path::ToolPath;

use crate::failure::Failure;
use crate::output::complain;
use crate::text::{decimals, micrometres, significant};

/// Displacements that are small against an arm end here (m).
const SMALL: f64 = 0.01;

/// A displacement of more than this share of the chip's section changes the force in another
/// proportion than at first.
const PART: f64 = 0.5;

/// Diameters that differ by less are the same: rounding.
const SAME: f64 = 1e-6;

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

/// Says so where the path moves at another feed than the cut, whose force it is; of a program that
/// gives the feed, where its spindle turns with another speed. `peak`: the feed is that of the cut.
pub fn complain_of_feed(file: &CutFile, name: &str, path: &ToolPath, peak: bool) {
    let Forces::Model(cut) = &file.forces else { return };
    if path.is_program && !peak {
        return complain_of_speed(cut, name, path);
    }
    let Some(of_cut) = cut.feed_speed() else { return };
    let differs = |feed: f64| (feed / of_cut - 1.0).abs() > 0.01;
    let Some((line, feed)) =
        path.points.iter().find_map(|point| point.feed.filter(|feed| differs(*feed)).map(|feed| (point.line, feed)))
    else {
        return;
    };
    let [of_path, of_cut] = [feed, of_cut].map(|feed| significant(feed * 6e4, 4));
    complain(format_args!(
        "warning: {}:{line}: the path's feed is {of_path} mm/min, the one that {name} computes its force for {of_cut} mm/min",
        path.file
    ));
}

/// Says so where nobody has the speed of the spindle, or a program turns it with another than the cut.
fn complain_of_speed(cut: &Cut, name: &str, path: &ToolPath) {
    let mut cutting = path.points.iter().filter(|point| !point.rapid);
    let Some(of_cut) = cut.speed else {
        if let Some(point) = cutting.find(|point| point.spindle.is_none_or(|speed| speed == 0.0)) {
            complain(format_args!(
                "warning: {}:{}: neither the program nor {name} has the speed of the spindle: the feed is that of {name}",
                path.file, point.line
            ));
        }
        return;
    };
    let speeds = cutting.filter_map(|point| Some((point.line, point.spindle.filter(|speed| *speed != 0.0)?.abs())));
    let mut other = speeds.filter(|(_, speed)| (speed / of_cut - 1.0).abs() > 0.01);
    let Some((line, speed)) = other.next() else { return };
    let [speed, of_cut] = [speed, of_cut].map(|speed| significant(speed * 60.0 / core::f64::consts::TAU, 4));
    complain(format_args!(
        "warning: {}:{line}: the program's spindle turns with {speed} rpm, that of {name} with {of_cut} rpm; the \
         program's counts",
        path.file
    ));
}

/// Says so where the tool that a cell has in the spindle is not as wide as that of the cut.
pub fn complain_of_diameter(cell: &Cell, path: &ToolPath, name: &str, forces: &Forces) -> Result<(), Failure> {
    let Forces::Model(cut) = forces else { return Ok(()) };
    let of_cell = cell.tool_on(path)?.and_then(|tool| tool.diameter);
    if let Some(of_cell) = of_cell.filter(|of_cell| (of_cell / cut.mill.diameter - 1.0).abs() > SAME) {
        let [of_cell, of_cut] = [of_cell, cut.mill.diameter].map(|diameter| significant(1e3 * diameter, 4));
        complain(format_args!(
            "warning: {}: the tool in the spindle is {of_cell} mm wide, that of {name} {of_cut} mm: the force is that of \
             {name}",
            cell.file
        ));
    }
    Ok(())
}
