//! What instructions can do and the compiler does not see.
//!
//! Transposing, which the compiler does number by number, and sines from tables. Gain:
//! `benches/README.md`. Without it, [`Portable`] is what remains.
#![cfg_attr(
    all(feature = "std", target_arch = "x86_64"),
    expect(unsafe_code, reason = "functions for certain instructions are called where the machine has these")
)]

use super::Float;
use super::joints::BLOCK;
use crate::trig;

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
pub struct Portable;

impl Instructions for Portable {
    #[inline(always)]
    fn transpose<T: Float>(self, rows: [&[T; 4]; 4], columns: [&mut [T; 4]; 4]) {
        for (j, column) in columns.into_iter().enumerate() {
            *column = [rows[0][j], rows[1][j], rows[2][j], rows[3][j]];
        }
    }
}

/// Exists only where the machine has AVX2 and FMA: nobody else can make one.
#[cfg(all(feature = "std", target_arch = "x86_64"))]
#[derive(Clone, Copy)]
pub struct Avx2(());

#[cfg(all(feature = "std", target_arch = "x86_64"))]
impl Avx2 {
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    pub fn new() -> Self {
        Self(())
    }
}

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

/// Exists only where the machine has AVX-512: nobody else can make one.
#[cfg(all(feature = "std", target_arch = "x86_64"))]
#[derive(Clone, Copy)]
pub struct Avx512(());

#[cfg(all(feature = "std", target_arch = "x86_64"))]
impl Avx512 {
    #[inline]
    #[target_feature(enable = "avx2,fma,avx512f,avx512dq,avx512vl,avx512bw")]
    pub fn new() -> Self {
        Self(())
    }
}

#[cfg(all(feature = "std", target_arch = "x86_64"))]
impl Instructions for Avx512 {
    #[inline(always)]
    fn transpose<T: Float>(self, rows: [&[T; 4]; 4], columns: [&mut [T; 4]; 4]) {
        // SAFETY: the machine has AVX.
        unsafe { T::transpose(rows, columns) }
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

    use crate::batch::BLOCK;
    use crate::trig::{circle, tables};

    /// Both passes of a module of `trig/circle`.
    macro_rules! by_the_circle {
        ($module:ident) => {
            #[inline(always)]
            unsafe fn shift_each_with_avx2(angles: &[Self; BLOCK], shifted: &mut [Self; BLOCK]) -> bool {
                // SAFETY: the machine has AVX2 and FMA.
                unsafe { circle::$module::shift_each(angles, shifted) }
            }

            #[inline(always)]
            unsafe fn sin_cos_each_with_avx2(
                angles: &[Self; BLOCK],
                sines: &mut [Self; BLOCK],
                cosines: &mut [Self; BLOCK],
            ) {
                // SAFETY: the machine has AVX2 and FMA.
                unsafe { circle::$module::sin_cos_each(angles, sines, cosines) }
            }
        };
    }

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

        by_the_circle!(double);

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

        by_the_circle!(single);
    }
}
