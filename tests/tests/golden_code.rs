//! The golden files, compiled: bit for bit what `robot!` expands to.
//!
//! Apart from `golden.rs`, which can so still write the files anew where they
//! do not compile.

use nalgebra::{SVector, Vector6};
use robstiff::{Robot, State};
use robstiff_tests::arms;
use robstiff_tests::judge::trials;

macro_rules! golden {
    ($($module:ident $robot:ident)*) => {
        $(
            mod $module {
                // Included, not a module file: it stays as it was generated.
                include!(concat!("../golden/", stringify!($module), ".rs"));

                #[test]
                fn is_the_macros() {
                    super::is_the_macros($robot, super::arms::$robot);
                }
            }
        )*
    };
}

golden! {
    rv130hsc Rv130hsc
    fanuc_r2000ic FanucR2000ic
    every_effect EveryEffect
    every_law EveryLaw
}

fn is_the_macros<const N: usize>(text: impl Robot<N>, expanded: impl Robot<N>) {
    assert_eq!(text.name(), expanded.name());
    assert_eq!(text.convention(), expanded.convention());
    assert_eq!(text.joint_kinds(), expanded.joint_kinds());
    assert_eq!(text.joint_compliance(), expanded.joint_compliance());
    assert_eq!(text.limits(), expanded.limits());
    assert_eq!(text.effects(), expanded.effects());
    assert_eq!((text.base(), text.tool()), (expanded.base(), expanded.tool()));
    for (q, wrench) in trials::<N>(200, 3) {
        assert_eq!(bits(&text, &q, &wrench), bits(&expanded, &q, &wrench));
    }
}

/// Everything calculated in one pose.
fn bits<const N: usize>(robot: &impl Robot<N>, q: &SVector<f64, N>, wrench: &Vector6<f64>) -> Vec<u64> {
    let mut all: Vec<f64> = Vec::new();
    all.extend(&robot.transform(q));
    all.extend(robot.link_frames(q).iter().flatten());
    all.extend(&robot.jacobian(q));
    all.extend(&robot.compliance(q));
    all.extend(&robot.deflection(q, wrench));
    all.extend(&robot.joint_torques(q, wrench));
    let mut state = State::new();
    all.extend(&robot.deflection_with(q, wrench, &mut state));
    all.extend(&robot.deflection_with(q, &(wrench * -0.5), &mut state));
    all.extend(state.plays.as_flattened());
    let statics = robot.statics(q);
    all.extend(statics.transform.iter().chain(&statics.jacobian).chain(&statics.compliance));
    all.into_iter().map(f64::to_bits).collect()
}
