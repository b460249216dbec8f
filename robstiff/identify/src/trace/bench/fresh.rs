//! Benches from a campaign, and from another with more or less in its catalogue.

use std::cell::{OnceCell, RefCell};
use std::rc::Rc;
use std::string::String;
use std::vec;
use std::vec::Vec;

use super::{Bench, Known};
use crate::campaign::Campaign;
use crate::identify::prepare::Prepared;
use crate::trace::catalogue::{Candidate, LIKELY};
use crate::trace::isolated::Event;
use crate::trace::slip::{Moment, Moments};

/// Moments at which a slip is looked for besides the likeliest, so that the
/// tests know of the search.
const MOMENTS: usize = 8;

impl<'c> Bench<'c> {
    /// The bench of a prepared campaign.
    ///
    /// # Errors
    /// Why not even the description's own model can be fitted.
    pub fn new(campaign: &'c Campaign, prepared: &'c Prepared<'c>) -> Result<Self, String> {
        Self::of(campaign, prepared, true)
    }

    /// The same where the reflector may sit elsewhere, if so.
    ///
    /// # Errors
    /// As for [`new`](Self::new).
    pub fn of(campaign: &'c Campaign, prepared: &'c Prepared<'c>, elsewhere: bool) -> Result<Self, String> {
        let rows = prepared.samples.rows.len();
        let contradicted = prepared.covariance.beyond_doubt();
        let on = (&*prepared.samples, prepared.data.measured_frame);
        let mut bench = Self {
            elsewhere,
            left_out: prepared.left_out.clone(),
            events: contradicted.into_iter().map(|one| Event::contradicted(one, on)).collect(),
            ..Self::bare(campaign, prepared)
        };
        let evenly = |count: usize, before: bool| {
            (1..=count).map(move |k| Moment { row: (k * rows / (count + 1)).clamp(1, rows), before })
        };
        // What the likeliest will be take the first places.
        let moments = evenly(LIKELY, false).chain(evenly(MOMENTS, false)).chain(evenly(MOMENTS, true));
        bench.moments = Moments::alike(&moments.collect::<Vec<Moment>>());
        bench.set_up()?;
        Ok(bench)
    }

    /// One with the same candidates, fresh.
    ///
    /// # Errors
    /// As for [`new`](Self::new).
    pub fn anew(&self) -> Result<Self, String> {
        Self::of(self.campaign, self.prepared, self.elsewhere)
    }

    /// One that judges alike, fresh, in whose catalogue is also what has no name.
    ///
    /// # Errors
    /// As for [`new`](Self::new).
    pub fn widened(&self) -> Result<Self, String> {
        let mut bench = Self { strict: self.strict, by_own_pose: self.by_own_pose, ..self.anew()? };
        bench.wide = true;
        bench.fit_to(&self.base);
        bench.set_up()?;
        Ok(bench)
    }

    /// The same with what has no name in the catalogue, too.
    ///
    /// # Errors
    /// As for [`new`](Self::new).
    pub fn widened_as_it_is(&self) -> Result<Self, String> {
        let mut bench = Self { wide: true, ..self.copy() };
        bench.set_up_again(Candidate::is_nameless, |kept, nameless| [kept, nameless].concat())?;
        Ok(bench)
    }

    /// The same without what has no name.
    #[must_use]
    pub fn narrowed(mut self) -> Self {
        self.wide = false;
        let (nameless, named): (Vec<Candidate>, Vec<Candidate>) =
            self.candidates.iter().cloned().partition(Candidate::is_nameless);
        let variants = nameless.iter().flat_map(|candidate| &candidate.variants);
        if let Some(&first) = variants.flat_map(|variant| &variant.columns).min() {
            self.numbers = self.numbers[..first - self.own.len()].into();
            self.signs = self.signs[..first].into();
        }
        self.candidates = named.into();
        self.forget();
        self
    }

    /// The bench of a prepared campaign with nothing in its catalogue: it fits
    /// the description's own model.
    pub fn bare(campaign: &'c Campaign, prepared: &'c Prepared<'c>) -> Self {
        Self {
            campaign,
            prepared,
            own: prepared.own.iter().map(|number| number.column).collect(),
            base: prepared.seen().into(),
            candidates: Rc::new([]),
            numbers: Rc::new([]),
            signs: prepared.signs().into(),
            invisible: Vec::new(),
            events: Rc::new([]),
            left_out: vec![false; prepared.samples.rows.len()],
            noise: Rc::new(Known::of(prepared)),
            strict: false,
            by_own_pose: false,
            by_own_form: false,
            wide: false,
            elsewhere: true,
            moments: Moments::default(),
            settings: RefCell::default(),
            stored: Rc::default(),
            states: RefCell::default(),
            tests: RefCell::default(),
            readings: OnceCell::new(),
        }
    }
}
