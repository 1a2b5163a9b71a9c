//! The window: panels around a picture. What is shown is in the [`Model`]; what draws is the [`Worker`].
mod bar;
mod canvas;
mod controls;
mod exporting;
mod finder;
mod formula;
mod gallery;
mod inspect;
mod meter;
mod player;
mod side;
mod status;
mod theme;

pub use inspect::lines as inspection;
pub use meter::{Meter, Timings};

use crate::{
    export::Export,
    host::{Found, SharedHost},
    model::Model,
    thumbnails::Thumbnails,
    worker::{Event, Image, Job, Refusal, Worker},
};
use antumbra::render::{Overlay, RunSpec};
use eframe::egui;
use exporting::ExportForm;
use finder::Finder;
use gallery::Gallery;
use player::Player;
use side::Side;
use std::sync::Arc;

/// What a hand does with the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Tool {
    #[default]
    Orbit,
    Pan,
    Light,
}

/// A word about what was done, or could not be.
#[derive(Clone, Debug)]
enum Note {
    Good(String),
    Bad(String),
}

/// The window's content.
pub struct App {
    host: SharedHost,
    run: RunSpec,
    model: Model,
    worker: Worker,
    /// What was asked for last: the document's revision, pixels, overlay.
    asked: Option<(u64, [usize; 2], Option<Overlay>)>,
    /// The revision that is drawn, and whether all of it is done, after how many seconds.
    drawn: u64,
    done: Option<f64>,
    /// The revision of the last picture.
    seen: u64,
    sides: Vec<Side>,
    refusal: Option<(u64, Refusal)>,
    /// Pixels of the picture.
    pixels: [usize; 2],
    overlay: Option<Overlay>,
    tool: Tool,
    /// Where the line between two methods stands, 0 to 1.
    split: f32,
    /// The formula as it is typed, and of which surface.
    text: String,
    surface: usize,
    light: usize,
    player: Player,
    gallery: Gallery,
    finder: Finder,
    open: String,
    save: Option<String>,
    form: Option<ExportForm>,
    export: Option<Export>,
    note: Option<Note>,
    meter: Meter,
    help: bool,
    /// What draws the window.
    drawn_by: String,
}

impl App {
    /// A window on a scene; it begins to draw when it is shown.
    ///
    /// # Errors
    /// Where the system gives no threads.
    pub fn new(context: &egui::Context, host: SharedHost, run: RunSpec, start: Found) -> std::io::Result<Self> {
        theme::apply(context);
        let waker = || {
            let context = context.clone();
            move || context.request_repaint()
        };
        let worker = Worker::start(run, waker())?;
        let thumbnails = Thumbnails::start(worker.hurry(), waker())?;
        Ok(Self {
            finder: Finder::new(Arc::clone(&host), context.clone()),
            host,
            run,
            model: Model::new(start),
            worker,
            asked: None,
            drawn: 0,
            done: None,
            seen: 0,
            sides: vec![],
            refusal: None,
            pixels: [0, 0],
            overlay: None,
            tool: Tool::default(),
            split: 0.5,
            text: String::new(),
            surface: 0,
            light: 0,
            player: Player::default(),
            gallery: Gallery::new(thumbnails),
            open: String::new(),
            save: None,
            form: None,
            export: None,
            note: None,
            meter: Meter::default(),
            help: false,
            drawn_by: String::new(),
        })
    }

    /// Tells by what the window is drawn, to be shown with the keys, and at once if that is not what was to be expected.
    pub fn is_drawn_by(&mut self, what: &str, unexpected: bool) {
        what.clone_into(&mut self.drawn_by);
        if unexpected {
            self.note = Some(Note::Good(format!("drawn with {what}: there is no adapter for anything else")));
        }
    }

    /// What is shown.
    #[must_use]
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// How long frames of the window and pictures took.
    #[must_use]
    pub fn meter(&self) -> &Meter {
        &self.meter
    }

    /// Whether everything that was asked for is drawn to the end.
    #[must_use]
    pub fn is_done(&self) -> bool {
        self.done.is_some() && self.asked.is_some_and(|(revision, ..)| revision == self.drawn)
    }

