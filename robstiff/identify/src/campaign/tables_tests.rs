//! Tables as people have them.

use std::format;
use std::string::{String, ToString};
use std::vec::Vec;

use super::tests::{CAMPAIGN, Folder, problems};
use super::{Data, Displacements};

const HEADER: &str = "pose;visit;q1 [deg];q2;Fx;Fy [kN];Fz;dx [um];dy [mm];dz";

fn read(campaign: &str, table: &str) -> Displacements {
    match Folder::new(campaign, table).read() {
        Ok(campaign) => match campaign.data {
            Data::Displacement(data) => data,
            _ => panic!("kind displacement"),
        },
        Err(problems) => panic!("{problems}"),
    }
}

fn refused(campaign: &str, table: &str) -> String {
    Folder::new(campaign, table).read().expect_err("a problem").to_string()
}

#[test]
fn separators_and_decimal_commas_do_not_change_what_is_read() {
    let comma = read(CAMPAIGN, &format!("{HEADER}\na,v,90,0.5,1,2.5,3,4,5,6\n").replace(';', ","));
    for row in ["a;v;90;0,5;1;2,5;3;4;5;6", "a;v;90;0.5;1;2.5;3;4;5;6"] {
        let table = format!("{HEADER}\n{row}\n");
        assert_eq!(read(CAMPAIGN, &table).rows, comma.rows);
        assert_eq!(read(CAMPAIGN, &table.replace(';', "\t")).rows, comma.rows);
    }
}

#[test]
fn two_decimal_signs_are_a_problem_with_its_place() {
    let table = format!("{HEADER}\na;v;90;0,5;1;2;3;4;5;6\na;v;90;0,5;1;2.5;3;4;5;6\n");
    assert_eq!(problems(CAMPAIGN, &table), ["3:14 `2.5` has a point, and `0,5` on line 2 a decimal comma"]);
}

#[test]
fn axes_are_joints_in_the_unit_of_their_header() {
    let table = format!("{HEADER}\na;v;90;0,5;1;2;3;4;5;6\n");
    let read_as = |letter: char| {
        let named = table.replace("q1", &format!("{letter}1")).replace("q2", &format!("{letter}2"));
        read(CAMPAIGN, &named).rows
    };
    let rows = read(CAMPAIGN, &table).rows;
    assert_eq!(read_as('A'), rows);
    assert_eq!(read_as('J'), rows);
    let both = format!("{}\na,v,1,2,1,2,3,4,5,6,7\n", "pose,visit,A1,J2,A2,Fx,Fy,Fz,dx,dy,dz");
    assert!(refused(CAMPAIGN, &both).contains("which are the joints?"));
}

#[test]
fn visits_may_be_numbered_within_each_pose() {
    let row = |pose: &str, visit: usize, q1: usize| format!("{pose};{visit};{q1};0;1;2;3;{visit}{q1};5;6\n");
    let within: String = [("a", 1, 0), ("a", 1, 0), ("a", 2, 0), ("b", 1, 9), ("b", 2, 9)]
        .iter()
        .map(|&(pose, visit, q1)| row(pose, visit, q1))
        .collect();
    let data = read(CAMPAIGN, &format!("{HEADER}\n{within}"));
    let visits: Vec<usize> = data.rows.iter().map(|row| row.visit).collect();
    assert_eq!((visits, data.visits.len()), (Vec::from([0, 0, 1, 2, 3]), 4));
    // One id of many that comes back at another pose is a slip.
    let slip: String = [("a", 1, 0), ("b", 2, 9), ("c", 1, 5)].iter().map(|&(p, v, q)| row(p, v, q)).collect();
    assert_eq!(
        problems(CAMPAIGN, &format!("{HEADER}\n{slip}")),
        ["4:3 visit `1` began at pose `a`, this row is at pose `c`"]
    );
}

#[test]
fn columns_may_have_other_names() {
    let table = format!("{HEADER}\na;v;90;0,5;1;2;3;4;5;6\n");
    let renamed = table.replace("q1", "Achse 1").replace("dx", "Messuhr X");
    let campaign = format!("{CAMPAIGN}columns: {{q1: \"Achse 1\", dx: Messuhr X}}\n");
    assert_eq!(read(&campaign, &renamed).rows, read(CAMPAIGN, &table).rows);
    // Even those of each other.
    let exchanged = table.replace("dx [um];dy [mm]", "dy [um];dx [mm]");
    let campaign = format!("{CAMPAIGN}columns: {{dx: dy, dy: dx}}\n");
    assert_eq!(read(&campaign, &exchanged).rows, read(CAMPAIGN, &table).rows);
}

#[test]
fn a_column_that_is_not_there_has_its_line_in_the_campaign_file() {
    let table = format!("{HEADER}\na;v;90;0,5;1;2;3;4;5;6\n");
    let said = |columns: &str, table: &str| refused(&format!("{CAMPAIGN}columns:\n{columns}\n"), table);
    let missing = said("  dx: Messuhr X", &table);
    assert!(missing.contains("has no column `Messuhr X`") && missing.contains("campaign.yaml:6:1"), "{missing}");
    let round = said("  dx: Messuhr X", &table.replace("dx [um]", "Messuhr X (um)"));
    assert!(round.contains("write `Messuhr X [um]` in the table's header"), "{round}");
    let unknown = said("  force: F", &table);
    assert!(
        unknown.contains("there is no column `force` to rename") && unknown.contains("campaign.yaml:6"),
        "{unknown}"
    );
    assert!(said("  dx: M\n  dy: M", &table).contains("the column `M` is named twice"));
}

