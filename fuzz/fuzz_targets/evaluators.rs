//! See `antumbra_fuzzing::evaluators`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| antumbra_fuzzing::evaluators(bytes));
