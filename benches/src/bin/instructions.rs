//! Runs each measured function a thousand times, for callgrind to count.

use std::hint::black_box;

use robstiff::Robot;
use robstiff::nalgebra::{Matrix4, Matrix6, SMatrix, Vector6};
use robstiff_benches as measured;

fn main() {
    let (five, six) = (measured::poses::<5>(1000), measured::poses::<6>(1000));
    let (mut square, mut frame, mut jacobian) = (Matrix6::zeros(), Matrix4::zeros(), SMatrix::zeros());
    let (mut triangle, mut vector, mut pairs) = ([0.0; 21], Vector6::zeros(), [(0.0, 0.0); 5]);
    let mut all = measured::Rv130hsc.statics(&five[0]);
    for (five, six) in five.iter().zip(&six) {
        measured::five_angles(&five.data.0[0], &mut pairs);
        measured::transform(five, &mut frame);
        measured::jacobian(five, &mut jacobian);
        measured::compliance(five, &mut square);
        measured::triangle(five, &mut triangle);
        measured::triangle_of_six(six, &mut triangle);
        measured::compliance_of_six(six, &mut square);
        measured::statics(five, &mut all);
        measured::deflection(five, &measured::WRENCH, &mut vector);
        black_box((measured::trace(five), &square, &frame, &jacobian, &triangle, &vector, &pairs, &all));
    }
}
