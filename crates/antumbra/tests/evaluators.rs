//! The one suite that every evaluator passes: the same checks on every kind of number, at every operator of the language.
#[path = "containment/mod.rs"]
mod containment;
#[path = "evaluators/mod.rs"]
mod suite;
