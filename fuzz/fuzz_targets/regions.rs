//! See `antumbra_fuzzing::regions`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| antumbra_fuzzing::regions(bytes));
