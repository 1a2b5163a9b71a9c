//! See `antumbra_fuzzing::formula`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| antumbra_fuzzing::formula(bytes));
