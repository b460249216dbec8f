//! `plan`: what to measure next.

mod common;

use std::fs;
use std::path::Path;

use common::{fail, folder, inside, json, keys, measured, names, run, succeed};
use robstiff::nalgebra::{SVector, Vector3};
use robstiff::{Generic, Robot};
use robstiff_robots::Description;
use serde_json::Value;

/// What tracing the FANUC leaves open: two laws that are one where their knees are.
const PAIR: [&str; 2] = ["lost_motion@joint 1", "stiffness_nonlinearity@joint 1"];

fn campaign() -> String {
    inside(&measured(), "campaign.yaml")
}

#[test]
fn proposes_poses_for_the_fanuc() {
    let folder = folder("plan");
    let (out, copy, table) = (inside(&folder, "out"), inside(&folder, "copy.json"), inside(&folder, "next.csv"));
    let page = succeed(&["plan", &campaign(), "--out", &out, "--json", &copy, "--csv", &table]);
    assert!(page.contains("10 poses to measure next, after 43"), "{page}");
    assert!(page.contains(&PAIR.join(" / ")), "{page}");
    assert!(page.contains("joints without limits in the description stay in the campaign's range"), "{page}");
    assert!(page.contains("so its values differ and its standard deviations are mostly larger"), "{page}");
    assert_eq!(names(Path::new(&out)), ["plan.csv", "plan.json"]);
    let plan = json(&copy);
    assert_eq!(plan, json(&inside(Path::new(&out), "plan.json")));
    assert_eq!(keys(&plan), ["robot", "poses", "verdict", "proposals", "pairs", "numbers", "assumptions"]);
    let proposals = plan["proposals"].as_array().unwrap();
    assert_eq!(proposals.len(), 10);
    assert_eq!(keys(&proposals[0]), ["q_deg", "force_N", "moment_Nm", "separates", "separation", "std"]);
    let number = |value: &Value| value.as_f64().unwrap();
    assert!(plan["pairs"].as_array().unwrap().iter().all(|pair| pair["outlook"] == "alias"), "{}", plan["pairs"]);
    assert!(
        page.contains(&format!("No pose and load can tell {}: they show the same.", PAIR.join(" from "))),
        "{page}"
    );
    let numbers = plan["numbers"].as_array().unwrap();
    assert!(numbers.iter().all(|known| number(&known["factor"]) >= 1.0));
    // The same plan as in the book.
    let joints = numbers.iter().filter(|known| known["name"].as_str().unwrap().starts_with("joint "));
    let factors: Vec<f64> = joints.map(|known| number(&known["factor"])).collect();
    let said = format!(
        "the standard deviations of the joints to fall by factors of {:.2} to {:.2}.",
        factors.iter().copied().fold(f64::INFINITY, f64::min),
        factors.iter().copied().fold(0.0, f64::max)
    );
    let page = include_str!("../../docs/measuring.md").split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(page.contains(&said), "{said}");

    // The campaign's own columns, within its range, at its greatest force.
    let table = fs::read_to_string(table).unwrap();
    assert!(table.starts_with("pose,visit,q1 [deg],q2 [deg],"), "{table}");
    let loads = fs::read_to_string(measured().join("loads.csv")).unwrap();
    let numbers = |text: &str, skipped: usize| -> Vec<Vec<f64>> {
        let row = |line: &str| line.split(',').skip(skipped).map(|field| field.parse().unwrap()).collect();
        text.lines().skip(1).map(row).collect()
    };
    let (next, past) = (numbers(&table, 2), numbers(&loads, 1));
    let force = |row: &Vec<f64>| row[6..9].iter().map(|value| value * value).sum::<f64>().sqrt();
    let greatest = past.iter().map(force).fold(0.0, f64::max);
    for row in &next {
        assert!((force(row) - greatest).abs() < 0.01);
        for joint in 0..6 {
            let within = |q: f64| past.iter().any(|row| row[joint].to_degrees() <= q + 1e-5);
            let beyond = |q: f64| past.iter().any(|row| row[joint].to_degrees() >= q - 1e-5);
            assert!(within(row[joint]) && beyond(row[joint]), "{row:?}");
        }
    }
}

