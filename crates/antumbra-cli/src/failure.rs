//! Exit codes: 0 done, 1 failed, 2 not understood, 130 interrupted.

use std::process::ExitCode;

/// What `antumbra --help` says about exit codes.
pub(crate) const EXIT_CODES: &str = "\
Exit codes:
  0    done (also where the reader of a pipe has gone away)
  1    failed: a file could not be written, a picture not computed; nothing is left half-written
  2    not understood: an option, a scene name or a formula is wrong
  130  interrupted by Ctrl-C; nothing is left half-written, and `render --resume` goes on";

/// The command line, a scene name or a formula is wrong: exit code 2, as clap has it for its own errors.
#[derive(Debug)]
pub(crate) struct Usage(pub(crate) String);

impl std::fmt::Display for Usage {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Usage {}

/// Ctrl-C, and what was kept: exit code 130.
#[derive(Debug)]
pub(crate) struct Interrupted(pub(crate) String);

impl std::fmt::Display for Interrupted {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "interrupted: {}", self.0)
    }
}

impl std::error::Error for Interrupted {}

/// Exit code 2 for [`Usage`], 130 for [`Interrupted`], 1 for everything else.
pub(crate) fn code(error: &anyhow::Error) -> ExitCode {
    ExitCode::from(if error.is::<Usage>() {
        2
    } else if error.is::<Interrupted>() {
        130
    } else {
        1
    })
}
