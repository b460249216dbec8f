//! Coefficients from records, heads of DynoWare files, the law of Kienzle.

use core::f64::consts::{PI, TAU};
use std::fs;
use std::path::{Path, PathBuf};

use nalgebra::Vector3;

use super::MATERIAL;
use crate::milling::fit::{Unfit, by_means, by_revolutions};
use crate::milling::*;

/// A cut of the records below.
fn cut(feed: f64, engagement: Engagement) -> Cut {
    let mill = EndMill { diameter: 0.025, teeth: 2, helix: 0.5, corner: 0.0, runout: Vec::new() };
    let speed = Some(6000.0 * PI / 30.0);
    Cut { mill, coefficients: MATERIAL, engagement, depth: 0.003, feed_per_tooth: feed, speed }
}

/// The force on the tool of a cut for so many turns, 200 samples each, the first tooth anywhere.
fn record(cut: &Cut, turns: f64, first: f64, noise: f64) -> Recorded {
    let mut state = 1_u64;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    let speed = cut.speed.unwrap();
    let sample = |k: usize| {
        let time = k as f64 * TAU / speed / 200.0;
        let force = cut.force_at(speed * time + first) + Vector3::from_fn(|_, _| noise * random());
        Sample { time: Some(time), angle: None, force }
    };
    let samples = (0..(200.0 * turns) as usize).map(sample).collect();
    let bare = Cut { coefficients: Coefficients::default(), ..cut.clone() };
    Recorded { path: PathBuf::new(), cut: bare, force: MeasuredForce { frame: ForceFrame::Cut, samples } }
}

fn numbers(of: &Coefficients) -> [f64; 6] {
    [of.ktc, of.kte, of.krc, of.kre, of.kac, of.kae]
}

fn apart(one: &Coefficients, other: &Coefficients) -> f64 {
    let pairs = numbers(one).into_iter().zip(numbers(other));
    pairs.map(|(one, other)| (one / other - 1.0).abs()).fold(0.0, f64::max)
}

const FEEDS: [f64; 4] = [25e-6, 50e-6, 100e-6, 125e-6];

#[test]
fn means_without_noise_give_the_coefficients_back() {
    for engagement in [Engagement::SLOT, Engagement::of_width(Direction::Down, 0.008, 0.025).unwrap()] {
        let records: Vec<Recorded> = FEEDS.iter().map(|&feed| record(&cut(feed, engagement), 10.3, 0.4, 0.0)).collect();
        let fit = by_means(&records).unwrap();
        // Some hundred samples a turn.
        assert!(apart(&fit.coefficients, &MATERIAL) < 5e-3, "{fit:?}");
        for record in &fit.records {
            assert!((record.predicted.unwrap() - record.measured).norm() < 0.5, "{record:?}");
            let turn = record.turn.unwrap();
            assert!(turn.rms < 0.03 * turn.force && (turn.predicted_peak / turn.peak - 1.0).abs() < 0.03, "{turn:?}");
        }
        let over = by_revolutions(&records, &fit.coefficients).unwrap();
        assert!(apart(&over.coefficients, &MATERIAL) < 0.02, "{:?}", over.coefficients);
    }
}

/// Two cuts of one feed and other widths have other chips, but not at other places.
#[test]
fn one_feed_is_not_enough() {
    let one = record(&cut(1e-4, Engagement::SLOT), 3.0, 0.0, 0.0);
    assert_eq!(by_means(&[one.clone(), one.clone(), one.clone()]), Err(Unfit::OneFeed));
    assert_eq!(by_means(&[]), Err(Unfit::OneFeed));
    let other = record(&cut(5e-5, Engagement::SLOT), 3.0, 0.0, 0.0);
    let fit = by_means(&[one.clone(), other.clone()]).unwrap();
    assert_eq!((fit.std, fit.records[0].predicted), (None, None));
    let mut untimed = [one, other];
    for record in &mut untimed {
        record.cut.speed = None;
    }
    assert_eq!(by_revolutions(&untimed, &fit.coefficients), Err(Unfit::NoRevolution));
}

