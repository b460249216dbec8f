//! What a description states, as the bodies of methods that return it.

use proc_macro2::{Literal, TokenStream};
use quote::quote;
use robstiff_robots::{Convention, Description, Effect, JointKind};

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
            quote!(Some([#low, #high]))
        }
        None => quote!(None),
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
    let index = Literal::usize_unsuffixed;
    match *effect {
        Effect::TransverseCompliance { joint, value } => {
            let (joint, value) = (index(joint), number(value));
            quote!(Effect::TransverseCompliance { joint: #joint, value: #value })
        }
        Effect::LinkCompliance { link, bending, torsion } => {
            let (link, bending, torsion) = (index(link), number(bending), number(torsion));
            quote!(Effect::LinkCompliance { link: #link, bending: #bending, torsion: #torsion })
        }
        Effect::BaseCompliance { tilt, translation } => {
            let (tilt, translation) = (number(tilt), number(translation));
            quote!(Effect::BaseCompliance { tilt: #tilt, translation: #translation })
        }
        Effect::ToolCompliance { rotation, translation } => {
            let (rotation, translation) = (number(rotation), number(translation));
            quote!(Effect::ToolCompliance { rotation: #rotation, translation: #translation })
        }
        Effect::JointCoupling { joints: [i, j], value } => {
            let (i, j, value) = (index(i), index(j), number(value));
            quote!(Effect::JointCoupling { joints: [#i, #j], value: #value })
        }
        Effect::StiffnessNonlinearity { joint, added, knee } => {
            let (joint, added, knee) = (index(joint), number(added), number(knee));
            quote!(Effect::StiffnessNonlinearity { joint: #joint, added: #added, knee: #knee })
        }
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
