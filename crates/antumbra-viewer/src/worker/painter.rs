//! One job after another, size by size, slice by slice.
use super::{Event, Image, Job, Pace, Refusal, image};
use antumbra::{
    render::{Frame, Method, Overlay, RenderSpec, Renderer, RunSpec, Stats},
    scene::{FileError, Scene, SceneFile},
};
use std::{
    collections::VecDeque,
    sync::{Arc, atomic::AtomicBool},
    time::{Duration, Instant},
};

/// Work between two looks at the mailbox, for a first picture and for others.
const FIRST_SLICE: Duration = Duration::from_millis(8);
const SLICE: Duration = Duration::from_millis(60);
/// A first picture that takes longer is given up for a newer job.
const PATIENCE: Duration = Duration::from_millis(160);
/// Time between two pictures of unfinished work: at least, and in units of what it takes to show one.
const OFTEN: Duration = Duration::from_millis(200);
const SHARE: u32 = 8;

/// What waits in the mailbox.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum News {
    Nothing,
    Job,
    End,
}

/// What draws.
pub(super) struct Painter {
    run: RunSpec,
    pace: Pace,
    built: Option<(SceneFile, Arc<Scene>)>,
    painting: Option<Painting>,
    /// The last pictures of each side that were shown: whole ones.
    shown: Vec<Shown>,
}

/// A job on the easel.
struct Painting {
    job: Job,
    scene: Arc<Scene>,
    begun: Instant,
    steps: VecDeque<Step>,
    current: Option<Current>,
    /// Seconds and pixels of the first steps so far.
    spent: (f64, usize),
}

/// A size of a side.
#[derive(Clone, Copy, Debug)]
struct Step {
    side: usize,
    method: Method,
    size: [usize; 2],
    first: bool,
    last: bool,
}

struct Current {
    step: Step,
    renderer: Renderer,
    begun: Instant,
    shown: Instant,
    pause: Duration,
}

/// What a picture was made of, to be shown in another way.
struct Shown {
    step: Step,
    frame: Arc<Frame>,
    stats: Stats,
}

impl Painter {
    pub(super) fn new(run: RunSpec) -> Self {
        Self { run, pace: Pace::default(), built: None, painting: None, shown: vec![] }
    }

    /// Whether there is something left to do.
    pub(super) fn busy(&self) -> bool {
        self.painting.as_ref().is_some_and(|p| p.current.is_some() || !p.steps.is_empty())
    }

    /// Whether what is drawn is the first picture of its job.
    pub(super) fn first(&self) -> bool {
        self.painting.as_ref().and_then(|p| p.current.as_ref()).is_some_and(|c| c.step.first)
    }

    /// Begins a job, if its scene can be built; else goes on with the one before.
    pub(super) fn take(&mut self, job: Job, tell: &dyn Fn(Event)) {
        let begun = Instant::now();
        let revision = job.revision;
        let scene = match self.build(&job) {
            Ok(scene) => scene,
            Err(error) => return tell(Event::Refused { revision, refusal: Refusal::of(&error) }),
        };
        if let Some(old) = &mut self.painting
            && Arc::ptr_eq(&old.scene, &scene)
            && (&old.job.size, &old.job.methods, &old.job.name) == (&job.size, &job.methods, &job.name)
        {
            // The same picture, shown in another way.
            old.job = job;
            tell(Event::Built { revision, scene });
            self.show_again(tell);
            if !self.busy() {
                tell(Event::Done { revision, seconds: begun.elapsed().as_secs_f64() });
            }
            return;
        }
        tell(Event::Built { revision, scene: Arc::clone(&scene) });
        let sides = job.methods.len().max(1);
        let sizes = self.pace.sizes(job.size);
        let mut steps = VecDeque::new();
        for (k, size) in sizes.iter().enumerate() {
            for (side, method) in job.methods.iter().enumerate() {
                // Side by side the first pictures share the time.
                let shrink = if k == 0 && sizes.len() > 1 { (sides as f64).sqrt() } else { 1.0 };
                let size = size.map(|n| ((n as f64 / shrink).round() as usize).max(1));
                let (first, last) = (k == 0, k + 1 == sizes.len());
                steps.push_back(Step { side, method: *method, size, first, last });
            }
        }
        // What was drawn of another picture is never shown as one of this.
        self.shown.clear();
        self.painting = Some(Painting { job, scene, begun, steps, current: None, spent: (0.0, 0) });
    }

    /// The scene of a job: as little as possible is built anew.
    fn build(&mut self, job: &Job) -> Result<Arc<Scene>, FileError> {
        let file = &job.file;
        if let Some((old, scene)) = &self.built
            && scene.name == job.name
        {
            if old == file {
                return Ok(Arc::clone(scene));
            }
            if old.surface == file.surface && old.parameters == file.parameters {
                let scene = Arc::new(file.scene_like(scene)?);
                self.built = Some((file.clone(), Arc::clone(&scene)));
                return Ok(scene);
            }
        }
        let scene = Arc::new(file.scene(&job.name)?);
        // Another surface may take longer, or less: a parameter that moves changes little.
        if self.built.as_ref().is_none_or(|(_, old)| old.name != scene.name) {
            self.pace = Pace::default();
        }
        self.built = Some((file.clone(), Arc::clone(&scene)));
        Ok(scene)
    }