/// Of a hundred fits to noisy means the truth is within one standard deviation in some two thirds.
#[test]
fn standard_deviations_are_those_of_the_coefficients() {
    let (mut within, mut all) = (0, 0);
    for draw in 0..100_u32 {
        let mut state = u64::from(draw) + 1;
        let mut normal = || -> f64 {
            let mut random = || {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
            };
            (0..12).map(|_| random()).sum()
        };
        let noisy = |&feed: &f64| {
            let cut = cut(feed, Engagement::SLOT);
            let force = cut.mean_force() + Vector3::from_fn(|_, _| 2.0 * normal());
            let samples = vec![Sample { time: None, angle: None, force }];
            Recorded { path: PathBuf::new(), cut, force: MeasuredForce { frame: ForceFrame::Cut, samples } }
        };
        let feeds: Vec<f64> = (1..9).map(|k| f64::from(k) * 2e-5).collect();
        let fit = by_means(&feeds.iter().map(noisy).collect::<Vec<_>>()).unwrap();
        let (found, std) = (numbers(&fit.coefficients), numbers(&fit.std.unwrap()));
        for ((found, std), truth) in found.into_iter().zip(std).zip(numbers(&MATERIAL)) {
            within += usize::from((found - truth).abs() < std);
            all += 1;
        }
    }
    let share = f64::from(within as u32) / f64::from(all);
    assert!((0.58..0.74).contains(&share), "{share}");
}

const HEAD: &str = "DynoWare,Version 2.5.1.2\nFilename:,a.dwd\nDate:, \nSampling rate [Hz]:,200\nCycles:,1\n";

fn parse(text: &str) -> Result<(MeasuredForce, Vec<String>), robstiff_robots::Diagnostics> {
    MeasuredForce::parse("a.txt", text, ForceFrame::Cut, false)
}

#[test]
fn the_head_of_a_dynoware_file_is_read() {
    for separator in [",", "\t", ";"] {
        let text = format!("{HEAD}Time,Fx,Fy,Fz\ns,N,kN,N\n8,1,2,3\n8.5,4,5,6\n").replace(',', separator);
        let (force, warnings) = parse(&text).unwrap_or_else(|problems| panic!("{problems}"));
        assert!(warnings.is_empty(), "{warnings:?}");
        assert_eq!(force.samples[1], Sample { time: Some(8.5), angle: None, force: Vector3::new(4.0, 5000.0, 6.0) });
    }
    // Without times the sampling rate says them.
    let (force, _) = parse(&format!("{HEAD}Fx,Fy,Fz\nN,N,N\n1,2,3\n4,5,6\n")).unwrap();
    assert_eq!(force.samples[1].time, Some(0.005));
    let (force, _) = parse("time [s],Fx [N],Fy [N],Fz [N]\n0.5,1,2,3\n").unwrap();
    assert_eq!(force.samples[0].time, Some(0.5));
}

#[test]
fn mistakes_in_a_dynoware_file_are_shown_in_its_lines() {
    for (rest, place, part) in [
        ("Time,Fx,Fy,Fz\ns,N,N,N\n8,1,2,3\n9,1,x,3\n", "a.txt:9:5", "`x`"),
        ("Time,Fx,Fy,Fz\ns,N,N,furlong\n8,1,2,3\n", "a.txt:7:", "furlong"),
        ("Time,Fx,Fy,Fz\n8,1,2,3\n", "a.txt:7:1", "the columns have no units"),
        ("Time,Mx\ns,Nm\n8,1\n", "a.txt:1:1", "names no column `Fx`"),
        ("Time,Fx,Fy\ns,N,N\n8,1,2\n", "a.txt:7:1", "`Fz` is missing"),
    ] {
        let said = parse(&format!("{HEAD}{rest}")).unwrap_err().to_string();
        assert!(said.contains(place) && said.contains(part), "{rest}: {said}");
    }
}

