//! What the rig does to readings, each fault against what it is to first
//! order, written out here.

use nalgebra::{Vector3, Vector6};

use super::hidden_tests::{assert_near, force, rigid, rows, small, vector};
use super::{Arm, Follows, Hidden, Mount, Outside, Row, Scenario, six_axis};

/// The load is `G F + b` of the reading `F`; exactly for bias and scale, to
/// first order for a turn.
#[test]
fn the_load_is_what_the_cell_reads_and_its_fault() {
    for mount in [Mount::Ground, Mount::Tool] {
        let axes = |row: &Row| match mount {
            Mount::Ground => nalgebra::Matrix3::identity(),
            Mount::Tool => Arm::new(&six_axis(), &[]).at(&row.q).tool(),
        };
        let turn = [2e-4, -3e-4, 1e-4];
        for row in rows(six_axis(), Hidden::LoadCellMisalignment { turn, mount }) {
            let (read, acts) = (force(&row.wrench), force(&row.acting));
            assert_near(acts, read + (axes(&row) * vector(turn)).cross(&read), 2e-7 * read.norm());
            assert!((acts - read).norm() > 1e-6 * read.norm());
        }
        let bias = [12.0, -7.0, 20.0];
        for row in rows(six_axis(), Hidden::LoadCellBias { force: bias, mount }) {
            assert_near(force(&row.acting), force(&row.wrench) + axes(&row) * vector(bias), 1e-11);
        }
        let scale = [0.03, 0.0, -0.05];
        for row in rows(six_axis(), Hidden::LoadCellScale { scale, mount }) {
            let read = axes(&row).transpose() * force(&row.wrench);
            let acts = axes(&row).transpose() * force(&row.acting);
            assert_near(acts, read + read.component_mul(&vector(scale)), 1e-11);
        }
    }
    // Seen from the tool, it is the same force.
    let scenario = small(six_axis(), Hidden::LoadCellBias { force: [5.0, 0.0, 0.0], mount: Mount::Tool });
    let in_tool = Scenario { wrench_in_tool: true, ..scenario.clone() }.run();
    assert!(in_tool.campaign_yaml().contains("wrench: {frame: tool, at: tcp}"));
    for (row, other) in in_tool.rows.iter().zip(&scenario.run().rows) {
        let tool = Arm::new(&six_axis(), &[]).at(&row.q).tool();
        assert_near(tool * force(&row.wrench), force(&other.wrench), 1e-11);
    }
}

#[test]
fn a_turned_tracker_turns_what_it_reads() {
    let turn = [2e-4, 1e-4, -3e-4];
    let scenario = Scenario { rotation_noise: Some(0.0), ..small(six_axis(), Hidden::TrackerMisalignment(turn)) };
    let plain = Scenario { hidden: Vec::new(), ..scenario.clone() }.run();
    for (row, plain) in scenario.run().rows.iter().zip(&plain.rows) {
        let (read, is) = (vector(row.displacement), vector(plain.displacement));
        assert_near(read, is + vector(turn).cross(&is), 2e-7 * is.norm());
        let (read, is) = (vector(row.rotation.unwrap()), vector(plain.rotation.unwrap()));
        assert_near(read, is + vector(turn).cross(&is), 2e-7 * is.norm());
    }
}

#[test]
fn a_drift_is_what_has_passed_since_the_unloaded_reading() {
    let rate = [30e-6, -10e-6, 20e-6];
    for unloaded_first in [false, true] {
        let visits = 8.0;
        for (follows, law) in [
            (Follows::Time, (|time, _| time / 3600.0) as fn(f64, f64) -> f64),
            (Follows::Temperature, |_, temperature| temperature - 21.0),
            (Follows::Settling(1800.0), |time, _| 1.0 - (-time / 1800.0_f64).exp()),
        ] {
            let drift = Hidden::ThermalDrift { rate, follows };
            let run = Scenario { unloaded_first, swing: 0.7, ..small(rigid(), drift) }.run();
            // The unloaded readings of the eight visits, one a minute, come
            // first or each a minute before its visit's first row.
            for row in &run.rows {
                let began = if unloaded_first { 60.0 * (row.visit + 1) as f64 } else { 300.0 * row.visit as f64 };
                let warm = |time: f64| {
                    21.0 + 4.0 * (1.0 - (-time / 7200.0).exp()) + 0.7 * (std::f64::consts::TAU * time / 5400.0).sin()
                };
                assert!((row.temperature - warm(row.time)).abs() < 1e-12);
                let passed = law(row.time, row.temperature) - law(began, warm(began));
                assert_near(vector(row.displacement), vector(rate) * passed, 1e-15);
            }
            let last = run.rows.last().unwrap().time;
            assert_eq!(last, 60.0 * (40.0 + if unloaded_first { visits } else { 0.0 }));
        }
    }
}

