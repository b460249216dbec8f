//! `view`: the page, and what a browser makes of it.

mod common;

use std::fs;
use std::path::Path;
use std::process::Command;

use common::{fail, folder, inside, json, measured, names, run, succeed};
use serde_json::Value;

/// Runs in the page after its own scripts, and leaves what it saw in the page.
const PROBE: &str = r#"
const seen = { errors: window.failures };
const picture = () => { draw(); return canvas.toDataURL(); };
const point = (type, x, y, id = 1) => canvas.dispatchEvent(new PointerEvent(type, { pointerId: id, clientX: x, clientY: y }));
const pictures = [picture()];
const pixels = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
seen.colours = new Set(new Uint32Array(pixels.buffer)).size;
point("pointerdown", 300, 200); point("pointermove", 420, 260); point("pointerup", 420, 260);
pictures.push(picture());
canvas.dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowLeft" }));
pictures.push(picture());
canvas.dispatchEvent(new WheelEvent("wheel", { deltaY: 200, cancelable: true }));
pictures.push(picture());
point("pointerdown", 300, 200, 1); point("pointerdown", 400, 200, 2); point("pointermove", 500, 200, 2);
point("pointerup", 300, 200, 1); point("pointerup", 500, 200, 2);
pictures.push(picture());
const near = document.getElementById("near");
if (near) { near.click(); pictures.push(picture()); seen.near = document.getElementById("ellipsoid-scale").textContent; near.click(); }
const row = document.getElementById("row");
if (row) { row.value = state.row ? 0 : 1; row.dispatchEvent(new Event("input")); pictures.push(picture()); }
const q2 = document.getElementById("q2");
q2.value = Number(q2.value) + 8; q2.dispatchEvent(new Event("input"));
pictures.push(picture());
seen.moved = document.getElementById("moved").textContent;
document.getElementById("back").click();
seen.different = new Set(pictures).size;
seen.pictures = pictures.length;
const most = (values) => Math.max(...values);
seen.tcp = most(data.poses.map((pose) => norm(add(origin(standing(data, pose.q).tcp), pose.tcp, -1))));
seen.compliance = most(data.poses.map((pose) => {
  const own = jointCompliance(data, standing(data, pose.q));
  return norm(own.map((h, k) => h - pose.compliance[k])) / norm(pose.compliance);
}));
seen.principal = data.poses.slice(0, 1).map((pose) => principal(pose.compliance).map(({ value }) => value))[0];
seen.readout = document.getElementById("readout").textContent;
seen.drawing = getComputedStyle(document.getElementById("drawing")).display;
const result = document.createElement("pre");
result.id = "seen";
result.textContent = btoa(String.fromCharCode(...new TextEncoder().encode(JSON.stringify(seen))));
document.body.append(result);
"#;

fn browser() -> Option<&'static str> {
    let works = |name: &&str| Command::new(name).arg("--version").output().is_ok_and(|output| output.status.success());
    ["chromium", "chromium-browser", "google-chrome"].into_iter().find(works)
}

/// What the probe saw in a page; nothing where there is no browser.
fn look(folder: &Path, page: &str) -> Option<Value> {
    let Some(browser) = browser() else {
        eprintln!("skipped: no chromium is installed, so the page was not looked at in a browser");
        return None;
    };
    let text = fs::read_to_string(page).unwrap();
    let listen =
        "<script>window.failures = []; addEventListener(\"error\", (event) => failures.push(event.message));</script>";
    // The page runs no script but its own, by its policy; the probe is let in beside it.
    let text = text.replacen("<head>", &format!("<head>{listen}"), 1);
    let text = text.replacen("script-src ", "script-src 'nonce-probe' ", 1);
    let end = text.rfind("</body>").unwrap();
    let probed = inside(folder, "probed.html");
    fs::write(&probed, format!("{}<script nonce=\"probe\">{PROBE}</script>{}", &text[..end], &text[end..])).unwrap();
    let output = Command::new(browser)
        .args(["--headless", "--no-sandbox", "--disable-gpu", "--enable-logging=stderr", "--window-size=1100,900"])
        .args(["--virtual-time-budget=3000", "--dump-dom"])
        .arg(format!("--user-data-dir={}", inside(folder, "browser")))
        .arg(format!("file://{}", fs::canonicalize(&probed).unwrap().display()))
        .output()
        .unwrap();
    let (dom, log) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(!log.contains("CONSOLE"), "{log}");
    let seen = dom.rsplit_once("<pre id=\"seen\">").unwrap_or_else(|| panic!("the probe did not end:\n{log}")).1;
    let seen = decoded(seen.split_once('<').unwrap().0);
    Some(serde_json::from_slice(&seen).unwrap())
}

