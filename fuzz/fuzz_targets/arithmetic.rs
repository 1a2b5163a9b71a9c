//! See `antumbra_fuzzing::arithmetic`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| antumbra_fuzzing::arithmetic(bytes));
