//! Rotary tables and heads, with TCP and without.

use nalgebra::{Rotation3, Vector3};

use super::{Format, Machine, Move, Options, on, points, read};

fn moves(text: &str, options: &Options) -> Vec<Move> {
    read(Format::GCode, &format!("G21\n{text}"), options).unwrap().0
}

fn axis(machine: &str, words: &str) -> Vector3<f64> {
    moves(&format!("M428\nG0 X0 Y0 Z0 {words}"), &on(machine))[0].axis.into_inner()
}

/// The tool's axis on a table A that carries C: (sin C sin A, cos C sin A, cos A), as the forward
/// kinematics of LinuxCNC's xyzac-trt turn a step along the machine's Z; likewise xyzbc-trt.
#[test]
fn tables_tilt_as_linuxcnc_has_them() {
    for (a, c) in [(-70.0_f64, -36.0_f64), (30.0, 100.0), (10.0, -200.0)] {
        let ((sin_a, cos_a), (sin_c, cos_c)) = (a.to_radians().sin_cos(), c.to_radians().sin_cos());
        let found = axis("xyzac-trt", &format!("A{a} C{c}"));
        assert!((found - Vector3::new(sin_c * sin_a, cos_c * sin_a, cos_a)).norm() < 1e-12, "{a} {c}: {found}");
        let found = axis("xyzbc-trt", &format!("B{a} C{c}"));
        assert!((found - Vector3::new(-cos_c * sin_a, sin_c * sin_a, cos_a)).norm() < 1e-12, "{a} {c}: {found}");
    }
}

#[test]
fn heads_turn_the_tool_and_tables_the_workpiece() {
    let x = Vector3::x();
    // A head that turns by +90 degrees about y points the tool's other end along x.
    assert!((axis("head B", "B90") - x).norm() < 1e-12);
    assert!((axis("table B", "B90") + x).norm() < 1e-12);
    assert!((axis("table -B", "B90") - x).norm() < 1e-12);
    // C carries B: the tilted tool turns with it.
    assert!((axis("head C B", "B90 C90") - Vector3::y()).norm() < 1e-12);
    assert!((axis("head B table -C", "B90 C90") - Vector3::y()).norm() < 1e-12);
}

#[test]
fn machines_are_named_by_their_axes() {
    assert_eq!(Machine::parse("xyzac-trt"), Machine::parse("table A C"));
    assert_eq!(Machine::parse(" head  c,b "), Machine::parse("head C B"));
    for wrong in ["", "A C", "table", "table X", "table A A", "table A head A", "trunnion"] {
        assert!(Machine::parse(wrong).unwrap_err().contains("`table A C`"), "{wrong}");
    }
}

/// A point fixed to the workpiece, wherever the table turns it: with the machine sent after it the
/// tip stays there.
#[test]
fn without_tcp_the_tip_is_where_the_axes_bring_it() {
    let center = Vector3::new(0.01, -0.02, -0.05);
    for (name, turn) in [
        ("table A C", Rotation3::from_euler_angles(0.4, 0.0, 0.0) * Rotation3::from_euler_angles(0.0, 0.0, 1.1)),
        ("table B", Rotation3::from_euler_angles(0.0, 0.4, 0.0)),
    ] {
        let mut options = on(name);
        options.machine.as_mut().unwrap().center = Some(center);
        let on_part = Vector3::new(0.03, 0.01, 0.02);
        let sent = (center + turn * (on_part - center)) * 1e3;
        let (tilt, c) = (0.4_f64.to_degrees(), 1.1_f64.to_degrees());
        let words = if name == "table B" { format!("B{tilt:.12}") } else { format!("A{tilt:.12} C{c:.12}") };
        let text = format!("G0 X{:.9} Y{:.9} Z{:.9} {words}", sent.x, sent.y, sent.z);
        let found = moves(&text, &options)[0];
        assert!((found.point - on_part).norm() < 1e-10, "{name}: {found:?}");
        assert!((found.axis.into_inner() - turn.inverse() * Vector3::z()).norm() < 1e-10);
    }
    // A head: the pivot stays, and the tip swings about it.
    let mut options = on("head B");
    options.machine.as_mut().unwrap().pivot_length = Some(0.2);
    let moves = moves("G0 X0 Y0 Z0\nB90", &options);
    assert_eq!(points(&moves).last(), Some(&[-200.0, 0.0, 200.0]));
    // On the way it is on a circle, within the tolerance.
    let pivot = Vector3::new(0.0, 0.0, 0.2);
    for pair in moves.windows(2) {
        let middle = (pair[0].point + pair[1].point) * 0.5;
        assert!(((pair[1].point - pivot).norm() - 0.2).abs() < 1e-12);
        assert!((middle - pivot).norm() > 0.2 - 1e-5);
    }
}