/// Base 64.
fn decoded(text: &str) -> Vec<u8> {
    let digit = |byte| match byte {
        b'A'..=b'Z' => byte - b'A',
        b'a'..=b'z' => byte - b'a' + 26,
        b'0'..=b'9' => byte - b'0' + 52,
        b'+' => 62,
        _ => 63,
    };
    let digits: Vec<u32> = text.bytes().filter(|&byte| byte != b'=').map(|byte| u32::from(digit(byte))).collect();
    let bytes = |group: &[u32]| {
        let bits = group.iter().enumerate().map(|(k, digit)| digit << (18 - 6 * k)).sum::<u32>();
        bits.to_be_bytes()[1..group.len()].to_vec()
    };
    digits.chunks(4).flat_map(bytes).collect()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value}"))
}

/// What holds for every page: it draws, and everything that can be moved moves.
fn assert_alive(seen: &Value) {
    assert_eq!(seen["errors"], serde_json::json!([]));
    assert!(number(&seen["colours"]) > 200.0, "{seen}");
    assert_eq!(seen["different"], seen["pictures"], "something moved and the picture did not: {seen}");
    assert_eq!(seen["drawing"], "none");
    assert!(number(&seen["tcp"]) < 1e-9, "{seen}");
}

fn docs(file: &str) -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/commands/files").join(file).to_str().unwrap().to_owned()
}

#[test]
fn a_pose_turns_and_its_numbers_are_those_of_show() {
    let folder = folder("view-pose");
    let (page, shown) = (inside(&folder, "page.html"), inside(&folder, "shown.json"));
    let at = "0.2, -30 deg, 20 deg, 0, 1";
    let said = succeed(&["view", "rv130hsc", "--at", at, "--force", "0, 0, -400 N", "--out", &page]);
    assert!(said.contains("Rv130hsc: 1 pose\nsoftest direction: 2.029 um/N\n"), "{said}");
    succeed(&["show", "rv130hsc", "--at", at, "--json", &shown]);
    let text = fs::read_to_string(&page).unwrap();
    for outside in ["http:", "https:", " src=", " href=", "url(", "import "] {
        assert!(!text.replace("http://www.w3.org/2000/svg", "").contains(outside), "the page needs {outside}");
    }
    assert!(text.contains("role=\"img\" aria-label=\"Rv130hsc seen from the front left\"") && !text.contains("NaN"));
    let Some(seen) = look(&folder, &page) else { return };
    assert_alive(&seen);
    // A robot without effects: the page's own compliance is the whole.
    assert!(number(&seen["compliance"]) < 1e-12, "{seen}");
    for (own, shown) in
        seen["principal"].as_array().unwrap().iter().zip(json(&shown)["principal_directions"].as_array().unwrap())
    {
        let shown = number(&shown["compliance_m_per_N"]) * 1e6;
        assert!((number(own) - shown).abs() < 1e-12 * shown.max(1.0), "{own} {shown}");
    }
    assert!(seen["readout"].as_str().unwrap().contains("µm in all"), "{seen}");
}

