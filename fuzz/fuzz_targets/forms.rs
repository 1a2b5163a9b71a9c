//! See `antumbra_fuzzing::forms`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| antumbra_fuzzing::forms(bytes));
