//! Every method of the trait `Robot` of arms that together have every effect there is, in `f32`
//! and in `f64`, on bare metal. The panic handler calls a function that does not exist, so the program links
//! only if the compiler proved that no panic can be reached.
#![no_std]
#![no_main]

use core::hint::black_box;
use core::panic::PanicInfo;

use robstiff::nalgebra::{SVector, Vector6};
use robstiff::{Real, Robot, State, upper_triangle};

macro_rules! robots {
    ($($robot:ident $file:literal)*) => {
        $(robstiff::robot!($file);)*

        fn every_robot() {
            $(
                facts(&$robot);
                calculations::<f32, _>(&$robot);
                calculations::<f64, _>(&$robot);
            )*
        }
    };
}

robots! {
    EveryEffect "../robots/every-effect.yaml"
    EveryLaw "../robots/every-law.yaml"
    Preloaded "../robots/preloaded.yaml"
}

/// What needs no pose.
#[inline(never)]
fn facts<const N: usize>(robot: &impl Robot<N>) {
    black_box(robot.name());
    black_box(robot.convention());
    black_box(&robot.joint_kinds());
    black_box(&robot.joint_compliance());
    black_box(&robot.limits());
    black_box(robot.effects());
    black_box(&robot.base());
    black_box(&robot.tool());
}

/// What is calculated. `black_box` stands for encoders, force sensor and drives: the compiler
/// knows no number.
#[inline(never)]
fn calculations<T: Real, const N: usize>(robot: &impl Robot<N>) {
    let (mut q, mut wrench, mut state) = (SVector::<T, N>::zeros(), Vector6::<T>::zeros(), State::<N, T>::new());
    let (q, wrench, state) = (&*black_box(&mut q), &*black_box(&mut wrench), black_box(&mut state));
    black_box(&robot.transform(q));
    black_box(&robot.link_frames(q));
    black_box(&robot.jacobian(q));
    black_box(&robot.compliance(q));
    black_box(&upper_triangle(&robot.compliance(q)));
    robot.compliance_entries(q, |place, entry| {
        black_box((place, entry));
    });
    black_box(&robot.deflection(q, wrench));
    black_box(&robot.deflection_with(q, wrench, state));
    black_box(state);
    black_box(&robot.joint_torques(q, wrench));
    black_box(&robot.preload(q));
    black_box(&robot.statics(q));
}

/// The entry. The kernel, which calls nothing, leaves no return address on the
/// stack; code behind a call expects one, and its aligned stores would fault.
///
/// # Safety
/// Nothing else is called `_start`.
#[cfg(target_arch = "x86_64")]
#[unsafe(no_mangle)]
#[unsafe(naked)]
pub extern "C" fn _start() -> ! {
    core::arch::naked_asm!("and rsp, -16", "call {run}", "ud2", run = sym run)
}

/// The entry.
///
/// # Safety
/// Nothing else is called `_start`.
#[cfg(not(target_arch = "x86_64"))]
#[unsafe(no_mangle)]
pub extern "C" fn _start() -> ! {
    run()
}

extern "C" fn run() -> ! {
    loop {
        every_robot();
    }
}

unsafe extern "C" {
    /// Defined nowhere.
    fn a_panic_can_be_reached() -> !;
}

#[panic_handler]
fn panic(_: &PanicInfo<'_>) -> ! {
    // SAFETY: never called, or the program would not have linked.
    unsafe { a_panic_can_be_reached() }
}
