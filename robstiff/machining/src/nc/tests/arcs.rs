//! Arcs are split within a tolerance.

use nalgebra::Vector3;

use super::{Format, Options, moves, points, read};

/// How far the chords of an arc about a centre are off its radius (mm), its points and their middles.
fn off(moves: &[super::Move], center: [f64; 3], radius: f64, axis: usize) -> [f64; 2] {
    let center = Vector3::from(center);
    let distance = |point: Vector3<f64>| {
        let mut out = point * 1e3 - center;
        out[axis] = 0.0;
        (out.norm() - radius).abs()
    };
    let ends = moves.iter().map(|each| distance(each.point)).fold(0.0, f64::max);
    let middles = moves.windows(2).map(|pair| distance((pair[0].point + pair[1].point) * 0.5)).fold(0.0, f64::max);
    [ends, middles]
}

#[test]
fn chords_are_within_the_tolerance_of_the_circle() {
    for tolerance in [1e-3, 1e-4, 1e-5, 1e-6] {
        let options = Options { arc_tolerance: tolerance, ..Options::default() };
        let (moves, _) = read(Format::GCode, "G21 G0 X50 Y0 Z0\nG3 X0 Y50 I-50 J0 F600", &options).unwrap();
        let [ends, middles] = off(&moves, [0.0; 3], 50.0, 2);
        assert!(ends < 1e-9 && middles <= tolerance * 1e3 + 1e-9, "{tolerance}: {ends} {middles}");
        // No more chords than it needs.
        assert!(middles > 0.8 * tolerance * 1e3, "{tolerance}: {middles} {}", moves.len());
        assert_eq!(points(&moves).last(), Some(&[0.0, 50.0, 0.0]));
        let time: f64 = moves.iter().filter_map(|each| each.duration).sum();
        assert!((time - 25.0 * core::f64::consts::PI / 10.0).abs() < 1e-9, "{time}");
        assert!(moves[1..].iter().all(|each| each.feed == Some(0.01) && each.line == 2));
    }
}

/// In each plane G2 is clockwise seen from the positive end of the axis across it.
#[test]
fn planes_and_directions() {
    // A quarter from the first axis of the plane to the second: 45 degrees in the middle.
    let s = 10.0 * core::f64::consts::FRAC_1_SQRT_2;
    for (text, middle, axis) in [
        ("G17 G0 X10 Y0 Z0\nG3 X0 Y10 I-10 F60", [s, s, 0.0], 2),
        ("G18 G0 Z10 X0 Y0\nG3 Z0 X10 K-10 F60", [s, 0.0, s], 1),
        ("G19 G0 Y10 Z0 X0\nG3 Y0 Z10 J-10 F60", [0.0, s, s], 0),
        ("G17 G0 X0 Y10 Z0\nG2 X10 Y0 J-10 F60", [s, s, 0.0], 2),
        ("G18 G0 X10 Y0 Z0\nG2 X0 Z10 R10 F60", [s, 0.0, s], 1),
        ("G17 G0 X0 Y10 Z0\nG90.1 G2 X10 Y0 I0 J0 F60", [s, s, 0.0], 2),
        ("G17 G90 G0 X0 Y10 Z0\nG91 G2 X10 Y-10 R10 F60", [s, s, 0.0], 2),
    ] {
        let moves = moves(text);
        let [ends, middles] = off(&moves, [0.0; 3], 10.0, axis);
        assert!(ends < 1e-9 && middles < 0.01 + 1e-9, "{text}: {ends} {middles}");
        let nearest =
            moves.iter().map(|each| (each.point * 1e3 - Vector3::from(middle)).norm()).fold(f64::MAX, f64::min);
        assert!(nearest < 0.5, "{text}: {nearest}");
        // A quarter of the circle and no more.
        assert!(moves.iter().all(|each| each.point.min() > -1e-9), "{text}");
    }
}

