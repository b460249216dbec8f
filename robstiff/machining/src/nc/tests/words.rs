//! Words, units, feeds, spindle, tools, offsets.

use core::f64::consts::TAU;

use nalgebra::Vector3;

use super::{Format, Options, moves, points, read};

#[test]
fn a_program_as_cam_writes_it() {
    let text = "%\nO1234 (BRACKET)\n(T1 (10 MM))\nN10 G21 G00 G17 G40 G49 G80 G90 G94 ; safe\nN20 T1 M06\nN30 g54 x1. y-.5 s6000 m3\n\
                N40 G43 H1 Z5 M8\nN50 G 1 Z - 2 F 300\nX+10\n\nN70 G0 Z5.0\nM5\nM30\n%\n";
    let (moves, warnings) = read(Format::GCode, text, &Options::default()).unwrap();
    assert_eq!(warnings, Vec::<String>::new());
    assert_eq!(points(&moves), [[1.0, -0.5, 5.0], [1.0, -0.5, -2.0], [10.0, -0.5, -2.0], [10.0, -0.5, 5.0]]);
    assert_eq!(moves.iter().map(|each| each.line).collect::<Vec<_>>(), [7, 8, 9, 11]);
    assert_eq!(moves.iter().map(|each| each.rapid).collect::<Vec<_>>(), [true, false, false, true]);
    assert_eq!(moves.iter().map(|each| each.feed).collect::<Vec<_>>(), [None, Some(0.005), Some(0.005), None]);
    assert!(moves.iter().all(|each| each.tool == Some(1) && each.axis == Vector3::z_axis()));
    assert!(moves.iter().all(|each| (each.spindle - 100.0 * TAU).abs() < 1e-9));
    // 7 mm at 5 mm/s.
    assert!((moves[1].duration.unwrap() - 1.4).abs() < 1e-12);
}

#[test]
fn lengths_are_in_the_unit_that_is_named() {
    assert_eq!(points(&moves("G0 X1 Y2 Z0\nG20 X1\nG21 Y3")), [[1.0, 2.0, 0.0], [25.4, 2.0, 0.0], [25.4, 3.0, 0.0]]);
    let (unnamed, warnings) = read(Format::GCode, "G0 X1 Y2 Z3\nG1 X2 F100", &Options::default()).unwrap();
    assert_eq!(points(&unnamed)[0], [1.0, 2.0, 3.0]);
    assert_eq!(warnings, ["part.ngc: no unit is named before line 1: lengths are taken in mm"]);
}

#[test]
fn incremental_moves_count_from_the_last() {
    let text = "G0 X1 Y2 Z3\nG91 X1 Z-1\nG1 Y1 F60\nG90 X0";
    assert_eq!(points(&moves(text)), [[1.0, 2.0, 3.0], [2.0, 2.0, 2.0], [2.0, 3.0, 2.0], [0.0, 3.0, 2.0]]);
}

#[test]
fn feeds_are_per_minute_inverse_or_per_revolution() {
    let feeds = |text: &str| {
        let moves = moves(text);
        let feeds = moves.iter().filter(|each| !each.rapid).map(|each| each.feed.unwrap() * 6e4);
        feeds.map(|feed| (feed * 1e6).round() / 1e6).collect::<Vec<f64>>()
    };
    assert_eq!(feeds("G0 X0 Y0 Z0\nG94 G1 X10 F500\nX20"), [500.0, 500.0]);
    // 10 mm in 1/50 of a minute, then in 1/100.
    assert_eq!(feeds("G0 X0 Y0 Z0\nG93 G1 X10 F50\nX20 F100"), [500.0, 1000.0]);
    assert_eq!(feeds("S3000 M3 G0 X0 Y0 Z0\nG95 G1 X10 F0.2"), [600.0]);
    assert_eq!(feeds("G20 G0 X0 Y0 Z0\nG1 X1 F10"), [254.0]);
}

