//! The instructions that the machine has.
//!
//! This is the only unsafe code of the crate: a function made for certain
//! instructions may be called only where the machine has them, which is what
//! is looked up right before. Gain: twice the poses in the same time with
//! AVX2, and a third more with AVX-512, for programs that are not built for
//! one machine. Without it, [`Level::Portable`] is what remains.
#![cfg_attr(
    all(feature = "std", target_arch = "x86_64"),
    expect(unsafe_code, reason = "only the machine knows which instructions it has")
)]

use nalgebra::SVector;

use super::quantities::Quantity;
use super::sink::Sink;
use super::{Float, block};
use crate::trig;

/// A set of instructions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Level {
    /// What the crate was built for.
    Portable,
    /// AVX2 and FMA.
    #[cfg(all(feature = "std", target_arch = "x86_64"))]
    Avx2,
    /// AVX-512 for numbers and, for the quadrants, whole numbers.
    #[cfg(all(feature = "std", target_arch = "x86_64"))]
    Avx512,
}

impl Level {
    /// Those that this machine has, the best last.
    pub fn available() -> impl DoubleEndedIterator<Item = Self> {
        #[cfg(all(feature = "std", target_arch = "x86_64"))]
        let (avx2, avx512) = {
            use std::is_x86_feature_detected as has;
            let avx2 = has!("avx2") && has!("fma");
            let avx512 = avx2 && has!("avx512f") && has!("avx512dq") && has!("avx512vl") && has!("avx512bw");
            (avx2.then_some(Self::Avx2), avx512.then_some(Self::Avx512))
        };
        #[cfg(not(all(feature = "std", target_arch = "x86_64")))]
        let (avx2, avx512) = (None, None);
        [Some(Self::Portable), avx2, avx512].into_iter().flatten()
    }
}

/// Computes the quantity at `poses` with the best there is.
///
/// # Panics
/// If there are not as many results as poses.
pub fn run<T, Q, const N: usize, const M: usize>(quantity: &Q, poses: &[SVector<T, N>], sink: &mut impl Sink<T, M>)
where
    T: Float,
    Q: Quantity<T, N, M>,
{
    let best = Level::available().next_back().unwrap_or(Level::Portable);
    run_at(best, quantity, poses, sink);
}

/// Computes the quantity at `poses` with a set of instructions, which must be one
/// of [`Level::available`].
///
/// # Panics
/// If it is not, or if there are not as many results as poses.
pub fn run_at<T, Q, const N: usize, const M: usize>(
    level: Level,
    quantity: &Q,
    poses: &[SVector<T, N>],
    sink: &mut impl Sink<T, M>,
) where
    T: Float,
    Q: Quantity<T, N, M>,
{
    assert!(sink.fits(poses.len()), "there must be as many results as poses, {}", poses.len());
    assert!(Level::available().any(|available| available == level), "the machine has no {level:?}");
    match level {
        Level::Portable => block::run::<T, Q, N, M, { trig::FUSED }>(quantity, poses, sink),
        // SAFETY: AVX2 and FMA are available, the assertion says.
        #[cfg(all(feature = "std", target_arch = "x86_64"))]
        Level::Avx2 => unsafe { avx2(quantity, poses, sink) },
        // SAFETY: the parts of AVX-512 are available, the assertion says.
        #[cfg(all(feature = "std", target_arch = "x86_64"))]
        Level::Avx512 => unsafe { avx512(quantity, poses, sink) },
    }
}

#[cfg(all(feature = "std", target_arch = "x86_64"))]
#[target_feature(enable = "avx2,fma")]
fn avx2<T, Q, const N: usize, const M: usize>(quantity: &Q, poses: &[SVector<T, N>], sink: &mut impl Sink<T, M>)
where
    T: Float,
    Q: Quantity<T, N, M>,
{
    block::run::<T, Q, N, M, true>(quantity, poses, sink);
}

#[cfg(all(feature = "std", target_arch = "x86_64"))]
#[target_feature(enable = "avx2,fma,avx512f,avx512dq,avx512vl,avx512bw")]
fn avx512<T, Q, const N: usize, const M: usize>(quantity: &Q, poses: &[SVector<T, N>], sink: &mut impl Sink<T, M>)
where
    T: Float,
    Q: Quantity<T, N, M>,
{
    block::run::<T, Q, N, M, true>(quantity, poses, sink);
}