#[test]
fn the_sign_of_the_radius_tells_the_longer_arc() {
    let length = |text: &str| {
        let moves = moves(text);
        moves.windows(2).map(|pair| (pair[1].point - pair[0].point).norm() * 1e3).sum::<f64>()
    };
    let quarter = 5.0 * core::f64::consts::PI;
    for (text, quarters) in
        [("G2 X10 Y0 R10", 1.0), ("G2 X10 Y0 R-10", 3.0), ("G3 X10 Y0 R10", 1.0), ("G3 X10 Y0 R-10", 3.0)]
    {
        let found = length(&format!("G0 X0 Y10 Z0 F60\n{text}"));
        assert!((found - quarters * quarter).abs() < 0.05, "{text}: {found}");
    }
}

#[test]
fn whole_turns_and_helices() {
    let turn = moves("G0 X10 Y0 Z0\nG2 I-10 F60");
    let [ends, middles] = off(&turn, [0.0; 3], 10.0, 2);
    assert!(ends < 1e-9 && middles < 0.01);
    assert_eq!((points(&turn)[0], turn.last().unwrap().point), ([10.0, 0.0, 0.0], turn[0].point));
    let angle = |text: &str| {
        let moves = moves(text);
        moves.windows(2).map(|pair| pair[0].point.xy().angle(&pair[1].point.xy())).sum::<f64>().to_degrees()
    };
    assert!((angle("G0 X10 Y0 Z0\nG3 X10 Y0 Z-3 I-10 P3 F60") - 1080.0).abs() < 1e-6);
    let helix = moves("G0 X10 Y0 Z0\nG3 X-10 Y0 Z-6 I-10 F600");
    let [ends, middles] = off(&helix, [0.0; 3], 10.0, 2);
    assert!(ends < 1e-9 && middles < 0.01 + 1e-9);
    for each in &helix {
        let swept = each.point.y.atan2(each.point.x).rem_euclid(core::f64::consts::TAU);
        assert!((each.point.z * 1e3 + 6.0 * swept / core::f64::consts::PI).abs() < 1e-9);
    }
    // The tool goes along the helix with the feed.
    let time: f64 = helix.iter().filter_map(|each| each.duration).sum();
    assert!((time - (10.0 * core::f64::consts::PI).hypot(6.0) / 10.0).abs() < 1e-9);
}

/// Radii are rounded to the digits of the file.
#[test]
fn an_arc_ends_where_the_program_says() {
    let arc = moves("G20 G18 G0 X2.8640 Y4.8580 Z-.1569\nG2 X2.8540 Z-.1510 I-.0110 K-.0073 F9");
    let end = arc.last().unwrap().point / 25.4e-3;
    assert!((end - Vector3::new(2.8540, 4.8580, -0.1510)).norm() < 1e-12);
}

#[test]
fn wrong_arcs_are_shown_where_they_are() {
    let refused =
        |text: &str| read(Format::GCode, &format!("G21 G0 X10 Y0 Z0 F60\n{text}"), &Options::default()).unwrap_err();
    for (text, part) in [
        ("G2 X0 Y10", "no centre and no radius"),
        ("G2 X0 Y10 I-10 R10", "the arc has a centre and a radius"),
        ("G2 X0 Y12 I-10", "the arc ends 12.0000 mm from its centre and begins 10.0000 mm from it"),
        ("G2 X30 Y0 R9", "the radius is 9.0000 mm, and half of the chord is 10.0000 mm"),
        ("G2 X10 Y0 R9", "ends elsewhere than it begins"),
        ("G2 X0 Y10 K-10", "the centre of the arc is where it begins"),
        ("G2 X0 Y10 I-10 K1", "part.ngc:2:16"),
        ("G90.1 G2 X0 Y10 I0", "has one coordinate"),
        ("G2 X0 Y10 I-10 P1.5", "P is the number of turns"),
        ("G2 X0 Y10 I-999999 J999999", "from its centre"),
    ] {
        let said = refused(text);
        assert!(said.contains(part) && said.contains("part.ngc:2:"), "{text}: {said}");
    }
    let options = Options { arc_tolerance: 1e-15, ..Options::default() };
    let said = read(Format::GCode, "G21 G0 X10 Y0 Z0 F60\nG2 I-10", &options).unwrap_err();
    assert!(said.contains("chords, more than 100000"), "{said}");
    let said = read(Format::GCode, "G21 G2 X1 Y1 I1 F60", &Options::default()).unwrap_err();
    assert!(said.contains("begins where nobody knows"), "{said}");
}
