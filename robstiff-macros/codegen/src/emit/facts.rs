//! The methods of `Robot` that state what the description says: all there is to say of
//! one is its entry in [`FACTS`].

use proc_macro2::{Literal, TokenStream};
use quote::{ToTokens, format_ident, quote};
use robstiff_robots::{Convention, Description, DhEntry, Effect, JointKind, Place, Placement};

use super::reader::{Reader, from, number};
use super::signature::Signature;
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
            let compliances: Vec<_> = robot.joints.iter().map(|joint| number(joint.compliance(), reader)).collect();
            from(reader, "SVector", &compliances)
        },
    },
    Fact {
        signature: |n| quote!(fn limits(&self) -> [::core::option::Option<[f64; 2]>; #n]),
        value: |robot, reader| {
            let limits = robot.joints.iter().map(|joint| match joint.limits {
                Some(limits) => {
                    let [low, high] = limits.map(|limit| number(limit, reader));
                    quote!(::core::option::Option::Some([#low, #high]))
                }
                None => quote!(::core::option::Option::None),
            });
            quote!([#(#limits),*])
        },
    },
    Fact {
        signature: |_| quote!(fn effects(&self) -> &[Effect]),
        value: |robot, reader| {
            let effects = robot.effects.iter().map(|each| effect(each, reader));
            quote!(&[#(#effects),*])
        },
    },
    Fact { signature: |_| quote!(fn base(&self) -> Matrix4<f64>), value: |robot, reader| frame(&robot.base, reader) },
    Fact { signature: |_| quote!(fn tool(&self) -> Matrix4<f64>), value: |robot, reader| frame(&robot.tool, reader) },
];

fn frame(placement: &Placement, reader: Reader) -> TokenStream {
    let entries = symbolic::chain::homogeneous(placement).map(|entry| number(entry, reader));
    quote!(Matrix4::new(#(#entries),*))
}

fn effect(effect: &Effect, reader: Reader) -> TokenStream {
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
        let (name, value) = (format_ident!("{}", parameter.name), number(value, reader));
        quote!(#name: #value)
    });
    quote!(Effect::#variant { #place #(#numbers),* })
}
