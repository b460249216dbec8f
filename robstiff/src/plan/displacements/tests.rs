//! What visits tell, against what visits told.

use std::vec::Vec;

use super::Adapter;
use crate::campaign::Frame;
use crate::campaign::made::{Plan, displacements};
use crate::identify::prepare::Prepared;
use crate::plan::regressors::{Regressors, Visit};
use crate::trace::{Options, trace};

/// The visits of a campaign, proposed again, tell as much as they did, whether the rows of a
/// visit share an unloaded reading or each has its own, and whatever the noise of each axis.
#[test]
fn the_same_visits_again_tell_the_same() {
    let alike = Plan::new(5);
    let rotations = Some([3e-5, 3e-5, 6e-5]);
    for plan in [
        Plan { shares_unloaded: false, ..alike.clone() },
        Plan { noise: [5e-6, 1e-5, 2e-5], measured_frame: Frame::Tool, ..alike.clone() },
        Plan { rotation_noise: rotations, ..alike },
    ] {
        let shares_unloaded = plan.shares_unloaded;
        let campaign = plan.run();
        let prepared = Prepared::new(&campaign).expect("displacements");
        assert!(shares_unloaded == (prepared.covariance.shared > 0.5));
        let options = Options { draws: 99, ..Options::default() };
        let traced = trace(&campaign, &options, &|_| {}).expect("every joint is seen");
        let (adapter, _) = Adapter::new(&campaign, &prepared, &traced, &[]).expect("a model");
        let mut visits: Vec<Visit> = Vec::new();
        let mut last = None;
        for row in &displacements(&campaign).rows {
            if last.replace(row.visit) != Some(row.visit) {
                visits.push(Visit { q: row.q.clone(), loads: Vec::new() });
            }
            visits.last_mut().expect("it has just been begun").loads.push(row.wrench);
        }
        let known = adapter.known();
        let again = adapter.information(&visits, None).into_iter().fold(0.0 * &known, |sum, visit| sum + visit);
        for k in 0..known.nrows() {
            let ratio = again[(k, k)] / known[(k, k)];
            assert!((ratio - 1.0).abs() < 1e-9, "shared: {shares_unloaded}, column {k}: {ratio}");
        }
    }
}
