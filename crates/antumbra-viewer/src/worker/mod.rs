//! A thread that draws what was asked for last: coarse at once, then finer and finer, to the proof. Knows no window.
//!
//! A [`Job`] says what; of several only the last one counts. Its first, coarse picture is always finished, so that something moves
//! under a hand; everything after it is given up as soon as there is a newer job. What cannot be built leaves the picture that was
//! there, and its work goes on.
mod image;
mod pace;
mod painter;

pub use image::{Image, Kind, settled as is_settled};
pub use pace::Pace;

use crate::priority::step_back;
use antumbra::{
    render::{Frame, Method, Overlay, RunSpec},
    scene::{FileError, Scene, SceneFile},
};
use painter::{News, Painter};
use std::{
    ops::Range,
    sync::{
        Arc, Condvar, Mutex, MutexGuard, PoisonError,
        atomic::{AtomicBool, Ordering},
        mpsc,
    },
    thread::JoinHandle,
    time::Duration,
};

/// What is to be drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Job {
    /// Comes back with everything that is drawn for it.
    pub revision: u64,
    /// Name of the scene.
    pub name: String,
    /// The scene.
    pub file: SceneFile,
    /// Pixels per row and rows of the finest picture.
    pub size: [usize; 2],
    /// One method, or two to be seen side by side.
    pub methods: Vec<Method>,
    /// What is shown instead of the colours.
    pub overlay: Option<Overlay>,
}

/// Why a job cannot be drawn.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Refusal {
    /// What is wrong, and what to do.
    pub message: String,
    /// Index of the surface and the place in its formula, in bytes, where it is one.
    pub place: Option<(usize, Range<usize>)>,
}

/// What the thread tells.
#[derive(Debug)]
pub enum Event {
    /// The scene of a job was built.
    Built {
        /// Of the job.
        revision: u64,
        /// The scene.
        scene: Arc<Scene>,
    },
    /// A job cannot be drawn; the picture before it goes on.
    Refused {
        /// Of the job.
        revision: u64,
        /// Why.
        refusal: Refusal,
    },
    /// A picture.
    Image(Box<Image>),
    /// Everything of a job is done.
    Done {
        /// Of the job.
        revision: u64,
        /// Seconds since it was taken up.
        seconds: f64,
    },
}

/// What the owner and the thread share.
struct Mailbox {
    slot: Mutex<Slot>,
    news: Condvar,
    hurried: AtomicBool,
}

#[derive(Default)]
struct Slot {
    job: Option<Job>,
    /// Stops what is drawn.
    stop: Option<Arc<AtomicBool>>,
    /// It is the first picture of its job: a newer job does not stop it.
    patient: bool,
    quit: bool,
    /// Frames to let go.
    old: Vec<Arc<Frame>>,
}

impl Mailbox {
    fn slot(&self) -> MutexGuard<'_, Slot> {
        self.slot.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Says whether the thread draws something that somebody's hand waits for: others should leave the processors to it.
#[derive(Clone)]
pub struct Hurry(Arc<Mailbox>);

impl Hurry {
    /// Whether it does.
    #[must_use]
    pub fn hurried(&self) -> bool {
        self.0.hurried.load(Ordering::Relaxed)
    }
}

/// The thread and its mailbox; dropped, it ends.
pub struct Worker {
    mailbox: Arc<Mailbox>,
    events: mpsc::Receiver<Event>,
    thread: Option<JoinHandle<()>>,
}

impl Worker {
    /// Starts the thread. `wake` is called after every event, from that thread.
    ///
    /// # Errors
    /// Where the system gives no thread.
    pub fn start(run: RunSpec, wake: impl Fn() + Send + 'static) -> std::io::Result<Self> {
        let mailbox =
            Arc::new(Mailbox { slot: Mutex::default(), news: Condvar::new(), hurried: AtomicBool::new(false) });
        let (send, events) = mpsc::channel();
        let inside = Arc::clone(&mailbox);
        let tell = move |event| {
            // Nobody listens any more: the thread is about to be ended.
            let _ = send.send(event);
            wake();
        };
        let thread =
            std::thread::Builder::new().name("antumbra-draw".to_owned()).spawn(move || draw(&inside, run, &tell))?;
        Ok(Self { mailbox, events, thread: Some(thread) })
    }

