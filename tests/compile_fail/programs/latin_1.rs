use robstiff::Robot;
use robstiff::nalgebra::SVector;

robstiff::robot!("latin_1.yaml");

fn main() {
    println!("{}", Latin1.compliance(&SVector::from([0.0; 2])));
}
