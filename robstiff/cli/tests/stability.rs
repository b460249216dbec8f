//! What `robstiff stability` says of feeds, depths and modes.

mod common;

use std::fs;
use std::path::Path;

use common::{changed, fail, file, folder, inside, json, rigid, succeed};

fn stability(folder: &Path, backlash: Option<(&str, &str)>) -> serde_json::Value {
    stability_of(folder, &file("roughing.yaml"), backlash)
}

/// The page's arm in a cut, with backlash in its first joints (arcmin, Nm).
fn stability_of(folder: &Path, cut: &str, backlash: Option<(&str, &str)>) -> serde_json::Value {
    let (robot, told) = (inside(folder, "robot.yaml"), inside(folder, "stability.json"));
    let mut text = robstiff_robots::catalogue::find("kuka-kr270-r2700").unwrap().trim_end().to_owned();
    if let Some((gap, knee)) = backlash {
        text += "\neffects:\n";
        for joint in 1..=3 {
            text += &format!("  - {{kind: lost_motion, at: joint {joint}, gap: {gap} arcmin, knee: {knee} Nm}}\n");
        }
    }
    fs::write(&robot, text).unwrap();
    let at = "0,-90 deg,90 deg,0,60 deg,0";
    let page = succeed(&["stability", &robot, cut, "--at", at, "--frequency", "15 Hz", "--json", &told]);
    assert_eq!(page.contains("under the mean force of the cut at"), backlash.is_some(), "{page}");
    json(&told)
}

/// Beyond depths at which it chatters a narrow window of stable ones does not count.
#[test]
fn a_feed_is_stable_where_every_depth_up_to_the_cuts_is() {
    let told = stability(&folder("machining-windows"), None);
    let feeds = told["feeds"].as_array().unwrap();
    let stable = |feed: &&serde_json::Value| feed["stable"].as_bool().unwrap();
    assert_eq!(feeds.iter().filter(stable).count(), 7);
    for feed in feeds {
        let limit = feed["limiting_depth_m"].as_f64();
        assert_eq!(stable(&feed), limit.is_none_or(|limit| limit > 0.002), "{feed}");
    }
    let at = "0,-90 deg,90 deg,0,60 deg,0";
    let deep = changed(&folder("machining-six"), "roughing.yaml", ["depth: 2 mm", "depth: 6 mm"]);
    let page = succeed(&["stability", "kuka-kr270-r2700", &deep, "--at", at, "--frequency", "15 Hz"]);
    assert!(page.contains("3 more are stable at 6 mm itself, but they chatter at less.\n"), "{page}");
    let slow = ["--speed", "1800 rpm", "--damping", "0.02"];
    let asked = ["stability", "kuka-kr270-r2700", &deep, "--at", at, "--frequency", "15 Hz"];
    let page = succeed(&[&asked[..], &slow].concat());
    assert!(page.contains("Best feed: 55 deg, along (0.497, -0.819, 0.287), to 6.73 mm.\n"), "{page}");
    let page = succeed(&[&asked[..], &["--speed", "1200 rpm"]].concat());
    assert!(page.contains("Up to 6 mm no feed is stable.\n"), "{page}");
}

/// The page's arm with a damping ratio of 0.02; what it told and what it printed.
fn damped(folder: &Path, more: &[&str]) -> (serde_json::Value, String) {
    let told = inside(folder, "stability.json");
    let at = "0,-90 deg,90 deg,0,60 deg,0";
    let asked = ["stability", "kuka-kr270-r2700", &file("roughing.yaml"), "--at", at, "--frequency", "15 Hz"];
    let page = succeed(&[&asked[..], &["--damping", "0.02", "--json", &told], more].concat());
    (json(&told), page)
}

/// The depth of a feed by its angle (deg) in mm, under a key.
fn depth(told: &serde_json::Value, angle: f64, key: &str) -> Option<f64> {
    let is_at = |feed: &&serde_json::Value| (feed["angle_rad"].as_f64().unwrap() - angle.to_radians()).abs() < 1e-9;
    let feed = told["feeds"].as_array().unwrap().iter().find(is_at).unwrap();
    feed[key].as_f64().map(|depth| 1e3 * depth)
}

