//! `path --program` and `correct`: programs of robots, out and in.

mod common;

use std::fs;
use std::path::Path;

use common::{fail, file, folder, inside, json, names, run, succeed};
use robstiff_machining::program::{Document, Language, Target, TextFile, read};
use robstiff_robots::catalogue;

/// Where the pocket stands, and the same as a work frame.
const PLACE: &str = "200 mm, 0, 100 mm, 0, 0, 0";

/// The KR 270 with a controller and a zero that is off.
fn arm(folder: &Path, more: &str) -> String {
    let text = catalogue::find("kuka-kr270-r2700").unwrap();
    let path = inside(folder, "arm.yaml");
    fs::write(&path, format!("{text}\ntool: {{xyz: [0, 0, 200 mm]}}\ncontroller: {{}}\n{more}")).unwrap();
    path
}

fn parsed(path: &Path) -> Document {
    let name = path.file_name().unwrap().to_str().unwrap().to_owned();
    let language = Language::of_file(&name).unwrap();
    let text = fs::read_to_string(path).unwrap();
    read(language, vec![TextFile { name, text }]).unwrap_or_else(|problems| panic!("{problems}"))
}

/// How far the positions of two programs are apart (m), but for the first.
fn apart(one: &Document, other: &Document) -> f64 {
    assert_eq!(one.moves().count(), other.moves().count());
    let pairs = one.moves().zip(other.moves()).skip(1);
    let apart = pairs.map(|(one, other)| match (&one.position.target, &other.position.target) {
        (Target::Pose(one, _), Target::Pose(other, _)) => {
            assert!(one.rotation.angle_to(&other.rotation) < 2e-3);
            (one.translation.vector - other.translation.vector).norm()
        }
        _ => panic!("poses are expected"),
    });
    apart.fold(0.0, f64::max)
}

/// A path that is corrected as a program is what a program of the corrected path is.
#[test]
fn correcting_before_or_after_writing_is_the_same() {
    for (language, name, more) in [
        ("krl", "pocket.src", vec![]),
        ("rapid", "pocket.mod", vec![]),
        ("ur", "pocket.script", vec![]),
        ("ls", "POCKET.ls", vec!["--tool-data", "1 = description", "--work-data", "1 = 200 mm, 0, 100 mm, 0, 0, 0"]),
    ] {
        let folder = folder(&format!("correct-{language}"));
        let arm = arm(&folder, "effects: [{kind: joint_zero_offset, at: joint 2, value: 0.5 mrad}]\n");
        let cut = file("roughing.yaml");
        let path = |out: &str, corrected: bool| {
            let pocket = file("pocket.csv");
            let mut all = vec![
                "path",
                &arm,
                &pocket,
                "--place",
                PLACE,
                "--program",
                language,
                "--targets",
                "poses",
                "--out",
                out,
            ];
            if corrected {
                all.extend(["--cut", &cut, "--compensate"]);
            }
            succeed(&all)
        };
        let [plain, before, after] = ["plain", "before", "after"].map(|name| inside(&folder, name));
        let page = path(&plain, false);
        assert!(page.contains(&format!("Program ({language}): 40 motions to poses")), "{page}");
        let mut expected = [name, "job.html", "job.json"];
        expected.sort_unstable();
        assert_eq!(names(Path::new(&plain)), expected);
        let job = json(&inside(Path::new(&plain), "job.json"));
        assert_eq!(job["program"]["files"][0], name);
        assert_eq!(job["program"]["targets"], "poses");
        let sheet = |folder: &str| fs::read_to_string(inside(Path::new(folder), "job.html")).unwrap();
        let (without, said) = (sheet(&plain), "No force is given");
        assert!(without.contains(said) && without.contains("<h2>The joints</h2>") && without.contains(name));
        path(&before, true);
        let corrected = sheet(&before);
        assert!(!corrected.contains(said) && corrected.contains("<h2>Before and after the correction</h2>"));
        assert!(corrected.contains("if the model is true") && corrected.contains("shade9"));
        // The path is written for the described arm, so what `correct` is given is what the nominal one has.
        let source = inside(Path::new(&plain), name);
        let told = inside(&folder, "told.json");
        let correct =
            [&["correct", &arm, &source, "--cut", &cut, "--taught", "--out", &after, "--json", &told][..], &more[..]]
                .concat();
        let page = succeed(&correct);
        assert!(page.contains("40 motions, 39 corrected") && page.contains("positions are moved by [um]"), "{page}");
        let [plain, before, after] = [plain, before, after].map(|folder| Path::new(&folder).join(name));
        let [first, second, third] = [&plain, &before, &after].map(|path| parsed(path));
        let (moved, off) = (apart(&first, &third), apart(&second, &third));
        assert!(moved > 5e-5 && off < 0.02 * moved + 4e-6, "{language}: {moved} {off}");
        // Nothing but numbers of positions is changed.
        let [plain, after] = [&plain, &after].map(|path| fs::read_to_string(path).unwrap());
        let without = |text: &str| text.replace(|letter: char| letter.is_ascii_digit() || "-. ".contains(letter), "");
        assert_eq!(without(&plain), without(&after));
        let told = json(&told);
        let motions = told["motions"].as_array().unwrap();
        assert!(motions[0]["moved_m"].is_null() && motions[1]["moved_m"].as_f64().unwrap() > 1e-5, "{}", motions[1]);
        assert!(told["deviation"]["corrected"].is_object());
    }
}

