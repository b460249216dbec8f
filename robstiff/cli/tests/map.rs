//! `map`: what the files say, and what is said of wrong ones.

mod common;

use std::fs;

use common::{fail, folder, inside, json, names, robstiff, run, succeed};

const JOINTS: &str = "force: [0, 400 N, -200 N]\njoints:\n  - 0\n  - {from: -80 deg, to: 60 deg, count: 7}\n  \
                      - {from: -60 deg, to: 90 deg, count: 6}\n  - 0\n  - {from: 30 deg, to: 60 deg, count: 2}\n";

const BOX: &str = "force: 500 N\npositions:\n  x: {from: 1200 mm, to: 3000 mm, count: 4}\n  \
                   y: {from: -400 mm, to: 400 mm, count: 3}\n  z: 600 mm\n\
                   tool: {direction: [0, 0, -1], turn: {from: 0 deg, to: 90 deg, count: 2}}\n";

fn rows(path: &str) -> (Vec<String>, Vec<Vec<Option<f32>>>) {
    let text = fs::read_to_string(path).unwrap();
    let mut lines = text.lines();
    let header = lines.next().unwrap().split(',').map(str::to_owned).collect();
    let row = |line: &str| line.split(',').map(|field| field.parse().ok()).collect();
    (header, lines.map(row).collect())
}

fn parquet(path: &str) -> (Vec<String>, Vec<Vec<Option<f32>>>) {
    use parquet::file::reader::{FileReader, SerializedFileReader};
    use parquet::record::Field;

    let reader = SerializedFileReader::new(fs::File::open(path).unwrap()).unwrap();
    let schema = reader.metadata().file_metadata().schema_descr_ptr();
    let header = schema.columns().iter().map(|column| column.name().to_owned()).collect();
    let value = |(_, field): (&String, &Field)| match field {
        Field::Float(value) => Some(*value),
        Field::Null => None,
        other => panic!("{other} is no number"),
    };
    let rows = reader.get_row_iter(None).unwrap();
    (header, rows.map(|row| row.unwrap().get_column_iter().map(value).collect()).collect())
}

#[test]
fn csv_and_parquet_hold_the_same() {
    for (name, robot, map, cells) in [("joints", "rv130hsc", JOINTS, 84), ("box", "kuka-kr270-r2700", BOX, 12)] {
        let folder = folder(&format!("map-{name}"));
        let at = |file: &str| inside(&folder, file);
        fs::write(at("map.yaml"), map).unwrap();
        let page = succeed(&[
            "map",
            robot,
            &at("map.yaml"),
            "--csv",
            &at("m.csv"),
            "--parquet",
            &at("m.parquet"),
            "--json",
            &at("m.json"),
            "--svg",
            &at("m.svg"),
            "--html",
            &at("m.html"),
        ]);
        assert!(page.contains("worst"), "{page}");
        let (csv, columns) = (rows(&at("m.csv")), parquet(&at("m.parquet")));
        assert_eq!((csv.1.len(), &csv.0), (cells, &columns.0));
        assert_eq!(csv.1, columns.1);
        let document = json(&at("m.json"));
        let figure = csv.0.iter().position(|name| name == "deviation [um]").unwrap();
        let reached: Vec<f32> = csv.1.iter().filter_map(|row| row[figure]).collect();
        let unreachable = document["unreachable"].as_u64().unwrap() as usize;
        assert_eq!(reached.len() + unreachable, cells);
        // 3 m is further than the arm is long.
        assert_eq!(unreachable > 0, name == "box");
        let most = reached.iter().copied().fold(0.0, f32::max);
        let worst = document["worst"]["deviation [um]"].as_f64().unwrap();
        assert!((worst as f32 - most).abs() <= 1e-6 * most, "{worst} {most}");
        for (file, part) in [("m.svg", "<svg"), ("m.html", "</html>")] {
            let text = fs::read_to_string(at(file)).unwrap();
            assert!(text.contains(part) && !text.contains("NaN"), "{file}");
        }
    }
}