/// Figures of an independent computation. Without the surface of the tooth before they were 4.37
/// and 0.277 mm at 90 and 180 degrees, at every speed.
#[test]
fn depths_are_those_on_the_surface_of_the_tooth_before() {
    let folder = folder("machining-regeneration");
    let (cut, _) = damped(&folder, &[]);
    let is = |found: Option<f64>, millimetres: f64| {
        let found = found.unwrap();
        assert!((found / millimetres - 1.0).abs() < 3e-3, "{found} {millimetres}");
    };
    is(depth(&cut, 90.0, "limiting_depth_m"), 1.92);
    is(depth(&cut, 180.0, "limiting_depth_m"), 5.98);
    is(depth(&cut, 90.0, "without_delay_m"), 4.37);
    is(depth(&cut, 180.0, "without_delay_m"), 0.277);
    for (speed, millimetres) in [("3000 rpm", 0.68), ("18000 rpm", 3.79)] {
        let (told, page) = damped(&folder, &["--speed", speed]);
        is(depth(&told, 90.0, "limiting_depth_m"), millimetres);
        is(depth(&told, 90.0, "without_delay_m"), 4.37);
        assert!(page.contains(&format!(" Hz, {speed}\n")), "{page}");
    }
}

#[test]
fn lobes_are_the_depths_at_other_speeds() {
    let folder = folder("machining-lobes");
    let (cut, page) = damped(&folder, &[]);
    let lobes = cut["lobes"].as_array().unwrap();
    let rpm = |speed: &serde_json::Value| speed.as_f64().unwrap() * 60.0 / std::f64::consts::TAU;
    let ends = [&lobes[0], lobes.last().unwrap()].map(|lobe| rpm(&lobe["speed_rad_per_s"]));
    assert!((ends[0] - 1800.0).abs() < 1e-6 && (ends[1] - 18000.0).abs() < 1e-6, "{ends:?}");
    // The best of the other speeds is in the table of the page.
    assert!(page.contains("best feed [deg]"), "{page}");
    let (told, _) = damped(&folder, &["--speeds", "3000, 9000 rpm", "--speed", "3000 rpm"]);
    let narrow = told["lobes"].as_array().unwrap();
    let limits = |lobe: &serde_json::Value| lobe["limiting_depth_m"].as_array().unwrap().clone();
    for (lobe, of) in [(&narrow[0], &told), (narrow.last().unwrap(), &cut)] {
        let feeds = of["feeds"].as_array().unwrap();
        assert_eq!(limits(lobe).len(), feeds.len());
        for (found, feed) in limits(lobe).iter().zip(feeds) {
            let [found, expected] = [found, &feed["limiting_depth_m"]].map(|depth| depth.as_f64().unwrap_or(0.02));
            assert!((found / expected - 1.0).abs() < 1e-9, "{found} {feed}");
        }
    }
    // At any speed it is no deeper than at each.
    for lobe in lobes.iter().chain(narrow) {
        for (found, feed) in limits(lobe).iter().zip(cut["feeds"].as_array().unwrap()) {
            let least = feed["at_any_speed_m"].as_f64().unwrap();
            assert!(found.as_f64().is_none_or(|depth| depth >= least * (1.0 - 1e-9)), "{found} {feed}");
        }
    }
    for wrong in ["9000", "9000, 3000 rpm", "0, 3000 rpm", "3000 rpm", "fast, slow"] {
        fail(2, &["stability", "kuka-kr270-r2700", &file("roughing.yaml"), "--speeds", wrong]);
    }
}

#[test]
fn a_depth_needs_a_spindle_speed() {
    let folder = folder("machining-speed");
    let cut = changed(&folder, "roughing.yaml", ["speed: 9000 rpm", ""]);
    let asked = ["stability", "kuka-kr270-r2700", &cut, "--frequency", "15 Hz"];
    let said = fail(1, &asked);
    assert!(said.contains(&format!("{cut} gives no `speed` of the spindle")), "{said}");
    assert!(said.contains("--speed \"9000 rpm\""), "{said}");
    succeed(&[&asked[..], &["--speed", "9000 rpm"]].concat());
    let said = fail(2, &[&asked[..], &["--speed", "9000"]].concat());
    assert!(said.contains("`9000` has no unit; write e.g. `9000 rpm`"), "{said}");
}

