//! See `antumbra_fuzzing::tape`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| antumbra_fuzzing::tape(bytes));