#[test]
fn a_workpiece_is_placed_where_it_is_in_reach() {
    let folder = folder("map-place");
    let at = |file: &str| inside(&folder, file);
    fs::write(at("map.yaml"), BOX).unwrap();
    let arguments =
        ["map", "kuka-kr270-r2700", &at("map.yaml"), "--json", &at("m.json"), "--csv", &at("m.csv"), "--place"];
    let page = succeed(&[&arguments[..], &["600 x 400 x 0 mm"]].concat());
    assert!(page.contains("A workpiece of 600 x 400 x 0 mm is best put"), "{page}");
    let document = json(&at("m.json"));
    let placements = document["placements"].as_array().unwrap();
    // One turn for all of it, and the best at each point, which is no worse.
    let worst: Vec<f64> = placements.iter().map(|placed| placed["worst"].as_f64().unwrap()).collect();
    assert!(placements.len() == 2 && worst[1] <= worst[0] && !placements[0]["turn_deg"].is_null());
    // By hand: two by two cells of the map, all in reach.
    let (_, rows) = rows(&at("m.csv"));
    let value = |x: usize, y: usize| rows[x + 4 * y][2];
    let mut least = f32::MAX;
    for (x, y) in (0..3).flat_map(|x| (0..2).map(move |y| (x, y))) {
        let corners = [value(x, y), value(x + 1, y), value(x, y + 1), value(x + 1, y + 1)];
        if let Some(worst) = corners.into_iter().reduce(|a, b| Some(a?.max(b?))).flatten() {
            least = least.min(worst);
        }
    }
    assert!((worst[1] as f32 - least).abs() < 1e-5 * least, "{worst:?} {least}");
    // The map is written and told; that there is no place is an answer, with a warning.
    fs::remove_file(at("m.json")).unwrap();
    let ran = run(&[&arguments[..], &["1800 x 800 x 0 mm"]].concat());
    assert_eq!(ran.code, 0, "{}", ran.err);
    let said = "A workpiece of 1800 x 800 x 0 mm has no place that is reached everywhere";
    assert!(ran.out.contains("worst") && ran.out.contains(said), "{}", ran.out);
    let said = "map.yaml: a workpiece of 1800 x 800 x 0 mm has no place that is reached everywhere, the tool turned as \
                is best at each point; what would help";
    assert!(ran.err.starts_with("warning: ") && ran.err.contains(said), "{}", ran.err);
    assert!(json(&at("m.json"))["placements"][1]["corner_mm"].is_null());
    // Nothing need be computed for this.
    let said = fail(1, &[&arguments[..], &["1900 x 800 x 0 mm"]].concat());
    assert!(said.contains("a workpiece of 1900 x 800 x 0 mm is larger than the map, 1800 x 800 x 0 mm"), "{said}");
}

