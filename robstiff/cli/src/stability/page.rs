//! The prediction as text.

use std::f64::consts::TAU;

use robstiff::analysis::PrincipalDirections;
use robstiff::nalgebra::{SymmetricEigen, Vector3};
use robstiff_machining::milling::Cut;
use robstiff_machining::stability::{Limits, best};
use robstiff_robots::Description;

use super::{Predicted, Source, alike, softest};
use crate::modes;
use crate::text::{Table, decimals, significant};

/// What a prediction says, and what it does not.
pub const COVERS: &str = "chatter of the arm's own modes in this pose, each tooth on the surface that the one before \
                          has cut, with forces averaged over a revolution; not the modes of spindle, tool or workpiece";

/// How many rows of directions a person reads.
const ROWS: usize = 12;
/// How many of speeds, so that the cut's is among them.
const SPEED_ROWS: usize = 10;

pub fn page(predicted: &Predicted, robot: &Description, cut: &Cut) -> String {
    let state = if predicted.stiffens { ", without load" } else { "" };
    let mut page = format!("{}: {COVERS}\n\nThe arm at its tool{state}\n", robot.name);
    page += &directions(predicted);
    let frequencies: Vec<String> =
        predicted.modes.frequencies().iter().map(|frequency| decimals(frequency / TAU, 1)).collect();
    let mass = predicted.mass.map(|mass| SymmetricEigen::new(mass).eigenvalues);
    let source = match (predicted.source, mass) {
        (Source::Table, _) => ", as measured".to_owned(),
        (Source::Frequency, Some(mass)) => {
            format!(", mass at the tool {} kg, by the frequency of the first", significant(mass.max(), 3))
        }
        (Source::Links, Some(mass)) => format!(
            ", by the masses of the links; mass at the tool {} to {} kg",
            significant(mass.min(), 3),
            significant(mass.max(), 3)
        ),
        (_, None) => ", by the masses of the links".to_owned(),
    };
    page += &format!("modes at {} Hz{source}", frequencies.join(", "));
    let dampings = predicted.modes.damping();
    let undamped = dampings.iter().all(|damping| *damping == 0.0);
    page += &match alike(&predicted.modes) {
        _ if undamped => ", no damping\n".to_owned(),
        Some(damping) => format!(", damping ratio {}\n", significant(damping, 3)),
        None => {
            let each: Vec<String> = dampings.iter().map(|damping| significant(*damping, 3)).collect();
            format!(", damping ratios {}\n", each.join(", "))
        }
    };
    let (speed, teeth) = (cut.speed.unwrap_or_default(), cut.tooth_period().unwrap_or_default().recip());
    page += &format!("teeth pass at {} Hz, {} rpm\n", significant(teeth, 4), rpm(speed));
    if undamped {
        page += "without damping a movement that the cut feeds at all grows at any depth: give the measured ratio, e.g. \
                 --damping 0.02\n";
    }
    page += &predicted.table.as_ref().map(modes::page).unwrap_or_default();
    page += &format!("\nDepth at which it begins, by feed (up to {} mm looked at)\n", millimetres(predicted.greatest));
    page += &feeds(predicted);
    if predicted.stiffens {
        let force = decimals(cut.mean_force().norm(), 1);
        page += &format!(
            "softest: of the arm under the mean force of the cut at {} mm, {force} N, with that feed\n",
            millimetres(cut.depth)
        );
    }
    page += "any speed: stable up to there at every speed; without delay: on a surface that stays even\n";
    page += "\nDepth at which it begins, by spindle speed\n";
    page += &lobes(predicted);
    page += "\n";
    page + &verdict(predicted, cut)
}

fn directions(predicted: &Predicted) -> String {
    // The modes have none that is not finite.
    let Some(principal) = PrincipalDirections::of(predicted.modes.compliance()) else { return String::new() };
    let mut table = Table::new(1, ["principal direction", "x", "y", "z", "stiffness [N/um]"]);
    let each = principal.directions.column_iter().zip(principal.stiffnesses());
    for (name, (unit, stiffness)) in ["softest", "second", "stiffest"].into_iter().zip(each) {
        let mut row = vec![name.to_owned()];
        row.extend(unit.iter().map(|&part| decimals(part, 3)));
        row.push(stiffness.map_or("rigid".to_owned(), |stiffness| significant(1e-6 * stiffness, 4)));
        table.row(row);
    }
    table.to_string()
}

