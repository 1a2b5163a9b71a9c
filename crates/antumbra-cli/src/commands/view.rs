//! `antumbra view`: the window.

use std::sync::Arc;

use antumbra::render::RunSpec;
use antumbra_viewer::{Options, Report};
use anyhow::{Result, anyhow};

use crate::{
    output::remark,
    view::{Program, ViewArgs, find},
};

/// Opens the window and waits until it is closed.
pub(super) fn run(args: &ViewArgs) -> Result<()> {
    let options = Options { start: find(&args.scene)?, run: RunSpec { threads: args.threads }, glow: args.opengl };
    let Report { timings, drawn_by } = antumbra_viewer::run(Arc::new(Program), options).map_err(|e| anyhow!("{e}"))?;
    if args.timings {
        let mean = 1e3 * timings.latencies / timings.answers.max(1) as f64;
        remark(&format!(
            "drawn with {drawn_by}: {} frames of the window, the longest {:.1} ms; {} pictures asked for, the first one there after {mean:.0} ms on average, \
             {:.0} ms at most",
            timings.frames,
            1e3 * timings.longest,
            timings.answers,
            1e3 * timings.latency,
        ));
    }
    Ok(())
}
