//! The generated source text, for people, and what it costs: held against the
//! files in `tests/golden`, which `golden_code.rs` compiles.
//!
//! A change of the generator that is meant is accepted with
//! `ROBSTIFF_BLESS=1 cargo test -p robstiff-tests --test golden`, which writes
//! the files anew; what changed is then for `git diff` and a reader.

use std::fs;
use std::path::Path;

use robstiff_codegen::{Origin, functions, functions_in_columns, source, tokens};
use robstiff_robots::{Description, catalogue};
use robstiff_tests::arms::{self, description};

#[test]
fn rv130hsc_is_as_before() {
    is_as_before("rv130hsc", "rv130hsc.yaml");
}

#[test]
fn fanuc_r2000ic_is_as_before() {
    is_as_before("fanuc_r2000ic", "fanuc-r2000ic.yaml");
}

#[test]
fn every_effect_is_as_before() {
    is_as_before("every_effect", "every-effect.yaml");
}

#[test]
fn every_law_is_as_before() {
    is_as_before("every_law", "every-law.yaml");
}

fn origin(file: &str) -> Origin {
    let path = |text: &str| text.parse().expect("a token");
    Origin { file: file.to_owned(), runtime: path("robstiff"), visibility: path("pub") }
}

fn is_as_before(module: &str, file: &str) {
    compare(&format!("{module}.rs"), &source(&description(file), &origin(file)));
}

/// One joint is no joints, and a displacement per stroke is no angle's.
#[test]
fn docs_go_with_the_joints() {
    let code = |joints: &str| {
        let robot = format!("name: Slide\nconvention: standard\njoints: [{joints}]\n");
        source(&Description::parse("slide.yaml", &robot).expect("a robot"), &origin("slide.yaml"))
    };
    let slide = code("{type: prismatic}");
    assert!(slide.contains("`Slide`, 1 joint, generated") && slide.contains("translation (m/m), rotation."), "{slide}");
    let both = code("{type: prismatic}, {a: 1 m}");
    assert!(both.contains("2 joints, generated") && both.contains("(m/rad, of sliding joints m/m)"), "{both}");
    assert!(slide.contains("forces (N). Drives") && both.contains("of sliding joints forces (N). Drives"));
    let turning = code("{a: 1 m}");
    assert!(turning.contains("torques (Nm). Drives") && turning.contains("   rigid\n"), "{turning}");
    let offset = code("{type: prismatic, d: 100 mm}, {type: prismatic, d: -0.2}, {theta: -90 deg}");
    for entry in ["   q1 + 0.1   ", "   q2 - 0.2   ", "   q3 - 90   "] {
        assert!(offset.contains(entry), "{offset}");
    }
    let units = ["`q` are in m.", "`q` are in rad, of sliding joints in m.", "`q` are in rad."];
    for (code, unit) in [slide, both, turning].iter().zip(units) {
        assert!(code.contains(unit), "{code}");
    }
    let limited = code("{limits: [-170 deg, 90 deg]}, {type: prismatic, limits: [0, 1.5 m]}, {a: 1 m}");
    for joint in ["1. turns, from -170 to 90 deg", "2. slides, from 0 to 1500 mm", "3. turns, limits unknown"] {
        assert!(limited.contains(joint), "{limited}");
    }
}

/// What a robot's effects make of a method is said there, and only of those that have them.
#[test]
fn docs_go_with_the_effects() {
    let code = |file: &str| source(&description(file), &origin(file));
    let (rigid, laws) = (code("fanuc-r2000ic.yaml"), code("every-law.yaml"));
    for caveat in ["never loaded before", "commanded_rates", "# Effects"] {
        assert!(laws.contains(caveat) && !rigid.contains(caveat), "{caveat}");
    }
    let sagging = "name: Sagging\nconvention: standard\njoints: [{a: 1 m, compliance: 1e-7 rad/Nm}]\n\
                   links: [{mass: 9 kg}]\neffects: [{kind: gravity_sag, at: robot, share: 1}]\n";
    let sagging = source(&Description::parse("sagging.yaml", sagging).expect("a robot"), &origin("sagging.yaml"));
    assert!(sagging.contains("sags otherwise") && !laws.contains("sags otherwise"), "{sagging}");
}

