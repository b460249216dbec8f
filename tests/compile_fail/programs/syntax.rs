use robstiff::Robot;
use robstiff::nalgebra::{SVector, Vector6};

robstiff::robot!("syntax.yaml");
fn main() {
    // No error but the one above.
    let q = SVector::from([0.0; 2]);
    let moved = Broken.deflection(&q, &(Broken.compliance(&q) * Vector6::zeros()));
    println!("{} {moved} {}", Broken.name(), Broken.jacobian(&q));
    println!("{} {:?}", Broken::A2 + Broken::H1, Broken::COMPLIANCE_COST);
}
