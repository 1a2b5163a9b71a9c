//! See `antumbra_fuzzing::scene`.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| antumbra_fuzzing::scene(bytes));
