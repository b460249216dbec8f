//! The loop on axes that are loaded one by one: what such readings can show is
//! named and written, what they cannot is said, and nothing is named where
//! nothing is hidden. Thresholds as in `matrix_sample`: of the rate that is
//! claimed, a count below them has a probability of 1 in 1000.

use std::fs;

use robstiff_identify::campaign::Campaign;
use robstiff_identify::trace::{Options, Trace, Verdict, trace};
use robstiff_robots::{Description, Effect};
use robstiff_tests::folder::Folder;
use robstiff_tests::judge_tracing::{Told, suspected};
use robstiff_tests::matrix::interval::fewest;
use robstiff_tests::simulator::{Axes, Hidden, five_axis, scattered, six_axis};

/// Runs of what is to hold at a rate.
const RUNS: u64 = 12;

fn traced(axes: &Axes, declared: &Description) -> Trace {
    let folder = Folder::new();
    let write = |file: &str, text: &str| fs::write(folder.0.join(file), text).expect("a temporary file");
    write("robot.yaml", &declared.to_yaml());
    let noise = format!("noise: {{rotation: {} urad}}\n", 1e6 * axes.noise);
    let said = "name: axis by axis\nrobot: robot.yaml\nobservations: axes.csv\nkind: clamped\n";
    write("campaign.yaml", &(said.to_owned() + &noise));
    write("axes.csv", &axes.table());
    let campaign = Campaign::read(folder.0.join("campaign.yaml")).unwrap_or_else(|problem| panic!("{problem}"));
    trace(&campaign, &Options::default(), &|_| {}).unwrap_or_else(|problem| panic!("{problem}"))
}

/// Both arms in turn, other compliances in every run.
fn axes(run: u64, seed: u64) -> (Axes, Description) {
    let declared = if run.is_multiple_of(2) { five_axis() } else { six_axis() };
    (Axes::new(scattered(&declared, 0.7..1.3, seed + run), seed + run), declared)
}

/// Asserts that what `hide` hides is named, alone, in as many runs as 95 in 100
/// would have; and gives the traces in which it is.
fn assert_named(name: &str, seed: u64, hide: impl Fn(&mut Axes)) -> Vec<(Axes, Trace)> {
    let mut right = Vec::new();
    for run in 0..RUNS {
        let (mut axes, declared) = axes(run, seed);
        hide(&mut axes);
        let trace = traced(&axes, &declared);
        let told = Told::of(&trace);
        let stands = told.names.len() == 1
            && (told.names[0].name == name || told.names[0].same_as.iter().any(|other| other == name));
        println!("{name} {run}: {} ({}) {:?}{}", trace.verdict, trace.why, told.names, suspected(&trace));
        // Readings that are far off leave the noise above what is known of it now and then.
        if stands && (trace.verdict == Verdict::Explained || name == "outliers@rig") {
            right.push((axes, trace));
        }
    }
    let least = fewest(RUNS as usize, 0.95, 1e-3);
    assert!(right.len() >= least, "{name}: {} of {RUNS}, not {least}", right.len());
    right
}

#[test]
fn nothing_is_named_where_nothing_is_hidden() {
    let runs = 30;
    let adequate = (0..runs).filter(|&run| {
        let (axes, declared) = axes(run, 9000);
        let trace = traced(&axes, &declared);
        assert!(trace.description.effects.is_empty() || !trace.effects.is_empty());
        trace.verdict == Verdict::Adequate && trace.effects.is_empty()
    });
    let (count, least) = (adequate.count(), fewest(runs as usize, 0.98, 1e-3));
    assert!(count >= least, "{count} of {runs}, not {least}");
}

#[test]
fn curves_of_a_gear_are_named_and_written() {
    for (axes, trace) in assert_named("lost_motion@joint 2", 9100, |axes| {
        axes.hidden = vec![Hidden::LostMotion { joint: 2, gap: 4e-5, knee: 40.0 }];
    }) {
        let joint = trace.estimates[1].value / axes.truth.joints[1].compliance();
        assert!((joint - 1.0).abs() < 0.05, "{joint}");
        assert!(trace.after.rms < trace.identified.rms && trace.identified.rms < trace.declared.rms);
        assert!(trace.description.effects.iter().any(|effect| effect.place().to_string() == "joint 2"));
    }
    assert_named("stiffness_nonlinearity@joint 3", 9200, |axes| {
        let added = 0.5 * axes.truth.joints[2].compliance();
        axes.hidden = vec![Effect::StiffnessNonlinearity { joint: 3, added, knee: 400.0 }.into()];
    });
}