/// A table of the modes of one mass has its depths, also of an arm that yields nowhere itself.
#[test]
fn measured_modes_stand_in_place_of_the_mass() {
    let folder = folder("machining-modes");
    let (one, _) = damped(&folder, &[]);
    let numbers = |value: &serde_json::Value| -> Vec<f64> {
        value.as_array().unwrap().iter().map(|entry| entry.as_f64().unwrap()).collect()
    };
    // Of one mass alike in all directions, the modes are along the principal directions.
    let compliance: Vec<f64> = one["translational_compliance"].as_array().unwrap().iter().flat_map(numbers).collect();
    let principal = robstiff::nalgebra::Matrix3::from_row_slice(&compliance).symmetric_eigen();
    let mut order = [0, 1, 2];
    order.sort_by(|&i, &j| principal.eigenvalues[j].total_cmp(&principal.eigenvalues[i]));
    let hertz = numbers(&one["frequencies_Hz"]);
    let mut text = "frame: base\nmodes:\n".to_owned();
    for (mode, frequency) in order.into_iter().zip(&hertz) {
        let (stiffness, along) = (principal.eigenvalues[mode].recip(), principal.eigenvectors.column(mode));
        text += &format!(
            "  - {{frequency: {frequency} Hz, damping: 0.02, stiffness: {stiffness} N/m, direction: [{}, {}, {}]}}\n",
            along[0], along[1], along[2]
        );
    }
    let [table, told] = ["modes.yaml", "modes.json"].map(|name| inside(&folder, name));
    fs::write(&table, &text).unwrap();
    let at = "0,-90 deg,90 deg,0,60 deg,0";
    let cut = file("roughing.yaml");
    let asked = ["stability", "kuka-kr270-r2700", &cut, "--at", at, "--modes", &table];
    let page = succeed(&[&asked[..], &["--json", &told]].concat());
    assert!(page.contains(" Hz, as measured, damping ratio 0.02\n"), "{page}");
    let measured = json(&told);
    for angle in [0.0, 90.0, 180.0] {
        for key in ["limiting_depth_m", "at_any_speed_m", "without_delay_m"] {
            let [found, expected] = [&measured, &one].map(|told| depth(told, angle, key).unwrap());
            assert!((found / expected - 1.0).abs() < 1e-6, "{angle} {key}: {found} {expected}");
        }
    }
    // Of the arm the pose alone is asked.
    let rigid = rigid(&folder);
    succeed(&["stability", &rigid, &cut, "--tool-axis", "z", "--modes", &table]);

    fs::write(&table, text.replacen("damping: 0.02", "damping: 0.05", 1)).unwrap();
    let page = succeed(&[&asked[..], &["--json", &told]].concat());
    assert!(page.contains(", damping ratios 0.05, 0.02, 0.02\n"), "{page}");
    let unlike = json(&told);
    assert!(unlike["damping"].is_null() && numbers(&unlike["dampings"]) == [0.05, 0.02, 0.02], "{unlike}");

    for other in [["--frequency", "15 Hz"], ["--damping", "0.02"]] {
        let said = fail(2, &[&asked[..], &other].concat());
        assert!(said.contains("--modes") && said.contains(other[0]), "{said}");
    }
    fs::write(&table, text.replacen("damping: 0.02", "damping: -0.02", 1)).unwrap();
    let said = fail(1, &asked);
    assert!(said.contains("modes.yaml:3:") && said.contains("above 0 and below 1"), "{said}");
}

