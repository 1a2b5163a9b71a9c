//! One scene, one render.
use crate::answer::{CameraOf, Description, Exhibit, LightOf, Line, Pixel, Refusal, Report, Slider};
use crate::gpu::Gpu;
use crate::request::{CameraRequest, LightRequest, Request};
use antumbra::expr::{Formula, definitions};
use antumbra::geom::{Film, Rect, Vec3};
use antumbra::image::{COLOR_PLANE, Depth, Samples, codes_8, npy_bytes, png_bytes};
use antumbra::render::{Clock, Frame, Overlay, RenderSpec, Renderer, RunSpec};
use antumbra::scene::{GALLERY, PRESETS, Parameter, Scene, SceneFile, View, file_named, named, number};
use serde::Serialize;
use std::collections::BTreeMap;
use std::io::Cursor;
use std::sync::{Arc, OnceLock};
use std::time::{Duration, Instant};

/// Most pixels of a picture: what a page can show and a phone's memory holds.
const MOST_PIXELS: usize = 1 << 23;

/// Holds a scene and its render. Texts go in as JSON and come out as JSON.
#[derive(Default)]
pub struct Studio {
    built: Option<Built>,
    renderer: Option<Renderer>,
    /// Nothing is left to do, as far as the last look at it told.
    finished: bool,
    clock: Option<Clock>,
    gpu: Option<Gpu>,
}

/// A scene as its file has it: what takes long, kept while only camera, light and size change.
struct Built {
    text: String,
    set: BTreeMap<String, f64>,
    scene: Scene,
    parameters: Vec<Slider>,
}

type Answer<T> = Result<T, Refusal>;

/// The clock of std, since the first look at it.
fn std_clock() -> Duration {
    static BEGIN: OnceLock<Instant> = OnceLock::new();
    BEGIN.get_or_init(Instant::now).elapsed()
}

impl Studio {
    /// A studio that measures time by that clock.
    #[must_use]
    pub fn with_clock(clock: Clock) -> Self {
        Self { clock: Some(clock), ..Self::default() }
    }

