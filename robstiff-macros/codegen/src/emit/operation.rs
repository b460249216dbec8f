//! Operations as code, given the code of their operands.

use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};

use super::reader::{Reader, number};
use crate::angle::Angle;
use crate::op::{Id, Op};

/// How tightly an expression binds.
#[derive(Clone, Copy, PartialEq, PartialOrd)]
pub(super) enum Binding {
    Sum,
    Product,
    Sign,
    Unit,
}

/// Sums, differences, products and negatives of operands that `write` writes for
/// where they stand; nothing for other operations.
pub(super) fn arithmetic(op: Op, write: impl Fn(Id, Binding) -> TokenStream) -> Option<(TokenStream, Binding)> {
    Some(match op {
        Op::Add(a, b) => {
            let (a, b) = (write(a, Binding::Sum), write(b, Binding::Product));
            (quote!(#a + #b), Binding::Sum)
        }
        Op::Sub(a, b) => {
            let (a, b) = (write(a, Binding::Sum), write(b, Binding::Product));
            (quote!(#a - #b), Binding::Sum)
        }
        Op::Mul(a, b) => {
            let (a, b) = (write(a, Binding::Product), write(b, Binding::Sign));
            (quote!(#a * #b), Binding::Product)
        }
        Op::Neg(a) => {
            // A product in parentheses: `x * -a * b` multiplies in another order.
            let a = write(a, Binding::Sign);
            (quote!(-#a), Binding::Sign)
        }
        _ => return None,
    })
}

/// What is called as a method of its first operand; nothing for other operations.
pub(super) fn call(op: Op, write: impl Fn(Id, Binding) -> TokenStream) -> Option<TokenStream> {
    let (method, a, b) = match op {
        Op::Max(a, b) => (quote!(max), a, Some(b)),
        Op::Min(a, b) => (quote!(min), a, Some(b)),
        Op::Sqrt(a) => (quote!(sqrt), a, None),
        Op::Recip(a) => (quote!(recip), a, None),
        _ => return None,
    };
    let (a, b) = (write(a, Binding::Unit), b.map(|b| write(b, Binding::Sum)));
    Some(quote!(#a.#method(#b)))
}

/// What gives a column, of operands that `write` writes as arguments; nothing for
/// other operations.
pub(super) fn column(op: Op, write: impl Fn(Id) -> TokenStream) -> Option<TokenStream> {
    let call = |method: TokenStream, operands: &[Id]| {
        let operands = operands.iter().map(|&id| write(id));
        quote!(T::#method(#(#operands),*))
    };
    Some(match op {
        Op::Column(entries) => {
            let entries = entries.map(write);
            quote!([#(#entries),*])
        }
        Op::Scaled(a, by) => call(quote!(scaled), &[a, by]),
        Op::PlusScaled(a, b, by) => call(quote!(plus_scaled), &[a, b, by]),
        Op::Product(a, b) => call(quote!(product), &[a, b]),
        Op::PlusProduct(a, b, c) => call(quote!(plus_product), &[a, b, c]),
        Op::Cycled(a) => call(quote!(cycled), &[a]),
        Op::Direction(a) => call(quote!(direction), &[a]),
        _ => return None,
    })
}

/// An angle as code: `q[1] + q[2] + T::of(Self::THETA2)`.
pub(super) fn sum(angle: &Angle, reader: Reader) -> TokenStream {
    let mut sum = TokenStream::new();
    for (k, &(joint, factor)) in angle.terms().iter().enumerate() {
        let joint = Literal::usize_unsuffixed(joint);
        if factor < 0 {
            sum.extend(quote!(-));
        } else if k > 0 {
            sum.extend(quote!(+));
        }
        sum.extend(match factor.abs() {
            1 => quote!(q[#joint]),
            factor => {
                let factor = Literal::f64_unsuffixed(f64::from(factor));
                quote!(T::of(#factor) * q[#joint])
            }
        });
    }
    if let Some(parts) = angle.parts() {
        let mut offset = TokenStream::new();
        for (k, part) in parts.iter().enumerate() {
            let name = format_ident!("{}", part.name);
            offset.extend(match (k, part.is_negative) {
                (0, false) => quote!(Self::#name),
                (_, true) => quote!(- Self::#name),
                (_, false) => quote!(+ Self::#name),
            });
        }
        sum.extend(quote!(+ T::of(#offset)));
    } else if angle.offset() != 0.0 {
        let offset = number(angle.offset().abs(), reader);
        let sign = if angle.offset() < 0.0 { quote!(-) } else { quote!(+) };
        sum.extend(quote!(#sign T::of(#offset)));
    }
    sum
}