#[test]
fn a_trace_proposes_the_first_of_them() {
    // The first poses leave more open than all of them do.
    let folder = folder("plan-trace");
    let out = inside(&folder, "out");
    let robot = inside(&measured(), "../../fanuc-r2000ic.yaml");
    let loads: String =
        fs::read_to_string(measured().join("loads.csv")).unwrap().split_inclusive('\n').take(27).collect();
    fs::write(folder.join("loads.csv"), loads).unwrap();
    let text = fs::read_to_string(campaign()).unwrap().replace("../../fanuc-r2000ic.yaml", &robot);
    fs::write(folder.join("campaign.yaml"), text).unwrap();
    let page = succeed(&["trace", &inside(&folder, "campaign.yaml"), "--out", &out]);
    let trace = json(&inside(Path::new(&out), "trace.json"));
    let next = trace["next"].as_array().unwrap();
    assert_eq!(next.len(), 3);
    assert_eq!(keys(&next[0]), ["q_deg", "force_N", "separates"]);
    assert_eq!(next[0]["q_deg"].as_array().unwrap().len(), 6);
    assert_eq!(next[0]["separates"], serde_json::json!(["transverse_compliance@joint 3", "link_compliance@link 3"]));
    let said = "To tell transverse compliance of joint 3 from compliance of link 3, measure next:\n  q = (";
    assert!(page.contains(said), "{page}");
    let report = fs::read_to_string(folder.join("out/report.html")).unwrap();
    assert!(report.contains("What to measure next"));
}

#[test]
fn one_seed_gives_one_plan_and_options_count() {
    let page = |more: &[&str]| succeed(&[&["plan", &campaign(), "--poses", "3"], more].concat());
    assert_eq!(page(&[]), page(&[]));
    let asked = page(&["--force", "0.5 kN", "--floor", "900 mm", "--criterion", "d"]);
    assert!(asked.contains("forces of 500 N, as asked for") && asked.contains("at least 900 mm high"), "{asked}");
    let turned = page(&["--moment", "80 Nm"]);
    assert!(turned.contains("moments of 80 Nm, as asked for") && turned.contains("Mx [Nm]"), "{turned}");
    for wrong in [["--poses", "0"], ["--force", "-3 N"], ["--force", "3 m"], ["--criterion", "e"], ["--seed", "x"]] {
        assert_eq!(run(&["plan", &campaign(), wrong[0], wrong[1]]).code, 2, "{wrong:?}");
    }
}

#[test]
fn the_floor_is_that_of_the_base() {
    let folder = folder("plan-floor");
    let copied = common::copy(&folder);
    let page = || succeed(&["plan", &copied, "--poses", "2", "--floor", "900 mm"]);
    let (robot, on_the_ground) = (folder.join("robot.yaml"), page());
    let text = fs::read_to_string(&robot).unwrap();
    assert!(!text.contains("\nbase:"), "{text}");
    fs::write(&robot, text.replacen("\njoints:", "\nbase: {xyz: [0, 0, 2 m]}\njoints:", 1)).unwrap();
    assert_eq!(page(), on_the_ground);
}

/// What is filled in is read in the campaign's frame, so it has to be written in it.
#[test]
fn the_table_has_its_loads_in_the_frame_of_the_campaign() {
    let folder = folder("plan-tool");
    let scenario = "seed: 1\nposes: {count: 12}\nramp: [0.5, 1]\nforce: {bounds: [500 N, 900 N]}\n\
        moment: {bounds: [50 Nm, 90 Nm]}\nwrench: {frame: tool}\nnoise: {displacement: 8 um}\n";
    fs::write(folder.join("try.yaml"), scenario).unwrap();
    let (measured, out) = (inside(&folder, "measured"), inside(&folder, "out"));
    succeed(&["simulate", "kuka-kr270-r2700", &inside(&folder, "try.yaml"), "--out", &measured]);
    succeed(&["plan", &format!("{measured}/campaign.yaml"), "--poses", "2", "--out", &out]);
    let text = robstiff_robots::catalogue::find("kuka-kr270-r2700").unwrap();
    let robot = Generic::<6>::new(&Description::parse("robot.yaml", text).unwrap()).unwrap();
    let proposals = json(&inside(Path::new(&out), "plan.json"))["proposals"].clone();
    let table = fs::read_to_string(folder.join("out/plan.csv")).unwrap();
    assert_eq!(table.lines().count(), 1 + 2 * 2);
    // The second row of a visit has the greatest load.
    for (row, proposal) in table.lines().skip(2).step_by(2).zip(proposals.as_array().unwrap()) {
        let row: Vec<f64> = row.split(',').skip(2).map(|field| field.parse().unwrap()).collect();
        let pose = robot.transform(&SVector::<f64, 6>::from_fn(|joint, _| row[joint].to_radians()));
        let tool = pose.fixed_view::<3, 3>(0, 0);
        for (name, first) in [("force_N", 6), ("moment_Nm", 9)] {
            let base = Vector3::from_fn(|k, _| proposal[name][k].as_f64().unwrap());
            let turned = tool * Vector3::from_column_slice(&row[first..first + 3]);
            assert!((turned - base).norm() < 0.01, "{name}: {turned} {base}");
        }
    }
}