const LIST: &str = "\
name: slots
on: workpiece
axes: {feed: -Fy, normal: -Fx, axis: Fz}
tool: {diameter: 25 mm, teeth: 2}
milling: slot
depth: 3 mm
speed: 6000 rpm
records:
  - {file: a.csv, feed_speed: 300 mm/min}
  - {file: a.csv, feed: 0.05 mm/tooth, depth: 2 mm, milling: down, width: 8 mm}
";

/// A folder with a record and a list of such.
fn folder(name: &str, list: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("robstiff-{name}-{}", std::process::id()));
    fs::create_dir_all(&folder).unwrap();
    fs::write(folder.join("a.csv"), "t [s],Fx [N],Fy [N],Fz [N]\n0,1,2,3\n").unwrap();
    fs::write(folder.join("list.yaml"), list).unwrap();
    folder
}

fn read(name: &str, list: &str) -> Result<Records, String> {
    let folder = folder(name, list);
    let read = Records::read(&folder.join("list.yaml")).map_err(|error| error.to_string());
    fs::remove_dir_all(&folder).unwrap();
    read
}

#[test]
fn a_list_of_records_is_read() {
    let records = read("records", LIST).unwrap();
    assert_eq!(records.name, "slots");
    let [one, other] = &records.records[..] else { panic!("{records:?}") };
    assert!((one.cut.feed_per_tooth - 25e-6).abs() < 1e-12 && one.cut.engagement.is_slot());
    assert_eq!((other.cut.depth, other.cut.feed_per_tooth, other.cut.engagement.wall()), (2e-3, 5e-5, Some(-1.0)));
    // On the tool they are the opposite of what the workpiece feels.
    assert_eq!(one.force.samples[0].force, Vector3::new(2.0, 1.0, -3.0));
    assert!(records.warnings.is_empty(), "{:?}", records.warnings);
    let mirrored = read("mirrored", &LIST.replace("-Fx", "Fx")).unwrap().warnings;
    assert!(mirrored[0].contains("list.yaml:3: feed, normal and axis are mirrored"), "{mirrored:?}");
    let plain = LIST.replace("workpiece", "tool").replace("axes: {feed: -Fy, normal: -Fx, axis: Fz}\n", "");
    assert_eq!(read("plain", &plain).unwrap().records[0].force.samples[0].force, Vector3::new(1.0, 2.0, 3.0));
}

#[test]
fn mistakes_in_a_list_are_shown_where_they_are() {
    for (index, (from, to, place, part)) in [
        ("on: workpiece\n", "", "list.yaml:1:1", "`on` is missing"),
        ("-Fy", "-Fx", "list.yaml:3:7", "a column is along two axes"),
        ("-Fy", "Fw", "list.yaml:3:14", "Fw"),
        ("file: a.csv, feed_s", "file: b.csv, feed_s", "list.yaml:9:12", "there is no file"),
        ("feed_speed: 300 mm/min", "depth: 1 mm", "list.yaml:9:5", "`feed` is missing"),
        ("depth: 3 mm\n", "", "list.yaml:8:5", "`depth` is missing"),
        ("feed: 0.05 mm/tooth", "fed: 0.05 mm/tooth", "list.yaml:10:19", "did you mean `feed`"),
        ("width: 8 mm", "width: 30 mm", "list.yaml:10:75", "wider than the tool"),
        ("milling: slot", "file: a.csv", "list.yaml:5:1", "unknown field `file`"),
        ("speed: 6000 rpm\n", "", "list.yaml:8:31", "without the spindle's"),
    ]
    .into_iter()
    .enumerate()
    {
        assert!(LIST.contains(from), "{from}");
        let said = read(&format!("mistake-{index}"), &LIST.replacen(from, to, 1)).unwrap_err();
        assert!(said.contains(place) && said.contains(part), "{from} -> {to}: {said}");
    }
    let none = LIST.split("records:").next().unwrap().to_owned() + "records: []\n";
    assert!(read("none", &none).unwrap_err().contains("there are no records"));
}