/// The modes of the sample's responses are those that it was made from, and what is printed of them is a table.
#[test]
fn responses_stand_in_place_of_the_modes() {
    let folder = folder("machining-responses");
    let [told, table, again, made] =
        ["told.json", "table.yaml", "again.json", "made.json"].map(|name| inside(&folder, name));
    let (cut, responses) = (file("roughing.yaml"), file("hammer.yaml"));
    let asked = ["stability", "kuka-kr270-r2700", &cut, "--at", "0,-90 deg,90 deg,0,60 deg,0", "--modes"];
    let page = succeed(&[&asked[..], &[&responses, "--json", &told]].concat());
    assert!(page.contains("Modes fitted to 6 responses at 226 lines from 5 to 50 Hz; they leave "), "{page}");
    let (printed, _) = page.split_once("modes:\n").unwrap().1.split_once("\n\n").unwrap();
    fs::write(&table, format!("modes:\n{printed}\n")).unwrap();
    succeed(&[&asked[..], &[&table, "--json", &again]].concat());
    let truth = fs::read_to_string(file("modes.yaml")).unwrap();
    let massless = "massless: [{stiffness: 7 N/um, direction: [0.3, 0.2, 0.9]}]\n";
    fs::write(&table, format!("{massless}{truth}")).unwrap();
    succeed(&[&asked[..], &[&table, "--json", &made]].concat());
    let [told, again, made] = [told, again, made].map(|path| json(&path));
    assert!(made["fit"].is_null() && told["fit"]["modes"].as_array().unwrap().len() == 3, "{}", told["fit"]);
    assert!((told["fit"]["left"].as_f64().unwrap() - 0.01).abs() < 3e-3, "{}", told["fit"]);
    for (found, expected) in told["fit"]["modes"].as_array().unwrap().iter().zip([14.6, 17.9, 28.3]) {
        assert!((found["frequency_Hz"].as_f64().unwrap() / expected - 1.0).abs() < 5e-3, "{found}");
    }
    for angle in [0.0, 30.0, 90.0, 180.0] {
        for key in ["limiting_depth_m", "at_any_speed_m", "without_delay_m"] {
            let [found, printed, expected] = [&told, &again, &made].map(|told| depth(told, angle, key));
            let Some(expected) = expected else {
                assert_eq!([found, printed], [None; 2], "{angle} {key}");
                continue;
            };
            let [found, printed] = [found, printed].map(Option::unwrap);
            assert!((found / printed - 1.0).abs() < 5e-3, "{angle} {key}: {found} {printed}");
            assert!((found / expected - 1.0).abs() < 0.05, "{angle} {key}: {found} {expected}");
        }
    }
    // They are not overwritten.
    let hammer = file("hammer.csv");
    let said = fail(1, &[&asked[..], &[&responses, "--json", &hammer]].concat());
    assert!(said.contains("hammer.csv is one of the files that were read"), "{said}");

    let [yaml, csv] = ["hammer.yaml", "hammer.csv"].map(|name| inside(&folder, name));
    let [text, values] = [&responses, &hammer].map(|path| fs::read_to_string(path).unwrap());
    fs::write(&csv, &values).unwrap();
    for (from, to, said) in [
        ("accelerance", "receptance", "hammer.csv:1:16"),
        ("  to: 50 Hz", "  to: 50 Hz\n  modes: 20", "hammer.yaml:6:10"),
        ("to: 50 Hz", "to: 5.5 Hz", "1 mode needs 7 lines, and 3 are in the band"),
    ] {
        fs::write(&yaml, text.replace(from, to)).unwrap();
        let complaint = fail(1, &[&asked[..], &[&yaml]].concat());
        assert!(complaint.contains(said), "{from}: {complaint}");
    }
}

/// Where nothing chatters up to the greatest depth there is no number, and no infinity.
#[test]
fn a_feed_without_a_limit_has_none() {
    let folder = folder("machining-no-limit");
    let (told, page) = damped(&folder, &["--speed", "1000000 rpm"]);
    for feed in told["feeds"].as_array().unwrap() {
        assert!(feed["limiting_depth_m"].is_null() && feed["without_delay_m"].is_number(), "{feed}");
        assert_eq!(feed["unstable_m"], serde_json::json!([]));
    }
    assert!(page.contains("Up to 2 mm every feed is stable.\nBest feed: 0 deg, along"), "{page}");
    assert!(page.contains("beyond 20 mm."), "{page}");
    let text = fs::read_to_string(inside(&folder, "stability.json")).unwrap();
    assert!(!text.to_lowercase().contains("inf"), "{text}");
    // Without damping all that the cut feeds chatters.
    let undamped = stability(&folder, None);
    assert_eq!(depth(&undamped, 90.0, "limiting_depth_m"), Some(0.0));
}

