//! The conclusion, and why.

use core::fmt;

use super::thresholds::{ABOVE_NOISE, MOST_NAMES, MOST_OUTLYING};
use crate::words::and;

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
    /// The share of rows that are named as outlying (1).
    pub outlying: f64,
    /// Full names of what is suspected.
    pub suspected: &'a [String],
    /// What has no name and looks like this, each as a noun for a sentence.
    pub looks_like: &'a [String],
    /// The lines of rows that are far off, of which the data do not tell whether they belong to the others.
    pub far_off: &'a [usize],
    /// The probability that a discrepancy is left.
    pub discrepancy: f64,
    /// What the model leaves over the noise, where that is known independently of the model.
    pub over_noise: Option<OverNoise>,
}

/// What a model leaves against a noise that is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OverNoise {
    /// One over the other.
    pub ratio: f64,
    /// What this may well be by chance.
    pub by_chance: f64,
}

/// The verdict, and why in a sentence without its full stop.
pub fn verdict(of: &Evidence<'_>) -> (Verdict, String) {
    let left = of.discrepancy > 0.5;
    let above = of.over_noise.is_some_and(|of| of.ratio > ABOVE_NOISE.max(of.by_chance));
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
        if of.outlying > MOST_OUTLYING {
            return Some("more readings do not belong to the others than single mistakes would make".into());
        }
        if let Some(last) = of.far_off.last() {
            let lines: Vec<String> = of.far_off.iter().map(usize::to_string).collect();
            let is = match lines.len() {
                1 => format!("line {last} is"),
                _ => format!("lines {} are", and(&lines)),
            };
            return Some(format!("{is} off by far more than the others: mistakes, or something that only these show"));
        }
        if left {
            return Some("poses deviate by more than the noise of their readings".into());
        }
        above.then(|| "what is left is more than the noise".into())
    };
    let is_none = of.named == 0 && of.outlying == 0.0;
    match (of.named, more()) {
        (_, None) if is_none => (Verdict::Adequate, "nothing is missing that these data could show".into()),
        (_, Some(why)) if is_none => (Verdict::Unexplained, why),
        (_, Some(why)) => (Verdict::Partial, why),
        (named, None) if named > MOST_NAMES => {
            (Verdict::Partial, format!("{named} effects at once are more than these data can vouch for"))
        }
        (_, None) if of.over_noise.is_none() => {
            (Verdict::Partial, "the noise is known from the model only: declare it, or repeat readings".into())
        }
        _ => (Verdict::Explained, "what the named effects leave looks like noise".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NOTHING: Evidence<'static> = Evidence {
        named: 0,
        outlying: 0.0,
        suspected: &[],
        looks_like: &[],
        far_off: &[],
        discrepancy: 0.0,
        over_noise: Some(OverNoise { ratio: 1.0, by_chance: 1.0 }),
    };

    #[test]
    fn outlying_readings_are_something() {
        assert_eq!(verdict(&NOTHING).0, Verdict::Adequate);
        assert_eq!(verdict(&Evidence { outlying: 0.01, ..NOTHING }).0, Verdict::Explained);
        assert_eq!(verdict(&Evidence { outlying: 0.08, ..NOTHING }).0, Verdict::Partial);
        assert_eq!(verdict(&Evidence { outlying: 0.01, over_noise: None, ..NOTHING }).0, Verdict::Partial);
    }

    /// What is far off is something, whether the noise is known or not.
    #[test]
    fn nothing_is_not_all_where_rows_are_far_off() {
        let far = |over_noise| verdict(&Evidence { far_off: &[2, 9], over_noise, ..NOTHING });
        assert_eq!(far(None).0, Verdict::Unexplained);
        assert_eq!(far(NOTHING.over_noise).0, Verdict::Unexplained);
        assert!(far(None).1.starts_with("lines 2 and 9 are off by far more"), "{}", far(None).1);
    }

    /// Ten repetitions know a noise to no better than half of it.
    #[test]
    fn what_few_repetitions_say_is_uncertain() {
        let over =
            |ratio, by_chance| verdict(&Evidence { over_noise: Some(OverNoise { ratio, by_chance }), ..NOTHING }).0;
        assert_eq!(over(1.3, 1.0), Verdict::Unexplained);
        assert_eq!(over(1.3, 1.9), Verdict::Adequate);
    }
}
