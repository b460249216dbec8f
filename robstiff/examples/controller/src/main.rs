//! The control step on bare metal: no standard library, no runtime, no
//! allocator, and no panic: the panic handler calls a function that does not
//! exist, so the program links only if the compiler proved that no panic can be
//! reached.
#![no_std]
#![no_main]

use core::hint::black_box;
use core::panic::PanicInfo;

use robstiff_controller::{Controller, JOINTS, Limits};

/// Half a millimetre at two metres' reach, some 0.1 rad/s at a kilohertz, and
/// ten milliseconds of patience.
static LIMITS: Limits = Limits { size: 2.5e-4, rate: 1e-4, hold: 10 };

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

/// Control steps without end, where a real controller waits for its timer.
/// `black_box` stands for the encoders, the force sensor and the drives.
extern "C" fn run() -> ! {
    let mut controller = Controller::new(LIMITS);
    loop {
        let q: [f32; JOINTS] = black_box([0.3, -0.4, 0.5, 0.2, 1.2]);
        let wrench: Option<[f32; 6]> = black_box(Some([150.0, -200.0, 300.0, 0.0, 0.0, 0.0]));
        black_box(controller.step(&q, wrench.as_ref()));
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
