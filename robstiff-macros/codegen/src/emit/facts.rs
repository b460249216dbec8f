//! What a description states, as the bodies of methods that return it.

use proc_macro2::{Literal, TokenStream};
use quote::{ToTokens, format_ident, quote};
use robstiff_robots::{Convention, Description, DhEntry, Effect, JointKind, Place};

use crate::symbolic;

/// The methods that state facts of the description, in the order of the trait.
pub(super) fn facts(robot: &Description) -> Vec<TokenStream> {
    let name = &robot.name;
    let convention = match robot.convention {
        Convention::Standard => quote!(Convention::Standard),
        Convention::Modified => quote!(Convention::Modified),
    };
    let kinds = robot.joints.iter().map(|joint| match joint.kind {
        JointKind::Revolute => quote!(JointKind::Revolute),
        JointKind::Prismatic => quote!(JointKind::Prismatic),
    });
    let compliances = robot.joints.iter().map(|joint| number(joint.compliance()));
    let limits = robot.joints.iter().map(|joint| match joint.limits {
        Some([low, high]) => {
            let (low, high) = (number(low), number(high));
            quote!(::core::option::Option::Some([#low, #high]))
        }
        None => quote!(::core::option::Option::None),
    });
    let effects = robot.effects.iter().map(effect);
    let placement = |placement| {
        let entries = symbolic::chain::homogeneous(placement).map(number);
        quote!(Matrix4::new(#(#entries),*))
    };
    let (base, tool) = (placement(&robot.base), placement(&robot.tool));
    vec![
        quote!(#name),
        convention,
        quote!([#(#kinds),*]),
        quote!(SVector::from([#(#compliances),*])),
        quote!([#(#limits),*]),
        quote!(&[#(#effects),*]),
        base,
        tool,
    ]
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
