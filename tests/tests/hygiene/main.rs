//! Generated code in files that have no prelude, or other things under the
//! names of one.

use robstiff::Robot;
use robstiff::nalgebra::SVector;

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