#[test]
fn a_program_of_angles_is_written() {
    let folder = folder("correct-angles");
    let arm = arm(&folder, "");
    let out = inside(&folder, "job");
    let pocket = file("pocket.csv");
    let all = ["path", &arm, &pocket, "--place", PLACE, "--program", "ls", "--blend", "50 %", "--out", &out];
    let page = succeed(&[&all[..], &["--name", "SLOT", "--targets", "joints"]].concat());
    assert!(page.contains("40 motions to angles of the joints"), "{page}");
    let text = fs::read_to_string(Path::new(&out).join("SLOT.ls")).unwrap();
    assert!(text.contains("L P[2] 60mm/sec CNT50") && text.contains("J1="), "{text}");
    // As it is without a force: the arm has nothing else to correct.
    let source = inside(Path::new(&out), "SLOT.ls");
    let again = inside(&folder, "again");
    let tool = ["--tool-data", "1 = description"];
    let page = succeed(&["correct", &arm, &source, tool[0], tool[1], "--out", &again]);
    assert!(page.contains("40 motions, 0 corrected"), "{page}");
    assert_eq!(fs::read_to_string(Path::new(&again).join("SLOT.ls")).unwrap(), text);
}

const PART: &str = "DEF Part( )\n$BASE={X 1500,Y 0,Z 800,A 0,B 0,C 0}\n$TOOL={X 0,Y 0,Z 200,A 0,B 0,C 0}\n\
    PTP XHOME\n$VEL.CP=0.05\nLIN {X 0,Y 0,Z 0,A 0,B 90,C 0}\nCIRC {X 10,Y 10,Z 0},{X 20,Y 0,Z 0}\n\
    LIN {X 40,Y 0,Z 0,A 0,B 90,C 0} C_DIS\nLIN {X 80,Y 0,Z 0}\nEND\n";
const DATA: &str = "DEFDAT PART\nDECL E6AXIS XHOME={A1 0,A2 -90,A3 90,A4 0,A5 60,A6 0,E1 0}\nENDDAT\n";

#[test]
fn what_is_not_corrected_is_listed_and_the_dat_is_found() {
    let folder = folder("correct-kept");
    let arm = arm(&folder, "effects: [{kind: joint_zero_offset, at: joint 2, value: 1 mrad}]\n");
    let source = inside(&folder, "Part.src");
    fs::write(&source, PART).unwrap();
    fs::write(folder.join("PART.DAT"), DATA).unwrap();
    let out = inside(&folder, "out");
    let page = succeed(&["correct", &arm, &source, "--out", &out]);
    assert!(page.contains("5 motions, 3 corrected"), "{page}");
    assert!(page.contains("Part.src:7: `CIRC") && page.contains("a circular motion"), "{page}");
    assert_eq!(names(Path::new(&out)), ["PART.DAT", "Part.src"]);
    assert_eq!(fs::read_to_string(Path::new(&out).join("PART.DAT")).unwrap(), DATA);
    let lines = fs::read_to_string(Path::new(&out).join("Part.src")).unwrap();
    for (number, (before, after)) in (1..).zip(PART.lines().zip(lines.lines())) {
        assert_eq!(before == after, ![6, 8, 9].contains(&number), "{before} {after}");
    }
}

#[test]
fn bad_input_is_shown_and_nothing_is_written() {
    let folder = folder("correct-wrong");
    let arm = arm(&folder, "");
    let (source, out) = (inside(&folder, "part.src"), inside(&folder, "out"));
    fs::write(&source, PART.replace("PTP XHOME\n", "").replace("LIN {X 40", "LIN {X 9000")).unwrap();
    let said = fail(1, &["correct", &arm, &source, "--out", &out]);
    assert!(said.contains("part.src:7:1") && said.contains("out of reach"), "{said}");
    fs::write(&source, PART.replace("$TOOL={X 0,Y 0,Z 200,A 0,B 0,C 0}", "BAS(#TOOL,3)")).unwrap();
    let said = fail(1, &["correct", &arm, &source, "--out", &out]);
    assert!(said.contains("part.src:6:1") && said.contains("--tool-data \"3 = x, y, z"), "{said}");
    fs::write(&source, PART.replace("LIN {X 0,Y", "LIN {X 0,Y 0,Y")).unwrap();
    let said = fail(1, &["correct", &arm, &source, "--out", &out]);
    assert!(said.contains("part.src:6:14") && said.contains("`Y` is given twice"), "{said}");
    assert!(!Path::new(&out).exists());

    fs::write(&source, PART).unwrap();
    let here = folder.to_str().unwrap();
    assert!(fail(1, &["correct", &arm, &source, "--out", here]).contains("would be overwritten"));
    assert!(fail(2, &["correct", &arm, &file("pocket.csv")]).contains("known by the end of the name"));
    let said = fail(1, &["correct", "kuka-kr270-r2700", &source]);
    assert!(said.contains("has no `controller`"), "{said}");
    let pocket = file("pocket.csv");
    let said = fail(1, &["path", "kuka-kr270-r2700", &pocket, "--place", PLACE, "--program", "krl", "--out", &out]);
    assert!(said.contains("has no `controller`"), "{said}");
    let said = fail(2, &["path", &arm, &pocket, "--program", "krl", "--blend", "50 %", "--out", &out]);
    assert!(said.contains("--blend"), "{said}");
    assert_eq!(run(&["path", &arm, &pocket, "--program", "krl"]).code, 2);
    let slow = inside(&folder, "slow.csv");
    let table = fs::read_to_string(&pocket).unwrap();
    let columns = table.lines().map(|line| line.rsplit_once(',').unwrap().0);
    fs::write(&slow, columns.collect::<Vec<_>>().join("\n")).unwrap();
    let said = fail(1, &["path", &arm, &slow, "--place", PLACE, "--program", "rapid", "--out", &out]);
    assert!(said.contains("slow.csv:3:1") && said.contains("--feed"), "{said}");
    assert!(!Path::new(&out).exists());
}
