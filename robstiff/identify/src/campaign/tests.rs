//! Campaigns as people write them, right and wrong.

use std::borrow::ToOwned;
use std::format;
use std::path::{Path, PathBuf};
use std::string::{String, ToString};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::vec::Vec;

use super::*;

pub(super) const ROBOT: &str = "name: Two
convention: standard
joints:
  - {a: 1 m, compliance: 1e-6}
  - {a: 500 mm, alpha: 90 deg, compliance: 2e-6}
";
pub(super) const CAMPAIGN: &str = "name: bench
robot: robot.yaml
observations: loads.csv
kind: displacement
";
pub(super) const HEADER: &str = "pose,visit,q1 [deg],q2,Fx,Fy [kN],Fz,dx [um],dy [mm],dz";

/// A folder of its own under the system's, removed at the end.
pub(super) struct Folder(pub(super) PathBuf);

impl Folder {
    pub(super) fn new(campaign: &str, table: &str) -> Self {
        static COUNT: AtomicUsize = AtomicUsize::new(0);
        let number = COUNT.fetch_add(1, Ordering::Relaxed);
        let path = std::env::temp_dir().join(format!("robstiff-campaign-{}-{number}", std::process::id()));
        std::fs::create_dir_all(&path).expect("a temporary folder");
        let write = |file: &str, text: &str| std::fs::write(path.join(file), text).expect("a temporary file");
        write("robot.yaml", ROBOT);
        write("campaign.yaml", campaign);
        write("loads.csv", table);
        Self(path)
    }

