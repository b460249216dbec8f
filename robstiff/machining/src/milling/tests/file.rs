//! Cuts and records of forces as files.

use core::f64::consts::{PI, TAU};
use std::path::Path;

use nalgebra::{Matrix3, Vector3};
use robstiff_robots::ReadError;

use super::cut;
use crate::milling::*;

const POCKET: &str = "\
tool: {diameter: 16 mm, teeth: 3, helix: 30 deg}
material: al6082-t6
milling: down
width: 4 mm
depth: 4 mm
feed: 0.1 mm/tooth
speed: 9000 rpm
";

fn read(text: &str) -> Result<CutFile, ReadError> {
    CutFile::parse("cut.yaml", text, Path::new(""))
}

#[test]
fn a_cut_is_read() {
    let expected = cut(Engagement::of_width(Direction::Down, 0.004, 0.016).unwrap(), 30.0, &[]);
    let close = |file: &CutFile| match &file.forces {
        Forces::Model(found) => {
            assert!((found.mean_force() - expected.mean_force()).norm() < 1e-9);
            assert!((found.speed.unwrap() - expected.speed.unwrap()).abs() < 1e-9);
        }
        Forces::Measured { .. } => panic!("nothing was measured"),
    };
    let ball = read(&POCKET.replace("helix: 30 deg", "helix: 30 deg, corner: 8 mm")).unwrap();
    assert!(matches!(&ball.forces, Forces::Model(found) if (found.mill.corner - 0.008).abs() < 1e-12));
    let file = read(POCKET).unwrap();
    assert!(file.source.contains("10.1186"));
    close(&file);
    let by_speed = POCKET.replace("feed: 0.1 mm/tooth", "feed_speed: 2700 mm/min");
    close(&read(&by_speed).unwrap());
    let own = "coefficients: {tangential: {cutting: 631 N/mm2, edge: 13 N/mm}, \
               radial: {cutting: 99 N/mm2, edge: 10 N/mm}, axial: {cutting: 273 N/mm2, edge: 2.8 N/mm}}";
    close(&read(&POCKET.replace("material: al6082-t6", own)).unwrap());
    let angles = POCKET.replace("milling: down\nwidth: 4 mm", "engagement: [120 deg, 180 deg]");
    close(&read(&angles).unwrap());
}

#[test]
fn mistakes_are_shown_where_they_are() {
    for (from, to, place, part) in [
        ("al6082-t6", "al6082-t", "cut.yaml:2:11", "did you mean `al6082-t6`"),
        ("width: 4 mm", "width: 40 mm", "cut.yaml:4:8", "wider than the tool"),
        ("width: 4 mm", "width: 16 mm", "cut.yaml:4:8", "a cut as wide as the tool is a slot"),
        ("width: 4 mm", "width: 4", "cut.yaml:4:8", "`width` has no unit and is taken in m: is it in mm?"),
        ("teeth: 3", "teeth: 2.5", "cut.yaml:1:32", "e.g. `3`"),
        ("width: 4 mm\n", "", "cut.yaml:1:1", "`width` is missing"),
        ("helix: 30 deg", "corner: 9 mm", "cut.yaml:1:43", "`8 mm` of a ball nose"),
        ("helix: 30 deg", "corner: -1 um", "cut.yaml:1:43", "not between 0 and half the diameter"),
        ("teeth: 3", "teeth: 0", "cut.yaml:1:32", "1 to 100 teeth"),
        ("feed: 0.1 mm/tooth", "feed: 0.1 m/tooth", "cut.yaml:6:7", "not below the tool's radius"),
        ("depth: 4 mm", "depth: -4 mm", "cut.yaml:5:8", "above zero"),
        ("depth: 4 mm", "depth: 1e9 mm", "cut.yaml:5:8", "1000 times as deep as the tool is wide"),
        ("speed: 9000 rpm", "feed_speed: 1 m/min", "cut.yaml:6:7", "given twice"),
        ("feed: 0.1 mm/tooth\nspeed: 9000 rpm", "feed_speed: 1 m/min", "cut.yaml:6:13", "without the spindle's"),
        ("helix: 30 deg", "runout: [0, 1 um]", "cut.yaml:1:43", "has 3 values, not 2"),
        ("milling: down", "milling: slot", "cut.yaml:4:8", "as wide as the tool"),
        ("milling: down", "milling: climb", "cut.yaml:3:10", "write `down`, which is climb milling"),
        ("milling: down", "engagement: [3]", "cut.yaml:3:13", "write 2, e.g. `[0, 90 deg]`"),
        ("milling: down", "engagement: [3, 1]", "cut.yaml:3:13", "lower first"),
        ("speed: 9000 rpm", "measured: {file: no.csv, frame: cut, on: tool}", "cut.yaml:7:18", "there is no file"),
    ] {
        assert!(POCKET.contains(from), "{from}");
        let error = read(&POCKET.replace(from, to)).unwrap_err().to_string();
        assert!(error.contains(place) && error.contains(part), "{from} -> {to}: {error}");
    }
}

