//! `start`: what to measure first.

mod common;

use std::fs;
use std::path::Path;

use common::{fail, folder, inside, json, names, succeed};

const FILES: [&str; 4] = ["campaign.schema.json", "campaign.yaml", "how-to-measure.html", "loads.csv"];

/// Fills in what would be read on an arm that is as a description says, with some noise.
fn fill(folder: &Path, truth: &str) {
    let table = folder.join("loads.csv");
    let campaign = inside(folder, "campaign.yaml");
    let text = fs::read_to_string(&table).unwrap();
    // What is predicted does not depend on what was read; rows that read alike would pass for copies.
    let reads = |(number, line): (usize, &str)| match line.strip_suffix(",,,") {
        Some(row) => format!("{row},{number},1,1\n"),
        None => format!("{line}\n"),
    };
    fs::write(&table, text.lines().enumerate().map(reads).collect::<String>()).unwrap();
    let predicted = inside(folder, "predicted.csv");
    succeed(&["predict", truth, &campaign, "--csv", &predicted]);
    let predicted = fs::read_to_string(predicted).unwrap();
    let mut rows = predicted.lines();
    let header: Vec<&str> = rows.next().unwrap().split(',').collect();
    let column = |name: &str| header.iter().position(|header| header.starts_with(name)).expect(name);
    let at = ["predicted_dx", "predicted_dy", "predicted_dz"].map(column);
    let mut filled = text.lines().take(1).map(|line| line.to_owned() + "\n").collect::<String>();
    // A sequence that fills the unit interval evenly: noise of some um.
    let mut draw = 0.5_f64;
    for (line, row) in text.lines().skip(1).zip(rows) {
        let fields: Vec<&str> = row.split(',').collect();
        let readings = at.map(|at| {
            draw = (draw + 0.618_033_988_749_895).fract();
            assert!(header[at].ends_with("[um]"), "{}", header[at]);
            format!("{:.2}", fields[at].parse::<f64>().unwrap() + 4.0 * (draw - 0.5))
        });
        filled += &format!("{},{}\n", line.strip_suffix(",,,").unwrap(), readings.join(","));
    }
    fs::write(&table, filled).unwrap();
}

#[test]
fn a_folder_that_can_be_filled_in_and_traced() {
    let folder = folder("start");
    let out = inside(&folder, "mine");
    let page = succeed(&["start", "rv130hsc", "--out", &out, "--poses", "12"]);
    assert!(page.contains("12 poses to measure, 48 rows of loads up to 500 N"), "{page}");
    // This robot has no limits in its description.
    assert!(page.contains("stay within 90 deg of zero: 1, 2, 3, 4, 5"), "{page}");
    assert_eq!(names(Path::new(&out)), FILES);
    let campaign = inside(Path::new(&out), "campaign.yaml");

    // Nothing was read yet.
    for command in ["identify", "trace"] {
        let said = fail(1, &[command, &campaign, "--out", &inside(&folder, "none")]);
        assert!(said.starts_with("error: no readings yet: fill in dx, dy, dz"), "{said}");
        assert_eq!(said.matches("error:").count(), 1, "{said}");
    }

    // The same arguments give the same bytes.
    let again = inside(&folder, "again");
    succeed(&["start", "rv130hsc", "--out", &again, "--poses", "12"]);
    for name in FILES {
        let read = |out: &str| fs::read(Path::new(out).join(name)).unwrap();
        assert_eq!(read(&out), read(&again), "{name}");
    }

    // What is there stays.
    let said = fail(1, &["start", "rv130hsc", "--out", &out]);
    assert!(said.contains("is there already and is not empty"), "{said}");

    fill(Path::new(&out), "rv130hsc");
    let traced = inside(&folder, "traced");
    succeed(&["trace", &campaign, "--out", &traced]);
    let trace = json(&inside(Path::new(&traced), "trace.json"));
    assert_eq!(trace["poses"], 12);
    assert_eq!(trace["verdict"], "adequate", "{}", trace["why"]);
}

#[test]
fn a_description_of_ones_own_is_copied() {
    let folder = folder("start-own");
    let robot = inside(&folder, "arm.yaml");
    let text = "name: Arm
convention: standard
joints:
  - {d: 400 mm, alpha: -90 deg, limits: [-170 deg, 170 deg], compliance: 1e-6}
  - {a: 800 mm, limits: [-120 deg, 30 deg], compliance: 1e-6}
  - {a: 600 mm, limits: [-100 deg, 100 deg], compliance: 2e-6}
";
    fs::write(&robot, text).unwrap();
    let out = inside(&folder, "out");
    succeed(&["start", &robot, "--out", &out, "--poses", "5", "--margin", "10", "--force", "200 N"]);
    assert_eq!(names(Path::new(&out)), [&FILES[..], &["robot.yaml"]].concat());
    assert_eq!(fs::read_to_string(Path::new(&out).join("robot.yaml")).unwrap(), text);
    let table = fs::read_to_string(Path::new(&out).join("loads.csv")).unwrap();
    assert!(table.starts_with("pose,visit,q1 [deg],q2 [deg],q3 [deg],Fx [N],Fy [N],Fz [N],dx [um],dy [um],dz [um]\n"));
    for row in table.lines().skip(1) {
        let numbers: Vec<f64> = row.split(',').filter(|field| !field.is_empty()).map(|f| f.parse().unwrap()).collect();
        assert!((-136.0..=136.0).contains(&numbers[2]), "{row}");
        assert!((-105.0..=15.0).contains(&numbers[3]), "{row}");
        assert!((-80.0..=80.0).contains(&numbers[4]), "{row}");
        assert!(numbers[5..8].iter().map(|force| force * force).sum::<f64>().sqrt() < 200.2, "{row}");
    }
    let said = fail(2, &["start", &robot, "--out", &inside(&folder, "no"), "--margin", "60"]);
    assert!(said.contains("a percentage from 0 to 45 is expected here"), "{said}");
}
