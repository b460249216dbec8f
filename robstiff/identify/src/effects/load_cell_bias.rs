//! The load cell's zero is off: a force acts beside what the file says, constant in the base frame or
//! in the tool's; of clamped axes, a torque.

use std::rc::Rc;

use super::scene::What;
use super::{Form, Kind, Offers, Place, Scene, Side, three};
use crate::model::rig::{BASE, TOOL};
use crate::model::{At, Parameter, Size, Term};

/// The kind.
pub static KIND: Kind = Kind {
    name: "load_cell_bias",
    side: Side::Rig,
    words: |_, _| "a bias of the load cell".into(),
    explanation: "What acts is more than the file says, by the same at every load: the load cell was not tared, or the \
        weight of hook and cable is not in the file. Add these numbers, with their signs, to the loads in the file, or \
        tare it unloaded at the pose and measure again.",
    offer,
};

/// The likely part of the largest force.
const LIKELY: f64 = 0.08;

const FORCE: [&str; 3] = ["Fx", "Fy", "Fz"];

fn offer(scene: &Scene<'_>, offers: &mut Offers) {
    match scene.what {
        What::Displacements => {
            let size = LIKELY * scene.force;
            let base = three(FORCE, "N", size, |world, k, by| world.rig.force_bias[BASE][k] += by);
            let tool = three(FORCE, "N", size, |world, k, by| world.rig.force_bias[TOOL][k] += by);
            offers.add(
                Place::Rig,
                vec![
                    Form::new("in the base frame", base),
                    Form::new("in the tool frame", tool).with("tool_frame", 1.0, "1"),
                ],
            );
        }
        What::Clamped if scene.axes.len() > 1 => {
            // Every axis stands aside by what the bias does to it.
            let (visit, axes, compliance) = (scene.visit.clone(), scene.axes.clone(), scene.compliance.clone());
            let of = move |at: &At<'_>| nalgebra::Vector3::x() * compliance[axes[visit[at.row]] - 1];
            let size = LIKELY * scene.torque.iter().copied().fold(0.0, f64::max);
            let bias = Parameter::new("torque", "Nm", Size::Of(size), Term::Reading(Rc::new(of)));
            offers.add(Place::Rig, vec![Form::new("", vec![bias])]);
        }
        _ => {}
    }
}
