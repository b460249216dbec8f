//! Drilling cycles.

use super::{Format, Options, moves, points, read};

/// x, z and whether it is a rapid of each move.
fn told(text: &str) -> Vec<(f64, f64, bool)> {
    let moves = moves(text);
    points(&moves).iter().zip(&moves).map(|([x, _, z], each)| (*x, *z, each.rapid)).collect()
}

#[test]
fn a_drill_goes_back_to_where_it_began_or_to_r() {
    let text = "G0 X0 Y0 Z20\nG98 G81 X5 Z-3 R2 F100\nX9\nG99 X12\nX15\nG80\nG0 Z20";
    let [rapid, feed] = [true, false];
    assert_eq!(
        told(text),
        [
            (0.0, 20.0, rapid),
            (5.0, 20.0, rapid),
            (5.0, 2.0, rapid),
            (5.0, -3.0, feed),
            (5.0, 20.0, rapid),
            (9.0, 20.0, rapid),
            (9.0, 2.0, rapid),
            (9.0, -3.0, feed),
            (9.0, 20.0, rapid),
            (12.0, 20.0, rapid),
            (12.0, 2.0, rapid),
            (12.0, -3.0, feed),
            (12.0, 2.0, rapid),
            (15.0, 2.0, rapid),
            (15.0, -3.0, feed),
            (15.0, 2.0, rapid),
            (15.0, 20.0, rapid),
        ]
    );
}

#[test]
fn pecks_clear_the_hole_or_break_the_chip() {
    let depths = |text: &str| told(text).iter().skip(2).map(|(_, z, rapid)| (*z, *rapid)).collect::<Vec<_>>();
    let [rapid, feed] = [true, false];
    assert_eq!(
        depths("G0 X0 Y0 Z5\nG99 G83 X0 Y0 Z-7 R1 Q3 F100"),
        [
            (-2.0, feed),
            (1.0, rapid),
            (-1.746, rapid),
            (-5.0, feed),
            (1.0, rapid),
            (-4.746, rapid),
            (-7.0, feed),
            (1.0, rapid)
        ]
    );
    assert_eq!(
        depths("G0 X0 Y0 Z5\nG99 G73 X0 Y0 Z-5 R1 Q3 F100"),
        [(-2.0, feed), (-1.746, rapid), (-5.0, feed), (1.0, rapid)]
    );
    assert_eq!(depths("G0 X0 Y0 Z5\nG99 G82 X0 Y0 Z-5 R1 P500 F100"), [(-5.0, feed), (1.0, rapid)]);
    // A boring bar comes back with feed.
    assert_eq!(depths("G0 X0 Y0 Z5\nG99 G85 X0 Y0 Z-5 R1 F100"), [(-5.0, feed), (1.0, feed)]);
}

#[test]
fn holes_in_a_row() {
    let holes = told("G0 X0 Y0 Z5\nG91 G99 G81 X10 Z-6 R-3 L3 F100");
    let bottoms: Vec<f64> = holes.iter().filter(|(_, _, rapid)| !rapid).map(|(x, ..)| *x).collect();
    assert_eq!(bottoms, [10.0, 20.0, 30.0]);
    assert!(holes.iter().all(|(_, z, rapid)| *rapid || *z == -4.0), "{holes:?}");
    // Other planes, and never sideways below R.
    let along_y = moves("G18 G0 X0 Y1 Z0\nG81 X5 Y-3 R4 F100");
    assert_eq!(
        points(&along_y),
        [[0.0, 1.0, 0.0], [0.0, 4.0, 0.0], [5.0, 4.0, 0.0], [5.0, -3.0, 0.0], [5.0, 4.0, 0.0]]
    );
}

#[test]
fn wrong_cycles_are_shown_where_they_are() {
    for (text, part) in [
        ("G81 X1 Z-3 F100", "G81 needs the bottom of the hole, Z, and R"),
        ("G83 X1 Z-3 R1 F100", "the depth of a peck, Q"),
        ("G81 X1 Z3 R1 F100", "is above R"),
        ("G83 X1 Z-3 R1 Q0.0001 F100", "more than 10000 pecks"),
        ("G81 X1 Z-3 R1", "the move has no feed"),
        ("G81 X1 Z-3 R1 L1.5 F100", "L is the number of holes"),
        ("G93 G81 X1 Z-3 R1 F100", "no inverse time"),
        ("G84 X1 Z-3 R1 F100", "G84 is not followed: tapping"),
    ] {
        let said = read(Format::GCode, &format!("G21 G0 X0 Y0 Z5\n{text}"), &Options::default()).unwrap_err();
        assert!(said.contains(part) && said.contains("part.ngc:2:"), "{text}: {said}");
    }
}
