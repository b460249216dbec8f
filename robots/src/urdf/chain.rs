//! The serial chain between two links of a tree.

use std::collections::HashSet;

use nalgebra::{Isometry3, Translation3, Unit, UnitQuaternion, Vector3};

use super::{Connection, Motion, Tree};
use crate::description::MOST_JOINTS;
use crate::suggest::{closest, list};
use crate::{Diagnostics, JointKind, words};

/// A serial chain of revolute and prismatic joints.
#[derive(Clone, Debug)]
pub struct Chain {
    /// The robot's name in the file.
    pub robot: String,
    /// The name of the first link, whose frame is the base frame.
    pub base: String,
    /// The name of the last link, whose frame is that of the tool.
    pub tip: String,
    /// The joints that move, from the base to the tip.
    pub joints: Vec<ChainJoint>,
    /// The tip's frame behind the last joint.
    pub end: Isometry3<f64>,
    /// The body that moves with each joint: its mass (kg) and its centre of mass
    /// in the joint's frame (m). Empty where the file has no masses.
    pub bodies: Vec<(f64, Vector3<f64>)>,
    /// What is left out of it.
    pub warnings: Vec<String>,
    /// Its joints in the tree, fixed ones too, from the base to the tip.
    pub(super) path: Vec<usize>,
}

/// A joint of a [`Chain`].
#[derive(Clone, Debug, PartialEq)]
pub struct ChainJoint {
    /// Its name.
    pub name: String,
    /// Turning or sliding.
    pub kind: JointKind,
    /// The axis in the joint's frame.
    pub axis: Unit<Vector3<f64>>,
    /// Lower and upper limit (rad or m), where there are any.
    pub limits: Option<[f64; 2]>,
    /// The joint's frame, at coordinate 0, in that of the joint before it, the
    /// first one's in the base frame.
    pub before: Isometry3<f64>,
}

impl Chain {
    /// The tip's frame in the base frame, from the file's own origins and axes.
    ///
    /// # Panics
    /// If there are fewer coordinates (rad or m) than joints.
    pub fn pose(&self, q: &[f64]) -> Isometry3<f64> {
        let along = |pose: Isometry3<f64>, (joint, &q): (&ChainJoint, &f64)| pose * joint.before * joint.motion(q);
        assert!(q.len() >= self.joints.len(), "a coordinate a joint");
        self.joints.iter().zip(q).fold(Isometry3::identity(), along) * self.end
    }
}

impl ChainJoint {
    fn motion(&self, q: f64) -> Isometry3<f64> {
        match self.kind {
            JointKind::Revolute => {
                Isometry3::from_parts(Translation3::identity(), UnitQuaternion::from_axis_angle(&self.axis, q))
            }
            JointKind::Prismatic => {
                Isometry3::from_parts(Translation3::from(self.axis.into_inner() * q), UnitQuaternion::identity())
            }
        }
    }
}

impl Tree {
    /// The chain from one link to another: from the root where `base` is left
    /// out, to the only end of the tree where `tip` is.
    ///
    /// # Errors
    /// Links that are not there or not on one chain, several ends to choose
    /// from, joints that a chain of revolute and prismatic ones cannot have.
    pub fn chain(&self, base: Option<&str>, tip: Option<&str>) -> Result<Chain, Diagnostics> {
        let base = match base {
            Some(name) => self.link(name, "base")?,
            None => self.root()?,
        };
        let tip = match tip {
            Some(name) => self.link(name, "tip")?,
            None => self.end(base)?,
        };
        let Some(path) = self.path(base, tip) else {
            let (base, tip) = (&self.links[base], &self.links[tip].name);
            let message = format!("no chain leads from `{}` down to `{tip}`", base.name);
            return Err(self.problem(&base.place, &message, "choose a base above the tip in the tree"));
        };
        let mut joints = Vec::new();
        let mut frame = Isometry3::identity();
        for &index in &path {
            let joint = &self.joints[index];
            frame *= joint.origin;
            match &joint.motion {
                None => {}
                Some(Motion::Other(kind)) => {
                    let message = format!("the joint `{}` is {kind}", joint.name);
                    let help = "a description has revolute and prismatic joints; choose a base behind this joint";
                    return Err(self.problem(&joint.place, &message, help));
                }
                Some(Motion::Axis { mimics: true, .. }) => {
                    let message = format!("the joint `{}` follows another one (mimic)", joint.name);
                    let help = "every joint of a chain has a coordinate of its own; choose a tip before this joint";
                    return Err(self.problem(&joint.place, &message, help));
                }
                Some(Motion::Axis { kind, axis, limits, .. }) => {
                    let (name, before) = (joint.name.clone(), frame);
                    joints.push(ChainJoint { name, kind: *kind, axis: *axis, limits: *limits, before });
                    frame = Isometry3::identity();
                }
            }
        }
        if joints.is_empty() || joints.len() > MOST_JOINTS {
            let (base, tip) = (&self.links[base].name, &self.links[tip].name);
            let message = format!("{} between `{base}` and `{tip}`", words::count(joints.len(), "moving joint"));
            let help = format!("a description has 1 to {MOST_JOINTS}; choose another base or tip");
            return Err(self.problem(&self.whole(), &message, &help));
        }
        let (bodies, warnings) = self.bodies(&path);
        Ok(Chain {
            robot: self.name.clone(),
            base: self.links[base].name.clone(),
            tip: self.links[tip].name.clone(),
            joints,
            end: frame,
            bodies,
            warnings,
            path,
        })
    }

