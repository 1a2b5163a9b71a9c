//! What two renders of one picture must have in common.
use antumbra::image::npy_bytes;
use antumbra::render::{Frame, Renderer, Stats};

/// Every plane as the bytes of its file, and the statistics without what may differ.
pub(crate) fn result(renderer: &Renderer) -> (Vec<Vec<u8>>, Stats) {
    (planes(renderer.frame()), counters(renderer))
}

/// Every plane as the bytes of its file.
pub(crate) fn planes(frame: &Frame) -> Vec<Vec<u8>> {
    frame.planes().unwrap().iter().map(|plane| npy_bytes(plane).unwrap()).collect()
}

/// The statistics without what may differ.
pub(crate) fn counters(renderer: &Renderer) -> Stats {
    let mut stats = renderer.stats();
    stats.threads = 0;
    let times = [&mut stats.grid_seconds, &mut stats.primary_seconds, &mut stats.shadow_seconds];
    times.into_iter().for_each(|t| *t = 0.0);
    (stats.shading_seconds, stats.seconds) = (0.0, 0.0);
    stats
}