/// The poses of a tracker's campaign: its own columns, payloads and all, but the readings.
#[test]
fn positions_are_planned_with_their_payloads() {
    let folder = folder("plan-positions");
    let scenario = "seed: 2\nkind: position\nposes: {count: 16}\npayloads: [0 kg, 80 kg, 160 kg]\n\
        noise: {displacement: 10 um}\nhidden:\n  effects:\n  - {kind: tool_compliance, at: tool, rotation: 4e-8 rad/Nm}\n";
    fs::write(folder.join("try.yaml"), scenario).unwrap();
    let (measured, out) = (inside(&folder, "measured"), inside(&folder, "out"));
    succeed(&["simulate", "kuka-kr270-r2700", &inside(&folder, "try.yaml"), "--out", &measured]);
    let campaign = format!("{measured}/campaign.yaml");
    let page = succeed(&["plan", &campaign, "--poses", "2", "--out", &out]);
    assert!(page.contains("q6 [deg]  payload [kg]") && page.contains("payloads of 0 kg, 80 kg, 160 kg"), "{page}");
    let header = |file: &Path| fs::read_to_string(file).unwrap().lines().next().unwrap().to_owned();
    let own = header(&folder.join("measured/positions.csv"));
    let read: Vec<&str> =
        own.split(',').filter(|name| !["px", "py", "pz", "time"].iter().any(|other| name.starts_with(other))).collect();
    assert_eq!(header(&folder.join("out/plan.csv")), read.join(","));
    let table = fs::read_to_string(folder.join("out/plan.csv")).unwrap();
    let payloads: Vec<&str> = table.lines().skip(1).map(|row| row.rsplit(',').next().unwrap()).collect();
    assert_eq!(payloads, ["0", "80", "160", "0", "80", "160"]);
    let proposal = json(&inside(Path::new(&out), "plan.json"))["proposals"][0].clone();
    let close = |value: &Value, expected: f64| (value.as_f64().unwrap() - expected).abs() < 1e-6;
    assert!(close(&proposal["force_N"][2], -160.0 * 9.80665) && close(&proposal["payloads_kg"][2], 160.0));
    let moment = fail(1, &["plan", &campaign, "--moment", "50 Nm"]);
    assert!(moment.contains("payloads pull by their weight"), "{moment}");
    // Half the weight, half of each payload.
    let half = succeed(&["plan", &campaign, "--poses", "2", "--force", "784.532 N"]);
    assert!(half.contains("payloads of 0 kg, 40 kg, 80 kg, the greatest of the weight asked for"), "{half}");
}

#[test]
fn what_cannot_be_planned_is_explained() {
    let folder = folder("plan-wrong");
    let message = fail(1, &["plan", &campaign(), "--floor", "9 m", "--json", &inside(&folder, "plan.json")]);
    assert!(message.contains("only 0 poses of 10"), "{message}");
    let loads = inside(&folder, "loads.csv");
    let copied = common::copy(&folder);
    assert!(fail(1, &["plan", &copied, "--csv", &loads]).contains("would be overwritten"));
    let clamped = inside(&folder, "clamped.yaml");
    fs::write(folder.join("axes.csv"), "axis,torque [Nm],deflection [rad]\n1,0,0\n1,100,1e-5\n2,100,2e-5\n").unwrap();
    fs::write(&clamped, "name: axis by axis\nrobot: robot.yaml\nobservations: axes.csv\nkind: clamped\n").unwrap();
    let message = fail(1, &["plan", &clamped]);
    assert!(message.contains("planning needs a campaign of kind `displacement` or `position`"), "{message}");
    fs::write(&loads, "pose\n1\n").unwrap();
    assert!(fail(1, &["plan", &copied]).contains("loads.csv:1"));
    assert_eq!(names(&folder), ["axes.csv", "campaign.yaml", "clamped.yaml", "loads.csv", "robot.yaml"]);
}