#[test]
fn a_path_is_coloured_by_its_deviation() {
    let folder = folder("view-path");
    let (page, told) = (inside(&folder, "page.html"), inside(&folder, "told.json"));
    let path = docs("pocket-solved.csv");
    let said = succeed(&["view", "kuka-kr270-r2700", "--path", &path, "--out", &page, "--json", &told]);
    assert!(said.contains("109 poses") && said.contains("deviation under the force: "), "{said}");
    let told = json(&told);
    let poses = told["poses"].as_array().unwrap();
    assert_eq!(poses.len(), 109);
    for pose in poses {
        // The third column of the file's x y z: the arm is where the path says.
        assert!((number(&pose["tcp"][2]) - 0.6).abs() < 1e-6, "{pose}");
        let d = pose["displacement"].as_array().unwrap().iter().map(|d| number(d).powi(2)).sum::<f64>().sqrt();
        assert!((number(&pose["value"]) / d - 1.0).abs() < 1e-12);
    }
    if let Some(seen) = look(&folder, &page) {
        assert_alive(&seen);
        assert!(seen["near"].as_str().unwrap().contains("from corner to corner"), "{seen}");
    }
    let said = succeed(&["view", "kuka-kr270-r2700", "--path", &path, "--column", "Fx", "--out", &page]);
    assert!(said.contains("Fx: -514.7 to 514.7 N"), "{said}");

    // Errors have signs: the worst is the one farthest from zero.
    let below = inside(&folder, "below.csv");
    let text = fs::read_to_string(&path).unwrap();
    let signed = text.lines().enumerate().map(|(k, line)| match k {
        0 => format!("{line},error [um]\n"),
        _ => format!("{line},-{k}\n"),
    });
    fs::write(&below, signed.collect::<String>()).unwrap();
    succeed(&["view", "kuka-kr270-r2700", "--path", &below, "--column", "error", "--out", &page]);
    let page = fs::read_to_string(&page).unwrap();
    assert!(page.contains("wider where it is farther from zero"));
    let worst = page.split("the worst dozen first").nth(1).unwrap();
    let row = worst.split("</tr>").nth(1).unwrap();
    assert!(row.contains(">109<") && row.contains(">-109<"), "{row}");
    // The last piece of the path, the worst, has the strongest colour; the bar says sizes.
    let lines: Vec<&str> = page.split("class=\"path shade").skip(1).map(|rest| &rest[..1]).collect();
    assert_eq!((lines.len(), lines[0], lines[107]), (108, "0", "9"));
    assert!(page.contains("<span>1</span><span>55</span><span>109</span>"));
}

#[test]
fn a_tolerance_passes_or_fails_at_the_top() {
    let folder = folder("view-tolerance");
    let [page, told] = ["page.html", "told.json"].map(|name| inside(&folder, name));
    let path = docs("pocket-solved.csv");
    let view = |tolerance: &str| {
        let arguments = ["view", "kuka-kr270-r2700", "--path", &path, "--tolerance", tolerance, "--out", &page];
        let said = succeed(&[&arguments[..], &["--json", &told]].concat());
        let text = fs::read_to_string(&page).unwrap();
        let top = text.split("<header>").nth(1).unwrap().split("</header>").next().unwrap().to_owned();
        (said, top, text, json(&told))
    };
    let (said, top, text, told_fail) = view("0.5 mm");
    let values = told_fail["poses"].as_array().unwrap().iter().map(|pose| number(&pose["value"]));
    let beyond = values.filter(|value| *value > 500.0).count();
    let verdict = format!("Fail: {beyond} of 109 points are beyond 500 ");
    assert!(beyond > 0 && said.contains(&verdict) && top.contains(&verdict), "{said}{top}");
    assert_eq!((&told_fail["value"]["passes"], &told_fail["value"]["tolerance"]), (&false.into(), &500.0.into()));
    // 172.7 to 607.6: the mark is at (500 - 172.7) / 434.9 of the bar.
    assert!(text.contains("x1=\"75.2%\"") || text.contains("x1=\"75.3%\""));
    let (said, top, _, told_pass) = view("1 mm");
    assert!(said.contains("Pass: none of 109 points") && top.contains("verdict pass"), "{said}{top}");
    assert_eq!(told_pass["value"]["passes"], true);
    // A force is no length.
    let arguments = ["view", "kuka-kr270-r2700", "--path", &path, "--column", "Fx", "--tolerance", "1 mm"];
    assert!(fail(2, &[&arguments[..], &["--out", &page]].concat()).contains("a tolerance is a length"));
}

