//! Targets for libFuzzer.

pub use libfuzzer_sys;
pub use robstiff_tests::fuzz;

/// Gives the bytes of libFuzzer to a target, and texts of its grammar and mistakes that people
/// make to libFuzzer, beside its own changes.
#[macro_export]
macro_rules! target {
    ($name:literal) => {
        $crate::libfuzzer_sys::fuzz_target!(|data: &[u8]| {
            let _ = ($crate::fuzz::target($name).check)(data);
        });

        $crate::libfuzzer_sys::fuzz_mutator!(|data: &mut [u8], size: usize, max_size: usize, seed: u32| {
            $crate::changed($name, data, size, max_size, seed)
        });
    };
}

/// Changes the first `size` of some bytes: the new size.
pub fn changed(name: &str, data: &mut [u8], size: usize, max_size: usize, seed: u32) -> usize {
    if seed % 4 == 0 {
        return libfuzzer_sys::fuzzer_mutate(data, size, max_size);
    }
    let grammar = fuzz::target(name).grammar;
    let text = fuzz::mutated::mutated(&data[..size], &data[..size], grammar, seed.into());
    let size = text.len().min(max_size);
    data[..size].copy_from_slice(&text[..size]);
    size
}
