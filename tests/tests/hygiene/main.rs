//! Generated code in files that have no prelude, or other things under the
//! names of one, or under those that the code itself has.

mod with_its_names;

use nalgebra::{Matrix6, SVector, Vector6};
use robstiff::{Robot, State, batch};
use robstiff_tests::arms;
use robstiff_tests::judge::trials;

mod without_prelude {
    #![no_implicit_prelude]

    ::robstiff::robot!("rv130hsc.yaml");
    ::robstiff::robot!("every-effect.yaml");
    ::robstiff::robot!("every-law.yaml");
    ::robstiff::robot!("sliders.yaml");
}

#[allow(dead_code, non_camel_case_types)]
mod with_other_things {
    pub struct Option;
    pub struct Some;
    pub struct None;
    pub struct Vec;
    pub struct Box;
    pub struct Result;
    pub struct Ok;
    pub struct Default;
    pub struct Clone;
    pub struct Copy;
    pub trait Into {}
    pub trait From {}
    pub trait Fn {}
    pub trait FnMut {}
    pub trait FnOnce {}
    pub trait Iterator {}
    pub trait Robot {}
    pub trait Real {}
    pub struct State;
    pub struct SVector;

    ::robstiff::robot!("rv130hsc.yaml");
    ::robstiff::robot!("every-effect.yaml");
    ::robstiff::robot!("every-law.yaml");
    ::robstiff::robot!("sliders.yaml");
}

mod named_as_in_the_prelude {
    robstiff::robot!("option.yaml",);
    robstiff::robot!("fn-mut.yaml");
}

#[test]
fn names_around_generated_code_do_not_matter() {
    let q = SVector::from([0.3, -0.4, 0.5, 0.2, 1.2]);
    let one = without_prelude::Rv130hsc.compliance(&q);
    assert_eq!(one, with_other_things::Rv130hsc.compliance(&q));
    let q = SVector::from([0.1]);
    let limits = named_as_in_the_prelude::Option.limits();
    assert_eq!(limits, [Some([-1.0, 1.0])]);
    assert_eq!(named_as_in_the_prelude::FnMut.compliance(&q), named_as_in_the_prelude::Option.compliance(&q));
}

/// What is under the names of its variables changes nothing, in single poses and in batches.
#[test]
fn names_in_generated_code_do_not_matter() {
    is_the_same(with_its_names::Rv130hsc, arms::Rv130hsc);
    is_the_same(with_its_names::KukaKr210L150, arms::KukaKr210L150);
    is_the_same(with_its_names::EveryEffect, arms::EveryEffect);
    is_the_same(with_its_names::EveryLaw, arms::EveryLaw);
    is_the_same(with_its_names::Sliders, arms::Sliders);
    is_the_same_in_batches(with_its_names::EveryLaw, arms::EveryLaw);
}

fn is_the_same<const N: usize>(one: impl Robot<N>, other: impl Robot<N>) {
    let (poses, wrenches): (Vec<SVector<f64, N>>, Vec<Vector6<f64>>) = trials::<N>(20, 5).unzip();
    for (q, wrench) in poses.iter().zip(&wrenches) {
        assert_eq!(one.transform(q), other.transform(q));
        assert_eq!(one.link_frames(q), other.link_frames(q));
        assert_eq!(one.jacobian(q), other.jacobian(q));
        assert_eq!(one.compliance(q), other.compliance(q));
        assert_eq!(one.deflection(q, wrench), other.deflection(q, wrench));
        assert_eq!(one.joint_torques(q, wrench), other.joint_torques(q, wrench));
        assert_eq!(one.statics(q).compliance, other.statics(q).compliance);
        let [mut after, mut after_other] = [State::new(), State::new()];
        assert_eq!(one.deflection_with(q, wrench, &mut after), other.deflection_with(q, wrench, &mut after_other));
        assert_eq!(after.plays, after_other.plays);
    }
    assert_eq!(one.joint_compliance(), other.joint_compliance());
}

fn is_the_same_in_batches<const N: usize>(one: impl Robot<N>, other: impl Robot<N>) {
    let poses: Vec<SVector<f64, N>> = trials::<N>(20, 5).map(|(q, _)| q).collect();
    let [mut compliances, mut compliances_other] = [(); 2].map(|()| vec![Matrix6::zeros(); poses.len()]);
    batch::compliance(&one, &poses[..], &mut compliances);
    batch::compliance(&other, &poses[..], &mut compliances_other);
    assert_eq!(compliances, compliances_other);
}
