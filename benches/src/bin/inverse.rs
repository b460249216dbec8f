//! Inverse kinematics beside rs-opw-kinematics, in one run: the ratio of the
//! least times of many rounds, on an ABB IRB 6640 that both describe.

use std::hint::black_box;
use std::time::Instant;

use robstiff::Robot;
use robstiff::nalgebra::SVector;
use robstiff_machining::inverse::{Inverse, Target};
use rs_opw_kinematics::kinematic_traits::Kinematics;
use rs_opw_kinematics::kinematics_impl::OPWKinematics;
use rs_opw_kinematics::parameters::opw_kinematics::Parameters;
use rs_opw_kinematics::pose::Pose;

robstiff::robot!("abb-irb6640-185-280.yaml");

const ROUNDS: usize = 200;
const POSES: usize = 500;

fn main() {
    let theirs = OPWKinematics::new(Parameters {
        a1: 0.32,
        a2: -0.2,
        c1: 0.78,
        c2: 1.075,
        c3: 1.392,
        c4: 0.2,
        offsets: [0.0, 0.0, -std::f64::consts::FRAC_PI_2, 0.0, 0.0, 0.0],
        ..Parameters::new()
    });
    let ours = Inverse::new(&AbbIrb6640);
    let limits = AbbIrb6640.limits().map(|limits| limits.expect("every joint of it has limits"));
    // Multiples of square roots are spread evenly.
    let roots = [2.0_f64, 3.0, 5.0, 7.0, 11.0, 13.0].map(f64::sqrt);
    let postures: Vec<[f64; 6]> = (1..=POSES)
        .map(|k| std::array::from_fn(|i| limits[i][0] + (limits[i][1] - limits[i][0]) * (k as f64 * roots[i]).fract()))
        .collect();
    let cases: Vec<(SVector<f64, 6>, Target, [f64; 6], Pose)> = postures
        .iter()
        .map(|posture| {
            let (q, pose) = (SVector::from(*posture), theirs.forward(posture));
            let transform = AbbIrb6640.transform(&q);
            for (axis, expected) in [pose.translation.x, pose.translation.y, pose.translation.z].into_iter().enumerate()
            {
                assert!((transform[(axis, 3)] - expected).abs() < 1e-9, "both describe the same arm");
            }
            (q.map(|value| value + 0.05), Target::pose(&transform), posture.map(|value| value + 0.05), pose)
        })
        .collect();
    let mut least = [f64::INFINITY; 4];
    for _ in 0..ROUNDS {
        let mut time = |which: usize, solve: &mut dyn FnMut(usize)| {
            let start = Instant::now();
            (0..POSES).for_each(solve);
            least[which] = least[which].min(start.elapsed().as_secs_f64() * 1e9 / POSES as f64);
        };
        time(0, &mut |k| {
            let _ = black_box(ours.all(&cases[k].1, &cases[k].0));
        });
        time(1, &mut |k| {
            let _ = black_box(theirs.inverse(&cases[k].3));
        });
        time(2, &mut |k| {
            let _ = black_box(ours.nearest(&cases[k].1, &cases[k].0));
        });
        time(3, &mut |k| {
            let _ = black_box(theirs.inverse_continuing(&cases[k].3, &cases[k].2));
        });
    }
    let found = |count: &dyn Fn(usize) -> usize| (0..POSES).map(count).sum::<usize>();
    println!(
        "solutions of {POSES} poses: {} within the limits here, {} there, without limits",
        found(&|k| ours.all(&cases[k].1, &cases[k].0).map_or(0, |solutions| solutions.len())),
        found(&|k| theirs.inverse(&cases[k].3).len())
    );
    for (name, ours, theirs) in [("all", least[0], least[1]), ("nearest to a seed", least[2], least[3])] {
        println!("{name}: {ours:.0} ns here, {theirs:.0} ns rs-opw-kinematics, {:.2} times", ours / theirs);
    }
}
