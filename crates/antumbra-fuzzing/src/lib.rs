//! Properties that hold whatever the input bytes are. `fuzz/` runs them under libFuzzer, `tests/` on random bytes and on
//! the finds of earlier runs.
//!
//! | target | input | property |
//! |---|---|---|
//! | [`arithmetic()`] | operands of one interval operation | the exact value at a member is in the result; batches agree |
//! | [`formula()`] | a text | no panic; printed and read again it is the same; simplified and rewritten it means the same |
//! | [`scene()`] | a scene file | no panic; written and read again it is the same |
//! | [`tape()`] | clauses, or a formula | bad clauses are refused; a compiled tape computes what the graph denotes |
//! | [`evaluators()`] | a tape, a box, points | values lie in the ranges of all kinds of number; no claim of continuity is false |
//! | [`regions()`] | a tape, boxes, points | the shorter tapes of regions contain its values, and are defined where it is |
//! | [`import()`] | a file of another program | no panic; a wrong line is refused |
//! | [`forms()`] | a tape, forms, symbols | planes admit the values, slopes the rises, gradients the differences |
//!
//! A violation panics with the data. Nothing here depends on anything but the bytes.
mod arithmetic;
mod continuity;
mod evaluators;
mod forms;
mod formula;
mod import;
mod input;
mod regions;
mod scene;
mod tape;
mod truth;

#[allow(unreachable_pub, reason = "the suite of the evaluators' tests; a part of it is used")]
#[path = "../../antumbra/tests/containment/mod.rs"]
mod containment;

pub use arithmetic::arithmetic;
pub use continuity::attack as attack_continuity;
pub use evaluators::evaluators;
pub use forms::forms;
pub use formula::formula;
pub use import::import;
pub use regions::regions;
pub use scene::scene;
pub use tape::tape;

/// A property of input bytes. Panics where it does not hold.
pub type Target = fn(&[u8]);

/// Every target by name.
pub const TARGETS: [(&str, Target); 8] = [
    ("arithmetic", arithmetic),
    ("formula", formula),
    ("tape", tape),
    ("evaluators", evaluators),
    ("forms", forms),
    ("scene", scene),
    ("regions", regions),
    ("import", import),
];