#[test]
fn what_depends_on_the_order_of_loads_is_named() {
    assert_named("hysteresis@joint 1", 9300, |axes| {
        let weight = 0.3 * axes.truth.joints[0].compliance();
        axes.hidden = vec![Hidden::Hysteresis { joint: 1, operators: vec![(200.0, weight)] }];
    });
    assert_named("creep@rig", 9400, |axes| axes.hidden = vec![Hidden::Creep { share: 0.05, onset: 20.0 }]);
}

/// What five of six axes do has their names, not that of what all would share.
#[test]
fn lag_of_all_axes_but_one_is_no_creep() {
    let right = (0..RUNS).filter(|&run| {
        let (mut axes, declared) = axes(2 * run + 1, 10_100);
        let lag = |joint: usize| Hidden::Hysteresis {
            joint,
            operators: vec![(if joint > 3 { 40.0 } else { 200.0 }, 0.3 * axes.truth.joints[joint - 1].compliance())],
        };
        axes.hidden = (1..=5).map(lag).collect();
        let trace = traced(&axes, &declared);
        let told = Told::of(&trace);
        let mut names: Vec<&str> = told.names.iter().map(|one| one.name.as_str()).collect();
        println!("{run}: {} {names:?}", trace.verdict);
        names.sort_unstable();
        let each = (1..=5).map(|joint| format!("hysteresis@joint {joint}"));
        // So many names at once are never called the whole truth.
        trace.verdict == Verdict::Partial && each.eq(names)
    });
    let (count, least) = (right.count(), fewest(RUNS as usize, 0.9, 1e-3));
    assert!(count >= least, "{count} of {RUNS}, not {least}");
}

/// Where the unloaded readings of several axes are off, that of one more is as likely as a bias
/// or a curve that stands in for it.
#[test]
fn unloaded_readings_of_several_axes_are_off() {
    for run in 0..RUNS {
        let (mut axes, declared) = axes(2 * run + 1, 10_200);
        axes.slips = (0..5).map(|axis| (20 * axis, [4e-5, -3e-5, 2e-5, -1.5e-5, 1e-5][axis])).collect();
        let trace = traced(&axes, &declared);
        let names: Vec<String> = trace.effects.iter().map(|named| named.effect.to_string()).collect();
        println!("{run}: {} {names:?}{}", trace.verdict, suspected(&trace));
        let off = names.iter().filter(|name| name.starts_with("unloaded_reading@joint ")).count();
        assert!(off >= 2, "{names:?}");
        assert!(trace.verdict != Verdict::Explained || off == names.len(), "{names:?}");
    }
}

#[test]
fn faults_of_the_rig_are_named_and_not_written() {
    let named = [
        assert_named("load_cell_bias@rig", 9500, |axes| axes.torque_bias = 40.0),
        assert_named("thermal_drift@rig", 9600, |axes| axes.drift = 1.5e-6),
        assert_named("unloaded_reading@joint 2", 10_000, |axes| axes.slips = vec![(29, 3e-5)]),
        assert_named("outliers@rig", 9700, |axes| axes.wild = vec![(7, 3e-4), (31, -2e-4)]),
    ];
    for (axes, trace) in named.iter().flatten() {
        assert!(trace.description.effects.is_empty(), "seed {}", axes.seed);
    }
    // Lines count from the heading.
    let slipped = |(_, trace): &(Axes, Trace)| trace.effects[0].effect.value("from_line");
    assert!(named[2].iter().all(|one| slipped(one) == 31.0));
    assert!(named[3].iter().all(|(_, trace)| trace.effects[0].lines == [9, 33]));
}

#[test]
fn what_clamped_axes_cannot_show_is_said() {
    let (axes, declared) = axes(1, 9800);
    let trace = traced(&axes, &declared);
    for name in ["joint_coupling@joints 2,3", "link_compliance@link 2", "load_cell_scale@rig", "tool_compliance@tool"] {
        assert!(trace.invisible.iter().any(|other| other == name), "{name} in {:?}", trace.invisible);
    }
}

#[test]
fn too_few_rows_tell_nothing() {
    let (axes, declared) = axes(0, 9900);
    let trace = traced(&Axes { ramp: vec![0.5, 1.0], ..axes }, &declared);
    assert_eq!((trace.verdict, trace.effects.len()), (Verdict::Insufficient, 0));
    assert_eq!(trace.description, declared);
}
