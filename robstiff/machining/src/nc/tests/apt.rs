//! APT and CLDATA.

use core::f64::consts::{PI, TAU};

use nalgebra::Vector3;

use super::{Format, Move, Options, points};

fn read(text: &str) -> Result<(Vec<Move>, Vec<String>), String> {
    super::read(Format::Apt, text, &Options::default())
}

fn moves(text: &str) -> Vec<Move> {
    let (moves, warnings) = read(&format!("UNITS/MM\n{text}")).unwrap();
    assert_eq!(warnings, Vec::<String>::new());
    moves
}

#[test]
fn a_program_as_cam_writes_it() {
    let text = "$$ written for a test\nPARTNO 50% / BRACKET $ 3\nMACHIN/MILL,1\nUNITS/MM\nCUTTER/10.0\nTOOLNO/4, 10.0\nLOADTL/5,1\n\
                SPINDL/ 6000.0,RPM,CLW\nCOOLNT/ON\nMULTAX/ON\nPPRINT PASS=1, A/B\nFROM/0,0,50\nRAPID\nGOTO  /   1.0, 2.0,$\n  5.0, \
                0,0,1\nFEDRAT/300,MMPM\ngoto/1,2,-1\nGODLTA/9,0,0\nGOTO/10,2,-1,0,1.0E0,1\nGOTO/11,2,-1\nMULTAX/OFF\nGOTO/12,2,-1\nFINI\n";
    let (moves, warnings) = read(text).unwrap();
    assert_eq!(warnings, Vec::<String>::new());
    assert_eq!(
        points(&moves),
        [
            [0.0, 0.0, 50.0],
            [1.0, 2.0, 5.0],
            [1.0, 2.0, -1.0],
            [10.0, 2.0, -1.0],
            [10.0, 2.0, -1.0],
            [11.0, 2.0, -1.0],
            [12.0, 2.0, -1.0]
        ]
    );
    assert_eq!(moves.iter().map(|each| each.line).collect::<Vec<_>>(), [12, 14, 17, 18, 19, 20, 22]);
    assert_eq!(
        moves.iter().map(|each| each.rapid).collect::<Vec<_>>(),
        [true, true, false, false, false, false, false]
    );
    assert!(moves.iter().all(|each| each.tool == Some(5) && (each.spindle - 100.0 * TAU).abs() < 1e-9));
    assert_eq!(moves[2].feed, Some(0.005));
    let s = core::f64::consts::FRAC_1_SQRT_2;
    let tilted = Vector3::new(0.0, s, s);
    for (each, axis) in
        moves.iter().zip([Vector3::z(), Vector3::z(), Vector3::z(), Vector3::z(), tilted, tilted, Vector3::z()])
    {
        assert!((each.axis.into_inner() - axis).norm() < 1e-12, "{each:?}");
    }
}

#[test]
fn units_of_lengths_and_feeds() {
    let feed = |text: &str| {
        moves(&format!("SPINDL/RPM,600,CCLW\nGOTO/0,0,0\nFEDRAT/{text}\nGOTO/1,0,0"))[1].feed.unwrap() * 6e4
    };
    for (text, expected) in [
        ("250", 250.0),
        ("MMPM,250.0", 250.0),
        ("10,IPM", 254.0),
        ("250,PERMIN", 250.0),
        ("0.1,MMPR", 60.0),
        ("PERREV,.2", 120.0),
        ("0.01,IPR", 152.4),
    ] {
        assert!((feed(text) - expected).abs() < 1e-9, "{text}: {}", feed(text));
    }
    let (inches, _) = read("UNITS/INCHES\nGOTO/1,0,0\nFEDRAT/10\nGOTO/2,0,0").unwrap();
    assert_eq!((points(&inches)[1], (inches[1].feed.unwrap() * 6e4).round()), ([50.8, 0.0, 0.0], 254.0));
    let (_, warnings) = read("GOTO/1,0,0\n").unwrap();
    assert_eq!(warnings, ["part.ngc: no unit is named before line 1: lengths are taken in mm"]);
    let spindles: Vec<f64> =
        moves("SPINDL/60,CLW\nGOTO/0,0,0\nSPINDL/OFF\nGOTO/0,0,0,0,0,1\nSPINDL/ON\nGOTO/0,0,0\nSPINDL/RPM,120,RANGE,2,CCLW\nGOTO/0,0,0\n".replace("GOTO", "RAPID\nGOTO").as_str())
            .iter()
            .map(|each| (each.spindle / TAU).round())
            .collect();
    assert_eq!(spindles, [1.0, 0.0, 1.0, -2.0]);
}

/// What an arc about the z axis of this radius (mm) sweeps (deg), its points being on it.
fn swept(moves: &[Move], radius: f64) -> f64 {
    assert!(moves.iter().all(|each| (each.point.xy().norm() * 1e3 - radius).abs() < 1e-6));
    let angle = |pair: &[Move]| {
        let (from, to) = (pair[0].point.xy(), pair[1].point.xy());
        from.perp(&to).atan2(from.dot(&to))
    };
    moves.windows(2).map(angle).sum::<f64>().to_degrees()
}