/// Zero is the same in every unit.
#[test]
fn runout_without_a_unit_is_asked_about() {
    let warned =
        |runout: &str| read(&POCKET.replace("helix: 30 deg", &format!("runout: [{runout}]"))).unwrap().warnings;
    assert_eq!(warned("0, 12, 5 um"), ["cut.yaml: `runout` has no unit and is taken in m: is it in um?"]);
    for stated in ["0, 12 um, 5 um", "0, 0, 0"] {
        assert!(warned(stated).is_empty(), "{stated}");
    }
    let error = read(&POCKET.replace("helix: 30 deg", "runout: [0, .inf, 0]")).unwrap_err().to_string();
    assert_eq!(error.matches("error: ").count(), 1, "{error}");
}

/// In Pa those of a material push with next to nothing.
#[test]
fn coefficients_without_a_unit_are_asked_about() {
    let warned = |edge: &str| {
        let one = format!("{{cutting: 631, edge: {edge}}}");
        let own = format!("coefficients: {{tangential: {one}, radial: {one}, axial: {one}}}");
        read(&POCKET.replace("material: al6082-t6", &own)).unwrap().warnings
    };
    let cutting = "cut.yaml: `cutting` has no unit and is taken in Pa: is it in N/mm2?";
    assert_eq!(warned("13 N/mm"), [cutting]);
    assert_eq!(warned("0"), [cutting]);
    assert_eq!(warned("13"), [cutting, "cut.yaml: `edge` has no unit and is taken in N/m: is it in N/mm?"]);
}

#[test]
fn records_are_averaged() {
    let header = "angle [deg],Fx [N],Fy [kN],Fz\n";
    let rows: Vec<_> = (0..720)
        .map(|k| {
            let angle = f64::from(k) * 0.5 + 0.1;
            let wave = angle.to_radians().sin();
            format!("{angle},{},{},7\n", 10.0 + wave, -0.002 * wave)
        })
        .collect();
    let text = format!("{header}{}", rows.concat());
    let (tool, warnings) = MeasuredForce::parse("f.csv", &text, ForceFrame::Cut, false).unwrap();
    assert!(warnings.is_empty());
    assert!((tool.mean(None) - Vector3::new(10.0, 0.0, 7.0)).norm() < 1e-9);
    let revolution = tool.revolution(4, None).unwrap();
    // The mean of a sine over a quarter is 2 / pi.
    assert!((revolution.samples[0].1 - Vector3::new(10.0 + 2.0 / PI, -4.0 / PI, 7.0)).norm() < 0.02);
    assert!((revolution.samples[3].0 - 1.75 * PI).abs() < 1e-12);

    let (workpiece, _) = MeasuredForce::parse("f.csv", &text, ForceFrame::Tool, true).unwrap();
    assert!((workpiece.mean(None) + tool.mean(None)).norm() < 1e-12);
    let frame = CutFrame::new(&-Vector3::z(), &Vector3::x()).unwrap();
    let turned = Matrix3::new(0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0);
    assert_eq!(workpiece.to_base(Some(&frame), &turned), Some(turned));
    assert_eq!(tool.to_base(Some(&frame), &turned), Some(frame.matrix()));
    assert_eq!((workpiece.to_base(None, &turned), tool.to_base(None, &turned)), (Some(turned), None));

    // By time, two turns in 0.2 s; without a speed nobody can tell.
    let timed = "t [ms],Fx,Fy,Fz\n0,1,0,0\n25,2,0,0\n50,3,0,0\n75,4,0,0\n100,1,0,0\n125,2,0,0\n150,3,0,0\n175,4,0,0\n";
    let (timed, _) = MeasuredForce::parse("f.csv", timed, ForceFrame::Cut, false).unwrap();
    assert_eq!(timed.revolution(4, None), None);
    let turn = timed.revolution(4, Some(TAU / 0.1 * (1.0 + 1e-12))).unwrap();
    assert_eq!(turn.samples.iter().map(|(_, force)| force.x).collect::<Vec<_>>(), [1.0, 2.0, 3.0, 4.0]);
    assert_eq!((turn.range(0).least, turn.range(0).greatest, turn.peak()), (1.0, 4.0, 4.0));

    // Angles on the bounds of the parts: each has its own.
    let rows: Vec<_> = (0..360).map(|k| format!("{k},{k},0,0\n")).collect();
    let text = format!("angle [deg],Fx,Fy,Fz\n{}", rows.concat());
    let (bounds, _) = MeasuredForce::parse("f.csv", &text, ForceFrame::Cut, false).unwrap();
    let turn = bounds.revolution(360, None).unwrap();
    assert!(turn.samples.len() == 360 && turn.samples.iter().zip(0..).all(|((_, force), k)| force.x == f64::from(k)));

    // Twice as fast they are too coarse, four times as slow too short; so are a few angles.
    for (times, resolves) in [(1.0, true), (2.0, false), (0.25, false)] {
        assert_eq!(timed.resolves_revolution(Some(TAU / 0.1 * times)), resolves, "{times}");
    }
    let few = |angles: [f64; 4]| {
        let text = format!("angle [deg],Fx,Fy,Fz\n{}", angles.map(|angle| format!("{angle},1,0,0\n")).concat());
        MeasuredForce::parse("f.csv", &text, ForceFrame::Cut, false).unwrap().0.revolution(4, None).is_some()
    };
    assert!(few([0.0, 270.0, 90.0, 540.0]) && !few([0.0, 30.0, 60.0, 90.0]));

    let text = "t [s],Fx,Fy,Fz\n0,1,0,0\n2,1,0,0\n1,1,0,0\n";
    let (_, warnings) = MeasuredForce::parse("f.csv", text, ForceFrame::Cut, false).unwrap();
    assert_eq!(warnings, ["f.csv: the times go back on line 4"]);

    let error = MeasuredForce::parse("f.csv", "Fx,Fy\n1,x\n", ForceFrame::Cut, false).unwrap_err().to_string();
    assert!(error.contains("`Fz` is missing") && error.contains("f.csv:1:1"), "{error}");
}

