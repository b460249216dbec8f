//! When rows were read, by whatever clock.

use std::format;
use std::string::String;
use std::vec::Vec;

use super::tests::{CAMPAIGN, Folder, HEADER, problems};
use super::*;

/// Drifts begin with the campaign, not with the epoch: two visits, after a round of two
/// unloaded readings or none.
#[test]
fn times_of_clocks_that_were_not_started_for_the_campaign_count_from_its_beginning() {
    let times = |times: [f64; 4]| {
        let row = |(k, time): (usize, &f64)| {
            let (pose, visit) = if k < 2 { ("a", "v") } else { ("b", "w") };
            format!("{pose},{visit},{},0,1,2,3,4,5,0.006,{time}\n", k / 2)
        };
        let rows: String = times.iter().enumerate().map(row).collect();
        let folder = Folder::new(CAMPAIGN, &format!("{HEADER},time [s]\n{rows}"));
        let Data::Displacement(data) = folder.read().unwrap().data else { panic!("kind displacement") };
        let times: Vec<f64> = data.rows.iter().map(|row| row.time.unwrap()).collect();
        times
    };
    for begun_with_the_campaign in [[10.0, 20.0, 40.0, 50.0], [30.0, 40.0, 60.0, 70.0]] {
        assert_eq!(times(begun_with_the_campaign), begun_with_the_campaign);
    }
    let counted = [30.0, 40.0, 60.0, 70.0];
    for started in [8.0 * 3600.0, 1_764_000_000.0] {
        assert_eq!(times(counted.map(|time| time + started)), counted, "a clock started {started} s before");
    }
}

/// The times of four rows of two visits, with the warnings.
fn clocked(kind: &str, header: &str, clock: [&str; 4]) -> (Vec<f64>, Vec<String>) {
    let row = |(k, time): (usize, &&str)| match kind {
        "position" => format!("p{k},{k},0,1,2,{k},{time}\n"),
        _ => format!("p{},{},{},0,1,2,3,4,5,0.00{k},{time}\n", k / 2, k / 2, k / 2),
    };
    let rows: String = clock.iter().enumerate().map(row).collect();
    let columns = if kind == "position" { "pose,q1,q2,px,py,pz" } else { HEADER };
    let campaign = CAMPAIGN.replace("displacement", kind);
    let folder = Folder::new(&campaign, &format!("{columns},{header}\n{rows}"));
    let read = folder.read().unwrap();
    let times = match read.data {
        Data::Displacement(data) => data.rows.iter().map(|row| row.time.unwrap()).collect(),
        Data::Position(data) => data.rows.iter().map(|row| row.time.unwrap()).collect(),
        Data::Clamped(_) => panic!("rows with times"),
    };
    (times, read.warnings)
}

/// From the midnight before the first row on, over later ones; displacements as other times
/// of the day from the beginning of the campaign.
#[test]
fn times_may_be_those_of_a_clock() {
    let quiet = Vec::<String>::new();
    let over_midnight = ["23:59:30", "23:59:40.5", "00:00:10", "00:00:20"];
    let expected = std::vec![86370.0, 86380.5, 86410.0, 86420.0];
    assert_eq!(clocked("position", "time", over_midnight), (expected.clone(), quiet.clone()));
    let dated = ["2026-12-31T23:59:30Z", "2026-12-31T23:59:40.5Z", "2027-01-01T00:00:10Z", "2027-01-01T00:00:20Z"];
    assert_eq!(clocked("position", "time", dated), (expected, quiet.clone()));
    // With a date they may be in any order, and the rows are taken in theirs.
    let dated = ["2026-11-25 08:15:00", "2026-11-25 08:14:00", "2026-11-26 08:15:00", "2026-11-24 08:15:00"];
    let (times, warnings) = clocked("position", "time", dated);
    assert_eq!(times, [-56_700.0, 29_640.0, 29_700.0, 116_100.0]);
    assert!(warnings.len() == 1 && warnings[0].ends_with("taken in the order of their times"), "{warnings:?}");
    let (times, warnings) = clocked("displacement", "time", ["8:15:00", "8:15:10", "8:15:30", "8:15:40"]);
    assert_eq!((times, warnings), (std::vec![30.0, 40.0, 60.0, 70.0], quiet));
    let (times, warnings) = clocked("position", "time", ["17:00:00", "17:01:00", "08:00:00", "08:01:00"]);
    assert_eq!(times, [61_200.0, 61_260.0, 115_200.0, 115_260.0]);
    assert_eq!(warnings.len(), 1);
    assert!(warnings[0].contains("earlier than the one before in 1 row, first on line 4, and taken"), "{warnings:?}");
}

#[test]
fn times_of_a_clock_are_all_written_alike() {
    let table = |times: [&str; 3]| {
        let rows: String = times.iter().enumerate().map(|(k, time)| format!("p{k},0,1,2,{k},5,{time}\n")).collect();
        problems(&CAMPAIGN.replace("displacement", "position"), &format!("pose,q1,q2,px,py,pz,time\n{rows}"))
    };
    let dated = "2026-11-25 08:15:00";
    assert_eq!(
        table([dated, "08:16:00", "2026-11-25T08:17:00Z"]),
        [
            "3:14 `08:16:00` is written otherwise than the time on line 2",
            "4:14 `2026-11-25T08:17:00Z` is written otherwise than the time on line 2"
        ]
    );
    assert_eq!(table([dated, "", "29700"]), ["3:14 a time is missing", "4:14 `29700` is no time of a clock"]);
    assert_eq!(table(["1", "", "3"]), ["3:14 a number is missing"]);
}
