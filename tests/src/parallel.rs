//! Work on several threads.

use std::thread;

/// What a function makes of each item, in order, by so many threads.
///
/// # Panics
/// Where the function does.
pub fn each<T: Sync, V: Send>(items: &[T], jobs: usize, of: impl Fn(&T) -> V + Sync) -> Vec<V> {
    let part = items.len().div_ceil(jobs.max(1)).max(1);
    let of = &of;
    thread::scope(|scope| {
        let threads: Vec<_> =
            items.chunks(part).map(|items| scope.spawn(move || items.iter().map(of).collect::<Vec<V>>())).collect();
        threads.into_iter().flat_map(|thread| thread.join().expect("no thread panics")).collect()
    })
}
