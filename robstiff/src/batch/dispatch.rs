//! The instructions that the machine has.
//!
//! This, with the sines that it calls (`trig/tables.rs`, `trig/circle.rs`), is
//! the only unsafe code of the crate: a function made for certain instructions may be
//! called only where the machine has them, which is what is looked up right before.
//! Gain: twice the poses in the same time with AVX2, and a third more with AVX-512, for
//! programs that are not built for one machine; and a quarter of the time of a triangle
//! by transposing, which the compiler does number by number. Without it,
//! [`Level::Portable`] is what remains.
#![cfg_attr(
    all(feature = "std", target_arch = "x86_64"),
    expect(unsafe_code, reason = "only the machine knows which instructions it has")
)]

use super::block::BLOCK;
use super::quantities::Quantity;
use super::sink::Sink;
use super::source::Source;
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

/// What the instructions of a level can do and the compiler does not see.
pub trait Instructions: Copy {
    /// Writes the transpose of four rows to four columns.
    fn transpose<T: Float>(self, rows: [&[T; 4]; 4], columns: [&mut [T; 4]; 4]);

    /// Sines and cosines of a block of angles. False if some angle is out of the domain
    /// or a NaN: then they mean nothing. `FUSED`: with an instruction that multiplies
    /// and adds.
    #[inline(always)]
    fn sin_cos_each<T: Float, const FUSED: bool>(
        self,
        angles: &[T; BLOCK],
        sines: &mut [T; BLOCK],
        cosines: &mut [T; BLOCK],
    ) -> bool {
        trig::sin_cos_each::<T, FUSED, BLOCK>(angles, sines, cosines)
    }

    /// The same of the angles of all joints that have some.
    #[inline(always)]
    fn sin_cos_all<T: Float, const N: usize, const FUSED: bool>(
        self,
        angles: [Option<&[T; BLOCK]>; N],
        sines: &mut [[T; BLOCK]; N],
        cosines: &mut [[T; BLOCK]; N],
    ) -> bool {
        for joint in 0..N {
            if let Some(angles) = angles[joint]
                && !self.sin_cos_each::<T, FUSED>(angles, &mut sines[joint], &mut cosines[joint])
            {
                return false;
            }
        }
        true
    }
}

/// No more than the compiler sees.
#[derive(Clone, Copy)]
struct Portable;

impl Instructions for Portable {
    #[inline(always)]
    fn transpose<T: Float>(self, rows: [&[T; 4]; 4], columns: [&mut [T; 4]; 4]) {
        for (j, column) in columns.into_iter().enumerate() {
            *column = [rows[0][j], rows[1][j], rows[2][j], rows[3][j]];
        }
    }
}

/// Exists only where the machine has AVX2.
#[cfg(all(feature = "std", target_arch = "x86_64"))]
#[derive(Clone, Copy)]
struct Avx2;

#[cfg(all(feature = "std", target_arch = "x86_64"))]
impl Instructions for Avx2 {
    #[inline(always)]
    fn transpose<T: Float>(self, rows: [&[T; 4]; 4], columns: [&mut [T; 4]; 4]) {
        // SAFETY: the machine has AVX.
        unsafe { T::transpose(rows, columns) }
    }

    #[inline(always)]
    fn sin_cos_all<T: Float, const N: usize, const FUSED: bool>(
        self,
        angles: [Option<&[T; BLOCK]>; N],
        sines: &mut [[T; BLOCK]; N],
        cosines: &mut [[T; BLOCK]; N],
    ) -> bool {
        for joint in 0..N {
            if let Some(angles) = angles[joint]
                // SAFETY: the machine has AVX2 and FMA.
                && !unsafe { T::shift_each_with_avx2(angles, &mut cosines[joint]) }
            {
                return false;
            }
        }
        for joint in 0..N {
            if let Some(angles) = angles[joint] {
                // SAFETY: the machine has AVX2 and FMA.
                unsafe { T::sin_cos_each_with_avx2(angles, &mut sines[joint], &mut cosines[joint]) };
            }
        }
        true
    }
}

/// Exists only where the machine has AVX-512.
#[cfg(all(feature = "std", target_arch = "x86_64"))]
#[derive(Clone, Copy)]
struct Avx512;

#[cfg(all(feature = "std", target_arch = "x86_64"))]
impl Instructions for Avx512 {
    #[inline(always)]
    fn transpose<T: Float>(self, rows: [&[T; 4]; 4], columns: [&mut [T; 4]; 4]) {
        Avx2.transpose(rows, columns);
    }

    #[inline(always)]
    fn sin_cos_each<T: Float, const FUSED: bool>(
        self,
        angles: &[T; BLOCK],
        sines: &mut [T; BLOCK],
        cosines: &mut [T; BLOCK],
    ) -> bool {
        // SAFETY: the machine has AVX-512.
        unsafe { T::sin_cos_each_with_avx512(angles, sines, cosines) }
    }
}

/// Numbers for which that is written by hand, with the vectors of x86-64.
#[expect(private_bounds, reason = "nobody else shall implement it")]
pub trait ByHand: trig::Float {
    /// Writes the transpose of four rows to four columns.
    ///
    /// # Safety
    /// The machine must have AVX.
    #[cfg(all(feature = "std", target_arch = "x86_64"))]
    unsafe fn transpose(rows: [&[Self; 4]; 4], columns: [&mut [Self; 4]; 4]);

    /// The first of two passes to sines and cosines (`trig/circle.rs`): what angles are
    /// looked up by. False if some angle is out of the domain or a NaN.
    ///
    /// # Safety
    /// The machine must have AVX2 and FMA.
    #[cfg(all(feature = "std", target_arch = "x86_64"))]
    unsafe fn shift_each_with_avx2(angles: &[Self; BLOCK], shifted: &mut [Self; BLOCK]) -> bool;

