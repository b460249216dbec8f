//! What is read, but not without a word: rows that are left out, numbers that nothing real has,
//! fields that are not used.

use std::borrow::ToOwned;
use std::format;
use std::string::String;
use std::vec::Vec;

use super::tests::{CAMPAIGN, Folder, HEADER, ROBOT, problems};
use super::*;

/// A row without load and displacement is the unloaded reading itself, and a visit or pose
/// that has no other is none.
#[test]
fn rows_of_the_unloaded_reading_are_left_out() {
    let rows =
        "a,v,0,0,0,0,0,0,0,0\na,v,0,0,1,2,3,4,5,6\na,v,0,0,0,0,0,0,0,1\nb,w,9,0,-0,0,0,0,0,0\nc,x,8,0,1,0,0,0,0,0\n";
    let read = |rows: &str| {
        let campaign = Folder::new(CAMPAIGN, &format!("{HEADER}\n{rows}")).read().expect("nothing is wrong");
        let Data::Displacement(data) = campaign.data else { panic!("kind displacement") };
        let said = campaign.warnings.iter().filter_map(|warning| warning.split_once("loads.csv: "));
        (data, said.map(|(_, said)| said.to_owned()).collect::<Vec<_>>())
    };
    let (data, warnings) = read(rows);
    let places: Vec<_> = data.rows.iter().map(|row| (row.line, row.pose, row.visit)).collect();
    assert_eq!(places, [(3, 0, 0), (4, 0, 0), (6, 1, 1)]);
    assert_eq!(
        (data.poses, data.visits),
        (std::vec!["a".to_owned(), "c".to_owned()], std::vec!["v".to_owned(), "x".to_owned()])
    );
    let said = "line 2 and 1 more: no load and no displacement, which is the unloaded reading itself; left out";
    assert!(warnings.contains(&said.to_owned()), "{warnings:?}");
    // Where there is nothing else, nothing was read.
    assert_eq!(read("a,v,0,0,0,0,0,0,0,0\n").0.rows.len(), 1);
    let found = problems(CAMPAIGN, &format!("{HEADER}\na,v,0,0,0,0,0,0,0,0\nb,w,0,0,0,0,0,NaN,0,0\n"));
    assert_eq!(found, ["3:15 `NaN` is not finite"]);
}

/// An id a row is not a pose a row, and visits stay as they are.
#[test]
fn rows_with_the_same_joint_coordinates_are_of_one_pose() {
    let rows = "1,v,0,0.5,1,2,3,4,5,6\n2,w,9,0.5,1,2,3,4,5,6\n3,x,0,0.5,1,2,3,4,5,6\n";
    let campaign = Folder::new(CAMPAIGN, &format!("{HEADER}\n{rows}")).read().expect("nothing is wrong");
    let Data::Displacement(data) = campaign.data else { panic!("kind displacement") };
    assert_eq!(data.rows.iter().map(|row| (row.pose, row.visit)).collect::<Vec<_>>(), [(0, 0), (1, 1), (0, 2)]);
    assert_eq!((data.poses.join(" ").as_str(), data.visits.len()), ("1 2", 3));
    let said = "loads.csv: pose `3` has the joint coordinates of pose `1`; rows with the same count as one pose";
    assert!(campaign.warnings.iter().any(|warning| warning.ends_with(said)), "{:?}", campaign.warnings);
}