/// One tooth in half immersion, recorded for more than whole turns: cut half of the time.
#[test]
fn a_mean_is_that_of_whole_revolutions() {
    let table = |header: &str, turns: f64, place: fn(f64) -> f64| {
        let rows = (0..(100.0 * turns) as u32).map(|k| {
            let turn = f64::from(k) / 100.0;
            format!("{},{},0,0\n", place(turn), if turn.fract() < 0.4999 { 200.0 } else { 0.0 })
        });
        let text = format!("{header},Fx,Fy,Fz\n{}", rows.collect::<std::string::String>());
        MeasuredForce::parse("f.csv", &text, ForceFrame::Cut, false).unwrap().0
    };
    for turns in [1.0, 1.25, 2.0, 2.4] {
        let timed = table("t [s]", turns, |turn| 0.02 * turn);
        assert!((timed.mean(Some(50.0 * TAU)).x - 100.0).abs() < 1e-9, "{turns} turns by time");
        let going_on = table("angle [deg]", turns, |turn| 360.0 * turn + 30.0);
        assert!((going_on.mean(None).x - 100.0).abs() < 1e-9, "{turns} turns by angle");
        let again = table("angle [deg]", turns, |turn| (360.0 * turn + 30.0) % 360.0);
        assert!((again.mean(None).x - 100.0).abs() < 1e-9, "{turns} turns by angles that begin again");
    }
    // Denser where a tooth cuts: half the turn at one degree each, the other at five.
    let angles = || (0..180).chain((180..360).step_by(5));
    let rows = angles().map(|angle| format!("{angle},{},0,0\n", if angle < 180 { 200.0 } else { 0.0 }));
    let text = format!("angle [deg],Fx,Fy,Fz\n{}", rows.collect::<std::string::String>());
    let (uneven, _) = MeasuredForce::parse("f.csv", &text, ForceFrame::Cut, false).unwrap();
    assert!((uneven.mean(None).x - 100.0).abs() < 2.0, "{}", uneven.mean(None).x);
    // Less than a turn, or nobody knows of what: all that there is.
    assert!((table("angle [deg]", 0.75, |turn| 360.0 * turn).mean(None).x - 200.0 / 1.5).abs() < 1e-9);
    assert!((table("t [s]", 1.25, |turn| 0.02 * turn).mean(None).x - 120.0).abs() < 1e-9);
}

/// Times that go back at an absurd speed: a turn is far less than the last place of such angles.
#[test]
fn no_angle_is_wound_on_without_end() {
    let text = "t [ms],Fx,Fy,Fz\n0,1,2,3\n-200,4,5,6\n10,1,2,3\n";
    let (force, _) = MeasuredForce::parse("f.csv", text, ForceFrame::Cut, false).unwrap();
    for speed in [1e3, 1e17, 1e300, f64::MAX] {
        assert!(force.mean(Some(speed)).iter().all(|force| (1.0..=6.0).contains(force)), "{speed}");
    }
}
