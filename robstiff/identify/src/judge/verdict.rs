//! The conclusion, and why.

use core::fmt;

/// What a tracing came to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Nothing is missing: no effect is named.
    Adequate,
    /// Effects are named, and the rest is noise.
    Explained,
    /// Effects are named, and more may be missing.
    Partial,
    /// Something is missing, and no effect passes: none is named.
    Unexplained,
    /// The data cannot tell.
    Insufficient,
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Adequate => "adequate",
            Self::Explained => "explained",
            Self::Partial => "partial",
            Self::Unexplained => "unexplained",
            Self::Insufficient => "insufficient",
        })
    }
}

/// What a verdict is reached from.
#[derive(Clone, Copy, Debug)]
pub struct Evidence<'a> {
    /// How many effects are named.
    pub named: usize,
    /// Full names of what is suspected besides.
    pub suspected: &'a [String],
    /// What has no name and looks like this, each as a noun for a sentence.
    pub looks_like: &'a [String],
    /// The probability that nothing is there.
    pub nothing: f64,
    /// The probability that a discrepancy is left.
    pub discrepancy: f64,
    /// What the model leaves over the noise, where that is known independently of the model.
    pub over_noise: Option<f64>,
}

use super::thresholds::{ABOVE_NOISE, MOST_NAMES};

/// The verdict, and why in a sentence without its full stop.
pub fn verdict(of: &Evidence<'_>) -> (Verdict, String) {
    let left = of.discrepancy > 0.5;
    let above = of.over_noise.is_some_and(|ratio| ratio > ABOVE_NOISE);
    let more = || -> Option<String> {
        if !of.looks_like.is_empty() {
            return Some(format!(
                "what is left looks like {}, for which the catalogue has no name",
                of.looks_like.join(" and ")
            ));
        }
        if !of.suspected.is_empty() {
            return Some(format!("suspected, but not certain enough to be named: {}", of.suspected.join(", ")));
        }
        if left {
            return Some("poses deviate by more than the noise of their readings".into());
        }
        above.then(|| "what is left is more than the noise".into())
    };
    match (of.named, more()) {
        (0, None) => (Verdict::Adequate, "nothing is missing that these data could show".into()),
        (0, Some(why)) => (Verdict::Unexplained, why),
        (_, Some(why)) => (Verdict::Partial, why),
        (named, None) if named > MOST_NAMES => {
            (Verdict::Partial, format!("{named} effects at once are more than these data can vouch for"))
        }
        (_, None) if of.over_noise.is_none() => (
            Verdict::Partial,
            "the noise of the readings is known from the model only: declare it, or repeat loads within a visit".into(),
        ),
        _ => (Verdict::Explained, "what the named effects leave looks like noise".into()),
    }
}
