//! How much a count says.

/// The interval that has the probability behind `right` of `all` in it with 95 %
/// confidence, at least (Clopper and Pearson).
pub fn interval(right: usize, all: usize) -> [f64; 2] {
    let low = if right == 0 { 0.0 } else { solve(|p| 1.0 - at_most(right - 1, all, p) < 0.025) };
    let high = if right >= all { 1.0 } else { solve(|p| at_most(right, all, p) > 0.025) };
    [low, high]
}

/// The fewest of `all` that is no proof, at the level `level`, that the
/// probability is below `claimed`.
pub fn fewest(all: usize, claimed: f64, level: f64) -> usize {
    (0..=all).find(|&count| at_most(count, all, claimed) > level).unwrap_or(all)
}

/// The probability of at most `count` of `all` with probability `p` each.
pub fn at_most(count: usize, all: usize, p: f64) -> f64 {
    if p <= 0.0 || count >= all {
        return 1.0;
    }
    if p >= 1.0 {
        return 0.0;
    }
    let (mut log, mut sum) = (all as f64 * (-p).ln_1p(), 0.0);
    for k in 0..=count {
        sum += log.exp();
        log += ((all - k) as f64 / (k + 1) as f64).ln() + p.ln() - (-p).ln_1p();
    }
    sum.min(1.0)
}

/// The largest probability that `holds`, which is true from 0 to it.
fn solve(holds: impl Fn(f64) -> bool) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if holds(middle) { low = middle } else { high = middle }
    }
    low
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_are_those_of_tables() {
        let near = |found: [f64; 2], expected: [f64; 2]| {
            assert!(found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 5e-4), "{found:?}");
        };
        near(interval(0, 10), [0.0, 0.3085]);
        near(interval(8, 10), [0.4439, 0.9748]);
        near(interval(10, 10), [0.6915, 1.0]);
        assert_eq!(interval(0, 0), [0.0, 1.0]);
    }

    #[test]
    fn fewest_is_at_the_level() {
        // Of 20 with 95 % each: P(X <= 15) = 0.0026, P(X <= 14) = 0.0003.
        assert_eq!((fewest(20, 0.95, 1e-3), fewest(20, 0.95, 5e-3)), (15, 16));
    }
}
