//! A frame as it is shown.
use antumbra::{
    image::{COLOR_PLANE, Samples, codes_8},
    render::{Frame, Method, Overlay, Stats},
    scene::Look,
};
use std::sync::Arc;

/// A kind of pixels of an overlay.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Kind {
    /// Its colour, sRGB.
    pub color: [u8; 3],
    /// Its meaning.
    pub text: String,
    /// Pixels of this kind.
    pub count: usize,
}

/// A picture, whole or in part, and everything that is known of it.
#[derive(Clone, Debug)]
pub struct Image {
    /// Of the job.
    pub revision: u64,
    /// Which of the methods.
    pub side: usize,
    /// That method.
    pub method: Method,
    /// Pixels per row and rows.
    pub size: [usize; 2],
    /// Red, green, blue and alpha of each pixel, sRGB, rows from the top: the bytes of a number as they lie in memory, so that a window
    /// takes them as they are. Alpha is 0 where nothing is known yet, else 255.
    pub rgba: Vec<u32>,
    /// The planes.
    pub frame: Arc<Frame>,
    /// What was found, and what it took.
    pub stats: Stats,
    /// Whether every pixel of this size is done.
    pub whole: bool,
    /// Whether it is the finest.
    pub last: bool,
    /// Share of the work of this size, 0 to 1.
    pub progress: f64,
    /// The kinds of pixels of an overlay; empty where the colours are shown.
    pub legend: Vec<Kind>,
    /// Seconds since the job was taken up.
    pub seconds: f64,
}

/// Whether what is shown of a pixel is what the finished picture shows, up to its neighbours: the light of a hit must be known.
#[must_use]
pub fn settled(frame: &Frame, index: usize) -> bool {
    let unknown = |k: usize| frame.lights[k].visible_lo[index] == 0.0 && frame.lights[k].visible_hi[index] == 1.0;
    frame.verdict[index] != Frame::UNSEEN && !(0..frame.lights.len()).any(unknown)
}

/// The colours of a frame, opaque where they are settled (everywhere, if it is whole), and the legend of an overlay.
pub(super) fn shown(frame: &Frame, look: &Look, overlay: Option<(Overlay, f64)>, whole: bool) -> (Vec<u32>, Vec<Kind>) {
    let n = frame.verdict.len();
    let mut rgba = Vec::with_capacity(n);
    let alpha = |index: usize| if whole || settled(frame, index) { 255 } else { 0 };
    if let Some((overlay, tolerance)) = overlay {
        let legend = frame.legend(overlay, tolerance);
        let mut counts = vec![0; legend.entries.len()];
        for (index, kind) in legend.kinds.iter().enumerate() {
            let [r, g, b] = legend.entries[*kind].0;
            counts[*kind] += 1;
            rgba.push(premultiplied([r, g, b], alpha(index)));
        }
        let entries = legend.entries.into_iter().zip(counts).map(|((color, text), count)| Kind { color, text, count });
        return (rgba, entries.collect());
    }
    let picture = frame.picture(look);
    let plane = picture.as_ref().ok().and_then(|planes| planes.require(COLOR_PLANE).ok());
    let codes = match plane.map(|plane| plane.samples()) {
        Some(Samples::F32(light)) => codes_8(light),
        // A frame of the renderer always has such a plane.
        _ => vec![0; 3 * n],
    };
    for (index, c) in codes.chunks_exact(3).enumerate() {
        rgba.push(premultiplied([c[0], c[1], c[2]], alpha(index)));
    }
    (rgba, vec![])
}

fn premultiplied([r, g, b]: [u8; 3], alpha: u8) -> u32 {
    if alpha == 0 { 0 } else { u32::from_ne_bytes([r, g, b, alpha]) }
}