    pub(super) fn read(&self) -> Result<Campaign, ReadError> {
        Campaign::read(self.0.join("campaign.yaml"))
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// The problems of a table as `line:column message`.
pub(super) fn problems(campaign: &str, table: &str) -> Vec<String> {
    match Folder::new(campaign, table).read() {
        Err(ReadError::Invalid(problems)) => {
            problems.iter().map(|p| format!("{}:{} {}", p.line, p.column, p.message)).collect()
        }
        Err(other) => std::vec![other.to_string()],
        Ok(_) => Vec::new(),
    }
}

#[test]
fn units_byte_order_marks_and_carriage_returns_are_read() {
    let table = format!("\u{feff}{HEADER},note\r\na,v,90,0.5,1,2,3,4,5,0.006,hello\r\nb,w,0,0,1,2,3,4,5,0.006,\r\n");
    let folder = Folder::new(CAMPAIGN, &table);
    let campaign = folder.read().unwrap();
    let Data::Displacement(data) = &campaign.data else { panic!("kind displacement") };
    assert_eq!((data.rows.len(), data.poses.len(), data.visits.len()), (2, 2, 2));
    let row = &data.rows[0];
    assert!((row.q[0] - core::f64::consts::FRAC_PI_2).abs() < 1e-15 && row.q[1] == 0.5);
    assert_eq!(row.wrench, [1.0, 2000.0, 3.0, 0.0, 0.0, 0.0]);
    assert!((row.displacement[0] - 4e-6).abs() < 1e-20 && (row.displacement[1] - 5e-3).abs() < 1e-17);
    assert_eq!(row.displacement[2], 0.006);
    assert_eq!(campaign.warnings.len(), 1, "the column `note` is named: {:?}", campaign.warnings);
    assert!(campaign.warnings[0].contains("`note`"));
}

#[test]
fn every_problem_of_a_table_has_its_place() {
    let found = |rows: &str| problems(CAMPAIGN, &format!("{HEADER}\n{rows}"));
    assert_eq!(found("a,v,0,0,1,2,3,4,x,6\n"), ["2:17 `x` is not a number"]);
    assert_eq!(found("a,v,0,0,1,2,3,4,NaN,inf\n"), ["2:17 `NaN` is not finite", "2:21 `inf` is not finite"]);
    assert_eq!(found("a,v,0,0,1,1e307,3,4,5,6\n"), ["2:11 `1e307` in SI units is too large"]);
    assert_eq!(found("a,v,0,0,1,2,1e31,4,5,6\n"), ["2:13 `1e31` in SI units is too large"]);
    assert_eq!(found("a,v,0,0,1,2,3,4,,6\n"), ["2:17 a number is missing"]);
    // A line of blanks is an empty line.
    assert_eq!(found("  \n\t\na,v,0,0,1,2,3,4,x,6\n"), ["4:17 `x` is not a number"]);
    assert_eq!(found("a,v,0,0,1,2,3,4,5\n"), ["2:1 this row has 9 fields, the header has 10"]);
    let blank = found("a,v,0,0,1,2,3,4,5,6\n ,v,9,0,1,2,3,4,5,6\nb, ,9,0,1,2,3,4,5,6\n,w,8,0,1,2,3,4,5,6\n");
    assert_eq!(blank, ["3:1 the pose has no id", "4:3 the visit has no id", "5:1 the pose has no id"]);
    let missing = found("a,v,0,0,1,2,3,4,5,6\nnan,v,9,0,1,2,3,4,5,6\nb,NaN,9,0,1,2,3,4,5,6\n");
    assert_eq!(missing, ["3:1 the pose has no id", "4:3 the visit has no id"]);
    assert_eq!(found(""), ["1:1 there are no rows"]);
    let open = found("a,v,0,0,1,2,3,4,5,6\n\"b,v,0,0,1,2,3,4,5,6\nc,w,0,0,1,2,3,4,x,6\n");
    assert_eq!(open, ["3:1 the quote is not closed on its line"]);
    let returns = found("a,v,0,0,1,2,3,4,5,6\r\rb,w,0,0,1,2,3,4,x,6\r");
    assert_eq!(returns, ["4:17 `x` is not a number"]);
    let visits = found("a,v,0,0,1,2,3,4,5,6\nb,v,9,0,1,2,3,4,5,6\n");
    assert_eq!(visits, ["3:3 visit `v` began at pose `a`, this row is at pose `b`"]);
    let poses = found("a,v,0,0,1,2,3,4,5,6\na,w,0.01,0,1,2,3,4,5,6\n");
    assert_eq!(poses, ["3:5 pose `a` has another q1 in line 2"]);
    assert_eq!(problems(CAMPAIGN, ""), ["1:1 the file is empty"]);
}

/// What spreadsheets and people make of a table is told as what it is.
#[test]
fn tables_as_others_write_them_are_told_how() {
    let told = |table: &str| {
        let said = Folder::new(CAMPAIGN, table).read().expect_err("something is wrong").to_string();
        said.replace(&std::env::temp_dir().display().to_string(), "")
    };
    let row = "a,v,0,0,1,2,3,4,5,6";
    let comment = told(&format!("# hall 2, by me\n{HEADER}\n{row}\n"));
    assert!(comment.contains("a comment line?") && comment.contains("the first line must be the header"), "{comment}");
    let round = told(&format!("{}\n{row}\n", HEADER.replace("q1 [deg]", "q1 (deg)")));
    assert!(round.contains("write `q1 [deg]`") && round.matches("error: ").count() == 1, "{round}");
    let quoted = told(&format!("{HEADER}\n{}\n", row.replace("v,0", "v,\"-126,6154\"")));
    assert!(quoted.contains("a decimal comma? write `-126.6154`"), "{quoted}");
    let divided = told(&format!("{HEADER}\n{}\n", row.replace("v,0", "v,-126,6154")));
    assert!(divided.contains("this row has 11 fields") && divided.contains("write `-126.6154`"), "{divided}");
}

/// A quote that is not closed takes the rows behind it into a column that nobody reads.
#[test]
fn no_row_is_lost_in_a_note() {
    let rows = "a,v,0,0,1,2,3,4,5,6,\nb,w,9,0,1,2,3,4,5,6,\"slow\nc,x,8,0,1,2,3,4,5,6,\n";
    let found = problems(CAMPAIGN, &format!("{HEADER},note\n{rows}"));
    assert_eq!(found, ["3:21 the quote is not closed on its line"]);
    let header = problems(CAMPAIGN, &format!("{HEADER},\"note\n{rows}"));
    assert_eq!(header, ["1:57 the quote is not closed on its line"]);
}

/// Of numbers that nothing real is as small as, squares would be zero.
#[test]
fn what_nothing_real_is_as_small_as_is_zero() {
    let folder = Folder::new(CAMPAIGN, &format!("{HEADER}\na,v,0,0,1e-250,2,-0,4,5,6\n"));
    let Data::Displacement(data) = folder.read().expect("nothing is wrong").data else { panic!("kind displacement") };
    let [x, _, z, ..] = data.rows[0].wrench;
    assert!([x, z].iter().all(|force| *force == 0.0 && force.is_sign_positive()), "{x} {z}");
}

/// Columns that may be left out are as good as left out in other letters.
#[test]
fn columns_in_other_letters_are_asked_about() {
    let header = HEADER.replace("visit", "Visit");
    let folder = Folder::new(CAMPAIGN, &format!("{header},Mz,note\na,v,0,0,1,2,3,4,5,6,7,\n"));
    let warnings = folder.read().expect("nothing is wrong").warnings;
    let said = warnings.iter().filter_map(|warning| warning.split_once(": the column ")).map(|(_, said)| said);
    assert_eq!(said.collect::<Vec<_>>(), ["`Visit` is not used: write `visit` if it is that", "`note` is not used"]);
}

/// Angles under load are read with their units, all of a kind or none.
#[test]
fn angles_under_load_are_read() {
    let header = "pose,q1,q2,Fx,Fy,Fz,dx,dy,dz,j1 [deg],j2,m1,m2";
    let folder = Folder::new(CAMPAIGN, &format!("{header}\na,0.5,0,1,2,3,0,0,0,30,0.001,0.5,0.0001\n"));
    let campaign = folder.read().unwrap();
    let Data::Displacement(data) = &campaign.data else { panic!("kind displacement") };
    let row = &data.rows[0];
    assert_eq!(row.encoders.as_deref(), Some(&[30_f64.to_radians(), 0.001][..]));
    assert_eq!(row.motors.as_deref(), Some(&[0.5, 0.0001][..]));
    assert_eq!(campaign.warnings, Vec::<String>::new());
    let half = header.replace(",j2", ",k2");
    assert_eq!(problems(CAMPAIGN, &format!("{half}\na,0,0,1,2,3,4,5,6,0,0,0,0\n")), ["1:1 the column `j2` is missing"]);
    let turned = half.replace("m1,m2", "rx,ry");
    assert_eq!(
        problems(CAMPAIGN, &format!("{turned}\na,0,0,1,2,3,4,5,6,0,0,0,0\n")),
        ["1:1 the column `rz` is missing", "1:1 the column `j2` is missing"]
    );
    assert_eq!(
        problems(CAMPAIGN, &format!("{header}\na,0,0,1,2,3,4,5,6,0,x,0,\n")),
        ["2:21 `x` is not a number", "2:25 a number is missing"]
    );
    let folder = Folder::new(CAMPAIGN, &format!("{header}\na,1,0,1,2,3,0,0,0,57.3,0,57,0\n"));
    let warnings = folder.read().unwrap().warnings;
    assert_eq!(warnings.len(), 1);
    assert!(
        warnings[0]
            .ends_with("m1 is far from q1 in 1 row, first on line 2: are the angles in degrees? write `m1 [deg]`")
    );
}

/// Empty lines are skipped, and counted.
#[test]
fn empty_lines_count() {
    let row = "a,v,0,0,1,2,3,4,5,6";
    let table = format!("\n{HEADER}\n{row}\n\n\r\n{row}\n\na,v,0,0,1,2,3,4,x,6\n");
    assert_eq!(problems(CAMPAIGN, &table), ["8:17 `x` is not a number"]);
    let table = table.replace(",x,", ",5,");
    let folder = Folder::new(CAMPAIGN, &table);
    let Data::Displacement(data) = folder.read().unwrap().data else { panic!("kind displacement") };
    assert_eq!(data.rows.iter().map(|row| row.line).collect::<Vec<_>>(), [3, 6, 8]);
    let header = HEADER.replace("dz", "height");
    assert_eq!(problems(CAMPAIGN, &format!("\n\n{header}\n{row}\n")), ["3:1 the column `dz` is missing"]);
}

#[test]
fn every_problem_of_a_header_has_its_place() {
    let found = |header: &str| {
        let fields = header.split(',').count();
        let row: Vec<_> = (0..fields).map(|_| "1").collect();
        problems(CAMPAIGN, &format!("{header}\n{}\n", row.join(",")))
    };
    assert_eq!(found("pose,q1,Fx,Fy,Fz,dx,dy"), ["1:1 the column `q2` is missing", "1:1 the column `dz` is missing"]);
    assert_eq!(found("pose,q1,q2,FX,Fy,Fz,dx,dy,dz"), ["1:12 the column `Fx` is missing"]);
    assert_eq!(found("pose,q1,q2,Fx,Fy,Fz,dx,dy,dz,dx"), ["1:30 the column `dx` is there twice"]);
    assert_eq!(found("pose,q1 [mm],q2,Fx,Fy,Fz,dx,dy,dz"), ["1:6 `mm` is a length, an angle is expected here"]);
    assert_eq!(found("pose,q1,q2,Fx,Fy,Fz,dx [um,dy,dz"), ["1:21 the bracket of the unit is not closed"]);
    assert_eq!(found("pose,q1,q2,Fx,Fy,Fz,dx,dy,dz [furlong]"), ["1:27 unknown unit `furlong` for a length"]);
}

#[test]
fn every_problem_of_a_campaign_file_has_its_place() {
    let table = format!("{HEADER}\na,v,0,0,1,2,3,4,5,6\n");
    let found = |from: &str, to: &str| problems(&CAMPAIGN.replace(from, to), &table);
    assert_eq!(found("kind:", "holdout: {fraction: 1.5}\nkind:").len(), 1);
    assert_eq!(found("kind:", "noise: {displacement: -8 um}\nkind:").len(), 1);
    assert_eq!(found("kind: displacement", "kind: place").len(), 1);
    assert!(found("robot.yaml", "nobody.yaml")[0].starts_with("2:8 there is no file"));
    assert!(found("loads.csv", ".")[0].ends_with("is a folder, and no file"));
    #[cfg(unix)]
    assert_eq!(found("loads.csv", "/dev/null"), ["3:15 /dev/null is no regular file"]);
    assert!(found("kind:", "colour: red\nkind:")[0].contains("unknown field `colour`"));
    // The catalogue's is there without a file; it has five joints, and the table two.
    assert!(found("robot.yaml", "rv130hsc")[0].contains("q3"));
}

/// Loads of a robot with one joint more can be fitted, too; what comes of that is no robot.
#[test]
fn a_column_of_a_joint_too_many_may_be_another_robots() {
    let loads = format!("{HEADER},q3 [deg]\na,v,0,0,1,2,3,4,5,6,90\n");
    let warned = |loads: &str| Folder::new(CAMPAIGN, loads).read().unwrap().warnings;
    let asked = "the column `q3` is not used, Two has 2 joints: is the campaign's `robot:` the right one?";
    let said = warned(&loads);
    let of_column: Vec<&String> = said.iter().filter(|said| said.contains("`q3`")).collect();
    assert!(matches!(of_column[..], [said] if said.ends_with(asked)), "{said:?}");
    // Of what is no joint's next to the last, nothing is known.
    let said = warned(&loads.replace("q3 [deg]", "q4"));
    assert!(said.iter().any(|said| said.ends_with("the column `q4` is not used")), "{said:?}");
}

#[test]
fn positions_are_read_with_their_payload() {
    let campaign = CAMPAIGN.replace("displacement", "position") + "measured: {at: [0, 20 mm, 0]}\n";
    let header = "pose,visit,q1 [deg],q2,px [mm],py,pz,payload [kg]";
    let folder = Folder::new(&campaign, &format!("{header}\na,v,90,0,1500,2,3,40\na,w,90,0,1500,2,3,0\n"));
    let Data::Position(data) = folder.read().unwrap().data else { panic!("kind position") };
    assert_eq!((data.measured_at, data.payload_at), ([0.0, 0.02, 0.0], [0.0; 3]));
    assert_eq!((data.poses.len(), data.visits.len(), data.rows[0].payload), (1, 2, 40.0));
    assert_eq!(data.rows[1].position, [1.5, 2.0, 3.0]);
    let none = format!("{}\na,v,90,0,1500,2,3\n", header.replace(",payload [kg]", ""));
    let Data::Position(data) = Folder::new(&campaign, &none).read().unwrap().data else { panic!("positions") };
    assert_eq!(data.rows[0].payload, 0.0);
    let far = format!("{}\na,v,0,0,1500,2,3\nb,w,0,1,900,2,3\n", "pose,visit,q1,q2,px,py,pz");
    let warnings = Folder::new(&campaign, &far).read().unwrap().warnings;
    let said = "px is more than 30 m off the middle of all in 1 row, first on line 3: are the lengths in millimetres? \
                write `px [mm]`";
    assert!(warnings.iter().any(|warning| warning.ends_with(said)), "{warnings:?}");
    let heavy = format!("{header}\na,v,90,0,1500,2,3,40\na,w,90,0,1500,2,3,1e9\n");
    let warnings = Folder::new(&campaign, &heavy).read().unwrap().warnings;
    assert!(warnings.iter().any(|warning| warning.ends_with("payload is more than 10 t in 1 row, first on line 3")));
    assert_eq!(
        problems(&campaign, &format!("{header}\na,v,0,0,1,2,3,-4\na,v,9,0,x,2,3,4\n")),
        ["2:15 a payload is not negative", "3:9 `x` is not a number"]
    );
    assert_eq!(
        problems(&campaign, "pose,q1,px,py\na,0,1,2\n"),
        ["1:1 the column `q2` is missing", "1:1 the column `pz` is missing"]
    );
}

#[test]
fn clamped_rows_name_an_axis_the_robot_has() {
    let campaign = CAMPAIGN.replace("displacement", "clamped");
    let header = "axis,torque [Nm],deflection [mrad]";
    let folder = Folder::new(&campaign, &format!("{header}\n1,100,0.1\n2,50,0.1\n"));
    let Data::Clamped(rows) = folder.read().unwrap().data else { panic!("kind clamped") };
    assert_eq!(rows[1].axis, 2);
    assert!((rows[0].deflection - 1e-4).abs() < 1e-18);
    assert_eq!(
        problems(&campaign, &format!("{header}\n3,1,1\n1.5,1,1\n")),
        ["2:1 the robot has no axis 3".to_owned(), "3:1 the robot has no axis 1.5".to_owned()]
    );
    let named = Folder::new(&campaign, &format!("{header}\none,1,1\n")).read().unwrap_err().to_string();
    assert!(named.contains("`one` is not a number") && named.contains("holds whole numbers, e.g. `1`"), "{named}");
}

/// A campaign that does not exist is named.
#[test]
fn a_missing_file_is_named() {
    let error = Campaign::read(Path::new("nowhere/campaign.yaml")).unwrap_err();
    assert!(error.to_string().contains("nowhere/campaign.yaml"));
}

/// Spreadsheets save in the encoding of the country they are in.
#[test]
fn files_in_other_encodings_are_told_with_their_place() {
    for file in ["campaign.yaml", "loads.csv", "robot.yaml"] {
        let folder = Folder::new(CAMPAIGN, "");
        std::fs::write(folder.0.join(file), b"a\n# M\xfcller\n").unwrap();
        let Err(ReadError::Invalid(problems)) = folder.read() else { panic!("{file} is read") };
        let problem = problems.iter().next().unwrap();
        assert_eq!((problem.line, problem.column, problem.help.as_str()), (2, 4, "save the file as UTF-8"), "{file}");
    }
}