    /// Draws the whole content of the window.
    pub fn content(&mut self, ui: &mut egui::Ui) {
        self.listen(ui.ctx());
        self.shortcuts(ui);
        let answered = self.refusal.as_ref().map_or(self.seen, |(revision, _)| self.seen.max(*revision));
        self.player.play(ui.ctx(), &mut self.model, answered);
        egui::Panel::top("bar").frame(theme::bar()).show(ui, |ui| self.bar(ui));
        egui::Panel::bottom("status").frame(theme::bar()).show(ui, |ui| self.status(ui));
        egui::Panel::left("formula")
            .frame(theme::panel())
            .resizable(true)
            .default_size(330.0)
            .size_range(240.0..=640.0)
            .show(ui, |ui| self.left(ui));
        egui::Panel::right("controls").frame(theme::panel()).resizable(false).exact_size(296.0).show(ui, |ui| {
            egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| self.controls(ui));
        });
        egui::CentralPanel::default().frame(theme::stage()).show(ui, |ui| self.canvas(ui));
        self.export_window(ui.ctx());
        self.help_window(ui.ctx());
        self.ask();
    }

    /// Takes in what the threads tell.
    fn listen(&mut self, context: &egui::Context) {
        let mut images: Vec<Image> = vec![];
        while let Some(event) = self.worker.event() {
            match event {
                Event::Built { revision, scene } => {
                    self.model.built(revision, scene);
                    (self.drawn, self.done, self.refusal) = (revision, None, None);
                }
                Event::Refused { revision, refusal } => self.refusal = Some((revision, refusal)),
                Event::Image(image) => {
                    self.meter.image(&image);
                    self.seen = image.revision;
                    // Where several come at once, only the newest goes to the screen.
                    let covered = |old: &mut Image| old.side == image.side && (image.whole || !old.whole);
                    images.extract_if(.., covered).for_each(|old| self.worker.give_back(old.frame));
                    images.push(*image);
                }
                Event::Done { revision, seconds } => {
                    if revision == self.drawn {
                        self.done = Some(seconds);
                    }
                }
            }
        }
        for image in images {
            while self.sides.len() <= image.side {
                self.sides.push(Side::default());
            }
            let old = self.sides[image.side].take(context, image);
            old.for_each(|old| self.worker.give_back(old.frame));
        }
        self.gallery.listen(context);
        if let Some(found) = self.finder.found() {
            match found {
                Ok(found) => {
                    self.note = Some(Note::Good(format!("opened {}", found.name)));
                    self.view(found);
                }
                Err(error) => self.note = Some(Note::Bad(error)),
            }
        }
        let dropped = context.input(|i| i.raw.dropped_files.first().map(|f| f.path().to_owned()));
        if let Some(path) = dropped {
            self.finder.ask(&path.to_string_lossy());
        }
    }

    /// Looks at another scene.
    fn view(&mut self, found: Found) {
        self.player.stop();
        self.model.open(found);
        (self.surface, self.light) = (0, 0);
    }

    /// Asks for what the document says now, if that has changed.
    fn ask(&mut self) {
        let wanted = (self.model.revision(), self.pixels, self.overlay);
        if self.asked == Some(wanted) || self.pixels.contains(&0) {
            return;
        }
        let document = self.model.document();
        self.meter.asked(wanted.0);
        self.worker.submit(Job {
            revision: wanted.0,
            name: document.name.clone(),
            file: document.complete(),
            size: self.pixels,
            methods: document.methods(),
            overlay: self.overlay,
        });
        self.asked = Some(wanted);
        self.done = None;
    }

    fn shortcuts(&mut self, ui: &egui::Ui) {
        use egui::{Key, KeyboardShortcut as Shortcut, Modifiers};
        let command = |key| Shortcut::new(Modifiers::COMMAND, key);
        let context = ui.ctx();
        let pressed = |shortcut: Shortcut| context.input_mut(|i| i.consume_shortcut(&shortcut));
        if pressed(command(Key::S)) {
            self.begin_saving();
        }
        if pressed(command(Key::E)) {
            self.begin_exporting();
        }
        if context.egui_wants_keyboard_input() {
            return;
        }
        if pressed(Shortcut::new(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z)) || pressed(command(Key::Y)) {
            self.model.redo();
        } else if pressed(command(Key::Z)) {
            self.model.undo();
        }
        let plain = |key| context.input(|i| i.key_pressed(key) && i.modifiers.is_none());
        let step = 5.0_f64.to_radians();
        for (key, azimuth, elevation) in [
            (Key::ArrowLeft, -step, 0.0),
            (Key::ArrowRight, step, 0.0),
            (Key::ArrowUp, 0.0, step),
            (Key::ArrowDown, 0.0, -step),
        ] {
            if plain(key) {
                self.model.move_camera(|orbit| orbit.turned(azimuth, elevation));
            }
        }
        for (key, factor) in [(Key::Plus, 1.0 / 1.1), (Key::Equals, 1.0 / 1.1), (Key::Minus, 1.1)] {
            if plain(key) {
                self.model.move_camera(|orbit| orbit.zoomed(factor));
            }
        }
        if plain(Key::R) {
            self.model.reset_camera();
        }
        if plain(Key::F) {
            self.model.fit_camera();
        }
        if plain(Key::P) {
            self.model.move_camera(|orbit| antumbra::scene::Orbit { parallel: !orbit.parallel, ..orbit });
        }
        for (tool, key) in [(Tool::Orbit, Key::O), (Tool::Pan, Key::M), (Tool::Light, Key::L)] {
            if plain(key) {
                self.tool = tool;
            }
        }
        let keys = [Key::Num1, Key::Num2, Key::Num3, Key::Num4];
        for (key, (overlay, _)) in keys.into_iter().zip(Overlay::ALL) {
            if plain(key) {
                self.overlay = Some(overlay).filter(|o| self.overlay != Some(*o));
            }
        }
        if plain(Key::Num0) {
            self.overlay = None;
        }
    }
}

impl eframe::App for App {
    fn ui(&mut self, ui: &mut egui::Ui, frame: &mut eframe::Frame) {
        if let Some(seconds) = frame.info().cpu_usage {
            self.meter.frame(f64::from(seconds));
        }
        self.content(ui);
    }
}