/// Degrees in a column without a unit are radians that no joint reaches.
#[test]
fn coordinates_that_joints_do_not_reach_are_warned_of() {
    let read = |header: &str, rows: &str| {
        let folder = Folder::new(CAMPAIGN, &format!("{header}\n{rows}"));
        let robot = ROBOT.replace("a: 1 m,", "a: 1 m, limits: [-90 deg, 90 deg],");
        std::fs::write(folder.0.join("robot.yaml"), robot).expect("a temporary file");
        let warnings = folder.read().expect("nothing is wrong").warnings;
        let file = format!("{}: ", folder.0.join("loads.csv").display());
        warnings.into_iter().map(|warning| warning.replace(&file, "")).collect::<Vec<_>>()
    };
    let rows = "a,90,12,1,2,3,0,0,0\nb,-90,13,1,2,3,0,0,0\n";
    assert_eq!(
        read("pose,q1,q2,Fx,Fy,Fz,dx,dy,dz", rows),
        [
            "q1 is outside its limits [-90, 90] deg in 2 rows, first on line 2: \
             are the angles in degrees? write `q1 [deg]`",
            "q2 is more than two turns in 1 row, first on line 3: are the angles in degrees? write `q2 [deg]`",
        ]
    );
    let header = "pose,q1 [deg],q2 [rad],Fx,Fy,Fz,dx,dy,dz";
    assert_eq!(read(header, rows), Vec::<String>::new());
    assert_eq!(
        read(header, "a,0,0,1,2,3,0,0,0\nb,91,0,1,2,3,0,0,0\n"),
        ["q1 is outside its limits [-90, 90] deg in 1 row, first on line 3"]
    );
}

/// Of a path, a force that is misspelt is none, but not zero.
#[test]
fn forces_of_a_path_are_all_there() {
    let read = |header: &str, row: &str| {
        let folder = Folder::new(CAMPAIGN, &format!("q1,q2,{header}\n0,0,{row}\n"));
        let robot = Description::parse("robot.yaml", ROBOT).expect("a robot");
        let read = JointTable::read(&folder.0.join("loads.csv"), &robot, None);
        let read = read.map_err(|problems| format!("{problems}"))?;
        let said = read.warnings.iter().filter_map(|warning| warning.split_once("loads.csv: "));
        Ok((read.wrenches, said.map(|(_, said)| said.to_owned()).collect::<Vec<_>>().join("; ")))
    };
    let told: String = read("Fx,fy,Fz", "1,2,3").expect_err("a misspelt column");
    assert!(told.contains("the column `Fy` is missing") && told.contains("write `Fy` in place of `fy`"), "{told}");
    assert!(read("Fz", "3").is_err_and(|told| told.contains("the column `Fx` is missing")));
    let (wrenches, told) = read("Fx,Fy,Fz,mx", "1,2,3,4").expect("forces");
    assert_eq!(wrenches, Some(std::vec![[1.0, 2.0, 3.0, 0.0, 0.0, 0.0]]));
    assert_eq!(told, "the column `mx` is not used: write `Mx` if it is that");
    let (_, told) = read("Fx [kN],Fy,Fz,other", "450,2,3,4").expect("forces");
    assert_eq!(told, "Fx is more than 100 kN in 1 row, first on line 2");
}

/// Loads and displacements that no robot comes to are read, and told with their lines.
#[test]
fn numbers_beyond_all_robots_are_warned_of() {
    let header = "pose,q1,q2,Fx,Fy,Fz,Mx,dx,dy [um],dz,rx [rad],ry [rad],rz [rad]";
    let rows = "a,0,0,1,2,3,0,0.4,400,1e-4,0,0,0\nb,1,0,1,2,3e9,4,0.2,800,1e-4,0,0,0.5\n";
    let folder = Folder::new(CAMPAIGN, &format!("{header}\n{rows}"));
    let warnings = folder.read().expect("nothing is wrong").warnings;
    let file = format!("{}: ", folder.0.join("loads.csv").display());
    let said: Vec<_> = warnings.iter().map(|warning| warning.replace(&file, "")).collect();
    assert_eq!(
        said,
        [
            "dx is more than 100 mm in 2 rows, first on line 2: are the lengths in millimetres? write `dx [mm]`",
            "Fz is more than 100 kN in 1 row, first on line 3",
            "rz is more than 0.1 rad in 1 row, first on line 3",
        ]
    );
    let campaign = CAMPAIGN.replace("displacement", "clamped");
    let table = "axis,torque,deflection\n1,100,0.1\n2,5e6,0.3\n";
    let warnings = Folder::new(&campaign, table).read().expect("nothing is wrong").warnings;
    assert!(warnings[0].ends_with("torque is more than 1 MNm in 1 row, first on line 3"));
    assert!(warnings[1].ends_with(
        "deflection is more than 0.1 rad in 1 row, first on line 3: \
         are the angles in milliradians? write `deflection [mrad]`"
    ));
}

