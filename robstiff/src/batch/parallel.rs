//! Batches on all cores, in pieces that keep a core busy for some microseconds. Each
//! function panics as its namesake does.
//!
//! ```
//! # #[cfg(feature = "rayon")] {
//! use robstiff::batch::{Grid, parallel};
//!
//! robstiff::robot!("rv130hsc.yaml");
//!
//! let turns: Vec<f64> = (0..100).map(|i| 0.03 * i as f64).collect();
//! let coordinates = [&turns[..], &turns[..50], &[0.5], &[0.0], &[1.2]];
//! let mut tables = vec![0.0; Grid::table_len(&coordinates)];
//! let grid = Grid::new(coordinates, &mut tables);
//! let mut traces = vec![0.0; grid.len()];
//! parallel::translational_trace(&Rv130hsc, grid, &mut traces);
//! # }
//! ```

use core::ops::Range;
use std::sync::Mutex;

use nalgebra::{Matrix6, Vector3, Vector6};

use super::poses::View;
use super::{BLOCK, Float, Poses};
use crate::Robot;

/// Poses in a piece: large against what handing it out costs, and a multiple of what
/// fills blocks and lines of the cache.
const PIECE: usize = 1024;

/// Room for results, which pieces are cut from.
trait Room: Sized + Send {
    /// Whether there is room for so many poses, and no more.
    fn fits(&self, poses: usize) -> bool;

    /// Takes that of the first poses away.
    fn take_first(&mut self, poses: usize) -> Self;
}

/// A result a pose.
impl<R: Send> Room for &mut [R] {
    fn fits(&self, poses: usize) -> bool {
        self.len() == poses
    }

    fn take_first(&mut self, poses: usize) -> Self {
        self.split_off_mut(..poses).expect("there is room for all poses")
    }
}

/// A slice a number.
impl<T: Send, const M: usize> Room for [&mut [T]; M] {
    fn fits(&self, poses: usize) -> bool {
        self.iter().all(|slice| slice.fits(poses))
    }

    fn take_first(&mut self, poses: usize) -> Self {
        self.each_mut().map(|slice| slice.take_first(poses))
    }
}

/// Results that are not kept.
impl Room for () {
    fn fits(&self, _: usize) -> bool {
        true
    }

    fn take_first(&mut self, _: usize) {}
}

/// Runs a function on the poses and the room of each piece; it is told where the piece
/// starts. The calling thread takes pieces, too, and begins before another is awake; it returns
/// when all that were woken have looked whether there is one left.
fn pieces<V: View<T, N>, T: Float, R: Room, const N: usize>(poses: V, results: R, run: impl Fn(usize, V, R) + Sync) {
    let count = poses.count();
    assert!(results.fits(count), "there must be as many results as poses, {count}");
    let left = Mutex::new((0..count, results));
    let next = || {
        let (poses, results) = &mut *left.lock().expect("a thread that has the lock does not panic");
        let piece = poses.start..poses.end.min(poses.start + PIECE);
        poses.start = piece.end;
        (!piece.is_empty()).then(|| (piece.clone(), results.take_first(piece.len())))
    };
    let work = || {
        while let Some((piece, results)) = next() {
            run(piece.start, poses.cut(piece), results);
        }
    };
    rayon::in_place_scope(|scope| {
        for _ in 1..rayon::current_num_threads().min(count.div_ceil(PIECE)) {
            scope.spawn(|_| work());
        }
        work();
    });
}

/// [`compliance`](super::compliance) on all cores.
pub fn compliance<T: Float, const N: usize>(
    robot: &(impl Robot<N> + Sync),
    poses: impl Poses<T, N>,
    compliances: &mut [Matrix6<T>],
) {
    pieces(poses.view(), compliances, |_, poses, results| super::compliance(robot, poses, results));
}