    /// Makes the next step ready and gives its stop flag; `None` where there is none.
    pub(super) fn ready(&mut self, tell: &dyn Fn(Event)) -> Option<Arc<AtomicBool>> {
        let painting = self.painting.as_mut()?;
        if painting.current.is_none() {
            let step = painting.steps.pop_front()?;
            let [width, height] = step.size;
            let scene = &painting.scene;
            let spec = RenderSpec {
                width,
                height,
                method: step.method,
                floor: scene.floor_shown,
                tolerance: scene.output.tolerance.unwrap_or(RenderSpec::default().tolerance),
                ..RenderSpec::default()
            };
            let begun = Instant::now();
            match Renderer::new(Arc::clone(scene), spec, self.run) {
                Ok(renderer) => {
                    painting.current = Some(Current { step, renderer, begun, shown: begun, pause: OFTEN });
                }
                Err(error) => {
                    let revision = painting.job.revision;
                    self.painting = None;
                    self.shown.clear();
                    let refusal = Refusal { message: error.to_string(), place: None };
                    tell(Event::Refused { revision, refusal });
                    return None;
                }
            }
        }
        painting.current.as_ref().map(|current| current.renderer.stop_flag())
    }

    /// Draws a little more. `newer` tells whether a newer job waits.
    pub(super) fn step(&mut self, newer: &dyn Fn() -> News, tell: &dyn Fn(Event)) {
        let Some(painting) = self.painting.as_mut() else { return };
        let Some(current) = painting.current.as_mut() else { return };
        let step = current.step;
        let mut done = false;
        if step.first {
            let late = |begun: &Instant| begun.elapsed() > PATIENCE;
            let mut news = newer();
            while !done && news != News::End && !(late(&current.begun) && news == News::Job) {
                done = current.renderer.refine(FIRST_SLICE);
                news = newer();
                if !done && late(&current.begun) && news == News::Nothing {
                    break;
                }
            }
            if !done && news == News::Nothing {
                if current.shown.elapsed() > current.pause {
                    painting.show(false, tell);
                }
                return;
            }
            if !done {
                let pixels = step.size[0] * step.size[1];
                // It would have taken longer: how much is not known.
                self.pace.measured(pixels, 2.0 * current.begun.elapsed().as_secs_f64());
                // The newer job takes its place; if that cannot be built, or is the same picture shown in another way, it is drawn after all.
                painting.current = None;
                painting.steps.push_front(step);
                return;
            }
        } else {
            done = current.renderer.refine(SLICE);
        }
        if !done {
            if current.shown.elapsed() > current.pause && newer() == News::Nothing {
                painting.show(false, tell);
            }
            return;
        }
        if step.first {
            painting.spent.0 += current.begun.elapsed().as_secs_f64();
            painting.spent.1 += step.size[0] * step.size[1];
            if painting.steps.front().is_none_or(|next| !next.first) {
                self.pace.measured(painting.spent.1, painting.spent.0);
            }
        }
        if let Some(frame) = painting.show(true, tell) {
            let stats = painting.current.take().map(|c| c.renderer.stats()).unwrap_or_default();
            self.shown.retain(|s| s.step.side != step.side);
            self.shown.push(Shown { step, frame, stats });
        }
        if painting.steps.is_empty() {
            let seconds = painting.begun.elapsed().as_secs_f64();
            tell(Event::Done { revision: painting.job.revision, seconds });
        }
    }

    /// Shows the pictures that are there in another way.
    fn show_again(&mut self, tell: &dyn Fn(Event)) {
        let Some(painting) = &self.painting else { return };
        for Shown { step, frame, stats } in self.shown.iter().filter(|s| s.step.side < painting.job.methods.len()) {
            tell(Event::Image(Box::new(painting.image(*step, frame, stats.clone(), 1.0, true))));
        }
    }
}

impl Painting {
    /// Shows what is drawn now.
    fn show(&mut self, whole: bool, tell: &dyn Fn(Event)) -> Option<Arc<Frame>> {
        let current = self.current.as_ref()?;
        let begin = Instant::now();
        let (step, renderer) = (current.step, &current.renderer);
        let frame = Arc::new(renderer.frame().clone());
        let image = self.image(step, &frame, renderer.stats(), renderer.progress(), whole);
        tell(Event::Image(Box::new(image)));
        if let Some(current) = &mut self.current {
            current.shown = Instant::now();
            current.pause = OFTEN.max(begin.elapsed() * SHARE);
        }
        Some(frame)
    }

    fn image(&self, step: Step, frame: &Arc<Frame>, stats: Stats, progress: f64, whole: bool) -> Image {
        let tolerance = self.scene.output.tolerance.unwrap_or(RenderSpec::default().tolerance);
        let overlay = self.job.overlay.map(|overlay: Overlay| (overlay, tolerance));
        let (rgba, legend) = image::shown(frame, &self.scene.look, overlay, whole);
        Image {
            revision: self.job.revision,
            side: step.side,
            method: step.method,
            size: step.size,
            rgba,
            frame: Arc::clone(frame),
            stats,
            whole,
            last: step.last,
            progress,
            legend,
            seconds: self.begun.elapsed().as_secs_f64(),
        }
    }
}
