//! See `antumbra_fuzzing::import`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| antumbra_fuzzing::import(bytes));
