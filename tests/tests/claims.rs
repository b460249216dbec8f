//! Tracing claims no more than the data show: what fits as well is listed, a whole truth needs noise
//! that is known, errors before and after are of the same rows, a name matters and is distinct from
//! zero, and the readings by themselves accuse nobody of what a named effect does.

use std::fs;
use std::path::Path;
use std::sync::LazyLock;

use robstiff::Effect;
use robstiff_identify::campaign::{Campaign, Data, Noise};
use robstiff_identify::trace::{NoiseSource, Options, RowResidual, Trace, Verdict, account_for, trace};
use robstiff_identify::triage::{Triage, triage};
use robstiff_robots::Description;
use robstiff_tests::folder::Folder;
use robstiff_tests::positions;
use robstiff_tests::simulator::{
    Axes, Hidden, Outside, Positions, Scenario, Simulated, five_axis, scattered, six_axis,
};

static FANUC: LazyLock<Campaign> = LazyLock::new(|| {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../robots/measured/fanuc-r2000ic/campaign.yaml");
    Campaign::read(path).unwrap_or_else(|problem| panic!("{problem}"))
});

/// What tracing finds in it.
static FOUND: LazyLock<Trace> =
    LazyLock::new(|| trace(&FANUC, &Options::default(), &|_| {}).expect("it can be traced"));

/// Noise of one reading on each axis, one sigma (m).
const NOISE: f64 = 1e-5;

fn traced(campaign: &Campaign) -> Trace {
    trace(campaign, &Options::default(), &|_| {}).unwrap_or_else(|problem| panic!("{problem}"))
}

fn names(trace: &Trace) -> Vec<String> {
    trace.effects.iter().map(|named| named.effect.to_string()).collect()
}

/// Five axes or six, each joint up to 30 % from what is declared.
fn plan(declared: &Description, seed: u64) -> Scenario {
    Scenario { noise: NOISE, ..Scenario::new(scattered(declared, 0.7..1.3, seed + 1000), Vec::new(), seed) }
}

/// A campaign as it is read from its files.
fn read(simulated: &Simulated, declared: &Description) -> Campaign {
    let folder = Folder::new();
    simulated.write(&folder.0, &declared.to_yaml()).expect("a temporary folder");
    Campaign::read(folder.0.join("campaign.yaml")).unwrap_or_else(|problem| panic!("{problem}"))
}

/// A campaign of clamped axes with `more` in its file.
fn clamped(axes: &Axes, declared: &Description, more: &str) -> Campaign {
    let folder = Folder::new();
    let write = |file: &str, text: &str| fs::write(folder.0.join(file), text).expect("a temporary file");
    write("robot.yaml", &declared.to_yaml());
    write("campaign.yaml", &format!("name: axes\nrobot: robot.yaml\nobservations: axes.csv\nkind: clamped\n{more}"));
    write("axes.csv", &axes.table());
    Campaign::read(folder.0.join("campaign.yaml")).unwrap_or_else(|problem| panic!("{problem}"))
}

