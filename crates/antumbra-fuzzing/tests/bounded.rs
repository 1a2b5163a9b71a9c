//! The fuzzer's properties on random bytes, the same every time, and on what the fuzzer has found.
use antumbra_fuzzing::TARGETS;
use std::path::Path;

/// SplitMix64: also for lengths, so that short inputs are common.
fn bytes(state: &mut u64) -> Vec<u8> {
    let mut next = || {
        *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = *state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    };
    let length = (next() % 40) as usize;
    (0..length).flat_map(|_| next().to_le_bytes()).collect()
}

fn random(name: &str, rounds: usize) {
    let (_, target) = TARGETS.iter().find(|(n, _)| *n == name).expect("a target");
    let mut state = 7;
    for _ in 0..rounds {
        target(&bytes(&mut state));
    }
}

#[test]
fn arithmetic_on_random_bytes() {
    random("arithmetic", 5_000);
}

#[test]
fn formulas_of_random_bytes() {
    random("formula", 3_000);
}

#[test]
fn tapes_of_random_bytes() {
    random("tape", 8_000);
}

#[test]
fn evaluators_on_random_bytes() {
    random("evaluators", 4_000);
}

#[test]
fn forms_on_random_bytes() {
    random("forms", 3_000);
}

#[test]
fn scenes_of_random_bytes() {
    random("scene", 3_000);
}

#[test]
fn regions_of_random_bytes() {
    random("regions", 1_500);
}

#[test]
fn imports_of_random_bytes() {
    random("import", 3_000);
}

/// Inputs that once broke something.
#[test]
fn finds_of_the_fuzzer_are_right_now() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("finds");
    for (name, target) in TARGETS {
        let Ok(entries) = std::fs::read_dir(folder.join(name)) else { continue };
        for entry in entries {
            target(&std::fs::read(entry.unwrap().path()).unwrap());
        }
    }
}
