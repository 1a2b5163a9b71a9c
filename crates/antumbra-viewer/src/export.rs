//! A picture of any size, drawn and written in the background.
use crate::{host::SharedHost, priority::step_back};
use antumbra::{
    image::{COLOR_PLANE, Depth, check_size, exr_bytes, png_bytes},
    render::{Method, Overlay, RenderSpec, Renderer, RunSpec},
    scene::SceneFile,
};
use std::{
    path::PathBuf,
    sync::{
        Arc, Mutex, PoisonError,
        atomic::{AtomicBool, Ordering},
    },
    thread::JoinHandle,
    time::Duration,
};

/// Work between two looks at the clock.
const SLICE: Duration = Duration::from_millis(100);

/// What is to be written.
#[derive(Clone, Debug)]
pub struct Order {
    /// Ends in `.png` or `.exr`.
    pub path: PathBuf,
    /// Name of the scene.
    pub name: String,
    /// The scene.
    pub file: SceneFile,
    /// Pixels per row and rows.
    pub size: [usize; 2],
    /// How shadows are found.
    pub method: Method,
    /// What is drawn instead of the colours; PNG only.
    pub overlay: Option<Overlay>,
    /// Whether a PNG has 16 bits per channel, not 8.
    pub deep: bool,
}

/// How far it is.
#[derive(Clone, Debug, PartialEq)]
pub enum Progress {
    /// Share of the work, 0 to 1, and about how long the rest takes.
    Drawing(f64, Option<Duration>),
    /// The file is there.
    Written(PathBuf),
    /// Somebody did not want it any more; nothing was written.
    Cancelled,
    /// It could not be done; nothing was written.
    Failed(String),
}

/// An export under way; dropped, it is cancelled.
pub struct Export {
    state: Arc<Mutex<Progress>>,
    cancel: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Export {
    /// Begins. `wake` is called when the progress has changed.
    ///
    /// # Errors
    /// In words: where the path cannot be written or names no format, the size is none, or there is no thread.
    pub fn begin(
        order: Order,
        host: &SharedHost,
        run: RunSpec,
        wake: impl Fn() + Send + 'static,
    ) -> Result<Self, String> {
        let format = order.path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
        if !["png", "exr"].contains(&format.as_str()) {
            return Err(format!("`{}` has no format that is known: end it in .png or .exr", order.path.display()));
        }
        check_size(order.size).map_err(|e| e.to_string())?;
        let place = host.reserve(&order.path)?;
        let state = Arc::new(Mutex::new(Progress::Drawing(0.0, None)));
        let cancel = Arc::new(AtomicBool::new(false));
        let (shared, asked) = (Arc::clone(&state), Arc::clone(&cancel));
        let work = move || {
            step_back();
            let tell = |progress| {
                *shared.lock().unwrap_or_else(PoisonError::into_inner) = progress;
                wake();
            };
            let end = match draw(&order, &format, run, &asked, &|share, rest| tell(Progress::Drawing(share, rest))) {
                Ok(Some(bytes)) => match place.fill(&bytes) {
                    Ok(()) => Progress::Written(order.path),
                    Err(error) => Progress::Failed(error),
                },
                Ok(None) => Progress::Cancelled,
                Err(error) => Progress::Failed(error),
            };
            tell(end);
        };
        let thread = std::thread::Builder::new().name("antumbra-export".to_owned()).spawn(work);
        let thread = thread.map_err(|e| format!("there is no thread for it: {e}"))?;
        Ok(Self { state, cancel, thread: Some(thread) })
    }

    /// How far it is.
    #[must_use]
    pub fn progress(&self) -> Progress {
        self.state.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Asks it to end without a file.
    pub fn cancel(&self) {
        self.cancel.store(true, Ordering::Relaxed);
    }
}

impl Drop for Export {
    fn drop(&mut self) {
        self.cancel();
        if let Some(thread) = self.thread.take() {
            // A panic in it was reported when it happened.
            let _ = thread.join();
        }
    }
}

/// The bytes of the file; `None` where it was cancelled.
fn draw(
    order: &Order,
    format: &str,
    run: RunSpec,
    cancel: &AtomicBool,
    tell: &dyn Fn(f64, Option<Duration>),
) -> Result<Option<Vec<u8>>, String> {
    let words = |e: antumbra::image::Error| e.to_string();
    let scene = Arc::new(order.file.scene(&order.name).map_err(|e| e.to_string())?);
    let [width, height] = order.size;
    let tolerance = scene.output.tolerance.unwrap_or(RenderSpec::default().tolerance);
    let (method, floor) = (order.method, scene.floor_shown);
    let spec = RenderSpec { width, height, method, floor, tolerance, ..RenderSpec::default() };
    let mut renderer = Renderer::new(Arc::clone(&scene), spec, run).map_err(|e| e.to_string())?;
    while !renderer.refine(SLICE) {
        if cancel.load(Ordering::Relaxed) {
            return Ok(None);
        }
        tell(renderer.progress(), renderer.remaining());
    }
    let frame = renderer.frame();
    let depth = if order.deep { Depth::Sixteen } else { Depth::Eight };
    let bytes = match (format, order.overlay) {
        ("exr", _) => exr_bytes(&frame.planes().map_err(words)?),
        (_, overlay) => {
            let planes = match overlay {
                Some(overlay) => frame.overlay(overlay, tolerance),
                None => frame.picture(&scene.look),
            };
            png_bytes(planes.map_err(words)?.require(COLOR_PLANE).map_err(words)?, depth)
        }
    };
    let bytes = bytes.map_err(words)?;
    Ok((!cancel.load(Ordering::Relaxed)).then_some(bytes))
}

#[cfg(test)]
mod tests;