#[test]
fn rapids_are_thin_and_grey_and_count_nowhere() {
    let folder = folder("view-rapids");
    let [table, page, told] = ["rapids.csv", "page.html", "told.json"].map(|name| inside(&folder, name));
    let text = fs::read_to_string(docs("pocket-solved.csv")).unwrap();
    let view = |rapid: fn(usize) -> &'static str| {
        let rows = text.lines().enumerate().map(|(k, line)| match k {
            0 => format!("{line},rapid\n"),
            _ => format!("{line},{}\n", rapid(k)),
        });
        fs::write(&table, rows.collect::<String>()).unwrap();
        ["view", "kuka-kr270-r2700", "--path", &table, "--out", &page, "--tolerance", "1 mm", "--json", &told]
    };
    // The rows from 50 on, the worst of all among them.
    let said = succeed(&view(|k| if k < 50 { "0" } else { "1" }));
    assert!(said.contains("109 poses") && said.contains("none of 49 points is beyond"), "{said}");
    let drawn = fs::read_to_string(&page).unwrap();
    assert_eq!((drawn.matches("class=\"path rapid\"").count(), drawn.matches("class=\"path shade").count()), (60, 48));
    let told = json(&told);
    let poses = told["poses"].as_array().unwrap();
    assert!(poses[..49].iter().all(|pose| pose["rapid"] == false && pose["value"].is_number()));
    assert!(poses[49..].iter().all(|pose| pose["rapid"] == true && pose["value"].is_null()));
    if let Some(seen) = look(&folder, &page) {
        assert_alive(&seen);
    }
    let said = fail(1, &view(|k| if k == 7 { "yes" } else { "0" }));
    assert!(said.contains("rapids.csv:8:"), "{said}");
}

/// Beside a pocket of 40 mm an ellipsoid as large as a sixth of the arm says nothing.
#[test]
fn no_ellipsoid_is_longer_than_the_path() {
    let folder = folder("view-ellipsoid");
    let [page, told] = ["page.html", "told.json"].map(|name| inside(&folder, name));
    let path = docs("pocket-solved.csv");
    succeed(&["view", "kuka-kr270-r2700", "--path", &path, "--out", &page, "--json", &told]);
    let told = json(&told);
    let poses = told["poses"].as_array().unwrap();
    let side = |axis: usize| {
        let ends = poses.iter().map(|pose| number(&pose["tcp"][axis]));
        ends.clone().fold(f64::MIN, f64::max) - ends.fold(f64::MAX, f64::min)
    };
    let extent = (0..3).map(side).fold(0.0, f64::hypot);
    let text = fs::read_to_string(&page).unwrap();
    let scale = text.split("ellipsoids: 1 µm/N is ").nth(1).unwrap().split(" mm").next().unwrap();
    // The softest direction of the robot's page is 1.187 um/N.
    let longest = 2.0 * 1.187 * scale.parse::<f64>().unwrap() / 1e3;
    assert!(longest <= extent && longest > 0.2 * extent, "{longest} {extent}");
}

