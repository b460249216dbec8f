//! Sines and cosines of four vectors of AVX2 abreast, in the order of these lines.
//!
//! The steps of [`within_domain`](super::within_domain), with the same roundings. Of
//! one vector each step waits for the one before, more than fifty cycles in all, and
//! a processor looks ahead over some hundred instructions: so it should find others'
//! steps there. The compiler, which saves registers, puts one vector behind the other
//! whatever the order in Rust. Here a line is a step of all four:
//!
//! | register | first | then |
//! |---|---|---|
//! | `r` | angle | angle less `k pi/2` |
//! | `s` | `k` | its polynomial, the sine |
//! | `c` | | its polynomial, the cosine |
//! | `z` | | `r^2`, then bits of `k` |
//!
//! The shifted `k`, whose last bits are the quadrant, wait in the place of the cosines.
//! Gain: `benches/README.md`. Without this, [`sin_cos_each`](super::sin_cos_each) is
//! what remains.
#![expect(unsafe_code, reason = "the order of instructions is that of assembly alone")]

use core::arch::asm;

use super::float::{Float, double, places, single};

/// An instruction for each of the four vectors: its name, how its numbers are called
/// there, and its operands, the result first.
#[rustfmt::skip]
macro_rules! four {
    ($($i:tt)+) => { concat!(line!(0 $($i)+), line!(1 $($i)+), line!(2 $($i)+), line!(3 $($i)+)) };
}

macro_rules! line {
    ($vector:tt $name:literal $numbers:literal $result:tt $($operand:tt)*) => {
        concat!($name, $numbers, " ", operand!($vector $result), $(", ", operand!($vector $operand),)* "\n")
    };
}

#[rustfmt::skip]
macro_rules! operand {
    (0 r) => { "ymm0" }; (1 r) => { "ymm1" }; (2 r) => { "ymm2" }; (3 r) => { "ymm3" };
    (0 z) => { "ymm4" }; (1 z) => { "ymm5" }; (2 z) => { "ymm6" }; (3 z) => { "ymm7" };
    (0 s) => { "ymm8" }; (1 s) => { "ymm9" }; (2 s) => { "ymm10" }; (3 s) => { "ymm11" };
    (0 c) => { "ymm12" }; (1 c) => { "ymm13" }; (2 c) => { "ymm14" }; (3 c) => { "ymm15" };
    // The vector's own place in an array.
    ($vector:tt angles) => { concat!("[{angles} + 32 * ", $vector, "]") };
    ($vector:tt sines) => { concat!("[{sines} + 32 * ", $vector, "]") };
    ($vector:tt cosines) => { concat!("[{cosines} + 32 * ", $vector, "]") };
    ($vector:tt strange) => { concat!("[{strange} + 32 * ", $vector, "]") };
    ($vector:tt usual) => { "[{usual}]" };
    // One of `Float::NUMBERS`: so many behind a place.
    ($vector:tt [$place:ident $behind:literal]) => {
        concat!("[{numbers} + {", stringify!($place), "} + 32 * ", $behind, "]")
    };
    ($vector:tt $shift:literal) => { $shift };
}

