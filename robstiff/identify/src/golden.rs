//! The golden section: where a function of one number is least, two looks at a time.

/// The larger part of a stretch over the whole.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// The two places inside a stretch that divide it so, the lower one first. Once one end has
/// moved to one of them, the other is one of the two of what is left.
pub(crate) fn inner(from: f64, to: f64) -> [f64; 2] {
    [to - GOLDEN * (to - from), from + GOLDEN * (to - from)]
}

/// The middle of what is left of a stretch when it is not longer than `fine`, in which a
/// function that falls and then rises is least.
pub(crate) fn least(low: f64, high: f64, fine: f64, of: impl Fn(f64) -> f64) -> f64 {
    let (mut low, mut high) = (low, high);
    let [mut left, mut right] = inner(low, high);
    let (mut of_left, mut of_right) = (of(left), of(right));
    while high - low > fine {
        if of_left < of_right {
            (high, right, of_right) = (right, left, of_left);
            left = inner(low, high)[0];
            of_left = of(left);
        } else {
            (low, left, of_left) = (left, right, of_right);
            right = inner(low, high)[1];
            of_right = of(right);
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_least_is_found_inside_and_at_an_end() {
        for (least_at, expected) in [(1.3, 1.3), (-5.0, 0.0), (9.0, 4.0)] {
            let found = least(0.0, 4.0, 1e-3, |x| (x - least_at) * (x - least_at));
            assert!((found - expected).abs() <= 1e-3, "{found}");
        }
    }

    #[test]
    fn a_place_serves_twice() {
        let [low, high] = inner(2.0, 5.0);
        assert!((inner(2.0, high)[1] - low).abs() < 1e-15 && (inner(low, 5.0)[0] - high).abs() < 1e-15);
    }
}