/// The root mean square of one axis over rows (m).
fn rms<'a>(rows: impl Iterator<Item = &'a RowResidual>, of: fn(&RowResidual) -> [f64; 3]) -> f64 {
    let squares: Vec<f64> = rows.flat_map(of_row(of)).collect();
    (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
}

fn of_row(of: fn(&RowResidual) -> [f64; 3]) -> impl Fn(&RowResidual) -> [f64; 3] {
    move |row| of(row).map(|one| one * one)
}

/// Asserts a number within a fraction of another.
#[track_caller]
fn assert_near(what: &str, found: f64, expected: f64, fraction: f64) {
    assert!((found / expected - 1.0).abs() <= fraction, "{what}: {found:e}, expected {expected:e}");
}

/// 43 pulls, one a pose, no noise declared: the size of the noise is known from the model alone.
#[test]
fn what_the_fanuc_shows_is_not_the_whole_truth() {
    let found = &*FOUND;
    assert_eq!((found.verdict, found.noise_source), (Verdict::Partial, NoiseSource::Residuals));
    let probable = found.effects.iter().all(|named| named.probability >= 0.95 && named.recurs >= 0.8);
    assert!(probable && !found.effects.is_empty(), "{:?}", found.effects);
    assert!(found.suspected.iter().all(|of| !of.why_not.is_empty()), "{:?}", found.suspected);

    // Rows that do not belong to the others are in the errors before and after.
    assert_eq!(found.residuals.len(), 43);
    assert_near("before", found.identified.rms, rms(found.residuals.iter(), |row| row.before), 1e-9);
    assert_near("after", found.after.rms, rms(found.residuals.iter(), |row| row.after), 1e-9);
}

/// The whole search in five parts, each time without one.
#[test]
fn the_search_without_poses_of_the_fanuc_errs_by_more() {
    let (found, again) = (&*FOUND, &FOUND.nested);
    assert_eq!(again.folds, 5);
    // The figure that the page on tracing shows.
    assert_near("searched", again.rms, 120.4e-6, 0.02);
    assert_near("what is told", found.after.holdout_rms, again.rms, 1e-9);
    assert!(again.rms > 1.1 * found.after.rms, "{again:?}, {:?}", found.after);
    assert!(again.rms < again.identified_rms && again.identified_rms > found.identified.rms, "{again:?}");
    assert!(again.names.is_sorted_by(|one, next| one.1 >= next.1));
    assert!(again.names.iter().all(|one| one.1 > 0.0 && one.1 <= 1.0), "{:?}", again.names);
}

#[test]
fn a_true_effect_comes_back() {
    let mut simulated = Scenario { poses: 24, visits: 1, ..plan(&five_axis(), 1) };
    simulated.hidden.push(Effect::TransverseCompliance { joint: 3, value: 6e-7 }.into());
    let campaign = read(&simulated.run(), &five_axis());
    let found = trace(&campaign, &Options { folds: 4, ..Options::default() }, &|_| {}).expect("it can be traced");
    let again = &found.nested;
    assert_eq!(again.folds, 4);
    assert_eq!(
        again.names.first().map(|(name, share)| (name.as_str(), *share)),
        Some(("transverse_compliance@joint 3", 1.0))
    );
    // What it leaves is noise, little more of it than in the fit.
    assert!((1.0..1.3).contains(&(again.rms / (NOISE * 2_f64.sqrt()))), "{again:?}");
    assert!(again.identified_rms > 2.0 * again.rms, "{again:?}");
}

/// The verdict, and what it says of the noise, are as expected.
#[track_caller]
fn assert_verdict(what: &str, trace: &Trace, verdict: Verdict) {
    assert_eq!(trace.verdict, verdict, "{what}: {:?}, {}", names(trace), trace.why);
    assert!(!trace.effects.is_empty(), "{what}");
    let is_known = trace.noise_source != NoiseSource::Residuals;
    assert_eq!((is_known, trace.why.contains("noise is")), (verdict == Verdict::Explained, !is_known), "{what}");
}

/// The same effect in the same campaign, with noise that is declared, repeated, or neither.
#[test]
fn a_whole_truth_needs_noise_that_is_known() {
    let tilt = Effect::TransverseCompliance { joint: 3, value: 6e-7 };
    let once = Scenario { poses: 60, visits: 1, ramp: vec![1.0], ..plan(&six_axis(), 2) }.hiding(tilt);
    assert_verdict("one load a pose", &traced(&read(&once.run(), &six_axis())), Verdict::Partial);
    let states = Scenario { states_noise: true, ..once };
    assert_verdict("noise stated", &traced(&read(&states.run(), &six_axis())), Verdict::Explained);
    let several = plan(&six_axis(), 2).hiding(tilt);
    assert_verdict("several loads a pose", &traced(&read(&several.run(), &six_axis())), Verdict::Explained);

    let mut tracker = Positions::new(scattered(&six_axis(), 0.7..1.3, 3), 3);
    tracker.hidden.push(Hidden::JointZeroOffset { joint: 3, offset: 2e-3 });
    let positions = |tracker: &Positions, noise: Option<f64>| {
        let campaign = positions::read(tracker, &six_axis(), tracker.reflector);
        traced(&Campaign { noise: Noise { displacement: noise, rotation: None }, ..campaign })
    };
    assert_verdict("positions", &positions(&tracker, None), Verdict::Partial);
    let stated = tracker.noise[0].hypot(tracker.noise[1]);
    assert_verdict("positions, noise stated", &positions(&tracker, Some(stated)), Verdict::Explained);
    tracker.poses = [30, 2];
    assert_verdict("poses come to twice", &positions(&tracker, None), Verdict::Explained);

    let mut axes = Axes::new(scattered(&six_axis(), 0.7..1.3, 4), 4);
    axes.hidden.push(Hidden::LostMotion { joint: 2, gap: 6e-5, knee: 40.0 });
    let apart = [0.03, 0.1, 0.31, 0.58, 1.0, 0.72, 0.34, 0.06, -0.05, -0.28, -1.0, -0.62, -0.22, 0.14, 0.47, 0.83];
    axes.ramp = apart.to_vec();
    let of = |axes: &Axes, more: &str| traced(&clamped(axes, &six_axis(), more));
    assert_verdict("axes", &of(&axes, ""), Verdict::Partial);
    assert_verdict("axes, noise stated", &of(&axes, "noise: {rotation: 2 urad}\n"), Verdict::Explained);
    axes.ramp = apart.iter().flat_map(|share| [*share, *share]).collect();
    assert_verdict("torques twice", &of(&axes, ""), Verdict::Explained);
    // Less than there is does not make it one.
    let too_small = of(&axes, "noise: {rotation: 1 urad}\n");
    assert_eq!(too_small.verdict, Verdict::Partial, "{}", too_small.why);
}

/// A row that does not belong is left out of the fit, and predicted like all others.
#[test]
fn errors_before_and_after_are_of_the_same_rows() {
    let tilt = Effect::TransverseCompliance { joint: 3, value: 6e-7 };
    let mut simulated = plan(&five_axis(), 5).hiding(tilt).run();
    simulated.rows[40].displacement[1] += 2e-3;
    let found = traced(&read(&simulated, &five_axis()));
    assert!(found.effects.iter().any(|named| named.lines == [42]), "{:?}", names(&found));
    for (misfit, of) in
        [(found.identified, (|row| row.before) as fn(&RowResidual) -> [f64; 3]), (found.after, |row| row.after)]
    {
        assert_near("all rows", misfit.rms, rms(found.residuals.iter(), of), 1e-9);
        // The row alone, over all.
        assert!(misfit.holdout_rms > 0.9 * 2e-3 / (3.0 * found.rows as f64).sqrt(), "{misfit:?}");
    }
    let others = rms(found.residuals.iter().filter(|row| row.line != 42), |row| row.after);
    assert_near("without it", others, NOISE * 2_f64.sqrt(), 0.15);
}

/// One joint of 24 poses has lost motion and nothing else is missing, with the name of that.
fn lost_motion(seed: u64) -> (Simulated, Description, String) {
    let arm = if seed.is_multiple_of(2) { five_axis() } else { six_axis() };
    let joint = 1 + (seed / 2 % 3) as usize;
    let gap = [4e-5, 1e-4, 3e-4][(seed / 6 % 3) as usize];
    let ramp = vec![0.35, 0.7, 1.0, 0.7, 0.35];
    let scenario = Scenario { poses: 24, ramp, ..plan(&arm, seed) };
    let lost = Hidden::LostMotion { joint, gap, knee: 30.0 };
    (scenario.hiding(lost).run(), arm, format!("lost_motion@joint {joint}"))
}

#[test]
fn what_does_not_matter_is_not_named() {
    let (simulated, arm, name) = lost_motion(16);
    let found = traced(&read(&simulated, &arm));
    assert_eq!((found.verdict, names(&found)), (Verdict::Explained, vec![name]), "{}", found.why);
}

/// The checks that fail and the visits that stand out, of which nothing that was named is the reason.
fn open(asked: &Triage) -> (Vec<&'static str>, Vec<usize>) {
    let checks = asked.violated().filter(|(_, finding)| finding.accounted_for_by.is_empty());
    let strays = asked.outliers.iter().filter(|stray| stray.accounted_for_by.is_empty());
    (checks.map(|(check, _)| check.name).collect(), strays.map(|stray| stray.visit).collect())
}

/// Loads and displacements of gears with lost motion are not reciprocal, and visits stand out.
#[test]
fn readings_by_themselves_accuse_nobody_of_lost_motion() {
    for seed in [9, 14] {
        let (simulated, arm, name) = lost_motion(seed);
        let campaign = read(&simulated, &arm);
        let mut asked = triage(&campaign);
        let (checks, strays) = open(&asked);
        assert!(checks.contains(&"reciprocity") && checks.contains(&"outliers") && !strays.is_empty(), "{asked:?}");
        let found = traced(&campaign);
        assert_eq!((found.verdict, names(&found)), (Verdict::Explained, vec![name.clone()]), "{}", found.why);
        account_for(&mut asked, &campaign, &found);
        assert_eq!(open(&asked), (vec![], vec![]), "{asked:?}");
        assert!(asked.violated().all(|(_, finding)| finding.accounted_for_by == [name.as_str()]), "{asked:?}");
    }
}

/// A reading that is off in such a campaign is still one.
#[test]
fn lost_motion_does_not_account_for_a_reading_that_is_off() {
    let (mut simulated, arm, name) = lost_motion(9);
    simulated.rows[40].displacement[1] += 2e-3;
    let campaign = read(&simulated, &arm);
    let mut asked = triage(&campaign);
    let found = traced(&campaign);
    assert!(names(&found).contains(&name), "{:?}", names(&found));
    account_for(&mut asked, &campaign, &found);
    let Data::Displacement(data) = &campaign.data else { panic!("a campaign of displacements") };
    assert_eq!(open(&asked).1, [data.rows[40].visit], "{asked:?}");
}

/// It may not come out as a load cell whose scale is wrong.
#[test]
fn a_foundation_that_tilts_unequally_is_the_base() {
    for (seed, arm) in [(0, five_axis()), (1, six_axis())] {
        let uneven = Hidden::Outside(Outside::UnevenFoundation { tilt: [8e-8, 2e-8] });
        let found = traced(&read(&plan(&arm, seed).hiding(uneven).run(), &arm));
        let name = String::from("base_compliance@base");
        assert_eq!((found.verdict, names(&found)), (Verdict::Explained, vec![name]), "{}", found.why);
        let tilts = ["tilt_x", "tilt_y"].map(|name| found.effects[0].effect.value(name));
        assert_near("about x", tilts[0], 8e-8, 0.1);
        assert_near("about y", tilts[1], 2e-8, 0.3);
    }
}