fn feeds(Predicted { feeds, stiffens, .. }: &Predicted) -> String {
    let header = ["angle [deg]", "feed x", "y", "z", "depth [mm]", "any speed [mm]", "without delay [mm]"];
    let mut table = Table::new(0, header.into_iter().chain(stiffens.then_some("softest [N/um]")));
    for feed in feeds.iter().step_by(feeds.len().div_ceil(ROWS)) {
        let mut row = vec![degrees(feed.angle)];
        row.extend(feed.feed.iter().map(|&part| decimals(part, 3)));
        let at_any_speed = feed.lobes.at_any_speed();
        row.extend([feed.limits.limiting(), at_any_speed, feed.without_delay.limiting()].map(depth));
        row.extend(stiffens.then(|| softest(&feed.modes).map_or("rigid".to_owned(), |k| significant(k * 1e-6, 4))));
        table.row(row);
    }
    table.to_string()
}

fn lobes(Predicted { feeds, lobes, .. }: &Predicted) -> String {
    let Some(best) = best(feeds) else { return String::new() };
    let place = feeds.iter().position(|feed| feed.angle == best.angle).unwrap_or(0);
    let this = format!("{} deg [mm]", degrees(best.angle));
    let mut table = Table::new(0, ["speed [rpm]", &this, "worst feed [mm]", "best feed [deg]", "its depth [mm]"]);
    for lobe in lobes.iter().step_by(lobes.len().div_ceil(SPEED_ROWS)) {
        let best = lobe.best();
        table.row(vec![
            rpm(lobe.speed),
            depth(lobe.limits[place]),
            depth(lobe.least()),
            degrees(feeds[best].angle),
            depth(lobe.limits[best]),
        ]);
    }
    table.to_string()
}

fn verdict(predicted: &Predicted, cut: &Cut) -> String {
    let given = millimetres(cut.depth);
    let count =
        |is: fn(&Limits, f64) -> bool| predicted.feeds.iter().filter(|feed| is(&feed.limits, cut.depth)).count();
    let stable = count(Limits::is_stable_up_to);
    let all = predicted.feeds.len();
    let mut verdict = match stable {
        0 => format!("Up to {given} mm no feed is stable.\n"),
        _ if stable == all => format!("Up to {given} mm every feed is stable.\n"),
        _ => format!("Up to {given} mm, {stable} of {all} directions of feed are stable.\n"),
    };
    let beyond = count(Limits::is_stable) - stable;
    if beyond > 0 {
        let (are, they) = if beyond == 1 { ("is", "it chatters") } else { ("are", "they chatter") };
        verdict += &format!("{beyond} more {are} stable at {given} mm itself, but {they} at less.\n");
    }
    if let Some(best) = best(&predicted.feeds) {
        let along = direction(&best.feed);
        let angle = degrees(best.angle);
        verdict += &match best.limits.limiting() {
            Some(limit) => {
                let short = if limit < cut.depth { format!(", less than {given} mm") } else { String::new() };
                format!("Best feed: {angle} deg, along {along}, to {} mm{short}.\n", millimetres(limit))
            }
            None => format!("Best feed: {angle} deg, along {along}, beyond {} mm.\n", millimetres(predicted.greatest)),
        };
    }
    verdict
}

fn depth(limit: Option<f64>) -> String {
    limit.map_or_else(|| "none".to_owned(), millimetres)
}

/// A speed in rad/s in turns a minute, without the unit.
fn rpm(speed: f64) -> String {
    let turns = speed * 60.0 / TAU;
    if turns < 100.0 { significant(turns, 3) } else { decimals(turns, 0) }
}

/// An angle in rad as degrees without the unit.
fn degrees(angle: f64) -> String {
    significant(angle.to_degrees(), 4)
}

/// A direction in the base frame.
pub fn direction(unit: &Vector3<f64>) -> String {
    format!("({})", [unit.x, unit.y, unit.z].map(|part| decimals(part, 3)).join(", "))
}

/// A length in m as mm without the unit.
pub fn millimetres(length: f64) -> String {
    significant(length * 1e3, 3)
}
