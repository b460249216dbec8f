//! All parameters side by side, with the forms of all candidates.

use std::collections::BTreeMap;

use crate::effects::Candidate;
use crate::model::Parameter;

/// The parameters of a campaign, a column each.
pub struct Layout {
    /// The parameters.
    pub parameters: Vec<Parameter>,
    /// The name of each, which stays the same when candidates are offered again.
    pub keys: Vec<String>,
    /// So many of them come first and are not fitted: what a description declares of the kinematics.
    pub fixed: usize,
    /// So many behind these are always fitted.
    pub always: usize,
    /// The candidates.
    pub candidates: Vec<Candidate>,
    /// The forms of all candidates.
    pub forms: Vec<Columns>,
}

/// A form by its columns.
#[derive(Clone, Debug)]
pub struct Columns {
    /// The candidate.
    pub candidate: usize,
    /// Which of its forms.
    pub form: usize,
    /// Its columns.
    pub columns: Vec<usize>,
    /// The logarithm of the form's share in the candidate's prior.
    pub log_share: f64,
}

impl Layout {
    /// What is fixed, what is always fitted, and candidates.
    pub fn new(fixed: Vec<Parameter>, always: Vec<Parameter>, candidates: Vec<Candidate>) -> Self {
        let mut layout = Self {
            keys: Vec::new(),
            fixed: fixed.len(),
            always: always.len(),
            parameters: Vec::new(),
            candidates: Vec::new(),
            forms: Vec::new(),
        };
        for (k, parameter) in fixed.into_iter().chain(always).enumerate() {
            layout.keys.push(format!("{k}/{}", parameter.name));
            layout.parameters.push(parameter);
        }
        for (number, candidate) in candidates.iter().enumerate() {
            let first = layout.parameters.len();
            let grid = candidate.forms.iter().filter(|form| !form.between).count().max(1);
            for (which, form) in candidate.forms.iter().enumerate() {
                let columns = form.parameters.iter().enumerate().map(|(k, parameter)| {
                    let key = format!("{}/{}/{k} {}", candidate.name(), form.label, parameter.name);
                    // Forms share what is the same in them, and what was refined may be what the grid has.
                    let is_known =
                        |at: &usize| layout.keys[*at] == key || layout.parameters[*at].term.is(&parameter.term);
                    (first..layout.parameters.len()).find(is_known).unwrap_or_else(|| {
                        layout.keys.push(key);
                        layout.parameters.push(parameter.clone());
                        layout.parameters.len() - 1
                    })
                });
                let columns = columns.collect();
                let log_share = -(grid as f64).ln();
                layout.forms.push(Columns { candidate: number, form: which, columns, log_share });
            }
        }
        layout.candidates = candidates;
        layout
    }

    /// The columns that are always fitted.
    pub fn always(&self) -> core::ops::Range<usize> {
        self.fixed..self.fixed + self.always
    }

    /// The values of all parameters that a map has by their keys; zero for others, and what is
    /// declared of those that are fixed.
    pub fn values(&self, of: &BTreeMap<String, f64>) -> Vec<f64> {
        let value = |(k, key): (usize, &String)| {
            if k < self.fixed { self.parameters[k].mean } else { of.get(key).copied().unwrap_or(0.0) }
        };
        self.keys.iter().enumerate().map(value).collect()
    }

    /// The form of a candidate by both their names.
    pub fn find(&self, candidate: &str, label: &str) -> Option<usize> {
        self.forms.iter().position(|form| {
            let own = &self.candidates[form.candidate];
            own.forms[form.form].label == label && own.name() == candidate
        })
    }

    /// Whether a form is one of an effect, or does exactly the same, by the effect's full name.
    pub fn stands_for(&self, form: usize, name: &str) -> bool {
        let of = &self.forms[form];
        let candidate = &self.candidates[of.candidate];
        candidate.name() == name || candidate.forms[of.form].same.contains(&name)
    }

    /// The names of a form and of its candidate.
    pub fn names(&self, form: usize) -> (String, String) {
        let of = &self.forms[form];
        let candidate = &self.candidates[of.candidate];
        (candidate.name(), candidate.forms[of.form].label.clone())
    }
}