/// An arm of which no joint yields has no stiffness that a number could tell.
#[test]
fn what_is_rigid_has_no_number() {
    let folder = folder("map-rigid");
    let at = |file: &str| inside(&folder, file);
    let axis = |name: &str| format!("  {name}: {{from: -300 mm, to: 300 mm, count: 3}}\n");
    let mut rigid = 0;
    for (name, text) in robstiff_robots::catalogue::catalogue() {
        let robot = robstiff_robots::Description::parse(name, text).unwrap();
        if robot.joints.iter().any(|joint| !joint.compliance.is_empty()) {
            continue;
        }
        rigid += 1;
        for measure in ["stiffness", "compliance"] {
            // Over joints all is reached, over positions part of it.
            let over = match measure {
                "stiffness" => {
                    let q = |joint: &robstiff_robots::Joint| {
                        let [low, high] = joint.limits.unwrap_or([-1.0, 1.0]);
                        format!("{{from: {low}, to: {high}, count: 2}}")
                    };
                    format!("joints: [{}]\n", robot.joints.iter().map(q).collect::<Vec<_>>().join(", "))
                }
                _ => {
                    let xyz = "frame: {xyz: [1.5 m, 0, 0.8 m]}";
                    let tool = "tool: {direction: [0, 0, -1], turn: 0 deg}\n";
                    format!("positions:\n  {xyz}\n{}{}{}{tool}", axis("x"), axis("y"), axis("z"))
                }
            };
            fs::write(at("map.yaml"), format!("measure: {measure}\n{over}")).unwrap();
            let files = ["--csv", &at("m.csv"), "--parquet", &at("m.parquet"), "--json", &at("m.json")];
            let pages = ["--svg", &at("m.svg"), "--html", &at("m.html")];
            let ran = run(&[&["map", robot_name(name), &at("map.yaml")], &files[..], &pages].concat());
            assert_eq!(ran.code, 0, "{name}: {}", ran.err);
            let document = json(&at("m.json"));
            let [cells, unreachable, of_rigid] =
                ["cells", "unreachable", "rigid"].map(|key| document[key].as_u64().unwrap() as usize);
            assert!(of_rigid > 0 && of_rigid + unreachable == cells, "{name}: {document}");
            assert!(document["mean"].is_null() && document["worst"]["stiffness [N/um]"].is_null(), "{document}");
            let said = format!("{of_rigid} cells are rigid: no force moves the tool there");
            assert!(ran.out.contains(&said), "{name}: {}", ran.out);
            let (csv, columns) = (rows(&at("m.csv")), parquet(&at("m.parquet")));
            assert_eq!(csv.1, columns.1, "{name}");
            let figure = csv.0.iter().position(|name| name == "stiffness [N/um]").unwrap();
            assert!(csv.1.iter().all(|row| row[figure..figure + 4] == [None; 4]), "{name}");
            assert!(csv.1.iter().flatten().flatten().all(|value| value.is_finite()), "{name}");
            for file in ["m.csv", "m.json", "m.svg", "m.html"] {
                let text = fs::read_to_string(at(file)).unwrap();
                assert!(!text.contains("inf,") && !text.contains(",inf") && !text.contains("NaN"), "{name} {file}");
            }
        }
    }
    assert!(rigid >= 5, "{rigid}");
}

/// A name of the catalogue without its ending.
fn robot_name(file: &str) -> &str {
    file.trim_end_matches(".yaml")
}

/// Tables hold numbers of single precision; what is beyond is left out with a word.
#[test]
fn what_is_beyond_single_precision_is_no_number() {
    let folder = folder("map-beyond");
    let at = |file: &str| inside(&folder, file);
    let arm = "name: Soft\nconvention: standard\njoints: [{a: 1 m, compliance: 1e30 rad/Nm}, {a: 1 m}]\n";
    fs::write(at("soft.yaml"), arm).unwrap();
    let joints = "joints: [{from: 0, to: 1, count: 2}, {from: 0, to: 1, count: 2}]\n";
    fs::write(at("map.yaml"), format!("force: [0, 4e9 N, -2e9 N]\n{joints}")).unwrap();
    let files = ["--csv", &at("m.csv"), "--parquet", &at("m.parquet")];
    let ran = run(&[&["map", &at("soft.yaml"), &at("map.yaml")], &files[..]].concat());
    assert_eq!(ran.code, 0, "{}", ran.err);
    assert!(ran.err.starts_with("warning: ") && ran.err.contains("numbers beyond single precision"), "{}", ran.err);
    let (csv, columns) = (rows(&at("m.csv")), parquet(&at("m.parquet")));
    assert_eq!(csv.1, columns.1);
    let values: Vec<f32> = csv.1.iter().flatten().flatten().copied().collect();
    assert!(values.iter().all(|value| value.is_finite()) && csv.1.iter().any(|row| row.contains(&None)), "{values:?}");
}