/// Of three numbers of one sort each says which it is.
#[test]
fn docs_of_constants_differ() {
    for file in arms::FILES {
        let code = source(&description(file), &origin(file));
        let lines: Vec<&str> = code.lines().map(str::trim).collect();
        let mut docs: Vec<&str> =
            lines.windows(2).filter(|pair| pair[1].starts_with("pub const")).map(|pair| pair[0]).collect();
        let count = docs.len();
        docs.sort_unstable();
        docs.dedup();
        assert_eq!(docs.len(), count, "{file}");
    }
}

/// An exception is an error where the user's crate forbids the lint, and Clippy looks into
/// what macros expand to.
#[test]
fn code_for_the_compiler_asks_for_no_exception() {
    let joints = "{theta: 0.318309886, a: 3.14159, limits: [-180 deg, 90 deg]}, {theta: 0.2, a: 0.3, alpha: 0.1}";
    let robot = format!("name: Half\nconvention: standard\njoints: [{joints}]\n");
    let code = tokens(&Description::parse("half.yaml", &robot).expect("a robot"), &origin("half.yaml")).to_string();
    for suspect in ["allow", "3.14", "1.57", "0.318"] {
        assert!(!code.contains(suspect), "{suspect}: {code}");
    }
    assert!(code.contains("0.3"), "{code}");
    let every = tokens(&description("every-effect.yaml"), &origin("every-effect.yaml")).to_string();
    assert!(every.contains("const {"), "sums of constants are computed at compile time");
}

/// Operations of every function of every robot, number by number and in whole columns.
#[test]
fn costs_are_as_before() {
    let mut costs = String::new();
    for &file in arms::FILES {
        let robot = description(file);
        costs += &format!("{file}\n");
        for (name, function) in functions(&robot) {
            let gap = if name.len() < 14 { "" } else { " " };
            costs += &format!("  {name:<14}{gap}{}\n", function.cost());
        }
        for (name, function) in functions_in_columns(&robot) {
            costs += &format!("  {name:<14}{} in columns\n", function.cost_in_columns());
        }
    }
    compare("costs.txt", &costs);
}

fn compare(name: &str, generated: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("golden").join(name);
    if std::env::var_os("ROBSTIFF_BLESS").is_some_and(|value| value == "1") {
        fs::write(&path, generated).expect("the golden file can be written");
        return;
    }
    let golden = fs::read_to_string(&path).expect("a golden file").replace("\r\n", "\n");
    let differs = golden.lines().zip(generated.lines()).position(|(before, now)| before != now);
    let line = differs.unwrap_or(golden.lines().count().min(generated.lines().count()));
    let at = |text: &str| text.lines().nth(line).unwrap_or("(the end)").to_owned();
    assert!(
        golden == generated,
        "{}:{}: the generator says something else now\n  before: {}\n  now:    {}\n\
         if that is meant, run this test with ROBSTIFF_BLESS=1 and read the difference",
        path.display(),
        line + 1,
        at(&golden),
        at(generated),
    );
}

#[test]
fn the_same_description_gives_the_same_code() {
    for file in arms::FILES {
        let [one, other] = [(); 2].map(|()| source(&description(file), &origin(file)));
        assert_eq!(one, other, "{file}");
        let [one, other] = [(); 2].map(|()| tokens(&description(file), &origin(file)).to_string());
        assert_eq!(one, other, "{file}");
    }
}

#[test]
fn another_value_gives_other_code() {
    let file = "rv130hsc.yaml";
    let text = catalogue::find(file).expect("a robot of the catalogue");
    let code = |text: &str| source(&Description::parse(file, text).expect("a description"), &origin(file));
    for (value, other) in [("d: 1100 mm", "d: 1101 mm"), ("alpha: 90 deg", "alpha: 91 deg"), ("1.92e-7", "1.93e-7")] {
        assert_eq!(text.matches(value).count(), 1, "{value}");
        assert_ne!(code(text), code(&text.replace(value, other)), "{value}");
    }
}