    /// The surfaces of the gallery, as a list of `{name, title, author, year, formula}`.
    #[must_use]
    pub fn gallery(&self) -> String {
        let exhibit = |name: &'static str| {
            let of = |title: String, formula: String| Exhibit {
                name: name.to_owned(),
                title,
                author: None,
                year: None,
                formula,
            };
            if let Some(preset) = PRESETS.iter().find(|p| p.name == name) {
                return Some(of(preset.title.to_owned(), preset.formula.to_owned()));
            }
            let file = file_named(name)?.ok()?;
            let formula = file.surface.first().map(|s| s.formula.trim().to_owned()).unwrap_or_default();
            let (author, year) = file.about.map_or((None, None), |about| (about.author, about.year));
            Some(Exhibit { author, year, ..of(file.title.unwrap_or_else(|| name.to_owned()), formula) })
        };
        json(&GALLERY.iter().filter_map(|entry| exhibit(entry.name)).collect::<Vec<_>>())
    }

    /// Begins to draw a [`Request`]; the answer describes the scene, or is `{"error": {message, help, place}}`; then
    /// the picture is the one that was there (but where memory is short: then there is none).
    pub fn open(&mut self, request: &str) -> String {
        #[derive(Serialize)]
        struct Failed {
            error: Refusal,
        }
        let request = serde_json::from_str(request).map_err(|e| Refusal::new(e.to_string()));
        match request.and_then(|request| self.begin(&request)) {
            Ok(description) => json(&description),
            Err(error) => json(&Failed { error }),
        }
    }

    fn begin(&mut self, request: &Request) -> Answer<Description> {
        if request.width.saturating_mul(request.height) > MOST_PIXELS {
            return Err(Refusal::new(format!("a picture here has at most {MOST_PIXELS} pixels")));
        }
        let kept = self.built.take_if(|b| b.text == request.scene && b.set == request.set);
        let built = kept.map_or_else(|| build(request), Ok)?;
        let mut scene = built.scene.clone();
        let description = built.description();
        self.built = Some(built);
        if let Some(CameraRequest { eye, target, angle }) = request.camera {
            scene.view = View { eye: Vec3(eye), target: Vec3(target), fov_deg: angle };
            check_view(&scene.view)?;
        }
        if let (Some(LightRequest { center, scale }), Some(light)) = (request.light, scene.lights.first_mut()) {
            let Rect { edge_u, edge_v, .. } = light.rect;
            light.rect = Rect { center: Vec3(center), edge_u: edge_u * scale, edge_v: edge_v * scale };
            let all = [light.rect.center.0, light.rect.edge_u.0, light.rect.edge_v.0].concat();
            if !all.iter().all(|x| x.abs() <= 1e150) || scale.is_nan() || scale <= 0.0 {
                return Err(Refusal::new("the light must be somewhere, and larger than nothing"));
            }
        }
        let usual = RenderSpec::default();
        let spec = RenderSpec {
            width: request.width,
            height: request.height,
            floor: request.floor.unwrap_or(scene.floor_shown),
            tolerance: request.tolerance.or(scene.output.tolerance).unwrap_or(usual.tolerance),
            rectangles: request.rectangles.unwrap_or(usual.rectangles),
            ..usual
        };
        let refuse = |e: antumbra::render::Error| Refusal::new(e.to_string());
        spec.validate().map_err(refuse)?;
        if let Some([number, of]) = request.part.filter(|[number, of]| number >= of) {
            return Err(Refusal::new(format!("there is no part {number} of {of}")));
        }
        // The memory of the last picture first: from here on only a lack of it can be in the way.
        self.renderer = None;
        self.gpu_leave();
        let mut renderer = Renderer::new(Arc::new(scene), spec, RunSpec::default()).map_err(refuse)?;
        if let Some(clock) = self.clock {
            renderer.set_clock(clock);
        }
        if let Some([number, of]) = request.part {
            renderer.take_part(number, of);
        }
        (self.renderer, self.finished) = (Some(renderer), false);
        Ok(description)
    }

    /// Takes a GPU that whoever calls holds: [`About`](crate::About) it, as JSON. It is probed first. An empty text, or what is wrong with that text.
    pub fn gpu_open(&mut self, about: &str) -> String {
        let clock = self.clock.unwrap_or(std_clock);
        match serde_json::from_str(about) {
            Ok(about) => self.gpu = Some(Gpu::open(about, clock)),
            Err(error) => return error.to_string(),
        }
        String::new()
    }

    /// Lets the GPU begin to prove what it can of the picture, which has not begun; an empty text, or why the processor does all of it.
    pub fn gpu_begin(&mut self) -> String {
        let (Some(gpu), Some(renderer)) = (&mut self.gpu, &self.renderer) else { return "there is none".to_owned() };
        gpu.begin(renderer).err().map(|e| e.to_string()).unwrap_or_default()
    }

    /// Goes on with the probe or the proofs as far as answers allow: `{state, orders}`, the [`Order`](crate::Order)s to be carried out
    /// next. The state is `waits` (with the `progress`), then `passed`, `proved` or `failed` (with a `message`).
    pub fn gpu_step(&mut self) -> String {
        json(&self.gpu.as_mut().map(|gpu| gpu.step(self.renderer.as_mut())))
    }

    /// Brings what the order with that ticket answered, when it and all before it were done without an error; or why there is no answer.
    pub fn gpu_answer(&mut self, ticket: u32, answer: Result<Vec<u8>, String>) {
        if let Some(gpu) = &self.gpu {
            gpu.answer(ticket, answer);
        }
    }

    /// Nobody wants any more what the GPU is proving.
    pub fn gpu_leave(&mut self) {
        if let Some(gpu) = &mut self.gpu {
            gpu.leave();
        }
    }

    /// Goes on with the picture for about that time; tells whether it, or the part of it, is finished, or there is none.
    pub fn refine(&mut self, budget: Duration) -> bool {
        self.finished = self.renderer.as_mut().is_none_or(|renderer| renderer.refine(budget));
        self.finished
    }

    /// Everything that is known of the picture, for [`Studio::join`] of another studio; empty where there is none.
    #[must_use]
    pub fn state(&self) -> Vec<u8> {
        let mut state = Vec::new();
        match self.renderer.as_ref().map(|renderer| renderer.save(&mut state)) {
            Some(Ok(())) => state,
            Some(Err(_)) | None => Vec::new(),
        }
    }

    /// Takes over a finished part from the state of another studio; an empty text, or why it cannot.
    pub fn join(&mut self, state: &[u8]) -> String {
        let Some(renderer) = &mut self.renderer else { return "there is no picture".to_owned() };
        self.finished = false;
        renderer.join(&mut Cursor::new(state)).err().map(|e| e.to_string()).unwrap_or_default()
    }

    /// How far it is.
    #[must_use]
    pub fn report(&self) -> String {
        let Some(renderer) = &self.renderer else { return "null".to_owned() };
        let stats = renderer.stats();
        let classes = stats.lit + stats.partly + stats.dark;
        json(&Report {
            done: self.finished,
            progress: renderer.progress(),
            activity: renderer.activity().0,
            remaining: renderer.remaining().map(|t| t.as_secs_f64()),
            threads: stats.threads,
            pixels: (stats.width * stats.height) as u64,
            proved_empty: stats.proved_empty,
            proved_hit: stats.proved_hit,
            proved_edge: stats.proved_partly,
            undecided: stats.undecided(),
            brackets: stats.hits * stats.lights as u64,
            brackets_closed: classes.saturating_sub(stats.brackets_open),
            evaluations: stats.evaluations,
            seconds: stats.seconds,
        })
    }

    /// The picture for a screen: red, green, blue and opacity of each pixel, rows from the top. What was not looked at is transparent.
    /// With the name of an [`Overlay`], what is known instead. With `lit`, hits of whose light nothing is known are transparent too.
    #[must_use]
    pub fn pixels(&self, overlay: &str, lit: bool) -> Vec<u8> {
        let Some(renderer) = &self.renderer else { return Vec::new() };
        let frame = renderer.frame();
        let waits = |at: usize| frame.lights.iter().any(|l| l.visible_lo[at] == 0.0 && l.visible_hi[at] == 1.0);
        let hidden = |(at, verdict): (usize, &u8)| *verdict == Frame::UNSEEN || lit && waits(at);
        let seen = frame.verdict.iter().enumerate().map(|pixel| if hidden(pixel) { 0 } else { u8::MAX });
        if let Some(overlay) = Overlay::from_name(overlay) {
            let legend = frame.legend(overlay, renderer.question().tolerance);
            let color = |(kind, seen): (&usize, u8)| {
                let [r, g, b] = legend.entries[*kind].0;
                [r, g, b, seen]
            };
            return legend.kinds.iter().zip(seen).flat_map(color).collect();
        }
        let Ok(planes) = frame.picture(&renderer.scene().look) else { return Vec::new() };
        let Ok(Samples::F32(light)) = planes.require(COLOR_PLANE).map(|plane| plane.samples()) else {
            return Vec::new();
        };
        codes_8(light).chunks_exact(3).zip(seen).flat_map(|(c, seen)| [c[0], c[1], c[2], seen]).collect()
    }

    /// The legend of an overlay, as a list of `{color, meaning, pixels}`: the kinds that occur.
    #[must_use]
    pub fn legend(&self, overlay: &str) -> String {
        let (Some(renderer), Some(overlay)) = (&self.renderer, Overlay::from_name(overlay)) else {
            return "[]".to_owned();
        };
        let legend = renderer.frame().legend(overlay, renderer.question().tolerance);
        let mut counts = vec![0; legend.entries.len()];
        legend.kinds.iter().for_each(|kind| counts[*kind] += 1);
        let lines = legend.entries.into_iter().zip(counts).filter(|(_, pixels)| *pixels > 0);
        json(&lines.map(|((color, meaning), pixels)| Line { color, meaning, pixels }).collect::<Vec<_>>())
    }

    /// What is known of a pixel, or `null` outside of the picture.
    #[must_use]
    pub fn pixel(&self, column: usize, row: usize) -> String {
        let Some(renderer) = &self.renderer else { return "null".to_owned() };
        let (frame, film) = (renderer.frame(), renderer.question().film);
        if column >= frame.width || row >= frame.height {
            return "null".to_owned();
        }
        let at = row * frame.width + column;
        let legend = frame.legend(Overlay::Verdict, 1.0);
        let met = !frame.t_lo[at].is_nan();
        json(&Pixel {
            verdict: legend.entries[legend.kinds[at]].1.clone(),
            code: frame.verdict[at],
            t: met.then(|| [frame.t_lo[at], frame.t_hi[at]]),
            point: met.then(|| point(&film, column, row, 0.5 * (frame.t_lo[at] + frame.t_hi[at]))),
            normal: met.then_some(frame.normal[at]),
            visible: frame.lights.iter().filter(|_| met).map(|l| [l.visible_lo[at], l.visible_hi[at]]).collect(),
            coverage: [frame.coverage_lo[at], frame.coverage_hi[at]],
            evaluations: frame.cost[at],
        })
    }

    /// The PNG that `antumbra render` would write, or of an overlay with its legend; empty where there is none.
    #[must_use]
    pub fn png(&self, overlay: &str) -> Vec<u8> {
        let Some(renderer) = &self.renderer else { return Vec::new() };
        let frame = renderer.frame();
        let planes = match Overlay::from_name(overlay) {
            Some(overlay) => frame.overlay(overlay, renderer.question().tolerance),
            None => frame.picture(&renderer.scene().look),
        };
        let bytes = planes.and_then(|planes| png_bytes(planes.require(COLOR_PLANE)?, Depth::Eight));
        bytes.unwrap_or_default()
    }

    /// A plane of the frame as `antumbra render --planes` would write it; empty where there is none of that name.
    #[must_use]
    pub fn npy(&self, plane: &str) -> Vec<u8> {
        let Some(renderer) = &self.renderer else { return Vec::new() };
        let bytes = renderer.frame().planes().and_then(|planes| npy_bytes(planes.require(plane)?));
        bytes.unwrap_or_default()
    }

    /// The names of the planes, as a list.
    #[must_use]
    pub fn planes(&self) -> String {
        json(&self.renderer.as_ref().map(|r| Frame::plane_names(r.frame().lights.len())).unwrap_or_default())
    }
}

