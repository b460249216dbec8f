//! Whom code is written for, and how numbers and lists of them read there.

use proc_macro2::{Literal, TokenStream};
use quote::{ToTokens, format_ident, quote};

/// Whom the code is for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Reader {
    /// The compiler: products and sums are fused.
    Compiler,
    /// People: plain operators, and the remarks of the algorithms as
    /// statements that the text form turns into comments.
    Person,
}

/// A vector or matrix from a list. The compiler is told which `from` is meant: a trait of the
/// user's may have one for all types.
pub(super) fn from(reader: Reader, kind: &str, entries: &[TokenStream]) -> TokenStream {
    let kind = format_ident!("{kind}");
    match reader {
        Reader::Compiler => quote!(::core::convert::From::from([#(#entries),*])),
        Reader::Person => quote!(#kind::from([#(#entries),*])),
    }
}

/// What Clippy's `approx_constant` looks for.
#[rustfmt::skip]
const KNOWN: [f64; 19] = {
    use core::f64::consts::*;
    [
        E, FRAC_1_PI, FRAC_1_SQRT_2, FRAC_2_PI, FRAC_2_SQRT_PI, FRAC_PI_2, FRAC_PI_3, FRAC_PI_4, FRAC_PI_6, FRAC_PI_8,
        LN_2, LN_10, LOG10_2, LOG10_E, LOG2_10, LOG2_E, PI, SQRT_2, TAU,
    ]
};

/// A number as one would write it: `-0.41`, `2.97e-7`. A limit of 180 degrees is no misspelt
/// pi, for which Clippy takes it also in what macros expand to; an `allow` is an error
/// there if the user's crate forbids the lint, so the compiler gets its bits.
pub(super) fn number(value: f64, reader: Reader) -> TokenStream {
    let magnitude = value.abs();
    let text = if magnitude != 0.0 && !(1e-4..1e7).contains(&magnitude) {
        format!("{magnitude:e}")
    } else {
        format!("{magnitude:?}")
    };
    // A shorter one is nobody's pi.
    let is_like = |known: &f64| text.len() > 3 && (magnitude / known - 1.0).abs() < 2e-3;
    let magnitude = if reader == Reader::Compiler && KNOWN.iter().any(is_like) {
        let bits = Literal::u64_unsuffixed(magnitude.to_bits());
        quote!(::core::primitive::f64::from_bits(#bits))
    } else {
        text.parse::<Literal>().expect("a float prints as a literal").to_token_stream()
    };
    if value < 0.0 { quote!(-#magnitude) } else { magnitude }
}
