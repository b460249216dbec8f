//! The instructions that the machine has, found at run time.
//!
//! This, with what is done with them (`instructions.rs`, `trig/tables.rs`,
//! `trig/circle.rs`), is the only unsafe code of the crate: a function made for certain
//! instructions may be called only where the machine has them, which is what is looked
//! up right before. Gain: twice the poses in the same time with AVX2, and a third more
//! with AVX-512, for programs that are not built for one machine. Without it,
//! [`Level::Portable`] is what remains.
#![cfg_attr(
    all(feature = "std", target_arch = "x86_64"),
    expect(unsafe_code, reason = "only the machine knows which instructions it has")
)]

use super::Float;
use super::block::{self, Width};
use super::instructions::Portable;
#[cfg(all(feature = "std", target_arch = "x86_64"))]
use super::instructions::{Avx2, Avx512};
use super::quantities::Quantity;
use super::sink::Sink;
use super::source::Source;
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

/// Computes the quantity at all poses of a source with the best there is.
///
/// # Panics
/// If there are not as many results as poses.
pub fn run<T, Q, const N: usize, const M: usize>(quantity: Q, source: impl Source<T, N>, sink: impl Sink<T, M>)
where
    T: Float,
    Q: Quantity<T, N, M>,
{
    let best = Level::available().next_back().unwrap_or(Level::Portable);
    run_at(best, quantity, source, sink);
}

/// Computes the quantity at all poses of a source with a set of instructions,
/// which must be one of [`Level::available`].
///
/// # Panics
/// If it is not, or if there are not as many results as poses.
pub fn run_at<T, Q, const N: usize, const M: usize>(
    level: Level,
    mut quantity: Q,
    mut source: impl Source<T, N>,
    mut sink: impl Sink<T, M>,
) where
    T: Float,
    Q: Quantity<T, N, M>,
{
    let poses = source.poses();
    assert!(sink.fits(poses), "there must be as many results as poses, {poses}");
    assert!(Level::available().any(|available| available == level), "the machine has no {level:?}");
    let (quantity, source, sink) = (&mut quantity, &mut source, &mut sink);
    match level {
        Level::Portable => {
            let width = Width::<1, { trig::FUSED }>;
            block::run(quantity, source, sink, Portable, width, width);
        }
        // SAFETY: AVX2 and FMA are available, the assertion says.
        #[cfg(all(feature = "std", target_arch = "x86_64"))]
        Level::Avx2 => unsafe { avx2(quantity, source, sink) },
        // SAFETY: the parts of AVX-512 are available, the assertion says.
        #[cfg(all(feature = "std", target_arch = "x86_64"))]
        Level::Avx512 => unsafe { avx512(quantity, source, sink) },
    }
}

#[cfg(all(feature = "std", target_arch = "x86_64"))]
#[target_feature(enable = "avx2,fma")]
fn avx2<T, Q, const N: usize, const M: usize>(
    quantity: &mut Q,
    source: &mut impl Source<T, N>,
    sink: &mut impl Sink<T, M>,
) where
    T: Float,
    Q: Quantity<T, N, M>,
{
    if const { size_of::<T>() == size_of::<f64>() } {
        block::run(quantity, source, sink, Avx2::new(), Width::<4, true>, Width::<4, true>);
    } else {
        block::run(quantity, source, sink, Avx2::new(), Width::<8, true>, Width::<8, true>);
    }
}

/// The `f64` of a vector of AVX-512, half of it where the compiler makes them no longer:
/// in programs that are built for a machine with AVX-512 and not one of AMD's, which has
/// SSE4a. Two vectors at once do not stay in the registers there. Gain: by entry 13.5 ns
/// to 8.6.
#[cfg(all(feature = "std", target_arch = "x86_64"))]
const WIDE: usize = if cfg!(all(target_feature = "avx512f", not(target_feature = "sse4a"))) { 4 } else { 8 };

#[cfg(all(feature = "std", target_arch = "x86_64"))]
#[target_feature(enable = "avx2,fma,avx512f,avx512dq,avx512vl,avx512bw")]
fn avx512<T, Q, const N: usize, const M: usize>(
    quantity: &mut Q,
    source: &mut impl Source<T, N>,
    sink: &mut impl Sink<T, M>,
) where
    T: Float,
    Q: Quantity<T, N, M>,
{
    if const { size_of::<T>() == size_of::<f64>() } {
        block::run(quantity, source, sink, Avx512::new(), Width::<WIDE, true>, Width::<4, true>);
    } else {
        block::run(quantity, source, sink, Avx512::new(), Width::<{ 2 * WIDE }, true>, Width::<8, true>);
    }
}