#[test]
fn the_spindle_turns_as_m_codes_say() {
    let spindles: Vec<f64> =
        moves("S60\nG0 X0 Y0 Z0\nM3 X1\nM4 X2\nS120 X3\nM5 X4").iter().map(|each| each.spindle / TAU).collect();
    assert_eq!(spindles.iter().map(|turns| turns.round()).collect::<Vec<_>>(), [0.0, 1.0, -1.0, -2.0, 0.0]);
}

#[test]
fn tools_change_by_m6() {
    let tools: Vec<_> = moves("G0 X0 Y0 Z0\nT7 X1\nM6 X2\nT8\nX3\nM6\nX4").iter().map(|each| each.tool).collect();
    assert_eq!(tools, [None, None, Some(7), Some(7), Some(8)]);
}

#[test]
fn offsets_are_those_that_are_given() {
    let mut options = Options::default();
    options.offsets[1] = Some(Vector3::new(0.1, 0.0, 0.0));
    options.offsets[9] = Some(Vector3::new(0.0, 0.2, 0.0));
    let text = "G21 G0 X1 Y1 Z1\nG59.3 X1 Y1\nG55 X2 Y2\nG54 X2\n";
    let (moves, warnings) = read(Format::GCode, text, &options).unwrap();
    assert_eq!(points(&moves), [[101.0, 1.0, 1.0], [1.0, 201.0, 1.0], [2.0, 2.0, 1.0], [102.0, 2.0, 1.0]]);
    assert_eq!(warnings, ["part.ngc: G55 on line 3 has no zero: it is taken at that of the path's frame"]);
}

/// Where the machine's zero is not known the path goes on where it is known again.
#[test]
fn places_of_the_machine_are_not_followed() {
    let text =
        "G21 G0 X1 Y1 Z1\nG1 X2 F60\nG91 G28 Z0\nG90\nT2 M6\nG0 X5 Y5\nG1 X6\nG0 Z1\nG53 G0 Z0\nG53 X0 Y0\nM30\n";
    let (moves, warnings) = read(Format::GCode, text, &Options::default()).unwrap();
    assert_eq!(points(&moves), [[1.0, 1.0, 1.0], [2.0, 1.0, 1.0], [6.0, 5.0, 1.0]]);
    assert!(moves[2].rapid);
    assert_eq!(warnings.len(), 3, "{warnings:?}");
    assert!(warnings[0].starts_with("part.ngc: G28 on line 3 goes to a place of the machine that is not known"));
    assert!(warnings[1].starts_with("part.ngc: G53 on lines 9 to 10 goes to"), "{warnings:?}");
    assert_eq!(warnings[2], "part.ngc: feeds before X, Y and Z are known are left out: line 7");
    let mut options = Options::default();
    options.offsets[0] = Some(Vector3::new(0.0, 0.0, 0.3));
    let (moves, warnings) = read(Format::GCode, "G21 G91 G0\nG90 X1 Y1 Z1\nG91 G53 Z-10\n", &options).unwrap();
    assert_eq!((points(&moves)[1], warnings.len()), ([1.0, 1.0, 290.0], 0));
}

#[test]
fn what_is_doubtful_is_named_by_line() {
    let text = "G21 G0 X1 Y1 Z1\n/X2\n/X3\nM123\nM8\nX4 M123.4\nG4 P2\nG64 P0.01\nG61\nM2\nG0 X9\n";
    let (moves, warnings) = read(Format::GCode, text, &Options::default()).unwrap();
    assert_eq!(moves.len(), 4);
    assert_eq!(
        warnings,
        [
            "part.ngc: lines 2 to 3 with `/` in front: taken, as by a machine whose switch for it is off",
            "part.ngc: M123 on line 4 is not known and changes nothing here",
            "part.ngc: M123.4 on line 6 is not known and changes nothing here",
            "part.ngc: what is behind the end of the program is not read, from line 11 on",
        ]
    );
}
