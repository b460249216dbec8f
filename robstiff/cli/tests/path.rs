//! `path`: joint coordinates of a tool path, in and out.

mod common;

use std::fs;
use std::path::Path;

use common::{fail, folder, inside, json, keys, run, succeed};

fn pocket() -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/files/pocket.csv").to_str().unwrap().to_owned()
}

#[test]
fn a_pocket_is_solved_written_and_read_again() {
    let folder = folder("path");
    let (out, told) = (inside(&folder, "solved.csv"), inside(&folder, "told.json"));
    let page = succeed(&["path", "rv130hsc", &pocket(), "--tool-axis", "x", "--out", &out, "--json", &told]);
    let points = fs::read_to_string(pocket()).unwrap().lines().count() - 1;
    assert!(page.contains(&format!("{points} points")) && page.contains("all reached (closed form)"), "{page}");
    assert!(!page.contains("changes its posture"), "{page}");
    let document = json(&told);
    assert_eq!(keys(&document), ["robot", "closed_form", "length_m", "points", "jumps"]);
    let first = &document["points"][0];
    assert!((first["position_m"][0].as_f64().unwrap() - 1.5).abs() < 1e-9);
    assert!((first["feed_m_per_s"].as_f64().unwrap() - 0.02).abs() < 1e-15);

    let again = inside(&folder, "again.csv");
    let ran = run(&["path", "rv130hsc", &out, "--out", &again]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    assert!(ran.err.contains("the joint coordinates are used, not the poses"), "{}", ran.err);
    let numbers = |file: &str| -> Vec<f64> {
        let text = fs::read_to_string(file).unwrap();
        text.lines().skip(1).flat_map(|line| line.split(',').map(|field| field.parse().unwrap())).collect()
    };
    for (one, other) in numbers(&out).iter().zip(numbers(&again)) {
        assert!((one - other).abs() < 2e-6, "{one} {other}");
    }
}

#[test]
fn unreachable_points_are_named_and_nothing_is_written() {
    let folder = folder("path-unreachable");
    let far = inside(&folder, "far.csv");
    fs::write(&far, fs::read_to_string(pocket()).unwrap().replace("1520,0,", "5520,0,")).unwrap();
    let out = inside(&folder, "solved.csv");
    let said = fail(1, &["path", "abb-irb6640-185-280", &far, "--out", &out]);
    assert!(said.contains("far.csv:3:1") && said.contains("out of reach"), "{said}");
    assert!(said.contains("points cannot be reached"), "{said}");
    assert!(!Path::new(&out).exists());
}

#[test]
fn a_path_is_placed_and_begun_as_asked() {
    let at = ["--place", "-100 mm, 200 mm, 0, 0, 0, 10 deg"];
    let page = succeed(&["path", "kuka-kr270-r2700", &pocket(), at[0], at[1], "--start", "0,-90 deg,90 deg,0,0,0"]);
    assert!(page.contains("all reached"), "{page}");
    let said = fail(2, &["path", "kuka-kr270-r2700", &pocket(), "--place", "1,2,3"]);
    assert!(said.contains("--place gives 3 numbers, six are needed"), "{said}");
    let said = fail(2, &["path", "kuka-kr270-r2700", &pocket(), "--start", "0,0"]);
    assert!(said.contains("--start gives 2 joint coordinates"), "{said}");
}
