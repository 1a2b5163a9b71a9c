//! Command line of Antumbra.
fn main() {}
