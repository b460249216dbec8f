//! How fast a force a control keeps up with.

use std::fmt;

use crate::text::significant;

/// Frequencies between which is looked (Hz).
const RANGE: [f64; 2] = [0.1, 1000.0];

/// How near the ends of the last interval are, the higher over the lower.
const NEAR: f64 = 1.02;

/// The frequency (Hz) up to which less than some part of the deviation is left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reach {
    /// That frequency.
    To(f64),
    /// At this one, the lowest that was looked at, it is more already.
    Below(f64),
    /// At this one, the highest that was looked at, it is less still.
    Above(f64),
}

impl Reach {
    /// The frequency (Hz), if it was found.
    pub fn found(self) -> Option<f64> {
        match self {
            Self::To(frequency) => Some(frequency),
            Self::Below(_) | Self::Above(_) => None,
        }
    }

    /// Looks for it, by doubling and halving from a first frequency (Hz). `left` is the part that
    /// is left at a frequency, `affordable` whether anybody would wait for that.
    pub fn of(part: f64, first: f64, affordable: impl Fn(f64) -> bool, left: impl Fn(f64) -> f64) -> Self {
        let [lowest, highest] = RANGE;
        let (mut low, mut high) = (first, first);
        if left(first) < part {
            loop {
                if high >= highest {
                    return Self::Above(high);
                }
                low = high;
                high = (2.0 * high).min(highest);
                if left(high) >= part {
                    break;
                }
            }
        } else {
            loop {
                let next = (0.5 * low).max(lowest);
                if low <= lowest || !affordable(next) {
                    return Self::Below(low);
                }
                high = low;
                low = next;
                if left(low) < part {
                    break;
                }
            }
        }
        while high > NEAR * low {
            let middle = (low * high).sqrt();
            if left(middle) < part { low = middle } else { high = middle }
        }
        Self::To((low * high).sqrt())
    }
}

impl fmt::Display for Reach {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (sign, frequency) = match *self {
            Self::To(frequency) => ("", frequency),
            Self::Below(frequency) => ("< ", frequency),
            Self::Above(frequency) => ("> ", frequency),
        };
        write!(f, "{sign}{} Hz", significant(frequency, 3))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// More is left the faster the force, in proportion up to a corner (Hz).
    fn reach(corner: f64, first: f64, affordable: impl Fn(f64) -> bool) -> Reach {
        Reach::of(0.5, first, affordable, |frequency| frequency / corner)
    }

    #[test]
    fn it_is_found_from_either_side() {
        for (corner, first) in [(24.0, 1.0), (24.0, 100.0), (0.5, 1.0), (1500.0, 1.0)] {
            let found = reach(corner, first, |_| true).found().expect("within the range");
            assert!((found / (0.5 * corner) - 1.0).abs() < 0.01, "{corner} from {first}: {found}");
        }
    }

    #[test]
    fn the_best_and_the_worst_are_told_apart() {
        assert_eq!(reach(1e6, 1.0, |_| true), Reach::Above(1000.0));
        assert_eq!(reach(1e6, 3000.0, |_| true), Reach::Above(3000.0));
        assert_eq!(reach(1e-6, 1.0, |_| true), Reach::Below(0.1));
        assert_eq!(reach(1e-6, 0.05, |_| true), Reach::Below(0.05));
        assert_eq!(reach(1e-6, 100.0, |frequency| frequency > 20.0), Reach::Below(25.0));
        assert_eq!([Reach::Above(1000.0), Reach::Below(0.1)].map(|reach| reach.to_string()), ["> 1000 Hz", "< 0.1 Hz"]);
    }
}
