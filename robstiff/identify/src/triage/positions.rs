//! Triage of absolute positions. Loads have no part in them but for payloads, so
//! there is one thing to ask of the readings themselves: does the robot come back.

use std::format;
use std::string::String;
use std::vec::Vec;

use nalgebra::Vector3;

use super::{Raw, Unjudged};
use crate::campaign::Positions;
use crate::words::{count, micrometres};

/// The check that makes sense of positions.
pub(super) fn checks(data: &Positions) -> Vec<(&'static str, &'static str, Unjudged)> {
    std::vec![("repeatability", "does the robot come back to where it was?", repeatability(data))]
}

/// What visits of one pose under one payload differ by, in the frame that positions
/// are read in. It has the noise in it and how well the robot comes back, which
/// nobody declares, so that it is told and not judged.
fn repeatability(data: &Positions) -> Unjudged {
    let mut visits: Vec<Visit> = Vec::new();
    for row in &data.rows {
        let same = |visit: &&mut Visit| visit.id == row.visit && visit.payload == row.payload;
        match visits.iter_mut().rev().find(same) {
            Some(visit) => visit.positions.push(row.position.into()),
            None => visits.push(Visit {
                id: row.visit,
                pose: row.pose,
                payload: row.payload,
                positions: std::vec![row.position.into()],
            }),
        }
    }
    visits.sort_by(|a, b| a.pose.cmp(&b.pose).then(a.payload.total_cmp(&b.payload)));
    let (mut sum, mut freedom) = (0.0, 0);
    for alike in visits.chunk_by(|a, b| a.pose == b.pose && a.payload == b.payload) {
        let middles: Vec<Vector3<f64>> = alike.iter().map(Visit::middle).collect();
        let middle = middles.iter().sum::<Vector3<f64>>() / middles.len() as f64;
        sum += middles.iter().map(|one| (one - middle).norm_squared()).sum::<f64>();
        freedom += middles.len() - 1;
    }
    if freedom == 0 {
        return Err(String::from("several visits of a pose under the same payload"));
    }
    let spread = (sum / (3 * freedom) as f64).sqrt();
    let said = format!(
        "Visits of one pose differ by {} along an axis, the noise of the readings included ({} beyond the first).",
        micrometres(spread),
        count(freedom, "visit")
    );
    Ok(Raw {
        statistic: 1e6 * spread,
        unit: "um",
        p_value: None,
        matters_from: 0.0,
        witnesses: freedom,
        said: [said.clone(), said],
    })
}

/// The readings of a visit under one payload.
struct Visit {
    id: usize,
    pose: usize,
    payload: f64,
    positions: Vec<Vector3<f64>>,
}

impl Visit {
    fn middle(&self) -> Vector3<f64> {
        self.positions.iter().sum::<Vector3<f64>>() / self.positions.len() as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::PositionRow;

    fn data(rows: &[(usize, usize, f64)]) -> Positions {
        let row = |(i, &(pose, visit, x)): (usize, &(usize, usize, f64))| PositionRow {
            line: i + 2,
            pose,
            visit,
            time: None,
            temperature: None,
            q: std::vec![0.0],
            position: [x, 0.0, 0.0],
            payload: 0.0,
        };
        Positions {
            payload_at: [0.0; 3],
            measured_at: [0.0; 3],
            poses: Vec::new(),
            visits: Vec::new(),
            rows: rows.iter().enumerate().map(row).collect(),
        }
    }

    /// Readings within a visit do not tell how well the robot comes back; visits do.
    #[test]
    fn visits_tell_and_readings_do_not() {
        let same_visit = data(&[(0, 0, 1.0), (0, 0, 2.0), (1, 1, 5.0)]);
        assert_eq!(
            repeatability(&same_visit).map(|_| ()),
            Err("several visits of a pose under the same payload".into())
        );
        let two = data(&[(0, 0, 1.0), (0, 0, 3.0), (0, 1, 4.0), (1, 2, 9.0)]);
        let found = repeatability(&two).unwrap_or_else(|_| unreachable!("two visits of pose 0"));
        // Middles at 2 and 4: 1 + 1 over one visit more, three axes.
        assert!((found.statistic * 1e-6 - (2.0_f64 / 3.0).sqrt()).abs() < 1e-12 && found.witnesses == 1);
    }
}