macro_rules! sin_cos_each {
    (
        $name:ident, $if_available:ident, $float:ident, $bits:ident, $module:ident,
        $lanes:literal lanes,
        numbers: $n:literal, whole numbers: $i:literal, sign: $sign:literal,
        parts but the last: [$($part:literal)*], $last:literal,
        last term: $highest:literal, [$($term:literal)*],
    ) => {
        /// What [`sin_cos_each`](super::sin_cos_each) does, of four whole vectors each time.
        #[inline]
        #[target_feature(enable = "avx2,fma")]
        pub(crate) fn $name<const K: usize>(
            angles: &[$float; K],
            sines: &mut [$float; K],
            cosines: &mut [$float; K],
        ) -> bool {
            const GROUP: usize = 4 * $lanes;
            const {
                assert!(K > 0 && K.is_multiple_of(GROUP), "four whole vectors each time");
                assert!($last + 1 == <$float as Float>::PARTS && $highest + 1 == <$float as Float>::TERMS);
            }
            let (usual, mut strange) = ([$module::QUARTERS.0; $lanes], [[0; $lanes]; 4]);
            // SAFETY: the machine has AVX2 and FMA; all that is written are the sines, the cosines and what is
            // strange, and what is read are these, the angles and constants.
            unsafe {
                asm!(
                    "2:",
                    concat!(
                        // k, and r = x - k pi/2.
                        four!("vmovup" $n r angles),
                        four!("vmovap" $n s [two_over_pi 0]),
                        four!("vfmadd213p" $n s r [shift 0]),
                        four!("vmovup" $n cosines s),
                        four!("vsubp" $n s s [shift 0]),
                        $(four!("vfmadd231p" $n r s [parts $part]),)*
                        four!("vmulp" $n s s [parts $last]),
                        four!("vaddp" $n r r s),
                        // The polynomials of z = r^2, term by term.
                        four!("vmulp" $n z r r),
                        four!("vmovap" $n s [sin $highest]),
                        four!("vmovap" $n c [cos $highest]),
                        $(
                            four!("vfmadd213p" $n s z [sin $term]),
                            four!("vfmadd213p" $n c z [cos $term]),
                        )*
                        // cos r = 1 + z (z C - 1/2) and sin r = r + r z S.
                        four!("vfmadd213p" $n c z [minus_half 0]),
                        four!("vfmadd213p" $n c z [one 0]),
                        four!("vmulp" $n z z r),
                        four!("vfmadd213p" $n s z r),
                        // Beyond the domain, k is too large.
                        four!("vmovup" $n r cosines),
                        four!("vxorp" $n z r usual),
                        four!("vorp" $n z z strange),
                        four!("vmovup" $n strange z),
                        // The last bit of k changes the sign of the sine, then it exchanges the two; the
                        // one before changes both signs.
                        four!("vpsll" $i z r $sign),
                        four!("vxorp" $n s s z),
                        four!("vpsrl" $i r r 1),
                        four!("vpsll" $i r r $sign),
                        four!("vxorp" $n s s r),
                        four!("vxorp" $n c c r),
                        four!("vblendvp" $n r s c z),
                        four!("vblendvp" $n c c s z),
                        four!("vmovup" $n sines r),
                        four!("vmovup" $n cosines c),
                    ),
                    "add {angles}, 128",
                    "add {sines}, 128",
                    "add {cosines}, 128",
                    "dec {groups}",
                    "jnz 2b",
                    groups = inout(reg) K / GROUP => _,
                    angles = inout(reg) angles.as_ptr() => _,
                    sines = inout(reg) sines.as_mut_ptr() => _,
                    cosines = inout(reg) cosines.as_mut_ptr() => _,
                    strange = in(reg) strange.as_mut_ptr(),
                    usual = in(reg) usual.as_ptr(),
                    numbers = in(reg) $module::SPREAD.0.as_ptr(),
                    two_over_pi = const 32 * places::TWO_OVER_PI,
                    shift = const 32 * places::SHIFT,
                    one = const 32 * places::ONE,
                    minus_half = const 32 * places::MINUS_HALF,
                    parts = const 32 * places::PARTS,
                    sin = const 32 * places::sin::<$float>(),
                    cos = const 32 * places::cos::<$float>(),
                    out("ymm0") _, out("ymm1") _, out("ymm2") _, out("ymm3") _,
                    out("ymm4") _, out("ymm5") _, out("ymm6") _, out("ymm7") _,
                    out("ymm8") _, out("ymm9") _, out("ymm10") _, out("ymm11") _,
                    out("ymm12") _, out("ymm13") _, out("ymm14") _, out("ymm15") _,
                    options(nostack),
                );
            }
            strange.iter().flatten().fold(0, |all: $bits, bits| all | bits) & $module::QUARTERS.1 == 0
        }

        /// The same where the machine has AVX2.
        #[cfg(test)]
        pub(crate) fn $if_available<const K: usize>(angles: &[$float; K]) -> Option<([$float; K], [$float; K], bool)> {
            use std::is_x86_feature_detected as has;
            let (mut sines, mut cosines) = ([0.0; K], [0.0; K]);
            let is_usual = (has!("avx2") && has!("fma")).then(|| {
                // SAFETY: the machine has AVX2 and FMA.
                unsafe { $name(angles, &mut sines, &mut cosines) }
            })?;
            Some((sines, cosines, is_usual))
        }
    };
}

sin_cos_each! {
    sin_cos_each_f64, f64_if_available, f64, u64, double, 4 lanes,
    numbers: "d", whole numbers: "q", sign: 63,
    parts but the last: [0], 1,
    last term: 5, [4 3 2 1 0],
}

sin_cos_each! {
    sin_cos_each_f32, f32_if_available, f32, u32, single, 8 lanes,
    numbers: "s", whole numbers: "d", sign: 31,
    parts but the last: [0 1], 2,
    last term: 2, [1 0],
}
