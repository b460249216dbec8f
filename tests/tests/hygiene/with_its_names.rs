//! Generated code in a module that has constants, statics, unit structs and variants under
//! the names of its variables and parameters, methods for all types under those of the
//! methods that it calls, and modules under those of the crates that it names.
#![allow(clippy::new_ret_no_self, dead_code, unused_imports, non_camel_case_types, non_upper_case_globals)]

macro_rules! constants {
    ($($name:ident)*) => { $(const $name: f64 = 7.0;)* };
}

macro_rules! statics {
    ($($name:ident)*) => { $(static $name: f64 = 7.0;)* };
}

macro_rules! unit_structs {
    ($($name:ident)*) => { $(struct $name;)* };
}

constants! {
    q wrench state put
    t1 t2 t3 t4 t5 t6 t7 t8 t9 t10 t11 t12 t13 t14 t15 t16 t17 t18 t19 t20 t30 t40 t50 t99
    k1 k2 k3 k4 k5 k6 k7 k8 k9 k10 k11 k12
    s1 s1o s1o_2 s14o s2 s2o s23 s41x7 s3 s4 s4o s5 s5o s6 s7
    r1x r1y r2x r3z r4z r5x r5y r6z l1x l2x l2z l3x l4z l5x l5z
    sin_base_yaw cos_base_yaw tool_yaw theta1 theta4
    tt_xx tt_xy tt1_xx tt2_xx tt3_xx tt4_yy tt5_xx tr_xx tr1_xx tr4_xy tr5_yz rr_xx rr1_xx rr2_zz
    p_ p_x p1_x p2_y x_ x_x x2_x y_ y_x y2_x z_ z_x z3_x z5x
    before3_1 play3_1 weight1_3 radius1_3 e3 minus_t34 minus_rr2_xz
}

statics! {
    c1 c1o c1o_2 c14o c2 c2o c23 c2x4 c3 c4 c4o c5 c5o c6 c7
    a1 a2 a3 a4 a5 d1 d2 d3 d4 d5 d6 d7 h1 h2 h3 h4 h5 h6 h7
    fx fy fz
}

unit_structs! {
    j1 j1x j2 j2x j3 j3x j4 j5 j5y j6 j6x
    dq1 dq2 dq3 dq4 dq5 dq6 tau1 tau2 tau3 tau4 tau5 tau6
    base_tilt base_x tool_x tool_rotation bending2 coupling5_6 sin_alpha3 cos_alpha3 transverse1
}

enum Named {
    mx,
    my(f64),
    mz {},
}

use Named::{mx, my};

struct h5_a5(f64);

/// Methods for all types, under names that generated code calls.
pub trait Other: Sized {
    fn of(_: f64) {}
    fn zero() {}
    fn one() {}
    fn from<T>(_: T) {}
    fn new() {}
    fn sin_cos_of_sums<T, F>(_: T, _: F) {}
    fn scaled_sin_cos_of_sums<T, F, G>(_: T, _: F, _: G) {}
    fn mul_add(self, _: Self, _: Self) {}
    fn turn_blocks<T>(_: T) {}
    fn scaled<T>(_: T) {}
    fn plus_scaled<T>(_: T) {}
    fn product<T>(_: T) {}
    fn plus_product<T>(_: T) {}
    fn cycled<T>(_: T) {}
    fn direction<T>(_: T) {}
    fn sqrt(self) {}
    fn recip(self) {}
    fn max(self, _: Self) {}
    fn min(self, _: Self) {}
    fn neg(self) {}
    fn mul<T>(self, _: T) {}
    fn index<T>(&self, _: T) {}
}

impl<T> Other for T {}

mod core {}
mod std {}
mod alloc {}
mod nalgebra {}
mod robstiff {}
mod robstiff_macros {}
mod mem {}

// Macros that derive something else.
use ::clap::{Args as Debug, Parser as Copy, Subcommand as Eq, ValueEnum as PartialEq};

::robstiff::robot!("rv130hsc.yaml");
::robstiff::robot!("kuka-kr210-l150.yaml");
::robstiff::robot!("every-effect.yaml");
::robstiff::robot!("every-law.yaml");
::robstiff::robot!("sliders.yaml");