#[test]
fn codes_turn_tcp_on_and_off() {
    let mut options = on("table B");
    options.machine.as_mut().unwrap().center = Some(Vector3::zeros());
    let ends = |text: &str, options: &Options| {
        let moves = moves(text, options);
        let last = moves.last().unwrap().line;
        assert!(moves.iter().all(|each| each.line <= last));
        points(&moves)[moves.len() - 1]
    };
    // A quarter turn brings what was at x to where z was.
    assert_eq!(ends("G0 X10 Y0 Z0 B90", &options), [0.0, 0.0, 10.0]);
    for on in ["M428", "M128", "G43.4 H1"] {
        assert_eq!(ends(&format!("{on}\nG0 X10 Y0 Z0 B90"), &options), [10.0, 0.0, 0.0], "{on}");
    }
    for off in ["M428\nM429", "M128\nM129", "G43.4 H1\nG49"] {
        assert_eq!(ends(&format!("{off}\nG0 X10 Y0 Z0 B90"), &options), [0.0, 0.0, 10.0], "{off}");
    }
    assert_eq!(ends("M428\nG49\nG0 X10 Y0 Z0 B90", &options), [10.0, 0.0, 0.0]);
    // The tip stays where it is when the way to count changes.
    assert_eq!(ends("G0 X10 Y0 Z0 B90\nM428\nG91 G0 Y1", &options), [0.0, 1.0, 10.0]);
    assert_eq!(ends("M428\nG0 X10 Y0 Z0 B90\nM429\nG91 G0 Y1", &options), [10.0, 1.0, 0.0]);
    options.tcp = Some(true);
    assert_eq!(ends("M429\nG0 X10 Y0 Z0 B90", &options), [10.0, 0.0, 0.0]);
    options.tcp = Some(false);
    assert_eq!(ends("M428\nG0 X10 Y0 Z0 B90", &options), [0.0, 0.0, 10.0]);
}

#[test]
fn the_tools_axis_may_be_a_vector() {
    let moves = moves("G43.5 H1\nG0 X0 Y0 Z0 I0 J0 K1\nG1 X10 I1 K1 F600\nX20\nG49\nX30", &Options::default());
    let s = core::f64::consts::FRAC_1_SQRT_2;
    let axes = [[0.0, 0.0, 1.0], [s, 0.0, s], [s, 0.0, s], [0.0, 0.0, 1.0]];
    for (each, axis) in moves.iter().zip(axes) {
        assert!((each.axis.into_inner() - Vector3::from(axis)).norm() < 1e-12, "{each:?}");
    }
}

/// Between two points of a large turn the axis would take another way than the machine's.
#[test]
fn large_turns_are_split() {
    let moves = moves("M428\nG0 X0 Y0 Z0 A30 C0\nG1 C90 F900", &on("table A C"));
    assert!(moves.len() > 10);
    for pair in moves.windows(2) {
        let middle = (pair[0].axis.into_inner() + pair[1].axis.into_inner()).normalize();
        // On the cone of 30 degrees but for what the split allows.
        assert!((middle.z.acos().to_degrees() - 30.0).abs() < 0.12);
    }
    // 90 degrees at 900 deg/min, the tip in place.
    let time: f64 = moves.iter().filter_map(|each| each.duration).sum();
    assert!((time - 6.0).abs() < 1e-9);
    assert!(moves.iter().all(|each| each.feed.is_none() && each.point == Vector3::zeros()));
}

#[test]
fn what_is_missing_of_a_machine_is_named() {
    let refused = |text: &str, options: &Options| read(Format::GCode, &format!("G21\n{text}"), options).unwrap_err();
    let text = "G0 X0 Y0 Z0 B0\nB3";
    assert!(refused(text, &Options::default()).contains("--machine"));
    assert!(refused(text, &on("table A C")).contains("the machine has no axis B"));
    assert!(refused(text, &on("table B C")).contains("`--center x,y,z`"));
    assert!(refused(text, &on("head B")).contains("`--pivot-length`"));
    assert!(refused("G43.5\nG0 X0 Y0 Z0 I0", &Options::default()).contains("has no direction"));
}
