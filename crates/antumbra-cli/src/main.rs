//! `antumbra`: formula in, picture out.
//!
//! The program is thin: arguments ([`args`]) become validated options ([`options`]), a command ([`commands`]) hands
//! them to the heart and its results to files ([`output`]). Exit codes: [`failure`].

mod animation;
mod args;
mod bands;
mod commands;
#[cfg(test)]
mod documents;
mod failure;
mod import;
mod interrupt;
mod missing;
mod options;
mod output;
mod progress;
mod unfinished;
mod values;
mod view;

use std::process::ExitCode;

fn main() -> ExitCode {
    let args = args::Args::of(std::env::args_os()).unwrap_or_else(|error| error.exit());
    match interrupt::install().and_then(|()| commands::run(args)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            let sort = if error.is::<failure::Interrupted>() { "" } else { "error: " };
            output::remark(&format!("{sort}{error:#}"));
            failure::code(&error)
        }
    }
}