    /// The second one, which finds in the cosines' place what the first one left.
    ///
    /// # Safety
    /// The machine must have AVX2 and FMA.
    #[cfg(all(feature = "std", target_arch = "x86_64"))]
    unsafe fn sin_cos_each_with_avx2(angles: &[Self; BLOCK], sines: &mut [Self; BLOCK], cosines: &mut [Self; BLOCK]);

    /// As [`Instructions::sin_cos_each`] with AVX-512: by polynomials, which for `f32` are
    /// short, or from a table.
    ///
    /// # Safety
    /// The machine must have AVX-512.
    #[cfg(all(feature = "std", target_arch = "x86_64"))]
    #[inline(always)]
    unsafe fn sin_cos_each_with_avx512(
        angles: &[Self; BLOCK],
        sines: &mut [Self; BLOCK],
        cosines: &mut [Self; BLOCK],
    ) -> bool {
        trig::sin_cos_each::<Self, true, BLOCK>(angles, sines, cosines)
    }
}

#[cfg(not(all(feature = "std", target_arch = "x86_64")))]
impl<F: trig::Float> ByHand for F {}

#[cfg(all(feature = "std", target_arch = "x86_64"))]
mod by_hand {
    use core::arch::x86_64::*;

    use crate::batch::block::BLOCK;
    use crate::trig::{circle, tables};

    impl super::ByHand for f64 {
        #[inline]
        #[target_feature(enable = "avx")]
        unsafe fn transpose(rows: [&[Self; 4]; 4], columns: [&mut [Self; 4]; 4]) {
            // SAFETY: each is four numbers.
            let [a, b, c, d] = rows.map(|row| unsafe { _mm256_loadu_pd(row.as_ptr()) });
            let (even, odd) = (_mm256_unpacklo_pd(a, b), _mm256_unpackhi_pd(a, b));
            let (even_below, odd_below) = (_mm256_unpacklo_pd(c, d), _mm256_unpackhi_pd(c, d));
            let transposed = [
                _mm256_permute2f128_pd::<0x20>(even, even_below),
                _mm256_permute2f128_pd::<0x20>(odd, odd_below),
                _mm256_permute2f128_pd::<0x31>(even, even_below),
                _mm256_permute2f128_pd::<0x31>(odd, odd_below),
            ];
            for (column, four) in columns.into_iter().zip(transposed) {
                // SAFETY: each is four numbers.
                unsafe { _mm256_storeu_pd(column.as_mut_ptr(), four) };
            }
        }

        #[inline(always)]
        unsafe fn shift_each_with_avx2(angles: &[Self; BLOCK], shifted: &mut [Self; BLOCK]) -> bool {
            // SAFETY: the machine has AVX2 and FMA.
            unsafe { circle::double::shift_each(angles, shifted) }
        }

        #[inline(always)]
        unsafe fn sin_cos_each_with_avx2(
            angles: &[Self; BLOCK],
            sines: &mut [Self; BLOCK],
            cosines: &mut [Self; BLOCK],
        ) {
            // SAFETY: the machine has AVX2 and FMA.
            unsafe { circle::double::sin_cos_each(angles, sines, cosines) }
        }

        #[inline(always)]
        unsafe fn sin_cos_each_with_avx512(
            angles: &[Self; BLOCK],
            sines: &mut [Self; BLOCK],
            cosines: &mut [Self; BLOCK],
        ) -> bool {
            // SAFETY: the machine has AVX-512.
            unsafe { tables::sin_cos_each(angles, sines, cosines) }
        }
    }

    impl super::ByHand for f32 {
        #[inline]
        #[target_feature(enable = "avx")]
        unsafe fn transpose(rows: [&[Self; 4]; 4], columns: [&mut [Self; 4]; 4]) {
            // SAFETY: each is four numbers.
            let [mut a, mut b, mut c, mut d] = rows.map(|row| unsafe { _mm_loadu_ps(row.as_ptr()) });
            _MM_TRANSPOSE4_PS(&mut a, &mut b, &mut c, &mut d);
            for (column, four) in columns.into_iter().zip([a, b, c, d]) {
                // SAFETY: each is four numbers.
                unsafe { _mm_storeu_ps(column.as_mut_ptr(), four) };
            }
        }

        #[inline(always)]
        unsafe fn shift_each_with_avx2(angles: &[Self; BLOCK], shifted: &mut [Self; BLOCK]) -> bool {
            // SAFETY: the machine has AVX2 and FMA.
            unsafe { circle::single::shift_each(angles, shifted) }
        }

        #[inline(always)]
        unsafe fn sin_cos_each_with_avx2(
            angles: &[Self; BLOCK],
            sines: &mut [Self; BLOCK],
            cosines: &mut [Self; BLOCK],
        ) {
            // SAFETY: the machine has AVX2 and FMA.
            unsafe { circle::single::sin_cos_each(angles, sines, cosines) }
        }
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
        Level::Portable => block::run::<T, Q, _, _, N, M, 1, 1, { trig::FUSED }>(quantity, source, sink, Portable),
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
        block::run::<T, Q, _, _, N, M, 4, 4, true>(quantity, source, sink, Avx2);
    } else {
        block::run::<T, Q, _, _, N, M, 8, 8, true>(quantity, source, sink, Avx2);
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
        block::run::<T, Q, _, _, N, M, WIDE, 4, true>(quantity, source, sink, Avx512);
    } else {
        block::run::<T, Q, _, _, N, M, { 2 * WIDE }, 8, true>(quantity, source, sink, Avx512);
    }
}