#[test]
fn many_problems_of_a_kind_are_one() {
    let rows: String = (0..120).map(|k| format!("{k};{k};90;0;1;2;3;n/a;5;6\n")).collect();
    let found = problems(CAMPAIGN, &format!("{HEADER}\n{rows}"));
    assert_eq!(found, ["2:16 `n/a` is not a number"]);
    let said = refused(CAMPAIGN, &format!("{HEADER}\n{rows}"));
    assert!(said.ends_with("; .. and 119 more rows like it: lines 3-121"), "{said}");
}

#[test]
fn a_robot_is_no_campaign_and_a_campaign_no_robot() {
    let folder = Folder::new(CAMPAIGN, "");
    let said = super::Campaign::read(folder.0.join("robot.yaml")).expect_err("a robot").to_string();
    assert!(said.starts_with("error: this is a robot's description, and no campaign"), "{said}");
    assert_eq!(said.matches("error:").count(), 1, "{said}");
    let said = robstiff_robots::Description::read(folder.0.join("campaign.yaml")).expect_err("a campaign").to_string();
    assert!(said.contains("which the campaign names under `robot:`, here `robot.yaml`"), "{said}");
    assert_eq!(said.matches("error:").count(), 1, "{said}");
}

#[test]
fn a_table_without_readings_is_one_problem() {
    let rows = "a;v;90;0;1;2;3;;;\nb;w;0;0;1;2;3;;;\n";
    assert_eq!(problems(CAMPAIGN, &format!("{HEADER}\n{rows}")), ["2:16 no readings yet: fill in dx, dy, dz"]);
    let some = rows.replacen(";;;", ";1;2;3", 1);
    assert_eq!(problems(CAMPAIGN, &format!("{HEADER}\n{some}")).len(), 3);
}

#[test]
fn a_dial_gauge_reads_along_one_axis() {
    let table = "pose,q1 [deg],q2,Fx,Fy,Fz,dz [um]\na,90,0.5,1,2,3,4\n";
    let data = read(CAMPAIGN, table);
    assert_eq!((data.directions, data.rows[0].displacement), (std::vec![[0.0, 0.0, 1.0]], [0.0, 0.0, 4e-6]));
    let campaign = Folder::new(CAMPAIGN, table).read().unwrap();
    let told = "of the displacement only `dz` is read: how far the tool moves across is not known";
    assert!(campaign.warnings.iter().any(|said| said.contains(told)), "{:?}", campaign.warnings);
}

#[test]
fn a_dial_gauge_reads_along_a_direction_that_the_campaign_gives() {
    let table = "pose,q1 [deg],q2,Fx,Fy,Fz,d [um]\na,90,0.5,1,2,3,10\n";
    let along = format!("{CAMPAIGN}measured: {{along: [0, -3, 4]}}\n");
    let data = read(&along, table);
    let off = data.rows[0].displacement.into_iter().zip([0.0, -6e-6, 8e-6]).map(|(a, b)| (a - b).abs()).sum::<f64>();
    assert!(off < 1e-18 && data.directions == [[0.0, -0.6, 0.8]], "{:?}", data.rows);
    assert_eq!(
        problems(CAMPAIGN, table),
        ["1:1 the column `d` is a displacement along one direction, and the campaign does not say which"]
    );
    assert_eq!(problems(&along, &table.replace(",d [um]", ",dz [um]")), ["1:1 the column `d` is missing"]);
    for none in ["[0, 0, 0]", "[1e-300, 0, 0, 0]", "[0, 0]", "up"] {
        let said = refused(&format!("{CAMPAIGN}measured: {{along: {none}}}\n"), table);
        assert!(said.contains("campaign.yaml:"), "{said}");
    }
}

#[test]
fn two_axes_of_three_or_one_with_a_slip_of_the_pen_are_no_dial_gauge() {
    let table = "pose,q1 [deg],q2,Fx,Fy,Fz,dx,dz\na,90,0.5,1,2,3,1,2\n";
    assert_eq!(problems(CAMPAIGN, table), ["1:1 the column `dy` is missing"]);
    let table = "pose,q1 [deg],q2,Fx,Fy,Fz,dX,DY,dz\na,90,0.5,1,2,3,1,2,3\n";
    assert_eq!(problems(CAMPAIGN, table).len(), 2);
}

#[test]
fn what_the_pendant_shows_becomes_joint_coordinates() {
    let table = "pose,t1 [deg],t2,Fx,Fy,Fz,dx,dy,dz\na,90,0.5,1,2,3,1,2,3\n";
    let folder = Folder::new(CAMPAIGN, table);
    let told = folder.read().expect_err("the description has no controller").to_string();
    assert!(told.contains("`t1` .. are what the pendant shows") && told.contains("`controller:`"), "{told}");
    // The second counts from the ground, backwards, and shows 0 at 0.1 rad.
    let robot = folder.0.join("robot.yaml");
    let controller = "controller:\n  joints: [{}, {sign: -1, offset: 0.1 rad, add: {t1: 1}}]\n";
    std::fs::write(&robot, std::fs::read_to_string(&robot).unwrap() + controller).unwrap();
    let read = folder.read().unwrap_or_else(|problems| panic!("{problems}"));
    let Data::Displacement(data) = read.data else { panic!("kind displacement") };
    let quarter = core::f64::consts::FRAC_PI_2;
    assert_eq!(data.rows[0].q, [quarter, 0.1 - (0.5 + quarter)]);
}