/// A line instead of the law: at the chips of the cut it is off by little, and its mean by nothing.
#[test]
fn the_law_of_kienzle_becomes_the_nearest_line() {
    let law = Kienzle { kc11: 1990e6, mc: 0.26, radial: 0.3, axial: 0.1 };
    assert!((law.tangential(1e-3) - 1990e3).abs() < 1e-3);
    assert!((law.tangential(1e-4) - 1990e3 * 0.1_f64.powf(0.74)).abs() < 1e-3);
    for engagement in
        [Engagement::SLOT, Engagement::between(0.3, 1.2).unwrap(), Engagement::between(1.5, 1.62).unwrap()]
    {
        let found = law.coefficients(engagement, 1e-4);
        let Engagement { entry, exit } = engagement;
        let (mut line, mut curve) = (0.0, 0.0);
        for k in 0..10_000 {
            let chip = 1e-4 * (entry + (exit - entry) * (f64::from(k) + 0.5) / 1e4).sin();
            let (one, other) = (found.ktc * chip + found.kte, law.tangential(chip));
            (line, curve) = (line + one, curve + other);
            assert!((one - other).abs() < 0.12 * law.tangential(1e-4), "{chip}: {one} {other}");
        }
        assert!((line / curve - 1.0).abs() < 1e-3, "{line} {curve}");
        assert!((found.krc / found.ktc - 0.3).abs() < 1e-12 && (found.kae / found.kte - 0.1).abs() < 1e-12);
    }
}

const STEEL: &str = "\
tool: {diameter: 16 mm, teeth: 3}
kienzle: {material: 42crmo4, radial: 0.3}
milling: slot
depth: 4 mm
feed: 0.1 mm/tooth
";

fn cut_file(text: &str) -> Result<CutFile, robstiff_robots::ReadError> {
    CutFile::parse("cut.yaml", text, Path::new(""))
}

#[test]
fn a_cut_may_have_the_law_of_kienzle() {
    let file = cut_file(STEEL).unwrap();
    assert!(file.source.contains("42CrMo4") && file.source.contains("RÖHM"), "{}", file.source);
    let own = STEEL.replace("material: 42crmo4", "kc11: 2530 N/mm2, mc: 0.25");
    assert_eq!(cut_file(&own).unwrap().forces, file.forces);
    // All of the table can be read.
    for material in kienzle_materials() {
        cut_file(&STEEL.replace("42crmo4", &material.id)).unwrap();
        assert!(material.source.contains("RN 1391") && (0.1..0.35).contains(&material.mc));
    }
    for (from, to, place, part) in [
        ("42crmo4", "42crmo", "cut.yaml:2:21", "did you mean `42crmo4`"),
        (", radial: 0.3", "", "cut.yaml:2:10", "`radial` is missing"),
        ("material: 42crmo4", "kc11: 2530 N/mm2, mc: 1.2", "cut.yaml:2:33", "mc is less than 1"),
        ("material: 42crmo4", "kc11: 2530 mm, mc: 0.2", "cut.yaml:2:17", "mm"),
        ("material: 42crmo4", "material: 42crmo4, mc: 0.2", "cut.yaml:2:34", "the material says this already"),
        ("milling", "material: al7075-t6\nmilling", "cut.yaml:3:11", "keep one of them"),
        (
            "kienzle: {material: 42crmo4, radial: 0.3}",
            "material: e295",
            "cut.yaml:2:11",
            "kienzle: {material: e295, radial: 0.3}",
        ),
    ] {
        let said = cut_file(&STEEL.replacen(from, to, 1)).unwrap_err().to_string();
        assert!(said.contains(place) && said.contains(part), "{from} -> {to}: {said}");
    }
    let bare = STEEL.replace("material: 42crmo4", "kc11: 2530, mc: 0.25");
    assert_eq!(cut_file(&bare).unwrap().warnings, ["cut.yaml: `kc11` has no unit and is taken in Pa: is it in N/mm2?"]);
}