/// Of numbers without a unit the one is asked for that makes them what loads do.
#[test]
fn the_unit_that_is_asked_for_makes_displacements_plausible() {
    let asked = |rows: &str| {
        let folder = Folder::new(CAMPAIGN, &format!("pose,q1,q2,Fx,Fy,Fz,dx,dy,dz,rx,ry,rz\n{rows}"));
        let warnings = folder.read().expect("nothing is wrong").warnings;
        let units = |warning: &String| warning.rsplit_once("write ").map(|(_, unit)| unit.to_owned());
        warnings.iter().filter_map(units).collect::<Vec<_>>()
    };
    // The small ones of a row are in the unit of the others.
    let of = |unit: &str, angle: &str| {
        ["dx", "dy", "rx"].map(|name| format!("`{name} [{}]`", if name == "rx" { angle } else { unit }))
    };
    assert_eq!(asked("a,0,0,1,2,3,473.1,-1.5,0,1.2,0,0\n"), of("um", "mrad"));
    assert_eq!(asked("a,0,0,1,2,3,0.473,-0.15,0,300,0,0\n"), of("mm", "urad"));
}

/// A column of zeros and rows that were copied are asked about; an arm that was not loaded, and
/// rows that differ in their time alone, are not.
#[test]
fn what_nobody_read_is_warned_of() {
    let warned = |header: &str, row: &dyn Fn(usize) -> String| {
        let rows: String = (0..10).map(row).collect();
        let folder = Folder::new(CAMPAIGN, &format!("{header}\n{rows}"));
        let said = folder.read().expect("nothing is wrong").warnings;
        said.iter()
            .map(|said| said.split_once("loads.csv: ").expect("it names the file").1.to_owned())
            .collect::<Vec<_>>()
    };
    let moved = |i: usize| format!("a,v{i},0,0,100,50,20,{}e-5,0.00001,0\n", i + 1);
    assert_eq!(warned(HEADER, &moved), ["dz is 0 in every row: was it read? each says that nothing moves that way"]);
    let copied = |i: usize| format!("a,v{i},0,0,100,50,20,{}e-5,0.00001,-0.00001\n", i % 9);
    assert_eq!(
        warned(HEADER, &copied),
        ["all numbers are those of an earlier row in 1 row, first on line 11: copies, which are left out"]
    );
    let timed = |i: usize| format!("a,v{i},{i},0,0,100,50,20,{}e-5,0.00001,-0.00001\n", i % 9);
    assert_eq!(warned("pose,visit,time,q1,q2,Fx,Fy,Fz,dx,dy,dz", &timed), Vec::<String>::new());
    assert_eq!(warned(HEADER, &|i| format!("a,v{i},0,0,0,0,0,0,0,0\n")), Vec::<String>::new());
}

/// A copied block repeats its readings, their noise and all: it is left out, with the visits that
/// it makes; where times are told, whatever the gauge. Readings of a coarse one may be alike.
#[test]
fn copies_are_left_out() {
    let read = |header: &str, row: &dyn Fn(usize) -> String| {
        let rows: String = (0..12).map(|i| row(i % 9)).collect();
        let read = Folder::new(CAMPAIGN, &format!("{header}\n{rows}")).read().expect("nothing is wrong");
        let Data::Displacement(data) = read.data else { panic!("kind displacement") };
        assert!(data.rows.iter().all(|row| row.visit < data.visits.len()));
        let said = read.warnings.iter().find_map(|said| said.split_once("3 rows, first on line 11: ")?.1.into());
        (data.rows.len(), data.visits.len(), said.map(str::to_owned).expect("they are told"))
    };
    let left_out = (9, 9, "copies, which are left out".to_owned());
    let fine = |i: usize| format!("a,0,0,100,50,20,{i}.017,0.1,-0.0001\n");
    let without_visit = HEADER.replace("visit,", "");
    assert_eq!(read(&without_visit, &fine), left_out);
    let coarse = |i: usize| format!("a,0,0,100,50,20,{i}0,0.1,-0.0001\n");
    assert_eq!(read(&without_visit, &coarse), (12, 12, "are these copies?".to_owned()));
    let timed = |i: usize| format!("{},{}", 60 * i, coarse(i));
    assert_eq!(read(&format!("time,{without_visit}"), &timed), left_out);
    // A time for all readings of a visit tells none from another.
    let told_once = |i: usize| format!("60,{}", coarse(i));
    assert_eq!(read(&format!("time,{without_visit}"), &told_once).0, 12);
}

