//! The methods of `Robot` that state what the description says: all there is to say of
//! one is its entry in [`FACTS`].

use proc_macro2::{Literal, TokenStream};
use quote::{ToTokens, format_ident, quote};
use robstiff_robots::{Convention, Description, DhEntry, Effect, JointKind, Place, Placement};

use super::Signature;
use super::body::Reader;
use crate::symbolic;

/// A method that states a fact.
pub(super) struct Fact {
    /// The method's signature.
    pub signature: Signature,
    /// What it returns.
    pub value: fn(&Description, Reader) -> TokenStream,
}

/// Those of every robot, in the order of the trait.
pub(super) const FACTS: [Fact; 8] = [
    Fact { signature: |_| quote!(fn name(&self) -> &str), value: |robot, _| robot.name.to_token_stream() },
    Fact {
        signature: |_| quote!(fn convention(&self) -> Convention),
        value: |robot, _| match robot.convention {
            Convention::Standard => quote!(Convention::Standard),
            Convention::Modified => quote!(Convention::Modified),
        },
    },
    Fact {
        signature: |n| quote!(fn joint_kinds(&self) -> [JointKind; #n]),
        value: |robot, _| {
            let kinds = robot.joints.iter().map(|joint| match joint.kind {
                JointKind::Revolute => quote!(JointKind::Revolute),
                JointKind::Prismatic => quote!(JointKind::Prismatic),
            });
            quote!([#(#kinds),*])
        },
    },
    Fact {
        signature: |n| quote!(fn joint_compliance(&self) -> SVector<f64, #n>),
        value: |robot, reader| {
            let compliances: Vec<_> = robot.joints.iter().map(|joint| number(joint.compliance())).collect();
            from(reader, "SVector", &compliances)
        },
    },
    Fact {
        signature: |n| quote!(fn limits(&self) -> [::core::option::Option<[f64; 2]>; #n]),
        value: |robot, _| {
            let limits = robot.joints.iter().map(|joint| match joint.limits.map(|limits| limits.map(number)) {
                Some([low, high]) => quote!(::core::option::Option::Some([#low, #high])),
                None => quote!(::core::option::Option::None),
            });
            quote!([#(#limits),*])
        },
    },
    Fact {
        signature: |_| quote!(fn effects(&self) -> &[Effect]),
        value: |robot, _| {
            let effects = robot.effects.iter().map(effect);
            quote!(&[#(#effects),*])
        },
    },
    Fact { signature: |_| quote!(fn base(&self) -> Matrix4<f64>), value: |robot, _| frame(&robot.base) },
    Fact { signature: |_| quote!(fn tool(&self) -> Matrix4<f64>), value: |robot, _| frame(&robot.tool) },
];

fn frame(placement: &Placement) -> TokenStream {
    let entries = symbolic::chain::homogeneous(placement).map(number);
    quote!(Matrix4::new(#(#entries),*))
}

fn effect(effect: &Effect) -> TokenStream {
    let (variant, field) = effect.variant();
    let variant = format_ident!("{variant}");
    let index = Literal::usize_unsuffixed;
    let place = match effect.place() {
        Place::Joint(number) | Place::Link(number) => index(number).to_token_stream(),
        Place::Joints([i, j]) => {
            let (i, j) = (index(i), index(j));
            quote!([#i, #j])
        }
        Place::Entry(entry) => {
            let row = index(entry.row());
            match entry {
                DhEntry::A(_) => quote!(DhEntry::A(#row)),
                DhEntry::Alpha(_) => quote!(DhEntry::Alpha(#row)),
                DhEntry::D(_) => quote!(DhEntry::D(#row)),
                DhEntry::Theta(_) => quote!(DhEntry::Theta(#row)),
            }
        }
        Place::Base | Place::Tool | Place::Robot => TokenStream::new(),
    };
    let place = field.map(|field| {
        let field = format_ident!("{field}");
        quote!(#field: #place,)
    });
    let numbers = effect.parameters().map(|(parameter, value)| {
        let (name, value) = (format_ident!("{}", parameter.name), number(value));
        quote!(#name: #value)
    });
    quote!(Effect::#variant { #place #(#numbers),* })
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

/// A number as one would write it: `-0.41`, `2.97e-7`.
pub(super) fn number(value: f64) -> TokenStream {
    let magnitude = value.abs();
    let text = if magnitude != 0.0 && !(1e-4..1e7).contains(&magnitude) {
        format!("{magnitude:e}")
    } else {
        format!("{magnitude:?}")
    };
    let literal: Literal = text.parse().expect("a float prints as a literal");
    if value < 0.0 { quote!(-#literal) } else { quote!(#literal) }
}