impl Built {
    fn description(&self) -> Description {
        let scene = &self.scene;
        let View { eye, target, fov_deg } = scene.view;
        let light = scene.lights.first().map(|light| {
            let Rect { center, edge_u, edge_v } = light.rect;
            LightOf { center: center.0, u: edge_u.0, v: edge_v.0 }
        });
        Description {
            title: scene.title.clone(),
            about: scene.about.clone(),
            formulas: scene.objects.iter().map(|object| object.text.clone()).collect(),
            parameters: self.parameters.clone(),
            camera: CameraOf { eye: eye.0, target: target.0, angle: fov_deg },
            light,
            lights: scene.lights.len(),
            scale: scene.scale(),
            floor: scene.floor_shown,
            tolerance: scene.output.tolerance,
        }
    }
}

/// The scene of a request, with its parameters set. Takes up to a second: bounds of the surface are searched for.
fn build(request: &Request) -> Answer<Built> {
    let text = request.scene.trim();
    let (text_owned, set) = (request.scene.clone(), request.set.clone());
    if let Some(scene) = named(text).filter(|_| request.set.is_empty()) {
        let parameters = file_named(text).and_then(Result::ok).map(|file| sliders(&file)).unwrap_or_default();
        return Ok(Built { text: text_owned, set, scene: scene?, parameters });
    }
    let mut file = match file_named(text) {
        Some(file) => file?,
        None => {
            // So that an error speaks of the very text that was typed.
            Formula::parse(&request.scene).map_err(|e| Refusal::of_formula(&e, &request.scene))?;
            SceneFile::of_formula(&request.scene)
        }
    };
    let parameters = sliders(&file);
    for (name, value) in &request.set {
        file.set(name, *value)?;
    }
    Ok(Built { text: text_owned, set, scene: file.scene(text)?, parameters })
}