/// The file's own deviation and what the page computes, of each of its rows.
fn both_deviations(folder: &Path, robot: &str, forces: &str) -> Vec<[f64; 2]> {
    let [table, solved, page, told] = ["forces.csv", "solved.csv", "page.html", "told.json"].map(|n| inside(folder, n));
    fs::write(&table, forces).unwrap();
    let path = inside(folder, "path.csv");
    let points: String = (0..6).map(|k| format!("{},0,600,0,0,-1\n", 1500 + 40 * k)).collect();
    fs::write(&path, format!("x [mm],y [mm],z [mm],ux,uy,uz\n{points}")).unwrap();
    succeed(&["path", robot, &path, "--forces", &table, "--out", &solved]);
    succeed(&["view", robot, "--path", &solved, "--out", &page, "--json", &told]);
    let solved = fs::read_to_string(solved).unwrap();
    let deviation = solved.lines().next().unwrap().split(',').position(|name| name == "deviation [um]").unwrap();
    let written = solved.lines().skip(1).map(|row| row.split(',').nth(deviation).unwrap().parse().unwrap());
    let told = json(&told);
    written.zip(told["poses"].as_array().unwrap()).map(|(one, pose)| [one, number(&pose["value"])]).collect()
}

#[test]
fn a_path_deviates_as_its_file_says() {
    let folder = folder("view-agrees");
    let check = |both: &[[f64; 2]]| {
        assert_eq!(both.len(), 6);
        for [written, shown] in both {
            assert!((written - shown).abs() < 1e-3 && *written > 10.0, "{both:?}");
        }
    };
    // A moment of some size, and gears that keep what a load has left behind.
    check(&both_deviations(
        &folder,
        "kuka-kr270-r2700",
        &format!("Fx,Fy,Fz,Mx,My,Mz\n{}", "100,200,-300,150,-100,50\n".repeat(6)),
    ));
    let robot = inside(&folder, "robot.yaml");
    let text = robstiff_robots::catalogue::find("kuka-kr270-r2700").unwrap();
    let effect = "\neffects:\n  - {kind: hysteresis, at: joint 1, radius1: 100 Nm, weight1: 1e-6 rad/Nm}\n";
    fs::write(&robot, format!("{}{effect}", text.trim_end())).unwrap();
    let loads = ["100,800,-300\n".repeat(4), "0,0,0\n".repeat(2)].concat();
    check(&both_deviations(&folder, &robot, &format!("Fx,Fy,Fz\n{loads}")));
}

#[test]
fn the_worst_of_a_long_path_is_drawn_and_told() {
    let folder = folder("view-long");
    let [path, page, told] = ["path.csv", "page.html", "told.json"].map(|name| inside(&folder, name));
    let value = |k: usize| match k {
        1001 => 1828.4,
        2001 => -3.0,
        _ => 201.7,
    };
    let rows: String = (0..4000).map(|k| format!("0,0,0,0,{},{}\n", 30.0 + 0.01 * k as f64, value(k))).collect();
    fs::write(&path, format!("q1 [deg],q2 [deg],q3 [deg],q4 [deg],q5 [deg],deviation [um]\n{rows}")).unwrap();
    let column = ["--column", "deviation", "--out", &page, "--json", &told];
    let said = succeed(&[&["view", "rv130hsc", "--path", &path], &column[..]].concat());
    assert!(said.contains("one in 2 drawn") && said.contains("deviation: -3 to 1828 um"), "{said}");
    let told = json(&told);
    let poses = told["poses"].as_array().unwrap();
    assert_eq!(poses.len(), 2002);
    let worst = poses.iter().find(|pose| number(&pose["value"]) == 1828.4).unwrap();
    assert_eq!(worst["row"], 1002);
}

#[test]
fn a_campaign_shows_what_was_measured() {
    let folder = folder("view-campaign");
    let page = inside(&folder, "page.html");
    let campaign = measured().join("campaign.yaml");
    let arguments = ["view", "fanuc-r2000ic", "--campaign", campaign.to_str().unwrap(), "--out", &page];
    let said = succeed(&arguments);
    assert!(said.contains("43 poses") && said.contains("measured less predicted"), "{said}");
    let Some(seen) = look(&folder, &page) else { return };
    assert_alive(&seen);
    assert!(seen["readout"].as_str().unwrap().contains("Measured"), "{seen}");
}

