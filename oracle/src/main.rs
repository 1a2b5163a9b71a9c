//! Compares Antumbra's arithmetic with MPFR and with inari: `cargo run --release -- [POINTS] [SEED]`, in this folder.
//!
//! **Points.** At single floats MPFR gives the two neighbours of the real value (its functions are correctly rounded in
//! every direction). **Boxes.** On intervals inari gives the tightest enclosure. Ours must contain both; how much wider
//! it is, is counted in floats. **Forms.** Affine forms and slopes are held against values of MPFR at exact members.
//!
//! Prints the tables of `docs/accuracy.md`. Exit status 1 if anything is violated: a value outside an enclosure, an
//! enclosure of a point where the function is undefined, a bound that is farther out than [`function::Function::steps`].
mod box_side;
mod count;
mod forms;
mod function;
mod list;
mod point_side;
mod sample;
mod turns;

#[path = "../../crates/antumbra-interval/tests/nasty/mod.rs"]
mod nasty;

use count::Count;
use std::process::ExitCode;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let number = |i: usize, default: u64| arguments.get(i).map_or(Ok(default), |text| text.parse());
    let (Ok(points), Ok(seed)) = (number(0, 1_000_000), number(1, 1)) else {
        eprintln!("usage: antumbra-oracle [POINTS] [SEED], both whole numbers");
        return ExitCode::from(2);
    };
    let functions = list::functions();
    let counts = everywhere(functions.len(), |i| {
        let function = &functions[i];
        let mut count = Count::new(function.name, function.steps);
        point_side::check(function, points, seed, &mut count);
        box_side::check(function, points / 4, seed, &mut count);
        count
    });
    println!("{}", count::table(&counts));
    let operators = forms::operators();
    let forms = everywhere(operators.len(), |i| forms::check(operators[i], points / 40, seed));
    println!("{}", forms::table(&forms));

    let violations: Vec<&String> =
        counts.iter().flat_map(|c| &c.violations).chain(forms.iter().flat_map(|c| &c.violations)).collect();
    let total = counts.iter().map(|c| c.points + c.boxes + c.members).sum::<u64>()
        + forms.iter().map(|c| c.checks).sum::<u64>();
    println!("{total} comparisons, seed {seed}: {} violations", violations.len());
    for violation in violations.iter().take(50) {
        eprintln!("{violation}");
    }
    if violations.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// `work(0), work(1), ...` on all processors; the result does not depend on their number.
fn everywhere<T: Send>(n: usize, work: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let (next, done) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
    let threads = std::thread::available_parallelism().map_or(1, |n| n.get());
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                loop {
                    let i = next.fetch_add(1, Ordering::Relaxed);
                    if i >= n {
                        break;
                    }
                    let result = work(i);
                    done.lock().expect("no worker panicked").push((i, result));
                }
            });
        }
    });
    let mut done = done.into_inner().expect("no worker panicked");
    done.sort_by_key(|(i, _)| *i);
    done.into_iter().map(|(_, result)| result).collect()
}