/// The numbers of a scene that can be moved, and how far: as the file says, else to about twice and to minus the value.
fn sliders(file: &SceneFile) -> Vec<Slider> {
    let around = |name: &str, value: f64| {
        let reach = if value == 0.0 { 1.0 } else { 2.0 * value.abs() };
        Slider { name: name.to_owned(), value, min: -reach, max: reach }
    };
    let mut found: Vec<Slider> = file
        .parameters
        .iter()
        .map(|(name, parameter)| match parameter {
            Parameter::Value(value) => around(name, *value),
            Parameter::Ranged(r) => Slider { name: name.clone(), value: r.value, min: r.min, max: r.max },
        })
        .collect();
    for entry in &file.surface {
        for (name, place) in definitions(&entry.formula).unwrap_or_default() {
            if let Some(value) = entry.formula.get(place).and_then(|text| number(text).ok())
                && !found.iter().any(|slider| slider.name == name)
            {
                found.push(around(&name, value));
            }
        }
    }
    found
}

fn check_view(view: &View) -> Answer<()> {
    let finite = view.eye.0.iter().chain(&view.target.0).all(|x| x.abs() <= 1e150);
    if finite && view.eye != view.target && (1e-4..=170.0).contains(&view.fov_deg) {
        return Ok(());
    }
    Err(Refusal::new("the camera must stand somewhere else than at its target, with an angle of up to 170 degrees"))
}

/// About the point of the centre ray of a pixel at that distance along the view axis.
fn point(film: &Film, column: usize, row: usize, t: f64) -> [f64; 3] {
    let camera = &film.camera;
    let x = 2.0 * (column as f64 + 0.5) / film.width as f64 - 1.0;
    let y = 1.0 - 2.0 * (row as f64 + 0.5) / film.height as f64;
    (camera.eye + (camera.forward + camera.right * x + camera.up * y) * t).0
}

fn json(value: &impl Serialize) -> String {
    serde_json::to_string(value).unwrap_or_else(|e| format!("{{\"error\": {{\"message\": \"{e}\"}}}}"))
}
