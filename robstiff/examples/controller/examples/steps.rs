//! Runs some control steps on the host, to count their instructions:
//! `steps COUNT [ANGLE]`, the angle (rad) being that of every joint.

use std::hint::black_box;

use robstiff_controller::{Controller, JOINTS, Limits};

fn main() {
    let mut arguments = std::env::args().skip(1);
    let count = arguments.next().and_then(|text| text.parse::<u32>().ok()).expect("usage: steps COUNT [ANGLE]");
    let angle = arguments.next().map_or(0.5, |text| text.parse::<f32>().expect("ANGLE is a number"));
    let mut controller = Controller::new(Limits { size: 2.5e-4, rate: 1e-4, hold: 10 });
    for _ in 0..count {
        let wrench = black_box([150.0, -200.0, 300.0, 0.0, 0.0, 0.0]);
        black_box(controller.step(black_box(&[angle; JOINTS]), Some(&wrench)));
    }
}
