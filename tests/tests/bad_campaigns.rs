//! Broken campaigns, with what a person is told of each, word for word with the
//! place and the caret: `golden/bad_campaigns.txt`.
//!
//! New wording is accepted with `ROBSTIFF_BLESS=1 cargo test -p robstiff-tests
//! --test bad_campaigns`, and read in `git diff`.

use std::fs;
use std::path::Path;

use robstiff_identify::campaign::Campaign;

const ROBOT: &str = "name: Two
convention: standard
joints:
  - {a: 1 m, compliance: 1e-6 rad/Nm}
  - {a: 500 mm, compliance: 2e-6 rad/Nm}
";

const CAMPAIGN: &str = "name: bench
robot: robot.yaml
observations: loads.csv
kind: displacement
wrench: {frame: base, at: tcp}
measured: {frame: base, at: tcp}
";

const LOADS: &str = "pose,visit,q1 [deg],q2 [deg],Fx [N],Fy [N],Fz [N],dx [um],dy [um],dz [um]
a,1,0,30,100,200,300,10,20,30
a,1,0,30,200,400,600,20,40,60
b,2,45,60,100,200,300,10,20,30
";

/// A file, what is there, and what stands there instead.
const CASES: &[(&str, &str, &str)] = &[
    // The campaign.
    ("campaign.yaml", "kind: displacement", "kind: displacment"),
    ("campaign.yaml", "kind: displacement", "kind: position"),
    ("campaign.yaml", "kind: displacement\n", ""),
    ("campaign.yaml", "observations", "observation"),
    ("campaign.yaml", "wrench: {frame: base", "wrench: {frame: world"),
    ("campaign.yaml", "measured: {frame: base, at: tcp}", "measured: {at: [0, 120 mm]}"),
    ("campaign.yaml", "measured: {frame: base, at: tcp}", "measured: {at: [0, 0, 120 deg]}"),
    ("campaign.yaml", "name: bench", "noise: {displacement: 8 urad}"),
    ("campaign.yaml", "name: bench", "noise: {displacement: 0 um}"),
    ("campaign.yaml", "name: bench", "holdout: {fraction: 1, seed: 1}"),
    ("campaign.yaml", "name: bench", "holdout: {seed: -1, fraction: 0.2}"),
    ("campaign.yaml", "name: bench", "holdout: {seed: 0.5, fraction: 0.2}"),
    ("campaign.yaml", "name: bench", "holdout: {seed: 1e3, fraction: 0.2}"),
    ("campaign.yaml", "name: bench", "holdout: {seed: 99999999999999999999, fraction: 0.2}"),
    ("campaign.yaml", "robot.yaml", "robots.yaml"),
    ("campaign.yaml", "observations: loads.csv", "observations: ."),
    ("campaign.yaml", "name: bench", "name: [bench"),
    // The robot behind it.
    ("robot.yaml", "2e-6 rad/Nm", "2e-6 m/N"),
    // The table.
    ("loads.csv", ",dz [um]", ",dz [N]"),
    ("loads.csv", "Fx [N]", "Fx [kg]"),
    ("loads.csv", "Fy [N]", "Fy (N)"),
    ("loads.csv", "dx [um]", "dx [um"),
    ("loads.csv", "dx [um]", "dx ["),
    ("loads.csv", "pose,visit,q1 [deg],q2 [deg],Fx [N]", "pose;visit;q1 [deg];q2 [deg];Fx [N]"),
    ("loads.csv", "pose,visit,q1 [deg],q2 [deg],Fx [N],Fy [N],Fz [N],dx [um],dy [um],dz [um]\n", ""),
    ("loads.csv", "b,2,45", ",2,45"),
    ("loads.csv", "b,2,45", "b, ,45"),
    ("loads.csv", "q2 [deg]", "q3 [deg]"),
    ("loads.csv", "pose,", "poses,"),
    ("loads.csv", "a,1,0,30,200,400,600,20,40,60", "a,1,0,30,200,\"400,600\",20,40,60"),
    ("loads.csv", "a,1,0,30,200,400,600,20,40,60", "a,1,0,30,200,4OO,600,20,-,6e999"),
    ("loads.csv", "a,1,0,30,200", "\"a,1,0,30,200"),
    ("loads.csv", "a,1,0,30,200,400,600", "a,1,0,30,2e200,4e3,600"),
    ("loads.csv", "b,2,45,60", "b,1,45,60"),
    ("loads.csv", "b,2,45", "a,2,45"),
    (
        "loads.csv",
        "visit,q1 [deg],q2 [deg],Fx [N],Fy [N],Fz [N],dx [um],dy [um],dz [um]\na,1,",
        "time,q1 [deg],q2 [deg],Fx [N],Fy [N],Fz [N],dx [um],dy [um],dz [um]\na,08:15,",
    ),
    (
        "loads.csv",
        "visit,q1 [deg],q2 [deg],Fx [N],Fy [N],Fz [N],dx [um],dy [um],dz [um]\na,1,",
        "time [min],q1 [deg],q2 [deg],Fx [N],Fy [N],Fz [N],dx [um],dy [um],dz [um]\na,08:15:00,",
    ),
    ("loads.csv", "b,2,45,60,100,200,300,10,20,30", "b;2;45;60;100;200;300;10;20;30"),
];

#[test]
fn problems_are_told_in_these_words() {
    let folder = std::env::temp_dir().join(format!("robstiff-bad-campaigns-{}", std::process::id()));
    fs::create_dir_all(&folder).expect("a temporary folder");
    let files = [("robot.yaml", ROBOT), ("campaign.yaml", CAMPAIGN), ("loads.csv", LOADS)];
    let read = |broken: Option<&(&str, &str, &str)>| {
        for (file, text) in files {
            let text = match broken {
                Some((name, before, after)) if *name == file => {
                    assert_eq!(text.matches(before).count(), 1, "{before} in {file}");
                    text.replace(before, after)
                }
                _ => text.to_owned(),
            };
            fs::write(folder.join(file), text).expect("a temporary file");
        }
        Campaign::read(folder.join("campaign.yaml"))
    };
    assert!(read(None).expect("nothing is wrong").warnings.is_empty());

    let place = format!("{}{}", folder.display(), std::path::MAIN_SEPARATOR);
    let told: Vec<String> = CASES
        .iter()
        .map(|case @ (file, before, after)| {
            let message = read(Some(case)).map_or_else(|problem| problem.to_string(), |_| "accepted".to_owned());
            format!("# {file}: {before:?} -> {after:?}\n{}\n", message.replace(&place, "").trim_end())
        })
        .collect();
    fs::remove_dir_all(&folder).expect("the temporary folder");
    compare(&told);
}

fn compare(told: &[String]) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("golden/bad_campaigns.txt");
    if std::env::var_os("ROBSTIFF_BLESS").is_some_and(|value| value == "1") {
        fs::write(&path, told.join("\n")).expect("the golden file can be written");
        return;
    }
    let golden = fs::read_to_string(&path).expect("a golden file").replace("\r\n", "\n");
    for told in told {
        assert!(golden.contains(told.as_str()), "{} has other words for\n{told}", path.display());
    }
    assert_eq!(golden, told.join("\n"), "{} has more", path.display());
}