#[test]
fn creep_grows_by_a_share_a_decade_and_recovers() {
    let creep = Hidden::Creep { share: 0.02, onset: 6.0 };
    let plain = small(six_axis(), Hidden::JointZeroOffset { joint: 1, offset: 0.0 });
    let scenario = small(six_axis(), creep);
    let ramp = vec![1.0, 1.0, 0.0, 0.0];
    let creeping = Scenario { ramp: ramp.clone(), ..scenario }.run();
    let plain = Scenario { ramp, ..plain }.run();
    for (visit, plain) in creeping.rows.chunks(4).zip(plain.rows.chunks(4)) {
        let full = vector(plain[0].displacement);
        // On for 60 s and 120 s; then off for as long.
        let grown = |time: f64| 0.02 * (1.0 + time / 6.0).log10();
        let expected = [1.0 + grown(60.0), 1.0 + grown(120.0), grown(180.0) - grown(60.0), grown(240.0) - grown(120.0)];
        for (row, expected) in visit.iter().zip(expected) {
            assert_near(vector(row.displacement), full * expected, 1e-12 * full.norm());
        }
    }
}

#[test]
fn slips_are_there_from_their_moment_on() {
    let (shift, turn) = ([40e-6, -20e-6, 10e-6], [2e-6, -1e-6, 3e-6]);
    let when = 0.6;
    let slip = Scenario { unloaded_first: true, ..small(rigid(), Hidden::BaseSlip { shift, turn, when }) }.run();
    let end = slip.rows.last().unwrap().time;
    let marker = Hidden::ReflectorSlip { shift, when };
    let marker = Scenario { unloaded_first: true, ..small(rigid(), marker) }.run();
    for (row, other) in slip.rows.iter().zip(&marker.rows) {
        let posed = Arm::new(&rigid(), &[]).at(&row.q);
        let after = f64::from(u8::from(row.time > when * end));
        let expected = vector(shift) + vector(turn).cross(&vector(posed.tcp()));
        assert_near(vector(row.displacement), expected * after, 1e-10);
        assert_near(vector(other.displacement), posed.tool() * vector(shift) * after, 1e-15);
    }
    assert!(slip.rows[0].displacement == [0.0; 3] && slip.rows.last().unwrap().displacement != [0.0; 3]);
}

#[test]
fn a_cell_reads_otherwise_at_other_angles() {
    let gain = Hidden::Outside(Outside::GainOfAngle { joint: 2, gain: 0.1 });
    for row in &small(six_axis(), gain).run().rows {
        let (read, acting) = (Vector6::from(row.wrench), Vector6::from(row.acting));
        assert!((read - acting * (1.0 + 0.1 * row.q[1])).norm() < 1e-12 * acting.norm());
    }
}

#[test]
fn a_link_grows_along_itself() {
    let growth = Hidden::Outside(Outside::LinkGrowth { link: 2, per_kelvin: 23e-6 });
    let run = Scenario { unloaded_first: true, ..small(rigid(), growth) }.run();
    for row in &run.rows {
        let began = 60.0 * (row.visit + 1) as f64;
        let warm = row.temperature - (21.0 + 4.0 * (1.0 - (-began / 7200.0).exp()));
        // The upper arm, from joint 2 to joint 3.
        let (level, up) = (row.q[1].cos(), -row.q[1].sin());
        let along = Vector3::new(row.q[0].cos() * level, row.q[0].sin() * level, up);
        assert_near(vector(row.displacement), along * (1.25 * 23e-6 * warm), 1e-12);
    }
}

#[test]
fn outliers_are_as_many_and_as_far_as_said() {
    let wild = Hidden::Outliers { share: 0.05, size: 1e-4 };
    let run = Scenario { poses: 200, ..small(rigid(), wild) }.run();
    let off: Vec<f64> = run.rows.iter().map(|row| vector(row.displacement).norm()).filter(|off| *off > 0.0).collect();
    // 2000 rows: 100 +- 10.
    assert!((60..140).contains(&off.len()), "{}", off.len());
    assert!(off.iter().all(|off| (0.5e-4..1.5e-4).contains(off)));
}
