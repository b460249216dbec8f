//! Loads along one line, as hung weights are, and a load cell that is turned against them.

use std::string::ToString;
use std::vec;

use nalgebra::{Rotation3, Vector3};

use super::tests::{names, traced};
use super::*;
use crate::campaign::made::Plan;

const DOWN: [f64; 3] = [0.0, 0.0, -1.0];
const ALONG_X: [f64; 3] = [1.0, 0.0, 0.0];
const ALONG_NONE: [f64; 3] = [0.6, 0.3, -0.7];

fn turned(force: Vector3<f64>) -> Vector3<f64> {
    Rotation3::new(TURN) * force
}

const TURN: Vector3<f64> = Vector3::new(0.035, -0.026, 0.044);

/// The turn of the load cell that was found, and one standard deviation of its numbers.
fn turn_of(found: &Trace) -> [Vector3<f64>; 2] {
    let effect = &found.effects[0].effect;
    let std = |name: &str| effect.parameters.iter().find(|number| number.name == name).and_then(|number| number.std);
    let of = |number: &dyn Fn(&str) -> f64| Vector3::from(["rx", "ry", "rz"].map(number));
    [of(&|name| effect.value(name)), of(&|name| std(name).unwrap_or_default())]
}

/// A turn about the line does nothing; what is across it is found, and named for what it is.
#[test]
fn what_they_show_of_a_turn_is_named() {
    for (line, seed) in [(DOWN, 1), (ALONG_X, 2)] {
        let line = Vector3::from(line);
        let found = traced(&Plan { line: Some(line), acts: turned, ..Plan::new(seed) }.run());
        let named = (names(&found), found.verdict);
        assert_eq!(named, (vec!["load_cell_misalignment@rig".into()], Verdict::Explained), "{seed}: {}", found.why);
        let words = found.effects[0].effect.words();
        assert_eq!(words, "a turn of the load cell across the line of the loads, constant in the base frame");
        let [turn, std] = turn_of(&found);
        assert!((0..3).all(|axis| (std[axis] > 0.0) == (line[axis] == 0.0)), "{seed}: {turn} {std}");
        let off = (Rotation3::new(turn) * line - turned(line)).norm();
        assert!(off < 4.0 * std.norm() && std.norm() < 0.3 * TURN.norm(), "{seed}: {off} {turn} {std}");
    }
}

/// Along no axis, unequal scales turn loads as well.
#[test]
fn what_turns_them_as_well_is_told() {
    let found = traced(&Plan { line: Some(Vector3::from(ALONG_NONE)), acts: turned, ..Plan::new(3) }.run());
    assert_eq!((names(&found).len(), found.verdict), (1, Verdict::Explained), "{:?}", names(&found));
    let may_be = [&names(&found)[..], &found.effects[0].same_as].concat();
    for name in ["load_cell_misalignment@rig", "load_cell_scale@rig"] {
        assert!(may_be.contains(&name.to_string()), "{may_be:?}");
    }
}

/// Where loads differ in direction, the turn has its three components.
#[test]
fn loads_all_round_show_all_of_a_turn() {
    let found = traced(&Plan { acts: turned, ..Plan::new(4) }.run());
    assert_eq!((names(&found), found.verdict), (vec!["load_cell_misalignment@rig".into()], Verdict::Explained));
    assert_eq!(found.effects[0].effect.words(), "a turn of the load cell, constant in the base frame");
    let [turn, std] = turn_of(&found);
    assert!((0..3).all(|axis| (turn[axis] - TURN[axis]).abs() < 4.0 * std[axis]), "{turn} {std}");
}

/// They lack nothing where nothing is hidden.
#[test]
fn they_are_adequate_where_nothing_is_turned() {
    for (line, seed) in [DOWN, ALONG_X, ALONG_NONE].into_iter().cycle().zip(1..=9) {
        let found = traced(&Plan { line: Some(Vector3::from(line)), ..Plan::new(seed) }.run());
        assert_eq!((names(&found), found.verdict), (vec![], Verdict::Adequate), "{seed}: {}", found.why);
    }
}

/// A scale of the loads is one of all compliances and of what the bias does, so that its slope
/// is among theirs; but it would have to be twice the load to do what a part of the bias does.
#[test]
fn a_scale_is_no_part_of_a_bias() {
    let aside = |force| force + Vector3::new(60.0, -45.0, 20.0);
    let found = traced(&Plan { line: Some(Vector3::from(DOWN)), acts: aside, ..Plan::new(3) }.run());
    assert_eq!((names(&found), found.verdict), (vec!["load_cell_bias@rig".into()], Verdict::Explained));
    let others = [&found.effects[0].same_as[..], &found.effects[0].in_part].concat();
    assert!(others.is_empty(), "{others:?}");
}
