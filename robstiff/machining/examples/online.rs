//! What control speed leaves of the deviation: the joint targets are corrected
//! while cutting, from a force sensor or from encoders on the output side of the
//! gears.
//!
//!     cargo run --release -p robstiff-machining --example online
//!
//! With position loops of 15 Hz and a delay of one control step it leaves, of the
//! deviation under a force of 1 Hz, 21 % at 12 ms a step, 13 % at 4 ms and 10 % at
//! 1 ms; of one of 10 Hz nothing is gained. At low frequencies a model that is 10 %
//! too stiff leaves its 10 %; encoders need no model, but do not see a bearing that
//! tilts (43 % left).

use robstiff::nalgebra::{SVector, Vector6};
use robstiff::robots::{Description, catalogue};
use robstiff::{Effect, Generic};
use robstiff_machining::online::{Controller, LeftOfSine, Limits, Sensing, Servo, left_of_sine};

fn main() {
    let text = catalogue::find("rv130hsc").expect("it is in the catalogue");
    let description = Description::parse("rv130hsc.yaml", text).expect("the catalogue is right");
    let truth = Generic::<5>::new(&description).expect("it has five joints");
    // What the controller takes it for: every joint a tenth stiffer.
    let mut stiffer = description.clone();
    stiffer.joints.iter_mut().flat_map(|joint| &mut joint.compliance).for_each(|part| part.value *= 0.9);
    let stiffer = Generic::<5>::new(&stiffer).expect("it has five joints");
    // A bearing that tilts, which no encoder sees.
    let mut tilting = description.clone();
    tilting.effects.push(Effect::TransverseCompliance { joint: 3, value: 6e-7 });
    let tilting = Generic::<5>::new(&tilting).expect("it has five joints");

    let q = SVector::from([0.3, -0.4, 0.5, 0.2, 1.2]);
    let wrench = Vector6::new(150.0, -200.0, 300.0, 0.0, 0.0, 0.0);
    let left = |truth: &Generic<5>, model: &Generic<5>, sensing, step: f64, frequency| -> LeftOfSine {
        let controller = Controller {
            sensing,
            step,
            delay: step,
            servo: Servo::SecondOrder { frequency: 15.0, damping: 0.7 },
            limits: Limits { size: 5e-3, rate: 1.0, hold: 0.02 },
            damping: 1e-9,
        };
        left_of_sine((truth, model), &q, &controller, (&wrench, frequency), |_, wrench| Some(*wrench))
    };

    println!("left of the deviation [%], by the frequency of the force");
    println!("control step   0.2 Hz   0.5 Hz     1 Hz     2 Hz     5 Hz    10 Hz");
    let row = |name: &str, left: &dyn Fn(f64) -> LeftOfSine| {
        let cells =
            [0.2, 0.5, 1.0, 2.0, 5.0, 10.0].map(|frequency| format!("{:9.1}", 100.0 * left(frequency).amplitude));
        println!("{name:<12}{}", cells.concat());
    };
    for (name, step) in [("12 ms", 12e-3), ("4 ms", 4e-3), ("1 ms", 1e-3)] {
        row(name, &|frequency| left(&truth, &truth, Sensing::Force, step, frequency));
    }
    println!("with 1 ms, and");
    row("model - 10 %", &|frequency| left(&truth, &stiffer, Sensing::Force, 1e-3, frequency));
    row("encoders", &|frequency| left(&truth, &stiffer, Sensing::Encoders, 1e-3, frequency));
    row("and a tilt", &|frequency| left(&tilting, &truth, Sensing::Encoders, 1e-3, frequency));
}
