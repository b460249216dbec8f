//! The methods of `Robot` that calculate: all there is to say of one is its entry in
//! [`CALCULATIONS`].

use proc_macro2::{Literal, TokenStream};
use quote::quote;
use robstiff_robots::{Description, Effect, JointKind};

use super::reader::{Reader, from};
use super::signature::Signature;
use crate::function::Function;
use crate::scales::with_scales;
use crate::symbolic::{self, Algorithm, columns};

/// Builds a result from its entries.
pub(super) type Build = fn(&Description, Reader, &[TokenStream]) -> TokenStream;

/// A paragraph of docs, if the robot asks for it.
type Caveat = fn(&Description) -> Option<String>;

/// A method that calculates.
pub(super) struct Calculation {
    /// The method's name.
    pub name: &'static str,
    /// What it gives, with shape, frame and unit; `{}` is that of a displacement per joint
    /// coordinate, `{torques}` what joints carry.
    doc: &'static str,
    /// What else there is to say of it for a robot with certain effects.
    caveat: Caveat,
    /// The method's signature.
    pub signature: Signature,
    algorithm: Algorithm,
    /// How its result is built.
    pub result: Build,
    /// The same for scalars that compute with columns as with one number.
    in_columns: Option<(Algorithm, Build)>,
}

/// Those of every robot, in the order of the trait.
pub(super) const CALCULATIONS: [Calculation; 7] = [
    Calculation {
        name: "transform",
        doc: "Frame of the tool centre point in the base frame, 4 x 4 homogeneous (m).",
        caveat: |_| None,
        signature: |n| quote!(fn transform<T: Real>(&self, q: &SVector<T, #n>) -> Matrix4<T>),
        algorithm: symbolic::transform,
        result: |_, _, entries| quote!(Matrix4::new(#(#entries),*)),
        in_columns: Some((columns::transform, |_, reader, frame| from(reader, "Matrix4", frame))),
    },
    Calculation {
        name: "link_frames",
        doc: "Frames behind the joints in the base frame, 4 x 4 homogeneous (m); the last is the flange.",
        caveat: |_| None,
        signature: |n| quote!(fn link_frames<T: Real>(&self, q: &SVector<T, #n>) -> [Matrix4<T>; #n]),
        algorithm: symbolic::link_frames,
        result: |_, _, entries| {
            let frames = entries.chunks(16).map(|frame| quote!(Matrix4::new(#(#frame),*)));
            quote!([#(#frames),*])
        },
        in_columns: None,
    },
    Calculation {
        name: "jacobian",
        doc: "Jacobian of the tool centre point in the base frame, 6 rows: translation ({}), rotation.",
        caveat: of_outputs,
        signature: |n| quote!(fn jacobian<T: Real>(&self, q: &SVector<T, #n>) -> SMatrix<T, 6, #n>),
        algorithm: symbolic::jacobian,
        result: |_, reader, entries| jacobian(reader, entries),
        in_columns: Some((columns::jacobian, |_, reader, entries| jacobian(reader, entries))),
    },
    Calculation {
        name: "compliance",
        doc: "Cartesian compliance at the tool centre point in the base frame, 6 x 6 (m/N, m/Nm; rad/N, rad/Nm), for
            a small wrench on the unloaded arm.

            It is carried from the tip to the base: tt (displacement per force), tr (displacement per moment) and
            rr (rotation per moment) of what lies beyond a joint, r from the joint to the tool centre point, all in the
            joint's own axes.",
        caveat: |_| None,
        signature: |n| quote!(fn compliance<T: Real>(&self, q: &SVector<T, #n>) -> Matrix6<T>),
        algorithm: symbolic::compliance,
        result: |_, _, entries| quote!(Matrix6::new(#(#entries),*)),
        in_columns: Some((columns::compliance, |_, _, entries| quote!(Matrix6::new(#(#entries),*)))),
    },
    Calculation {
        name: "deflection",
        doc: "Displacement (m) and rotation (rad) of the tool centre point in the base frame, under a wrench that acts
            there: fx, fy, fz (N), mx, my, mz (Nm), along the axes of the base frame.",
        caveat: |robot| {
            let says = "The arm is taken as never loaded before; `deflection_with` takes the state that loads left.";
            symbolic::remembers(robot).then(|| says.to_owned())
        },
        signature: |n| quote!(fn deflection<T: Real>(&self, q: &SVector<T, #n>, wrench: &Vector6<T>) -> Vector6<T>),
        algorithm: symbolic::deflection,
        result: |_, _, entries| quote!(Vector6::new(#(#entries),*)),
        in_columns: None,
    },
    Calculation {
        name: "joint_torques",
        doc: "What a wrench that acts on the tool centre point puts on the joints, `J^T F`:
            {torques}. Drives hold the arm with the negative.",
        caveat: |_| None,
        signature: |n| quote!(fn joint_torques<T: Real>(&self, q: &SVector<T, #n>, wrench: &Vector6<T>) -> SVector<T, #n>),
        algorithm: symbolic::joint_torques,
        result: |_, reader, entries| from(reader, "SVector", entries),
        in_columns: None,
    },
    Calculation {
        name: "statics",
        doc: "Transform, Jacobian and compliance of one pose, with what they have in common.

            Axes z and levers l of the Jacobian are in the base frame, or behind the turn of joint 1 where that is done
            at the end. As in `compliance`, tt, tr and rr are of what lies beyond a joint, at the tool centre point and
            in the joint's own axes, r from the joint to the tool centre point.",
        caveat: of_outputs,
        signature: |n| quote!(fn statics<T: Real>(&self, q: &SVector<T, #n>) -> Statics<#n, T>),
        algorithm: symbolic::statics,
        result: |_, reader, entries| {
            let (frame, rest) = entries.split_at(16);
            statics(reader, &quote!(Matrix4::new(#(#frame),*)), rest)
        },
        in_columns: Some((columns::statics, |_, reader, outputs| {
            let (frame, rest) = outputs.split_at(4);
            statics(reader, &from(reader, "Matrix4", frame), rest)
        })),
    },
];

/// What is generated besides for robots that [remember](symbolic::remembers) their loads.
const DEFLECTION_WITH: Calculation = Calculation {
    name: "deflection_with",
    doc: "Displacement (m) and rotation (rad) of the tool centre point in the base frame, under a wrench
        that follows the loads in the state, and joins them: fx, fy, fz (N), mx, my, mz (Nm), along the axes of the
        base frame.",
    caveat: |_| None,
    signature: |n| {
        quote!(fn deflection_with<T: Real>(
            &self,
            q: &SVector<T, #n>,
            wrench: &Vector6<T>,
            state: &mut State<#n, T>,
        ) -> Vector6<T>)
    },
    algorithm: symbolic::deflection_with,
    result: |robot, _, entries| {
        let (displacement, plays) = entries.split_at(6);
        let after = symbolic::plays(robot).into_iter().zip(plays).map(|((joint, index), play)| {
            let (joint, index) = (Literal::usize_unsuffixed(joint), Literal::usize_unsuffixed(index));
            quote!(state.plays[#joint][#index] = #play;)
        });
        quote!(#(#after)* Vector6::new(#(#displacement),*))
    },
    in_columns: None,
};

/// What is generated besides for robots whose gears [carry](symbolic::preloads) their weight.
const PRELOAD: Calculation = Calculation {
    name: "preload",
    doc: "What the arm's own weight puts on the gears before any load does: {torques}. The laws of joints begin there.",
    caveat: |_| None,
    signature: |n| quote!(fn preload<T: Real>(&self, q: &SVector<T, #n>) -> SVector<T, #n>),
    algorithm: symbolic::preload,
    result: |_, reader, entries| from(reader, "SVector", entries),
    in_columns: None,
};

/// Those of some robots, in the order in which they follow the others.
pub(super) const OF_SOME: [Calculation; 2] = [DEFLECTION_WITH, PRELOAD];

/// What a column of the Jacobian is of, where that is not what `q` says.
fn of_outputs(robot: &Description) -> Option<String> {
    let has = |is: fn(&Effect) -> bool| robot.effects.iter().any(is);
    let errs = has(|effect| matches!(effect, Effect::TransmissionError { .. })).then_some(
        "Columns of the Jacobian are per turn of a joint's output, which a load moves; per unit of `q` they are
            `elements::commanded_rates` times that.",
    );
    let sags = has(|effect| matches!(effect, Effect::GravitySag { .. }))
        .then_some("That the arm sags otherwise where `q` changes is not in the Jacobian.");
    let says: Vec<&str> = errs.into_iter().chain(sags).collect();
    (!says.is_empty()).then(|| says.join("\n"))
}

/// A Jacobian from its entries, column by column.
fn jacobian(reader: Reader, entries: &[TokenStream]) -> TokenStream {
    let columns: Vec<_> = entries.chunks(6).map(|column| quote!([#(#column),*])).collect();
    from(reader, "SMatrix", &columns)
}

/// Transform, Jacobian and compliance together.
fn statics(reader: Reader, transform: &TokenStream, rest: &[TokenStream]) -> TokenStream {
    let (columns, compliance) = rest.split_at(rest.len() - 36);
    let jacobian = jacobian(reader, columns);
    quote!(Statics { transform: #transform, jacobian: #jacobian, compliance: Matrix6::new(#(#compliance),*) })
}

impl Calculation {
    /// All of a robot; what not every robot has last.
    fn all(robot: &Description) -> impl Iterator<Item = Self> {
        let remembers = symbolic::remembers(robot).then_some(DEFLECTION_WITH);
        let preloads = symbolic::preloads(robot).then_some(PRELOAD);
        CALCULATIONS.into_iter().chain(remembers).chain(preloads)
    }

    /// What its docs say for one robot.
    pub fn doc(&self, robot: &Description) -> String {
        let is_of = |kind: JointKind| robot.joints.iter().all(|joint| joint.kind == kind);
        let (per_joint, torques) = match (is_of(JointKind::Revolute), is_of(JointKind::Prismatic)) {
            (true, _) => ("m/rad", "torques (Nm)"),
            (false, true) => ("m/m", "forces (N)"),
            (false, false) => ("m/rad, of sliding joints m/m", "torques (Nm), of sliding joints forces (N)"),
        };
        let doc = self.doc.replace("{}", per_joint).replace("{torques}", torques);
        (self.caveat)(robot).into_iter().fold(doc, |doc, caveat| doc + "\n\n" + &caveat)
    }

    fn function(&self, robot: &Description) -> Function {
        Function::of(|g| (self.algorithm)(g, robot))
    }
}

/// The functions that are generated for a robot, by the names of the methods.
pub fn functions(robot: &Description) -> Vec<(&'static str, Function)> {
    Calculation::all(robot).map(|calculation| (calculation.name, calculation.function(robot))).collect()
}

/// Those that are generated once more for scalars that compute with four numbers as with
/// one.
pub fn functions_in_columns(robot: &Description) -> Vec<(&'static str, Function)> {
    let all = Generated::all(robot).into_iter();
    all.filter_map(|generated| Some((generated.method.name, generated.in_columns?.0))).collect()
}

/// A method for one robot.
pub(super) struct Generated {
    /// The method.
    pub method: Calculation,
    /// What its result is built from.
    pub function: Function,
    /// The same in columns, where that is less.
    pub in_columns: Option<(Function, Build)>,
}

impl Generated {
    /// All of a robot, in the order of the trait.
    pub fn all(robot: &Description) -> Vec<Self> {
        Calculation::all(robot).map(|method| Self::of(method, robot)).collect()
    }

    /// The functions that are written for a reader.
    pub fn written(&self, reader: Reader) -> impl Iterator<Item = &Function> {
        let in_columns = self.in_columns.as_ref().filter(|_| reader == Reader::Compiler);
        [&self.function].into_iter().chain(in_columns.map(|(function, _)| function))
    }

    fn of(method: Calculation, robot: &Description) -> Self {
        let function = method.function(robot);
        let in_columns =
            method.in_columns.map(|(algorithm, result)| (with_scales(Function::of(|g| algorithm(g, robot))), result));
        let in_columns = in_columns.filter(|(columns, _)| columns.cost_in_columns() < function.cost_in_columns());
        Self { method, function, in_columns }
    }
}

/// The upper triangle of the compliance, by rows.
pub(super) fn compliance_entries(robot: &Description) -> Function {
    Function::of(|g| {
        let entries = symbolic::compliance(g, robot);
        (0..6).flat_map(|i| entries[6 * i + i..6 * (i + 1)].to_vec()).collect()
    })
}
