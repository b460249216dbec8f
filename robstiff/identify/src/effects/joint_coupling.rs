//! The torque of one joint turns another: belts, and the gearing of a wrist.

use robstiff::Effect;
use robstiff_robots::Place as Part;

use super::{Form, Kind, Offers, Scene, Side};
use crate::model::{Parameter, Size, Spring, Term};

/// The kind.
pub static KIND: Kind = Kind {
    name: "joint_coupling",
    side: Side::Robot,
    words: |place, _| format!("the coupling of {}", place.words()),
    explanation: "",
    offer,
};

/// The likely part of what would make the joints one (`sqrt(h_i h_j)`).
const LIKELY: f64 = 0.4;

fn offer(scene: &Scene<'_>, offers: &mut Offers) {
    if !scene.is_loaded() {
        return;
    }
    let turning = scene.turning();
    for (k, &first) in turning.iter().enumerate() {
        for &second in &turning[k + 1..] {
            let joints = [first, second];
            let size = LIKELY * joints.map(|joint| scene.likely(joint)).iter().product::<f64>().sqrt();
            let term = Term::Spring(Spring::Coupling(joints));
            let coupling = Parameter::new("c", "rad/Nm", Size::Of(size), term);
            let form = Form::new("", vec![coupling]);
            let form = form.written(move |v| vec![Effect::JointCoupling { joints, value: v[0] }]);
            offers.add(Part::Joints(joints), vec![form]);
        }
    }
}
