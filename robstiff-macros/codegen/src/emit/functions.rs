//! The functions that are generated for a robot.

use proc_macro2::{Literal, TokenStream};
use quote::quote;
use robstiff_robots::Description;

use crate::function::Function;
use crate::symbolic::{self, Algorithm, columns};

/// Builds a result from its entries.
type Build = dyn Fn(&[TokenStream]) -> TokenStream;

/// One generated function: what it is called, what its docs say, how its
/// result is put together.
pub(super) struct Generated {
    /// The method of the trait.
    pub name: &'static str,
    /// What it gives, with shape, frame and unit.
    pub doc: &'static str,
    /// The calculation.
    pub function: Function,
    /// The same in columns, where that is less.
    pub in_columns: Option<InColumns>,
    result: Box<Build>,
}

/// A calculation for scalars that compute with columns as with one number.
pub(super) struct InColumns {
    /// The calculation.
    pub function: Function,
    result: Box<Build>,
}

impl InColumns {
    /// The expression that builds the result from columns and entries.
    pub fn result(&self, outputs: &[TokenStream]) -> TokenStream {
        (self.result)(outputs)
    }
}

impl Generated {
    /// The expression that builds the result from its entries.
    pub fn result(&self, entries: &[TokenStream]) -> TokenStream {
        (self.result)(entries)
    }
}

/// All functions of a robot, in the order of the trait; that with a state last,
/// if the robot has one.
pub(super) fn functions(robot: &Description) -> Vec<Generated> {
    let stateful = symbolic::remembers(robot).then(|| stateful(robot));
    stateless(robot).into_iter().chain(stateful).collect()
}

/// The upper triangle of the compliance, by rows.
pub(super) fn compliance_entries(robot: &Description) -> Function {
    Function::of(|g| {
        let entries = symbolic::compliance(g, robot);
        (0..6).flat_map(|i| entries[6 * i + i..6 * (i + 1)].to_vec()).collect()
    })
}

fn stateful(robot: &Description) -> Generated {
    let slots = symbolic::plays(robot);
    Generated {
        name: "deflection_with",
        doc: "Displacement (m) and rotation (rad) of the tool centre point in the base frame, under a wrench (N, Nm)
            that follows the loads in the state.",
        function: Function::of(|g| symbolic::deflection_with(g, robot)),
        in_columns: None,
        result: Box::new(move |entries| {
            let (displacement, plays) = entries.split_at(6);
            let after = slots.iter().zip(plays).map(|(&(joint, index), play)| {
                let (joint, index) = (Literal::usize_unsuffixed(joint), Literal::usize_unsuffixed(index));
                quote!(state.plays[#joint][#index] = #play;)
            });
            quote!(#(#after)* Vector6::new(#(#displacement),*))
        }),
    }
}

fn stateless(robot: &Description) -> [Generated; 7] {
    let in_columns = |plain: &Function, algorithm: Algorithm, result: fn(&[TokenStream]) -> TokenStream| {
        let function = Function::of(|g| algorithm(g, robot));
        let pays = function.cost_in_columns() < plain.cost_in_columns();
        pays.then(|| InColumns { function, result: Box::new(result) })
    };
    let transform = Function::of(|g| symbolic::transform(g, robot));
    let jacobian = Function::of(|g| symbolic::jacobian(g, robot));
    let compliance = Function::of(|g| symbolic::compliance(g, robot));
    let statics = Function::of(|g| symbolic::statics(g, robot));
    [
        Generated {
            name: "transform",
            doc: "Frame of the tool centre point in the base frame, 4 x 4 homogeneous (m).",
            in_columns: in_columns(&transform, columns::transform, |frame| quote!(Matrix4::from([#(#frame),*]))),
            function: transform,
            result: Box::new(|entries| quote!(Matrix4::new(#(#entries),*))),
        },
        Generated {
            name: "link_frames",
            doc: "Frames behind the joints in the base frame, 4 x 4 homogeneous (m); the last is the flange.",
            function: Function::of(|g| symbolic::link_frames(g, robot)),
            in_columns: None,
            result: Box::new(|entries| {
                let frames = entries.chunks(16).map(|frame| quote!(Matrix4::new(#(#frame),*)));
                quote!([#(#frames),*])
            }),
        },
        Generated {
            name: "jacobian",
            doc: "Jacobian of the tool centre point in the base frame, 6 rows: translation (m/rad), rotation.",
            in_columns: in_columns(&jacobian, columns::jacobian, by_columns),
            function: jacobian,
            result: Box::new(by_columns),
        },
        Generated {
            name: "compliance",
            doc: "Cartesian compliance at the tool centre point in the base frame, 6 x 6 (m/N, m/Nm; rad/N, rad/Nm).

                It is carried from the tip to the base: tt (displacement per force), tr (displacement per moment) and
                rr (rotation per moment) of what lies beyond a joint, r from the joint to the tool centre point.",
            in_columns: in_columns(&compliance, columns::compliance, |entries| quote!(Matrix6::new(#(#entries),*))),
            function: compliance,
            result: Box::new(|entries| quote!(Matrix6::new(#(#entries),*))),
        },
        Generated {
            name: "deflection",
            doc: "Displacement (m) and rotation (rad) of the tool centre point in the base frame, under a wrench (N, Nm).",
            function: Function::of(|g| symbolic::deflection(g, robot)),
            in_columns: None,
            result: Box::new(|entries| quote!(Vector6::new(#(#entries),*))),
        },
        Generated {
            name: "joint_torques",
            doc: "Joint torques (Nm) (forces (N) of sliding joints) that hold a wrench at the tool centre point.",
            function: Function::of(|g| symbolic::joint_torques(g, robot)),
            in_columns: None,
            result: Box::new(|entries| quote!(SVector::from([#(#entries),*]))),
        },
        Generated {
            name: "statics",
            doc: "Transform, Jacobian and compliance of one pose, with what they have in common.",
            in_columns: in_columns(&statics, columns::statics, |outputs| {
                let (frame, rest) = outputs.split_at(4);
                parts(&quote!(Matrix4::from([#(#frame),*])), rest)
            }),
            function: statics,
            result: Box::new(|entries| {
                let (frame, rest) = entries.split_at(16);
                parts(&quote!(Matrix4::new(#(#frame),*)), rest)
            }),
        },
    ]
}

/// A Jacobian by columns.
fn by_columns(entries: &[TokenStream]) -> TokenStream {
    let columns = entries.chunks(6).map(|column| quote!([#(#column),*]));
    quote!(SMatrix::from([#(#columns),*]))
}

/// Transform, Jacobian and compliance together.
fn parts(transform: &TokenStream, rest: &[TokenStream]) -> TokenStream {
    let (columns, compliance) = rest.split_at(rest.len() - 36);
    let jacobian = by_columns(columns);
    quote!(Statics { transform: #transform, jacobian: #jacobian, compliance: Matrix6::new(#(#compliance),*) })
}