    fn link(&self, name: &str, what: &str) -> Result<usize, Diagnostics> {
        let names = || self.links.iter().map(|link| link.name.as_str());
        names().position(|known| known == name).ok_or_else(|| {
            let help = match closest(name, names()) {
                Some(near) => format!("did you mean `{near}`? the links are {}", list(names())),
                None => format!("the links are {}", list(names())),
            };
            self.problem(&self.whole(), &format!("there is no link `{name}` to be the {what}"), &help)
        })
    }

    /// The link that no joint carries.
    fn root(&self) -> Result<usize, Diagnostics> {
        let is_root = |index: &usize| self.hangs.on[*index].is_none();
        let roots: Vec<usize> = (0..self.links.len()).filter(is_root).collect();
        match roots[..] {
            [root] => Ok(root),
            [] => unreachable!("a file without links, or with a ring of them, was not read"),
            [first, ..] => {
                let names = list(roots.iter().map(|&root| self.links[root].name.as_str()));
                let message = "the file holds several trees";
                Err(self.problem(&self.links[first].place, message, &format!("choose the base: {names}")))
            }
        }
    }

    /// The only end of the tree behind moving joints.
    fn end(&self, base: usize) -> Result<usize, Diagnostics> {
        // How many joints move each link below the base, the nearest first.
        let (mut moving, mut ends) = (vec![(base, 0)], Vec::new());
        while let Some((link, count)) = moving.pop() {
            for &joint in &self.hangs.carries[link] {
                let Connection { child, motion, .. } = &self.joints[joint];
                moving.push((*child, count + usize::from(motion.is_some())));
            }
            if self.hangs.carries[link].is_empty() && count > 0 {
                ends.push((link, count));
            }
        }
        ends.sort_unstable();
        match ends[..] {
            [(end, _)] => Ok(end),
            [] => Err(self.problem(&self.links[base].place, "nothing moves behind this link", "choose another base")),
            _ => {
                let names: Vec<String> = ends
                    .iter()
                    .map(|&(end, count)| {
                        format!("`{}` (behind {})", self.links[end].name, words::count(count, "joint"))
                    })
                    .collect();
                let help = format!("choose the tip: {}", names.join(", "));
                Err(self.problem(&self.links[base].place, "the tree has several ends", &help))
            }
        }
    }

    /// The joints from one link down to another.
    fn path(&self, base: usize, tip: usize) -> Option<Vec<usize>> {
        let (mut path, mut link) = (Vec::new(), tip);
        while link != base {
            let joint = self.hangs.on[link]?;
            path.push(joint);
            link = self.joints[joint].parent;
        }
        path.reverse();
        Some(path)
    }

    /// The bodies that move with the joints of a path: the links themselves and
    /// all that is fixed to them.
    fn bodies(&self, path: &[usize]) -> (Vec<(f64, Vector3<f64>)>, Vec<String>) {
        let mut bodies: Vec<(f64, Vector3<f64>)> = Vec::new();
        let mut warnings = Vec::new();
        let first = path.first().map_or(0, |&joint| self.joints[joint].parent);
        // Links to visit with the body they belong to (none before the first
        // moving joint) and their frame in that body's.
        let path: HashSet<usize> = path.iter().copied().collect();
        let mut open = vec![(first, None, Isometry3::identity())];
        while let Some((link, body, frame)) = open.pop() {
            if let (Some(body), Some((mass, center))) = (body, self.links[link].inertia) {
                let (sum, moment): &mut (f64, Vector3<f64>) = &mut bodies[body];
                *sum += mass;
                *moment += (frame * nalgebra::Point3::from(center)).coords * mass;
            }
            for &index in &self.hangs.carries[link] {
                let joint = &self.joints[index];
                match (&joint.motion, path.contains(&index)) {
                    (None, _) => open.push((joint.child, body, frame * joint.origin)),
                    (Some(_), true) => {
                        bodies.push((0.0, Vector3::zeros()));
                        open.push((joint.child, Some(bodies.len() - 1), Isometry3::identity()));
                    }
                    (Some(_), false) => warnings.push(format!(
                        "{}: the joint `{}` branches off the chain; what it carries is left out",
                        self.file, joint.name
                    )),
                }
            }
        }
        if bodies.iter().all(|(mass, _)| *mass == 0.0) {
            return (Vec::new(), warnings);
        }
        let centered = |(mass, moment): (f64, Vector3<f64>)| (mass, if mass > 0.0 { moment / mass } else { moment });
        (bodies.into_iter().map(centered).collect(), warnings)
    }
}