/// One row with ten times its force is told, with its line; levels of load are not.
#[test]
fn a_force_that_stands_alone_is_warned_of() {
    let warned = |visits: usize, forces: &[f64]| {
        let row = |(i, force)| format!("a,v{},0,0,{force},0,0,{i},1e-3,1e-6\n", i % visits);
        let rows = forces.iter().enumerate().map(row);
        let folder = Folder::new(CAMPAIGN, &format!("{HEADER}\n{}", rows.collect::<String>()));
        folder.read().expect("nothing is wrong").warnings
    };
    let loads = [0.0, 400.0, 800.0, 1300.0, 800.0, 400.0, 0.0, 400.0, 820.0, 1250.0];
    let mut slip = loads;
    slip[8] *= 10.0;
    let said = warned(2, &slip);
    assert_eq!(said.len(), 1, "{said:?}");
    assert!(said[0].contains("loads.csv: line 10: a force of 8.2 kN, the next largest is 1.3 kN: "), "{said:?}");
    assert_eq!(warned(2, &loads), Vec::<String>::new());
    assert_eq!(warned(2, &slip[..9]), Vec::<String>::new());
    // Two levels, each often; and two visits, each with its own.
    let levels: Vec<f64> = loads.iter().chain(&[8000.0, 8000.0]).copied().collect();
    assert_eq!(warned(3, &levels), Vec::<String>::new());
    let alternating: Vec<f64> = (0..12).map(|i| if i % 2 == 0 { 100.0 } else { 1000.0 }).collect();
    assert_eq!(warned(2, &alternating), Vec::<String>::new());
    let one_visit: Vec<f64> = (0..12).map(|i| if i % 4 == 0 { 1000.0 } else { 100.0 }).collect();
    assert_eq!(warned(4, &one_visit).len(), 1);
}

/// The lines of rows of kind `displacement` as they are taken, with their visits, and what is said.
fn in_order(rows: &[(&str, f64)]) -> (Vec<(usize, usize)>, Vec<String>) {
    let row = |(k, (visit, time)): (usize, &(&str, f64))| format!("a,{visit},0,0,1,2,3,4,5,0.00{k},{time}\n");
    let rows: String = rows.iter().enumerate().map(row).collect();
    let read = Folder::new(CAMPAIGN, &format!("{HEADER},time [s]\n{rows}")).read().expect("nothing is wrong");
    let Data::Displacement(data) = read.data else { panic!("kind displacement") };
    let said = read.warnings.iter().map(|said| said.split_once("loads.csv: ").expect("it names the file").1.to_owned());
    (data.rows.iter().map(|row| (row.line, row.visit)).collect(), said.collect())
}

