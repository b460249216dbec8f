//! The golden section: where a function of one number is least, two looks at a time.

/// The larger part of a stretch over the whole.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// The two places inside a stretch that divide it so, the lower one first. Once one end has
/// moved to one of them, the other is one of the two of what is left.
pub(crate) fn inner(from: f64, to: f64) -> [f64; 2] {
    [to - GOLDEN * (to - from), from + GOLDEN * (to - from)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_serves_twice() {
        let [low, high] = inner(2.0, 5.0);
        assert!((inner(2.0, high)[1] - low).abs() < 1e-15 && (inner(low, 5.0)[0] - high).abs() < 1e-15);
    }
}
