//! Random containment checks, as many as you like: `cargo run --release -p antumbra --example containment -- 10000000 [seed]`.
//!
//! Every operator on nasty boxes, interval, gradient and affine evaluators, against correctly rounded values. Prints the
//! checks of each operator; exits with 1 and the data of each violation if there is one.
#[path = "../tests/containment/mod.rs"]
mod containment;

use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let number = |i: usize, default: u64| arguments.get(i).map_or(Ok(default), |text| text.parse());
    let (Ok(checks), Ok(seed)) = (number(0, 1_000_000), number(1, 1)) else {
        eprintln!("usage: containment [CHECKS] [SEED], both whole numbers");
        return ExitCode::from(2);
    };
    let counts = containment::run(checks, seed);
    for count in &counts {
        println!("{:>16} {:>10} checks {:>3} violations", count.operator.name(), count.checks, count.violations.len());
    }
    let violations: Vec<&String> = counts.iter().flat_map(|c| &c.violations).collect();
    let total: u64 = counts.iter().map(|c| c.checks).sum();
    println!("{total} checks of {} operators, seed {seed}: {} violations", counts.len(), violations.len());
    for violation in &violations {
        eprintln!("{violation}");
    }
    if violations.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