    /// Asks for something else. What is drawn is given up, unless it is the first picture of its job.
    pub fn submit(&self, job: Job) {
        let mut slot = self.mailbox.slot();
        slot.job = Some(job);
        if let Some(stop) = slot.stop.as_ref().filter(|_| !slot.patient) {
            stop.store(true, Ordering::Relaxed);
        }
        self.mailbox.news.notify_all();
    }

    /// Takes a frame that is not looked at any more: letting go of that much memory takes milliseconds, which a window does not have.
    pub fn give_back(&self, frame: Arc<Frame>) {
        self.mailbox.slot().old.push(frame);
        self.mailbox.news.notify_all();
    }

    /// The next event, if there is one.
    #[must_use]
    pub fn event(&self) -> Option<Event> {
        self.events.try_recv().ok()
    }

    /// The next event, waited for.
    #[must_use]
    pub fn wait(&self, most: Duration) -> Option<Event> {
        self.events.recv_timeout(most).ok()
    }

    /// Whether a hand waits.
    #[must_use]
    pub fn hurry(&self) -> Hurry {
        Hurry(Arc::clone(&self.mailbox))
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        {
            let mut slot = self.mailbox.slot();
            (slot.quit, slot.job) = (true, None);
            if let Some(stop) = &slot.stop {
                stop.store(true, Ordering::Relaxed);
            }
            self.mailbox.news.notify_all();
        }
        if let Some(thread) = self.thread.take() {
            // A panic in it was reported when it happened.
            let _ = thread.join();
        }
    }
}

/// The thread: takes the newest job, else draws a little more of what there is.
fn draw(mailbox: &Mailbox, run: RunSpec, tell: &dyn Fn(Event)) {
    step_back();
    let mut painter = Painter::new(run);
    loop {
        let job = {
            let mut slot = mailbox.slot();
            loop {
                if slot.quit {
                    return;
                }
                if !slot.old.is_empty() {
                    let old = std::mem::take(&mut slot.old);
                    drop(slot);
                    drop(old);
                    slot = mailbox.slot();
                    continue;
                }
                if let Some(job) = slot.job.take() {
                    break Some(job);
                }
                if painter.busy() {
                    break None;
                }
                mailbox.hurried.store(false, Ordering::Relaxed);
                slot = mailbox.news.wait(slot).unwrap_or_else(PoisonError::into_inner);
            }
        };
        if let Some(job) = job {
            mailbox.hurried.store(true, Ordering::Relaxed);
            painter.take(job, tell);
        }
        let Some(stop) = painter.ready(tell) else { continue };
        {
            // Under the lock: whoever submits afterwards sets this flag.
            let mut slot = mailbox.slot();
            slot.patient = painter.first();
            stop.store(slot.quit || (slot.job.is_some() && !slot.patient), Ordering::Relaxed);
            slot.stop = Some(stop);
            mailbox.hurried.store(slot.patient, Ordering::Relaxed);
        }
        let news = || {
            let slot = mailbox.slot();
            if slot.quit {
                News::End
            } else if slot.job.is_some() {
                News::Job
            } else {
                News::Nothing
            }
        };
        painter.step(&news, tell);
    }
}

impl Refusal {
    fn of(error: &FileError) -> Self {
        let surface = |key: &str| {
            let (number, rest) = key.strip_prefix("surface[")?.split_once(']')?;
            (rest == ".formula").then_some(())?;
            number.parse::<usize>().ok()?.checked_sub(1)
        };
        match error {
            FileError::Formula { key, message, place } => {
                let message = message.strip_prefix("error: ").unwrap_or(message).to_owned();
                Self { message, place: surface(key).zip(place.clone()) }
            }
            FileError::Shape { .. } | FileError::Value { .. } => Self { message: error.to_string(), place: None },
        }
    }
}

#[cfg(test)]
mod tests;
