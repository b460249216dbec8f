//! Files that are made to harm whoever reads them. No test is timed: what reads without end does not
//! come to its end.

mod common;

use std::fs::{self, File};

use common::{fail, folder, inside, names, run, succeed};

const ARM: &str = "name: Arm\nconvention: standard\njoints: [{a: 1 m, limits: [-1, 1], compliance: 1e-7 rad/Nm}, \
                   {a: 1 m, limits: [-1, 1], compliance: 1e-7 rad/Nm}]\n";

/// The commands that read a file of each kind, with the place where it goes.
fn readers<'a>(file: &'a str, out: &'a str) -> Vec<Vec<&'a str>> {
    vec![
        vec!["show", file],
        vec!["emit", file],
        vec!["import", file, "--out", out],
        vec!["identify", file, "--out", out],
        vec!["trace", file, "--out", out],
        vec!["plan", file],
        vec!["simulate", "rv130hsc", file, "--out", out],
        vec!["map", "rv130hsc", file],
        vec!["path", "rv130hsc", file],
        vec!["forces", file],
        vec!["view", file, "--out", out],
    ]
}

#[test]
#[cfg(unix)]
fn what_is_no_regular_file_is_not_read() {
    let folder = folder("hostile-kinds");
    let (pipe, out) = (inside(&folder, "pipe"), inside(&folder, "out"));
    let made = std::process::Command::new("mkfifo").arg(&pipe).status();
    assert!(made.is_ok_and(|status| status.success()));
    for file in ["/dev/zero", &pipe] {
        for arguments in readers(file, &out) {
            let said = fail(1, &arguments);
            assert!(said.contains("only regular files are read"), "{arguments:?}: {said}");
        }
    }
    assert_eq!(names(&folder), ["pipe"]);
}

#[test]
fn no_more_is_read_than_a_file_may_have() {
    let folder = folder("hostile-sizes");
    let [huge, out, map] = ["huge", "out", "map.yaml"].map(|name| inside(&folder, name));
    // A hole takes no room.
    File::create(&huge).and_then(|file| file.set_len(1 << 40)).unwrap();
    for (arguments, most) in [
        (vec!["show", &huge], "1 MiB"),
        (vec!["map", "rv130hsc", &huge], "1 MiB"),
        (vec!["import", &huge, "--out", &out], "16 MiB"),
        (vec!["path", "rv130hsc", &huge], "256 MiB"),
    ] {
        let said = fail(1, &arguments);
        assert!(said.contains(&format!("it is larger than {most}, the most that is read of such a file")), "{said}");
    }
    fs::write(&map, "robot: rv130hsc\nkind: displacement\nobservations: huge\n").unwrap();
    let said = fail(1, &["identify", &map, "--out", &out]);
    assert!(said.contains("huge: it is larger than 256 MiB"), "{said}");
}

#[test]
fn a_table_has_no_sixty_thousand_columns() {
    let folder = folder("hostile-columns");
    let [campaign, table, out] = ["campaign.yaml", "loads.csv", "out"].map(|name| inside(&folder, name));
    fs::write(&campaign, "robot: rv130hsc\nkind: displacement\nobservations: loads.csv\n").unwrap();
    let row = |field: &dyn Fn(usize) -> String| (0..60_000).map(field).collect::<Vec<_>>().join(",");
    fs::write(&table, format!("{}\n{}\n", row(&|k| format!("c{k}")), row(&|_| "1".to_owned()))).unwrap();
    let said = fail(1, &["identify", &campaign, "--out", &out]);
    assert!(said.starts_with("error: the header has 60000 columns, a table has 1000 at most\n"), "{said}");
    assert!(said.len() < 2000, "{}", said.len());
}

/// A line that is turned round reads as another one.
#[test]
fn what_turns_the_direction_of_writing_is_spelled_out() {
    let folder = folder("hostile-bidi");
    let [arm, page, code] = ["arm.yaml", "arm.html", "arm.rs"].map(|name| inside(&folder, name));
    let turned: Vec<char> = "\u{61c}\u{200e}\u{200f}\u{202a}\u{202e}\u{2066}\u{2069}".chars().collect();
    let text: String = turned.iter().collect();
    fs::write(&arm, format!("{ARM}description: \"a {text} b\"\nsource: \"c {text} d\"\n")).unwrap();
    let is_clean = |text: &str| !text.contains(&turned[..]);
    assert!(is_clean(&succeed(&["show", &arm])));
    succeed(&["view", &arm, "--out", &page]);
    succeed(&["emit", &arm, "--out", &code]);
    for file in [&page, &code] {
        let text = fs::read_to_string(file).unwrap();
        assert!(is_clean(&text) && text.contains("a \\u{61c}\\u{200e}"), "{file}");
    }
    fs::write(&arm, ARM.replace("1 m", &format!("\"{text} m\""))).unwrap();
    let said = fail(1, &["show", &arm]);
    assert!(is_clean(&said) && said.contains("\\u{202e}"), "{said}");
    // Also where it is in the name of a file.
    let said = run(&["show", "no\u{202e}file.yaml"]).err;
    assert!(is_clean(&said) && said.contains("no\\u{202e}file.yaml"), "{said}");
}

#[test]
#[cfg(unix)]
fn the_name_of_a_file_is_no_code() {
    let folder = folder("hostile-names");
    for name in ["arm\npub fn injected() {}\n.yaml", "arm\rpub fn injected() {}.yaml"] {
        let [arm, code] = [name, "arm.rs"].map(|name| inside(&folder, name));
        fs::write(&arm, ARM).unwrap();
        succeed(&["emit", &arm, "--out", &code]);
        let text = fs::read_to_string(&code).unwrap();
        let named: Vec<&str> = text.split(['\n', '\r']).filter(|line| line.contains("injected")).collect();
        assert!(!named.is_empty() && named.iter().all(|line| line.trim_start().starts_with("//")), "{named:?}");
    }
}

/// The pages run nothing but their own script, and load nothing.
#[test]
fn pages_have_a_policy() {
    let folder = folder("hostile-pages");
    let [arm, map, view, heat] = ["arm.yaml", "map.yaml", "view.html", "map.html"].map(|name| inside(&folder, name));
    let evil = "</script><script>alert(1)</script><img src=x onerror=alert(1)>";
    fs::write(&arm, format!("{ARM}description: \"{evil}\"\n")).unwrap();
    fs::write(&map, "joints: [{from: 0, to: 1, count: 3}, {from: 0, to: 1, count: 3}]\n").unwrap();
    succeed(&["view", &arm, "--out", &view]);
    succeed(&["map", &arm, &map, "--html", &heat]);
    for file in [&view, &heat] {
        let page = fs::read_to_string(file).unwrap();
        let policy = page.split_once("http-equiv=\"Content-Security-Policy\" content=\"").unwrap().1;
        let policy = policy.split_once('"').unwrap().0;
        assert!(policy.starts_with("default-src 'none'; img-src data:; style-src 'sha256-"), "{policy}");
        assert!(policy.contains("; script-src 'sha256-") && !policy.contains("unsafe"), "{policy}");
        // Before anything that it is about.
        assert!(page.find("Content-Security-Policy") < page.find("<style>"), "{file}");
        assert_eq!(page.matches("<style").count(), 1, "{file}");
        assert_eq!(page.matches("<script").count(), 2, "{file}");
        assert!(!page.contains(" style=") && !page.contains("onerror=alert(1)>"), "{file}");
    }
}
