//! Any text: no panic, and work in proportion.

use proptest::prelude::*;

use super::{Format, Options, on};
use crate::nc::Reader;
use robstiff_robots::text::Lines;

/// How many items a reader gives, and how often it is asked until it ends.
fn count(format: Format, text: &str, options: &Options) -> [usize; 2] {
    let lines = Lines::new(text.to_owned());
    let (mut moves, mut problems) = (0, 0);
    for each in Reader::new(format, "part", &lines, options) {
        match each {
            Ok(each) => {
                assert!(each.point.iter().chain(each.axis.iter()).all(|part| part.is_finite()));
                assert!(each.feed.is_none_or(|feed| feed > 0.0 && feed.is_finite()));
                moves += 1;
            }
            Err(problem) => {
                assert!((1..=lines.count()).contains(&problem.line), "{problem}");
                problems += 1;
            }
        }
    }
    [moves, problems]
}

/// Blocks of G-code that are mostly right.
fn word() -> impl Strategy<Value = String> {
    let number = prop_oneof![(-50_i32..50).prop_map(f64::from), -9.0..9.0];
    prop_oneof![
        6 => (prop::sample::select(b"XYZABCIJKRPQLFSTHDN".to_vec()), number).prop_map(|(letter, number)| format!("{}{number:.3}", char::from(letter))),
        4 => prop::sample::select(vec![0.0, 1.0, 2.0, 3.0, 17.0, 18.0, 19.0, 20.0, 21.0, 28.0, 43.4, 43.5, 49.0, 53.0, 55.0, 73.0, 80.0, 81.0, 83.0, 90.0, 91.0, 90.1, 91.1, 93.0, 94.0, 95.0, 98.0, 99.0]).prop_map(|code| format!("G{code}")),
        1 => (0..200_u16).prop_map(|code| format!("M{code}")),
        1 => "[ -~µ]{0,6}",
    ]
}

fn program() -> impl Strategy<Value = String> {
    let line = prop::collection::vec(word(), 0..6).prop_map(|words| words.join(" "));
    prop::collection::vec(line, 0..40).prop_map(|lines| format!("G21 G0 X0 Y0 Z0 F100 S100 M3\n{}", lines.join("\n")))
}

fn statements() -> impl Strategy<Value = String> {
    let majors = vec![
        "GOTO", "FROM", "GODLTA", "RAPID", "FEDRAT", "SPINDL", "CIRCLE", "MOVARC", "MULTAX", "UNITS", "LOADTL",
        "TLAXIS", "PPRINT", "XYZ", "$",
    ];
    let part =
        prop_oneof![8 => (-30_i32..30).prop_map(|number| number.to_string()), 1 => "[A-Z]{1,5}|\\$|ANGLE|ON|OFF|MM"];
    let line = (prop::sample::select(majors), prop::collection::vec(part, 0..9));
    let line = line.prop_map(|(major, parts)| format!("{major}/{}", parts.join(",")));
    prop::collection::vec(line, 0..40).prop_map(|lines| lines.join("\n"))
}

proptest! {
    #[test]
    fn any_text_is_read_to_its_end(text in "(?s).{0,400}") {
        for format in [Format::GCode, Format::Apt] {
            let [moves, problems] = count(format, &text, &Options::default());
            // A text of so many bytes has no room for arcs of many chords.
            prop_assert!(problems <= 100 && moves <= 1000 * (text.len() + 1));
        }
    }

    #[test]
    fn programs_that_are_nearly_right_are_read_to_their_end(text in program()) {
        let mut machine = on("table A C");
        machine.arc_tolerance = 1e-4;
        machine.machine.as_mut().unwrap().center = Some(nalgebra::Vector3::zeros());
        for options in [&Options::default(), &machine] {
            count(Format::GCode, &text, options);
        }
        count(Format::Apt, &text, &machine);
    }

    #[test]
    fn statements_that_are_nearly_right_are_read_to_their_end(text in statements()) {
        count(Format::Apt, &text, &Options::default());
    }

    /// A line is read once: ten times the program is ten times the moves, and no problem of a long
    /// line holds it.
    #[test]
    fn work_is_in_proportion(lines in prop::collection::vec((-9_i32..9, -9_i32..9), 1..50)) {
        let text: String = lines.iter().map(|(x, y)| format!("G1 X{x} Y{y}\n")).collect();
        let whole = |times: usize| format!("G21 G0 X0 Y0 Z0 F60\n{}", text.repeat(times));
        let [once, ten] = [1, 10].map(|times| count(Format::GCode, &whole(times), &Options::default())[0] - 1);
        prop_assert_eq!(10 * once, ten);
    }
}

#[test]
fn a_long_line_is_no_long_work() {
    for part in ["X", "X1", "(", "G1", "/", "#", "$", ",", "GOTO/", "1,", "é"] {
        let text = part.repeat((1 << 20) / part.len());
        for format in [Format::GCode, Format::Apt] {
            count(format, &text, &Options::default());
        }
    }
    let nested = format!("{}{}", "(".repeat(1 << 19), ")".repeat(1 << 19));
    assert_eq!(count(Format::GCode, &nested, &Options::default()), [0, 0]);
}
