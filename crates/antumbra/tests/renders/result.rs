//! What two renders of one picture must have in common.
use antumbra::image::npy_bytes;
use antumbra::render::{Renderer, Stats};

/// Every plane as the bytes of its file, and the statistics without what may differ.
pub(crate) fn result(renderer: &Renderer) -> (Vec<Vec<u8>>, Stats) {
    let planes = renderer.frame().planes().unwrap();
    let mut stats = renderer.stats();
    stats.threads = 0;
    let times = [&mut stats.grid_seconds, &mut stats.primary_seconds, &mut stats.shadow_seconds];
    times.into_iter().for_each(|t| *t = 0.0);
    (stats.shading_seconds, stats.seconds) = (0.0, 0.0);
    (planes.iter().map(|plane| npy_bytes(plane).unwrap()).collect(), stats)
}