#[test]
fn wrong_maps_are_explained_and_leave_nothing() {
    let folder = folder("map-wrong");
    let map = inside(&folder, "map.yaml");
    for (text, part) in [
        ("force: 500 N\n", "what the map is over is missing"),
        ("joints: [0, 0]\n", "map.yaml:1:9"),
        ("measure: deviation\njoints: [0, 0, 0, 0, 0]\n", "a deviation is that under a force"),
        ("force: 5 mm\njoints: [0, 0, 0, 0, 0]\n", "`mm` is a length"),
        ("joints: [{from: 10 deg, to: 0, count: 5}, 0, 0, 0, 0]\n", "help: swap the two"),
        ("joints: [{from: 1, to: 1, count: 5}, 0, 0, 0, 0]\n", "help: a single value is written without"),
        ("joints: [{from: 0, to: 1, count: 7.5}, 0, 0, 0, 0]\n", "help: e.g. `50`"),
        ("joints: [{from: 0, to: 1, count: 1}, 0, 0, 0, 0]\n", "from 2 to"),
        ("positions: {x: 1 m, y: 0, z: 1 m}\ntool: {direction: [0, 0, 0]}\n", "no direction"),
        ("positions: {x: 1 m, y: 0, z: 1 m}\n", "tool"),
    ] {
        fs::write(&map, text).unwrap();
        let message = fail(1, &["map", "rv130hsc", &map, "--csv", &inside(&folder, "out/m.csv")]);
        assert!(message.contains(part), "{text}: {message}");
    }
    fs::write(&map, "joints: [0, 0, 0, 0, {from: 0, to: 1, count: 3}]\n").unwrap();
    fail(2, &["map", "rv130hsc", &map, "--csv", &inside(&folder, "m.csv"), "--svg", &inside(&folder, "m.svg")]);
    fail(2, &["map", "rv130hsc", &map, "--place", "4 x 3"]);
    fail(1, &["map", "rv130hsc", &map, "--csv", &map]);
    assert_eq!(names(&folder), ["map.yaml"]);
}

/// Found before the work: a map of a second or more has no time to begin.
#[test]
fn what_cannot_be_written_is_told_before_the_map_is_made() {
    let folder = folder("map-unwritten");
    let (map, csv) = (inside(&folder, "map.yaml"), inside(&folder, "m.csv"));
    let axis = "{from: 0, to: 1, count: 30}, ".repeat(5);
    fs::write(&map, format!("joints: [{axis}]\n")).unwrap();
    let begun = std::time::Instant::now();
    for beside in ["map.yaml/m.json", "", "map.yaml"] {
        let said = fail(1, &["map", "rv130hsc", &map, "--csv", &csv, "--json", &inside(&folder, beside)]);
        assert!(said.contains("cannot write") || said.contains("would be overwritten"), "{said}");
    }
    assert!(begun.elapsed().as_secs() < 2, "{:?}", begun.elapsed());
    assert_eq!(names(&folder), ["map.yaml"]);
}

/// Half a map is of no use, and may be as large as a whole one.
#[test]
#[cfg(unix)]
fn an_interrupt_leaves_nothing_half_written() {
    use std::thread::sleep;
    use std::time::Duration;

    for (signal, name) in [("-INT", "map-interrupted"), ("-TERM", "map-ended")] {
        let folder = folder(name);
        let map = inside(&folder, "map.yaml");
        let axis = "{from: 0, to: 1, count: 60}, ".repeat(5);
        fs::write(&map, format!("joints: [{axis}]\n")).unwrap();
        let files = ["--csv", &inside(&folder, "made/m.csv"), "--parquet", &inside(&folder, "made/m.parquet")];
        let mut command = robstiff(&[&["map", "rv130hsc", &map], &files[..]].concat()).spawn().unwrap();
        let grows = || fs::read_dir(folder.join("made")).is_ok_and(|files| files.count() == 2);
        for _ in 0..1000 {
            if grows() {
                break;
            }
            sleep(Duration::from_millis(10));
        }
        assert!(grows() && command.try_wait().unwrap().is_none(), "it is at work");
        assert!(
            std::process::Command::new("kill").args([signal, &command.id().to_string()]).status().unwrap().success()
        );
        assert_eq!(command.wait().unwrap().code(), Some(130));
        assert_eq!(names(&folder), ["map.yaml"]);
    }
}

#[test]
fn a_map_that_no_pose_reaches_is_refused() {
    let folder = folder("map-unreached");
    let (map, out) = (inside(&folder, "map.yaml"), inside(&folder, "out.csv"));
    let far = "positions: {x: {from: 9 m, to: 10 m, count: 3}, y: 0, z: 1 m}\ntool: {direction: [0, 0, -1]}\n";
    fs::write(&map, far).unwrap();
    let said = fail(1, &["map", "rv130hsc", &map, "--csv", &out]);
    assert!(said.contains("no pose reaches any of it") && said.contains("is it in the robot's base frame"), "{said}");
    fs::write(&map, far.replace("9 m, to: 10 m", "-1000, to: 2200")).unwrap();
    let said = fail(1, &["map", "rv130hsc", &map, "--csv", &out]);
    assert!(said.contains("`x` is up to 2200 m away, farther than any arm reaches: in mm? write `2200 mm`"), "{said}");
    assert_eq!(names(&folder), ["map.yaml"]);
}

