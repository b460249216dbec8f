// `check` prints what each way makes of the first poses, anything else the least
// time of a pass over all poses, in ns a pose. As harness.c does.

use std::hint::black_box;
use std::time::{Duration, Instant};

/// Not a power of two: arrays of such a length fall into the same lines of the cache.
pub const COUNT: usize = 1008;
const CHECKED: usize = 64;

/// Poses all over the workspace.
pub fn poses<const N: usize>() -> Vec<[f64; N]> {
    (0..COUNT).map(|k| std::array::from_fn(|i| 2.0 * f64::sin(1.7 * k as f64 + 2.3 * i as f64))).collect()
}

/// A way (robot, quantity, name) to compute one pose after the other.
pub fn one<Q, const M: usize>(way: [&str; 3], poses: &[Q], one: impl Fn(&Q, &mut [f64; M])) {
    let mut results = vec![[0.0; M]; COUNT];
    // The compiler must not see which function it is: every peer is called once a pose.
    let one: &dyn Fn(&Q, &mut [f64; M]) = black_box(&one);
    all(
        way,
        &mut results,
        |results| poses.iter().zip(results).for_each(|(q, out)| one(q, out)),
        |results, k| results[k].to_vec(),
    );
}

/// Whether results are checked and nothing is timed.
pub fn is_check() -> bool {
    std::env::args().nth(1).as_deref() == Some("check")
}

/// A way to compute all poses, and what of the results belongs to pose `k`.
pub fn all<R>(way: [&str; 3], results: &mut R, mut pass: impl FnMut(&mut R), of: impl Fn(&R, usize) -> Vec<f64>) {
    let mut numbers = Vec::new();
    if is_check() {
        pass(results);
        numbers.extend((0..CHECKED).flat_map(|k| of(results, k)));
    } else {
        let first = Instant::now();
        let mut least = Duration::MAX;
        while first.elapsed() < Duration::from_millis(15) {
            let start = Instant::now();
            pass(results);
            least = least.min(start.elapsed());
            black_box(&mut *results);
        }
        numbers.push(least.as_nanos() as f64 / COUNT as f64);
    }
    let numbers: String = numbers.iter().map(|x| format!("\t{x:e}")).collect();
    println!("{}{numbers}", way.join("\t"));
}