#[test]
fn arcs_turn_about_their_axis() {
    let arc = |text: &str| {
        let moves = moves(&format!("FEDRAT/600\nGOTO/10,0,0\n{text}"));
        for pair in moves.windows(2) {
            assert!(((pair[0].point + pair[1].point) * 0.5).xy().norm() > 0.01 - 1e-5 - 1e-12);
        }
        swept(&moves, 10.0)
    };
    for (text, angle) in [
        ("CIRCLE/0,0,0,0,0,1,10\nGOTO/0,10,0", 90.0),
        ("CIRCLE/0,0,0,0,0,-1,10,0.06,0.5,10.0,0.0\nGOTO/0,-10,0", -90.0),
        ("MOVARC/0,0,0,0,0,1,10,ANGLE,270\nGOTO/0,-10,0", 270.0),
        ("MOVARC/ CENTER, 0,0,0, AXIS,0,0,-1, RADIUS,10\nGOTO/0,10,0", -270.0),
        // The angle tells the direction, where the axis is that of the plane.
        ("MOVARC/0,0,0,0,0,1,10,ANGLE,90\nGOTO/0,-10,0", -90.0),
        ("MOVARC/0,0,0,0,0,1,10,ANGLE,360\nGOTO/10,0,0", 360.0),
        ("MOVARC/0,0,0,0,0,1,10,ANGLE,720\nGOTO/10,0,-4", 720.0),
    ] {
        assert!((arc(text) - angle).abs() < 1e-6, "{text}: {}", arc(text));
    }
    let length: f64 = moves("FEDRAT/600\nGOTO/10,0,0\nCIRCLE/0,0,0,0,0,1,10\nGOTO/-10,0,0\n")
        .iter()
        .filter_map(|each| each.duration)
        .sum();
    assert!((length - PI).abs() < 1e-9);
    let (_, warnings) = read("UNITS/MM\nFEDRAT/600\nGOTO/10,0,0\nCIRCLE/0,0,0,0,0,1,10\nGOTO/0,-10,0\n").unwrap();
    assert!(warnings[0].contains("the arc of line 5 takes more than half a turn"), "{warnings:?}");
}

/// Some CAM systems write the points of a circle behind it: they are taken as they are.
#[test]
fn points_of_a_circle_are_taken_as_they_are() {
    let text = "FEDRAT/600\nGOTO/10,0,0\nCIRCLE/0,0,0,0,0,1,10\nGOTO/8,-6,0\nGOTO/6,-8,0\nGOTO/0,-10,0\nGOTO/0,-20,0";
    assert_eq!(
        points(&moves(text)),
        [[10.0, 0.0, 0.0], [8.0, -6.0, 0.0], [6.0, -8.0, 0.0], [0.0, -10.0, 0.0], [0.0, -20.0, 0.0]]
    );
}

#[test]
fn what_is_not_known_is_named_by_line() {
    let (_, warnings) = read("UNITS/MM\nGOTO/0,0,0\nAUXFUN/8\nINSERT M8\nAUXFUN/9\nFINI\nGOTO/1,1,1\n").unwrap();
    assert_eq!(
        warnings,
        [
            "part.ngc: AUXFUN on lines 3, 5 is not known and changes nothing here",
            "part.ngc: INSERT on line 4 is not known and changes nothing here",
            "part.ngc: what is behind the end of the program is not read, from line 7 on",
        ]
    );
}

#[test]
fn mistakes_have_their_line_and_column() {
    for (text, part, place) in [
        ("GOTO/1,2", "GOTO has 2 numbers", "2:1"),
        ("  GOTO/1,2,x", "`X` stands where a number belongs", "2:12"),
        ("GOTO/1,2,$\n 3.4.5", "`3.4.5` is not a number", "3:2"),
        ("GOTO/1,2,3,0,0,0", "the tool's axis has no direction", "2:1"),
        ("GODLTA/1,2,3", "GODLTA counts from a point that is not known", "2:1"),
        ("GOTO/0,0,0\nGOTO/1,2,3", "the move has no feed", "3:1"),
        ("GOTO/0,0,0\nFEDRAT/.1,PERREV\nGOTO/1,2,3", "the spindle stands", "4:1"),
        ("FEDRAT/0", "missing or not above zero", "2:1"),
        ("FEDRAT/10,LIGHTYEARS", "`LIGHTYEARS` is no unit of a feed here", "2:11"),
        ("SPINDL/200,SFM", "this is no speed of a spindle here", "2:12"),
        ("UNITS/LEAGUES", "the unit is not known", "2:1"),
        ("LOADTL/BALL", "the tool has no number", "2:1"),
        ("CUTCOM/LEFT", "cutter compensation (CUTCOM) is not followed", "2:1"),
        ("CYCLE/DRILL,5", "cycles (CYCLE) are not followed", "2:1"),
        ("INDIRV/1,0,0", "INDIRV is not followed", "2:1"),
        ("TLON,GOFWD/(CIRCLE/1,2,3,4)", "TLON is not followed", "2:1"),
        ("C1=CIRCLE/1,2,3", "definitions (=) are not followed", "2:1"),
        ("MSYS/0,0,0,1,0,0,0,1,0\nMSYS/0,0,9,1,0,0,0,1,0", "another system of coordinates", "3:1"),
        ("CIRCLE/1,2,3", "fewer than seven numbers", "2:1"),
        ("GOTO/10,0,0\nRAPID\nCIRCLE/0,0,0,0,0,1,12\nGOTO/0,10,0\nFINI", "does not move on the circle", "5:1"),
        ("GOTO/10,0,0\nRAPID\nMOVARC/0,0,0,0,0,1,10,ANGLE,45\nGOTO/0,10,0", "does not fit the angle", "5:1"),
        ("GOTO/1,2,3 $", "goes on behind the end of the file", "2:1"),
    ] {
        let said = read(&format!("UNITS/MM\n{text}")).unwrap_err();
        assert!(said.contains(part) && said.contains(&format!("part.ngc:{place}\n")), "{text}: {said}");
    }
}