/// Degrees without a unit are computed with as what they are, but not without a word.
#[test]
fn joints_of_many_turns_are_asked_about() {
    let folder = folder("map-degrees");
    let map = inside(&folder, "map.yaml");
    let asked = |joints: &str| {
        fs::write(&map, format!("force: 500 N\njoints: {joints}\n")).unwrap();
        run(&["map", "kuka-kr270-r2700", &map]).err
    };
    let said = asked("[0, {from: -90, to: -60, count: 4}, 90, 0, 60, 0]");
    assert!(said.contains("map.yaml: q2 = -90 rad is more than a turn: are the angles in degrees?"), "{said}");
    assert_eq!(asked("[0, {from: -90 deg, to: -60 deg, count: 4}, 1.5, 0, 1, 0]"), "");
}

#[test]
fn a_map_of_more_rows_than_anybody_reads_is_refused() {
    let folder = folder("map-huge");
    let (map, out) = (inside(&folder, "map.yaml"), inside(&folder, "out.csv"));
    let refuse = |text: &str, expected: [&str; 2]| {
        fs::write(&map, text).unwrap();
        let said = fail(1, &["map", "kuka-kr270-r2700", &map, "--csv", &out]);
        assert!(expected.iter().all(|part| said.contains(part)), "{said}");
        assert_eq!(names(&folder), ["map.yaml"]);
    };
    let joint = "  - {from: -10 deg, to: 10 deg, count: 10000}\n";
    let text =
        format!("force: 500 N\njoints:\n  - 0\n{}  - 0\n  - 0\n", joint.replace("10 deg, c", "0 deg, c").repeat(3));
    refuse(&text, ["map.yaml:3:", "10000 x 10000 x 10000 = 1.0e12 poses are more than the 4.3e9 that a map may have"]);
    // Far beyond what 64 bits count.
    let most = "  - {from: -1 deg, to: 0 deg, count: 1000000}\n".repeat(6);
    refuse(&format!("force: 500 N\njoints:\n{most}"), ["map.yaml:3:", "= 1.0e36 poses"]);
    // The turns of the tool count as well.
    let turns = BOX.replace("count: 4", "count: 1000").replace("count: 3", "count: 1000");
    let turns = turns.replace("90 deg, count: 2", "90 deg, count: 10000");
    refuse(&turns, ["map.yaml:3:", "1000 x 1000 x 10000 = 1.0e10 poses"]);
}

#[test]
fn a_map_fits_a_narrow_window_with_its_scale() {
    let folder = folder("map-narrow");
    let (map, page) = (inside(&folder, "map.yaml"), inside(&folder, "map.html"));
    let grid = BOX.replace("z: 600 mm", "z: {from: 600 mm, to: 900 mm, count: 2}");
    fs::write(&map, grid).unwrap();
    succeed(&["map", "kuka-kr270-r2700", &map, "--html", &page]);
    let page = fs::read_to_string(&page).unwrap();
    let narrow = page.split_once("<div class=\"narrow\">").unwrap().1.split_once("</div>").unwrap().0;
    let sizes = narrow.split_once("viewBox=\"0 0 ").unwrap().1.split_once('"').unwrap().0;
    let width: f64 = sizes.split(' ').next().unwrap().parse().unwrap();
    // Beside the margins of the page in a window of 420 px, nothing is made smaller.
    assert!(width <= 372.0, "{sizes}");
    // The scale and both slices; everything is within.
    assert_eq!(narrow.matches("<image").count(), 3);
    for part in narrow.split("<image ").skip(1) {
        let of = |name: &str| -> f64 {
            let rest = part.split_once(&format!(" {name}=\"")).unwrap().1;
            rest.split_once('"').unwrap().0.parse().unwrap()
        };
        assert!(of("x") >= 0.0 && of("x") + of("width") <= width, "{part}");
    }
}