/// [`compliance_triangle`](super::compliance_triangle) on all cores.
pub fn compliance_triangle<T: Float, const N: usize>(
    robot: &(impl Robot<N> + Sync),
    poses: impl Poses<T, N>,
    triangles: &mut [[T; 21]],
) {
    pieces(poses.view(), triangles, |_, poses, results| super::compliance_triangle(robot, poses, results));
}

/// [`compliance_by_entry`](super::compliance_by_entry) on all cores.
pub fn compliance_by_entry<T: Float, const N: usize>(
    robot: &(impl Robot<N> + Sync),
    poses: impl Poses<T, N>,
    entries: [&mut [T]; 21],
) {
    pieces(poses.view(), entries, |_, poses, entries| super::compliance_by_entry(robot, poses, entries));
}

/// [`compliance_blocks`](super::compliance_blocks) on all cores: several may call the
/// function at once, with blocks in any order.
///
/// ```
/// # #[cfg(feature = "rayon")] {
/// use std::sync::atomic::{AtomicUsize, Ordering};
///
/// use robstiff::batch::parallel;
/// use robstiff::nalgebra::SVector;
///
/// robstiff::robot!("rv130hsc.yaml");
///
/// let poses: Vec<_> = (0..5000).map(|i| SVector::from([0.0, -0.5, 0.5, 0.0, 0.001 * i as f64])).collect();
/// // At how many of them is the robot softer than 0.2 um/N along x?
/// let soft = AtomicUsize::new(0);
/// parallel::compliance_blocks(&Rv130hsc, &poses, |range, entries| {
///     let of_block = entries[0][..range.len()].iter().filter(|&&xx| xx > 0.2e-6).count();
///     soft.fetch_add(of_block, Ordering::Relaxed);
/// });
/// assert!(soft.into_inner() > 0);
/// # }
/// ```
pub fn compliance_blocks<T: Float, const N: usize>(
    robot: &(impl Robot<N> + Sync),
    poses: impl Poses<T, N>,
    look: impl Fn(Range<usize>, &[[T; BLOCK]; 21]) + Sync,
) {
    pieces(poses.view(), (), |start, poses, ()| {
        super::compliance_blocks(robot, poses, |block, entries| {
            look(start + block.start..start + block.end, entries);
        });
    });
}

/// [`translational_trace`](super::translational_trace) on all cores.
pub fn translational_trace<T: Float, const N: usize>(
    robot: &(impl Robot<N> + Sync),
    poses: impl Poses<T, N>,
    traces: &mut [T],
) {
    pieces(poses.view(), traces, |_, poses, results| super::translational_trace(robot, poses, results));
}

/// [`directional_compliance`](super::directional_compliance) on all cores.
pub fn directional_compliance<T: Float, const N: usize>(
    robot: &(impl Robot<N> + Sync),
    poses: impl Poses<T, N>,
    direction: &Vector3<T>,
    compliances: &mut [T],
) {
    pieces(poses.view(), compliances, |_, poses, results| {
        super::directional_compliance(robot, poses, direction, results);
    });
}

/// [`deflection`](super::deflection) on all cores.
pub fn deflection<T: Float, const N: usize>(
    robot: &(impl Robot<N> + Sync),
    poses: impl Poses<T, N>,
    wrench: &Vector6<T>,
    deflections: &mut [Vector6<T>],
) {
    pieces(poses.view(), deflections, |_, poses, results| super::deflection(robot, poses, wrench, results));
}

/// [`deflections`](super::deflections) on all cores.
pub fn deflections<T: Float, const N: usize>(
    robot: &(impl Robot<N> + Sync),
    poses: impl Poses<T, N>,
    wrenches: &[Vector6<T>],
    deflections: &mut [Vector6<T>],
) {
    let poses = poses.view();
    assert_eq!(wrenches.len(), poses.count(), "there must be as many wrenches as poses");
    pieces(poses, deflections, |start, poses, results| {
        super::deflections(robot, poses, &wrenches[start..start + results.len()], results);
    });
}
