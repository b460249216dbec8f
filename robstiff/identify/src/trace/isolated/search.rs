//! The search for what is wrong in single visits.

use std::vec::Vec;

use statrs::distribution::{ChiSquared, ContinuousCDF};

use super::{Event, Judge, Known, Scale, Visit, scale};
use crate::identify::covariance::outliers::{FEW, STRICT};
use crate::probability::told;

/// Takes what is wrong out of visits, the worst first; nothing is found where that
/// would be more than a few.
pub(super) fn search(visits: &mut [Visit], strict: bool, tells: f64, known: &Known) -> Vec<Event> {
    let rows: usize = visits.iter().map(|visit| visit.rows.len()).sum();
    let most = (FEW * rows as f64).floor() as usize;
    let too_many = |found: &[Event]| found.iter().map(|event| event.rows.len()).sum::<usize>() > most;
    let search = Search::among(rows, strict, known);
    let mut found: Vec<Event> = Vec::new();
    loop {
        let scale = scale(visits, strict, tells, known.tails);
        if scale.variance.iter().any(|variance| *variance <= 0.0) {
            return found;
        }
        let Some((k, event)) = search.worst(visits, &scale) else {
            search.tell_as_slips(visits, &scale, &mut found);
            return if too_many(&found) { Vec::new() } else { found };
        };
        let visit = &mut visits[k];
        for (i, row) in visit.rows.iter().enumerate() {
            visit.used[i] &= !event.rows.contains(row);
        }
        found.push(event);
        if too_many(&found) {
            return Vec::new();
        }
    }
}

/// What a search in visits holds events against.
struct Search<'k> {
    strict: bool,
    known: &'k Known,
    /// How many events are in question: of each row, that it is wild, and a slip before it.
    hypotheses: f64,
    table: ChiSquared,
    threshold: f64,
}

impl<'k> Search<'k> {
    fn among(rows: usize, strict: bool, known: &'k Known) -> Self {
        let hypotheses = 2.0 * rows as f64;
        let table = ChiSquared::new(3.0).expect("three degrees of freedom");
        let threshold = table.inverse_cdf(1.0 - STRICT / hypotheses);
        Self { strict, known, hypotheses, table, threshold }
    }

    /// The worst event of all visits, with the place of its own.
    fn worst(&self, visits: &[Visit], scale: &Scale) -> Option<(usize, Event)> {
        let of_visit = |k| Some((k, self.asked(visits, k, scale, |judge, visit| judge.worst(visit))?));
        let worst = (0..visits.len()).filter_map(of_visit).max_by(|(_, a), (_, b)| a.0.total_cmp(&b.0));
        worst.map(|(k, event)| (k, self.told(event)))
    }

    /// Tells several events of one visit as the one slip that they are, where it stands up.
    fn tell_as_slips(&self, visits: &mut [Visit], scale: &Scale, found: &mut Vec<Event>) {
        for k in 0..visits.len() {
            let is_of_it = |event: &Event, visit: &Visit| visit.rows.contains(&event.rows[0]);
            if found.iter().filter(|event| is_of_it(event, &visits[k])).count() < 2 {
                continue;
            }
            let Some(slip) = self.asked(visits, k, scale, |judge, visit| judge.one_slip(visit)) else { continue };
            let (slip, visit) = (self.told(slip), &mut visits[k]);
            found.retain(|event| !is_of_it(event, visit));
            visit.used = visit.rows.iter().map(|row| !slip.rows.contains(row)).collect();
            found.push(slip);
        }
    }

    /// What a judge says of one of the visits.
    fn asked<T>(
        &self,
        visits: &[Visit],
        k: usize,
        scale: &Scale,
        question: impl FnOnce(&Judge<'_>, &Visit) -> Option<T>,
    ) -> Option<T> {
        let own = |pattern: &[f64]| Some(self.known.by_pose.as_ref()?.noise(visits, k, pattern, scale));
        let judge = Judge { scale, own: &own, strict: self.strict, threshold: self.threshold };
        question(&judge, &visits[k])
    }

    /// An event with its p-value, by its statistic.
    fn told(&self, (statistic, event): (f64, Event)) -> Event {
        Event { p_value: told(self.hypotheses * self.table.sf(statistic)), ..event }
    }
}
