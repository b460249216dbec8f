//! The elastic parameters of a description, as named symbols.

use robstiff_robots::{Description, Effect, Joint, JointKind};

use crate::graph::{Graph, Sym};

/// All elastic parameters of a robot; what it does not have is 0 and folds
/// away. Joints and links count from 0.
#[derive(Debug)]
pub struct Elastic<'g> {
    /// The joints' own compliance (rad/Nm or m/N).
    pub joint: Vec<Sym<'g>>,
    /// Tilt of the joints about x and y (rad/Nm).
    pub transverse: Vec<Sym<'g>>,
    /// Bending and torsion of the links (rad/Nm).
    pub link: Vec<(Sym<'g>, Sym<'g>)>,
    /// Tilt (rad/Nm) and translation (m/N) of the foundation.
    pub base: (Sym<'g>, Sym<'g>),
    /// Rotation (rad/Nm) and translation (m/N) of flange and tool.
    pub tool: (Sym<'g>, Sym<'g>),
    /// Couplings of two joints, the smaller first (rad/Nm).
    pub coupling: Vec<([usize; 2], Sym<'g>)>,
    /// Joints whose compliance changes with torque: what the unloaded joint
    /// has on top (rad/Nm) and the knee (Nm).
    pub nonlinear: Vec<(usize, Sym<'g>, Sym<'g>)>,
}

impl<'g> Elastic<'g> {
    /// The parameters of `robot` under the names that generated code gives
    /// them.
    pub fn of(g: &'g Graph, robot: &Description) -> Self {
        let n = robot.joints.len();
        let zero = g.number(0.0);
        let joint = |(i, joint): (usize, &Joint)| {
            let unit = match joint.kind {
                JointKind::Revolute => "rad/Nm",
                JointKind::Prismatic => "m/N",
            };
            g.parameter(&format!("H{i}"), joint.compliance(), &format!("Compliance of joint {i} ({unit})."))
        };
        let mut elastic = Self {
            joint: (1..).zip(&robot.joints).map(joint).collect(),
            transverse: vec![zero; n],
            link: vec![(zero, zero); n],
            base: (zero, zero),
            tool: (zero, zero),
            coupling: Vec::new(),
            nonlinear: Vec::new(),
        };
        for effect in &robot.effects {
            let named = |name: &str, value: f64, what: &str, unit: &str| {
                g.parameter(name, value, &format!("{what} of {} ({unit}).", effect.place()))
            };
            match *effect {
                Effect::TransverseCompliance { joint, value } => {
                    elastic.transverse[joint - 1] =
                        named(&format!("TRANSVERSE{joint}"), value, "Transverse compliance", "rad/Nm");
                }
                Effect::LinkCompliance { link, bending, torsion } => {
                    elastic.link[link - 1] = (
                        named(&format!("BENDING{link}"), bending, "Bending compliance L / EI", "rad/Nm"),
                        named(&format!("TORSION{link}"), torsion, "Torsion compliance L / GJ", "rad/Nm"),
                    );
                }
                Effect::BaseCompliance { tilt, translation } => {
                    elastic.base = (
                        named("BASE_TILT", tilt, "Tilt compliance", "rad/Nm"),
                        named("BASE_TRANSLATION", translation, "Translation compliance", "m/N"),
                    );
                }
                Effect::ToolCompliance { rotation, translation } => {
                    elastic.tool = (
                        named("TOOL_ROTATION", rotation, "Rotation compliance", "rad/Nm"),
                        named("TOOL_TRANSLATION", translation, "Translation compliance", "m/N"),
                    );
                }
                Effect::JointCoupling { joints: [i, j], value } => {
                    let pair = [i.min(j) - 1, i.max(j) - 1];
                    let value = named(&format!("COUPLING{i}_{j}"), value, "Coupling compliance", "rad/Nm");
                    elastic.coupling.push((pair, value));
                }
                Effect::StiffnessNonlinearity { joint, added, knee } => {
                    elastic.nonlinear.push((
                        joint - 1,
                        named(&format!("ADDED{joint}"), added, "Additional compliance without load", "rad/Nm"),
                        named(&format!("KNEE{joint}"), knee, "Torque at the knee", "Nm"),
                    ));
                }
            }
        }
        elastic
    }

    /// The compliance of a joint about the unloaded state: its own and what a
    /// nonlinearity has on top there.
    pub fn unloaded_joint(&self, joint: usize) -> Sym<'g> {
        self.nonlinear.iter().filter(|(at, ..)| *at == joint).fold(self.joint[joint], |h, &(_, added, _)| h + added)
    }
}