#[test]
fn positions_show_how_far_they_are_off() {
    let folder = folder("view-positions");
    let (page, told) = (inside(&folder, "page.html"), inside(&folder, "told.json"));
    let (scenario, out) = (inside(&folder, "try.yaml"), inside(&folder, "out"));
    let text = "kind: position\nseed: 1\nposes: {count: 20}\nnoise: {displacement: 30 um}\nhidden:\n  effects:\n    \
                - {kind: joint_zero_offset, at: joint 3, value: 0.1 deg}\n";
    fs::write(&scenario, text).unwrap();
    succeed(&["simulate", "kuka-kr270-r2700", &scenario, "--out", &out]);
    let campaign = format!("{out}/campaign.yaml");
    let said = succeed(&["view", "kuka-kr270-r2700", "--campaign", &campaign, "--out", &page, "--json", &told]);
    assert!(said.contains("read less predicted: "), "{said}");
    assert!(fs::read_to_string(&page).unwrap().contains("From where the tool is predicted to where it was read"));
    let told = json(&told);
    for pose in told["poses"].as_array().unwrap() {
        let off = pose["off"].as_array().unwrap().iter().map(number).fold(0.0, f64::hypot);
        assert!((off - number(&pose["value"])).abs() < 1e-3 * off && pose["displacement"].is_null(), "{pose}");
    }
    let Some(seen) = look(&folder, &page) else { return };
    assert_alive(&seen);
    assert!(seen["readout"].as_str().unwrap().contains("Off"), "{seen}");
}

#[test]
fn an_ellipsoid_without_the_effects_says_so() {
    let folder = folder("view-effects");
    let (robot, page) = (inside(&folder, "robot.yaml"), inside(&folder, "page.html"));
    let text = robstiff_robots::catalogue::find("staubli-rx160").unwrap();
    let effect = "\neffects:\n  - {kind: transverse_compliance, at: joint 3, value: 5e-7}\n";
    fs::write(&robot, format!("{}{effect}", text.trim_end())).unwrap();
    succeed(&["view", &robot, "--out", &page]);
    let Some(seen) = look(&folder, &page) else { return };
    assert_alive(&seen);
    assert!(number(&seen["compliance"]) > 1e-3, "{seen}");
    assert!(seen["moved"].as_str().unwrap().contains("of the joints alone"), "{seen}");
}

#[test]
fn a_path_of_another_robot_is_told() {
    let folder = folder("view-other");
    let ran = run(&["view", "rv130hsc", "--path", &docs("pocket-solved.csv"), "--out", &inside(&folder, "page.html")]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    assert!(ran.err.contains("pocket-solved.csv: the column `q6` is not used, Rv130hsc has no joint 6"), "{}", ran.err);
}

#[test]
fn what_is_wrong_leaves_no_page() {
    let folder = folder("view-wrong");
    let (path, page) = (inside(&folder, "path.csv"), inside(&folder, "page.html"));
    fs::write(&path, "q1 [deg],q2 [deg],q3 [deg],q4 [deg],q5 [mm]\n0,0,0,x,0\n").unwrap();
    let message = fail(1, &["view", "rv130hsc", "--path", &path, "--out", &page]);
    assert!(message.contains("path.csv:1:37") && message.contains("`mm` is a length"), "{message}");
    fs::write(&path, "q1 [deg],q2 [deg],q3 [deg],q4 [deg],q5 [deg]\n0,0,0,x,0\n").unwrap();
    let message = fail(1, &["view", "rv130hsc", "--path", &path, "--column", "dev", "--out", &page]);
    assert!(message.contains("path.csv:2:7") && message.contains("the column `dev` is missing"), "{message}");
    assert!(fail(2, &["view", "rv130hsc", "--at", "0,0", "--out", &page]).contains("has 5 joints"));
    assert_eq!(run(&["view", "rv130hsc", "--force", "3 N", "--out", &page]).code, 2);
    assert_eq!(run(&["view", "rv130hsc", "--at", "0,0,0,0,0", "--path", &path, "--out", &page]).code, 2);
    assert_eq!(names(&folder), ["path.csv"]);
}