/// The slope at no torque, which no cut has, made the arm eight and thirty times as soft.
#[test]
fn backlash_that_the_cut_takes_up_does_not_make_an_arm_soft() {
    let folder = folder("machining-backlash");
    let softest = |told: &serde_json::Value| {
        let feeds = told["feeds"].as_array().unwrap();
        let softest = feeds.iter().map(|feed| feed["softest_N_per_m"].as_f64().unwrap());
        let (least, most) = softest.fold((f64::MAX, 0.0), |(least, most), k| (k.min(least), k.max(most)));
        [least, most]
    };
    // Without backlash it is the same for every feed.
    let without = stability(&folder, None);
    let [least, most] = softest(&without);
    assert!(least == most && (most - 1.233e6).abs() < 1e3, "{least} {most}");
    for (backlash, unloaded) in [(("0.5", "50"), 0.1622e6), (("1", "20"), 0.03579e6)] {
        let with = stability(&folder, Some(backlash));
        let [least, most] = softest(&with);
        assert!(least > 1.3 * unloaded && (2.5 * unloaded..1.233e6).contains(&most), "{backlash:?} {least} {most}");
        // The hammer finds the arm without load.
        assert!((with["frequencies_Hz"][0].as_f64().unwrap() - 15.0).abs() < 1e-9);
    }
    // A cut that presses harder leaves less of it.
    let cut = changed(&folder, "roughing.yaml", ["depth: 2 mm", "depth: 60 mm"]);
    let with = stability_of(&folder, &cut, Some(("1", "20")));
    assert!(softest(&with)[1] > 0.95 * most, "{:?}", softest(&with));
}

/// Nobody looked at the depth that is judged: no feed was stable there.
#[test]
fn the_depth_of_the_cut_is_among_those_looked_at() {
    let asked = ["stability", "kuka-kr270-r2700", &file("roughing.yaml"), "--frequency", "15 Hz", "--greatest"];
    let said = fail(2, &[&asked[..], &["1 mm"]].concat());
    assert!(said.contains("--greatest: 1 mm is less than the depth of the cut, 2 mm"), "{said}");
    let at = ["--at", "0,-90 deg,90 deg,0,60 deg,0"];
    let page = succeed(&[&asked[..], &["2 mm"], &at].concat());
    assert!(page.contains("Up to 2 mm, 7 of 72 directions of feed are stable."), "{page}");
}

/// Where the tool is along the base's x, the first feed is along y.
#[test]
fn the_picture_of_feeds_says_where_they_begin() {
    let folder = folder("machining-picture");
    let picture = inside(&folder, "limits.svg");
    for (wrist, along) in [("0", "(0.000, 1.000, 0.000)"), ("60 deg", "(0.866, 0.000, 0.500)")] {
        let at = format!("0,-90 deg,90 deg,0,{wrist},0");
        let cut = file("roughing.yaml");
        succeed(&["stability", "kuka-kr270-r2700", &cut, "--at", &at, "--frequency", "15 Hz", "--out", &picture]);
        let drawn = fs::read_to_string(&picture).unwrap();
        assert!(drawn.contains(&format!("0°: along {along} in the base frame")), "{drawn}");
        assert!(drawn.contains("Limiting depth of cut [mm] over the spindle speed [rpm]"), "{drawn}");
        assert!(!drawn.contains("NaN") && !drawn.contains("inf"), "{drawn}");
    }
}

#[test]
fn feeds_between_degrees_are_told_as_they_are() {
    let at = "0,-90 deg,90 deg,0,60 deg,0";
    let cut = file("roughing.yaml");
    let page = succeed(&["stability", "kuka-kr270-r2700", &cut, "--at", at, "--frequency", "15 Hz", "--feeds", "7"]);
    assert!(page.lines().any(|line| line.trim_start().starts_with("102.9 ")), "{page}");
    let said = fail(2, &["stability", "kuka-kr270-r2700", &cut, "--at", at, "--frequency", "15 Hz", "--feeds", "1"]);
    assert!(said.contains("a whole number from 4 to 3600 is expected here"), "{said}");
}