/// A table that was sorted since, here by pose or load, has its rows in the order of their times,
/// each with its line; visits stay together where times are told coarsely.
#[test]
fn rows_are_in_the_order_in_which_they_were_read() {
    let said = |rows: &str| {
        std::vec![format!(
            "the time is earlier than the one before in {rows}: the rows are taken in the order of their times"
        )]
    };
    let sorted = [("v", 60.0), ("v", 70.0), ("x", 180.0), ("x", 190.0), ("w", 120.0), ("w", 130.0)];
    let in_time = [(2, 0), (3, 0), (6, 1), (7, 1), (4, 2), (5, 2)];
    assert_eq!(in_order(&sorted), (in_time.to_vec(), said("1 row, first on line 6")));
    let coarse = [("x", 120.0), ("x", 180.0), ("w", 60.0), ("w", 120.0)];
    assert_eq!(in_order(&coarse).0, [(4, 0), (5, 0), (2, 1), (3, 1)]);
    // Nothing is to be said, or sorted, of rows in order, whose visits may take turns.
    let turns = [("v", 60.0), ("w", 60.0), ("v", 70.0), ("w", 80.0)];
    assert_eq!(in_order(&turns), (std::vec![(2, 0), (3, 1), (4, 0), (5, 1)], Vec::new()));
    // Positions as well.
    let campaign = CAMPAIGN.replace("displacement", "position");
    let table = "pose,q1 [deg],q2,px,py,pz,time [s]\na,9,0,1,2,3,200\nb,8,0,1,2,4,100\n";
    let read = Folder::new(&campaign, table).read().expect("nothing is wrong");
    let Data::Position(data) = read.data else { panic!("kind position") };
    assert_eq!(data.rows.iter().map(|row| (row.line, row.pose)).collect::<Vec<_>>(), [(3, 0), (2, 1)]);
    assert_eq!((data.poses.join(" "), data.visits.join(" ")), ("b a".to_owned(), "line 3 line 2".to_owned()));
}

/// The rows of a visit are in load order: a time that says otherwise is asked about.
#[test]
fn times_that_go_back_within_a_visit_are_warned_of() {
    let (rows, said) = in_order(&[("w", 120.0), ("w", 110.0), ("v", 60.0)]);
    assert_eq!(rows, [(2, 0), (3, 0), (4, 1)]);
    let expected = "the time is earlier than that of a row of the same visit before in 1 row, first on line 3: the rows \
                    are taken in the order of the file; if they were read in that of the times, sort them by time";
    assert_eq!(said, [expected]);
}

/// Clamped axes have no poses to hold out, and no tool.
#[test]
fn what_clamped_axes_do_not_use_is_warned_of() {
    let plan = CAMPAIGN.replace("displacement", "clamped")
        + "noise: {rotation: 1e-6, displacement: 1e-6}\nholdout: {fraction: 0.25}\n";
    let folder = Folder::new(&plan, "axis,torque,deflection\n1,100,1e-4\n");
    let (campaign, file) = (folder.read().unwrap(), folder.0.join("campaign.yaml"));
    let said =
        |field: &str, line| format!("{}: `{field}` on line {line} is not used with `kind: clamped`", file.display());
    let of_turning = "`displacement` of the noise is not used with axes that turn";
    assert_eq!(campaign.warnings, [said("holdout", 6), format!("{}: {of_turning}", file.display())]);
    assert_eq!(campaign.noise.rotation, Some(1e-6));
}

/// Payloads pull downwards and a tracker reads points in its own frame, so neither has
/// a frame to say; and a fit wants more poses than it leaves.
#[test]
fn what_positions_do_not_use_is_warned_of() {
    let plan = CAMPAIGN.replace("displacement", "position")
        + "wrench: {frame: base}\nmeasured: {frame: tool}\nnoise: {displacement: 1e-5, rotation: 1e-5}\n\
           holdout: {fraction: 0.7}\n";
    let table = "pose,q1,q2,px,py,pz\na,0,0,1,2,3\nb,1,0,1,2,3\nc,1,1,1,2,3\n";
    let folder = Folder::new(&plan, table);
    let file = format!("{}: ", folder.0.join("campaign.yaml").display());
    let said: Vec<_> = folder.read().unwrap().warnings.iter().map(|warning| warning.replace(&file, "")).collect();
    assert_eq!(
        said,
        [
            "`frame` on line 6 is not used with `kind: position`",
            "`rotation` on line 7 is not used with `kind: position`",
            "`holdout` keeps 2 of 3 poses from the fit",
        ]
    );
}
