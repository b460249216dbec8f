//! What is not understood is shown at its line and column.

use super::{Format, Options, read};

fn refused(text: &str) -> String {
    read(Format::GCode, text, &Options::default()).unwrap_err()
}

#[test]
fn a_mistake_is_shown_as_a_compiler_would() {
    assert_eq!(
        refused("G21 G0 X0 Y0 Z0\nG41 D1 G1 X5\n"),
        "error: G41 is not followed: cutter compensation\n --> part.ngc:2:1\n  |\n2 | G41 D1 G1 X5\n  | ^^^\n  |\n  = help: have \
         the CAM system write the path of the tool's centre, with G40"
    );
}

#[test]
fn mistakes_have_their_line_and_column() {
    for (text, part, place) in [
        ("G21 G0 X0 Y0 Z0\nG1 X5", "the move has no feed", "2:4"),
        ("G21\nG1 X#3", "`X` has no number", "2:4"),
        ("G21\n#3 = 5", "variables and expressions are not followed", "2:1"),
        ("G21\nG1 X[1+2]", "`X` has no number", "2:4"),
        ("G21\no100 sub", "(O words) are not followed", "2:1"),
        ("G21\nO<pocket> call", "(O words) are not followed", "2:1"),
        ("G21\nG0 X1\nO5", "", ""),
        ("G21\nG0 X1 X2", "`X` is in the block twice", "2:7"),
        ("G21\nG0 G1 X1", "G1 does not go with a code before it", "2:4"),
        ("G21\nG123 X1", "G123 is not known", "2:1"),
        ("G21\nG1.25 X1", "G1.25 is not known", "2:1"),
        ("G21\nG92 X1", "a shift of the coordinates", "2:1"),
        ("G21\nX1 Y2", "no code says how they move", "2:1"),
        ("G21\nG0 X1 U2", "`U` has no meaning here", "2:7"),
        ("G21\nG0 X1 R2", "`R` has no meaning here", "2:7"),
        ("G21\nG0 X1 I2", "`I` has no meaning here", "2:7"),
        ("G21\nG0 X1E5", "`E` has no meaning here", "2:6"),
        ("G21\nM98 P1000", "subprograms (M97, M98, M99)", "2:1"),
        ("G21\nG0 (stop X1", "the comment does not end in its line", "2:4"),
        ("G21\nG0 (ä) é X1", "`é` begins no word", "2:8"),
        ("G21\nG0 X--1", "`X` has no number", "2:4"),
        ("G21\nG0 X1.2.3", "`.` begins no word", "2:8"),
        ("G21\nG0 X9999999999", "beyond all machines", "2:4"),
        ("G21\nF-3", "the feed is below zero", "2:1"),
        ("G21\nT1.5", "a tool has a whole number", "2:1"),
        ("G21 G91 G0 X1", "counts from a position that is not known", "1:12"),
        ("G21 G0 X0 Y0 Z0\nG93 G1 X1 F5\nX2", "a block with G93 has its own F", "3:1"),
        ("G21 G0 X0 Y0 Z0\nG95 G1 X1 F5", "the spindle stands", "2:8"),
        ("G21 G0 X0 Y0 Z0\nG94 G1 X1 F5\nG93 X2", "a block with G93 has its own F", "3:5"),
        ("G21 G0 X0 Y0 Z0 B0\nX1 B3", "`B` turns the tool or the workpiece", "2:4"),
    ] {
        if part.is_empty() {
            // Behind G0 a number alone names nothing, and does nothing.
            assert!(read(Format::GCode, text, &Options::default()).is_ok());
            continue;
        }
        let said = refused(text);
        assert!(said.contains(part) && said.contains(&format!("part.ngc:{place}\n")), "{text}: {said}");
    }
}

/// All are reported, in the order of the file; a hundred are enough.
#[test]
fn a_file_has_all_its_mistakes_shown() {
    let said = refused("G21 G0 X0 Y0 Z0\nG41\nG1 X1 F60\nG2 X5\nU1\n");
    let places: Vec<&str> = said.lines().filter_map(|line| line.trim().strip_prefix("--> part.ngc:")).collect();
    assert_eq!(places, ["2:1", "4:4", "5:1"]);
    let many = refused(&"G41\n".repeat(5000));
    assert_eq!(many.matches("error:").count(), 100);
}
