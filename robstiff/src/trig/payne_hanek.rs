//! Angles without their whole turns, however large they are.
//!
//! An angle is its mantissa, a whole number, times a power of two. So times 1 / (2 pi) it is
//! a number of turns. The first bits of 1 / (2 pi) make whole turns only, and are left out.
//! As many bits follow as the rest of a turn needs, which is then a whole number (Payne and
//! Hanek, Radian reduction for trigonometric functions, SIGNUM Newsletter 18, 1983).
//!
//! There is no loop, and no index that could be wrong. With and without the standard
//! library, and on every machine, it gives the same bits.

macro_rules! without_turns {
    ($float:ident, $limb:ident, $double:ident, $signed:ident, [$($bits:literal),*]) => {
        /// An angle of at least 1 rad, less the turns nearest to it: at most half a turn, to
        /// two roundings. Of an infinity or a NaN a NaN.
        #[cold]
        #[inline(never)]
        pub(super) fn $float(angle: $float) -> $float {
            /// 1 / (2 pi), behind as many zeros as a limb has bits.
            const TURNS_PER_RADIAN: &[$limb] = &[0, $($bits),*];
            const DIGITS: u32 = $float::MANTISSA_DIGITS - 1;
            /// The exponent of a whole number, as a number of the next larger power of two has it.
            const OF_WHOLE: u32 = DIGITS + $float::MAX_EXP as u32 - 1;

            if !angle.is_finite() {
                return $float::NAN;
            }
            let bits = angle.abs().to_bits();
            let mantissa = (bits & ((1 << DIGITS) - 1)) | (1 << DIGITS);
            // Where the bits begin that make parts of a turn.
            let first = ((bits >> DIGITS) as u32 + $limb::BITS).saturating_sub(OF_WHOLE);
            let limb = |k: usize| {
                let at = (first / $limb::BITS) as usize + k;
                let both = [at, at + 1].map(|at| $double::from(TURNS_PER_RADIAN.get(at).copied().unwrap_or(0)));
                ((((both[0] << $limb::BITS) | both[1]) << (first % $limb::BITS)) >> $limb::BITS) as $limb
            };
            let times = |limb: $limb| $double::from(mantissa) * $double::from(limb);
            let below = times(limb(1)) + (times(limb(2)) >> $limb::BITS);
            // What overflows is whole turns.
            let above = mantissa.wrapping_mul(limb(0)).wrapping_add((below >> $limb::BITS) as $limb);
            let part = ($double::from(above) << $limb::BITS) | $double::from(below as $limb);
            // Of more than half a turn the one that is missing, as the sign says.
            let rest = (part as $signed) as $float * (core::$float::consts::TAU / $double::MAX as $float);
            if angle < 0.0 { -rest } else { rest }
        }
    };
}

// From benches/polynomials/turns.py. No f64 is nearer to a whole turn than 2^-62 of it, no f32
// than 2^-30, so that of 128 and 64 bits at least 66 and 34 are not zero.
without_turns! {
    f64, u64, u128, i128,
    [
        0x28be_60db_9391_054a, 0x7f09_d5f4_7d4d_3770, 0x36d8_a566_4f10_e410, 0x7f94_58ea_f7ae_f158,
        0x6dc9_1b8e_9093_74b8, 0x0192_4bba_8274_6487, 0x3f87_7ac7_2c4a_69cf, 0xba20_8d7d_4bae_d121,
        0x3a67_1c09_ad17_df90, 0x4e64_758e_60d4_ce7d, 0x2721_17e2_ef7e_4a0e, 0xc7fe_25ff_f781_6603,
        0xfbcb_c462_d682_9b47, 0xdb4d_9fb3_c9f2_c26d, 0xd3d1_8fd9_a797_fa8b, 0x5d49_eeb1_faf9_7c5e,
        0xcf41_ce7d_e294_a4ba, 0x9afe_d7ec_47e3_5742, 0x1580_cc11_bf1e_daea
    ]
}
without_turns! {
    f32, u32, u64, i64,
    [
        0x28be_60db, 0x9391_054a, 0x7f09_d5f4, 0x7d4d_3770, 0x36d8_a566, 0x4f10_e410, 0x7f94_58ea, 0xf7ae_f158
    ]
}
