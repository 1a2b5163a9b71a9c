//! Small pictures of the gallery, drawn by a thread that steps back when somebody's hand waits for the processors.
use crate::{priority::step_back, worker::Hurry};
use antumbra::{
    image::{COLOR_PLANE, Samples, codes_8},
    render::{RenderSpec, Renderer, RunSpec},
    scene::named,
};
use std::{
    collections::VecDeque,
    sync::{
        Arc, Condvar, Mutex, PoisonError,
        atomic::{AtomicBool, Ordering},
        mpsc,
    },
    thread::JoinHandle,
    time::Duration,
};

/// Pixels of each side of a thumbnail.
pub const SIDE: usize = 96;

/// Work between two looks at who waits.
const SLICE: Duration = Duration::from_millis(15);
/// How long it steps back.
const BACK: Duration = Duration::from_millis(30);

/// A picture of a scene by name.
#[derive(Clone, Debug)]
pub struct Thumbnail {
    /// The name.
    pub name: String,
    /// Red, green, blue and alpha of [`SIDE`] x [`SIDE`] pixels; `None` where the scene cannot be drawn.
    pub rgba: Option<Vec<u8>>,
}

#[derive(Default)]
struct Wanted {
    names: Mutex<VecDeque<String>>,
    news: Condvar,
    end: AtomicBool,
}

/// The thread; dropped, it ends.
pub struct Thumbnails {
    wanted: Arc<Wanted>,
    done: mpsc::Receiver<Thumbnail>,
    thread: Option<JoinHandle<()>>,
}

impl Thumbnails {
    /// Starts the thread. `wake` is called after every picture.
    ///
    /// # Errors
    /// Where the system gives no thread.
    pub fn start(hurry: Hurry, wake: impl Fn() + Send + 'static) -> std::io::Result<Self> {
        let wanted = Arc::new(Wanted::default());
        let (send, done) = mpsc::channel();
        let inside = Arc::clone(&wanted);
        let work = move || {
            step_back();
            while let Some(name) = inside.next() {
                let rgba = draw(&name, &hurry, &inside.end);
                if send.send(Thumbnail { name, rgba }).is_err() {
                    return;
                }
                wake();
            }
        };
        let thread = std::thread::Builder::new().name("antumbra-thumbnails".to_owned()).spawn(work)?;
        Ok(Self { wanted, done, thread: Some(thread) })
    }

    /// Asks for a picture; each name once.
    pub fn want(&self, name: &str) {
        self.wanted.names.lock().unwrap_or_else(PoisonError::into_inner).push_back(name.to_owned());
        self.wanted.news.notify_all();
    }

    /// The next picture that is done, if there is one.
    #[must_use]
    pub fn done(&self) -> Option<Thumbnail> {
        self.done.try_recv().ok()
    }
}

impl Drop for Thumbnails {
    fn drop(&mut self) {
        {
            let mut names = self.wanted.names.lock().unwrap_or_else(PoisonError::into_inner);
            names.clear();
            self.wanted.end.store(true, Ordering::Relaxed);
            self.wanted.news.notify_all();
        }
        if let Some(thread) = self.thread.take() {
            // A panic in it was reported when it happened.
            let _ = thread.join();
        }
    }
}

impl Wanted {
    /// The next name; `None` at the end.
    fn next(&self) -> Option<String> {
        let mut names = self.names.lock().unwrap_or_else(PoisonError::into_inner);
        loop {
            if self.end.load(Ordering::Relaxed) {
                return None;
            }
            if let Some(name) = names.pop_front() {
                return Some(name);
            }
            names = self.news.wait(names).unwrap_or_else(PoisonError::into_inner);
        }
    }
}

/// A small certified picture, on one processor.
fn draw(name: &str, hurry: &Hurry, end: &AtomicBool) -> Option<Vec<u8>> {
    let scene = Arc::new(named(name)?.ok()?);
    let spec = RenderSpec {
        width: SIDE,
        height: SIDE,
        floor: scene.floor_shown,
        // Shades are coarser than this on so small a picture.
        tolerance: 1.0 / 32.0,
        ..RenderSpec::default()
    };
    let look = scene.look;
    let mut renderer = Renderer::new(scene, spec, RunSpec { threads: Some(1) }).ok()?;
    loop {
        while hurry.hurried() && !end.load(Ordering::Relaxed) {
            std::thread::sleep(BACK);
        }
        if end.load(Ordering::Relaxed) {
            return None;
        }
        if renderer.refine(SLICE) {
            break;
        }
    }
    let planes = renderer.frame().picture(&look).ok()?;
    match planes.require(COLOR_PLANE).ok()?.samples() {
        Samples::F32(light) => Some(codes_8(light).chunks_exact(3).flat_map(|c| [c[0], c[1], c[2], 255]).collect()),
        _ => None,
    }
}
