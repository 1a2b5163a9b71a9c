//! Opening the window: on wgpu where it finds an adapter, else on OpenGL.
use crate::{
    host::{Found, SharedHost},
    ui::{App, Timings},
};
use antumbra::render::RunSpec;
use eframe::egui;
use std::sync::{Arc, Mutex, PoisonError};

/// Why there is no window.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// There is nothing to show it on.
    #[error("there is no display: {0}; `antumbra render` draws without one")]
    NoDisplay(String),
    /// Neither wgpu nor OpenGL can draw in it.
    #[error("the window cannot be drawn: {0}")]
    Graphics(String),
}

/// What to open.
#[derive(Clone)]
pub struct Options {
    /// The first scene.
    pub start: Found,
    /// How to run.
    pub run: RunSpec,
    /// Use OpenGL even where wgpu finds an adapter.
    pub glow: bool,
}

/// Opens the window and returns when it is closed, with what was measured.
///
/// # Errors
/// Where there is no display, or nothing that can draw on it.
pub fn run(host: SharedHost, options: Options) -> Result<Timings, Error> {
    display()?;
    let timings = Arc::new(Mutex::new(Timings::default()));
    let open = |renderer: eframe::Renderer| {
        let native = eframe::NativeOptions {
            viewport: egui::ViewportBuilder::default()
                .with_title("Antumbra")
                .with_app_id("antumbra")
                .with_inner_size([1280.0, 820.0])
                .with_min_inner_size([760.0, 480.0])
                .with_drag_and_drop(true),
            renderer,
            ..eframe::NativeOptions::default()
        };
        let (host, options, timings) = (Arc::clone(&host), options.clone(), Arc::clone(&timings));
        eframe::run_native(
            "Antumbra",
            native,
            Box::new(move |creation| {
                let app = App::new(&creation.egui_ctx, host, options.run, options.start)?;
                Ok(Box::new(Measured { app, timings }))
            }),
        )
    };
    let wgpu = !options.glow && has_adapter();
    let ended = match open(if wgpu { eframe::Renderer::Wgpu } else { eframe::Renderer::Glow }) {
        // The adapter cannot draw on this display.
        Err(eframe::Error::Wgpu(_)) => open(eframe::Renderer::Glow),
        other => other,
    };
    match ended {
        Ok(()) => Ok(*timings.lock().unwrap_or_else(PoisonError::into_inner)),
        Err(eframe::Error::WinitEventLoop(e)) => Err(Error::NoDisplay(e.to_string())),
        Err(e) => Err(Error::Graphics(e.to_string())),
    }
}

/// Whether the environment speaks of a display, where that is how one finds it.
fn display() -> Result<(), Error> {
    let unix = cfg!(all(unix, not(target_os = "macos")));
    let set = |name: &str| std::env::var_os(name).is_some_and(|v| !v.is_empty());
    if unix && !["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"].into_iter().any(set) {
        return Err(Error::NoDisplay("neither DISPLAY nor WAYLAND_DISPLAY is set".to_owned()));
    }
    Ok(())
}

/// Whether wgpu finds an adapter.
fn has_adapter() -> bool {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
    pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default())).is_ok()
}

/// The app, which leaves its measurements when it ends.
struct Measured {
    app: App,
    timings: Arc<Mutex<Timings>>,
}

impl eframe::App for Measured {
    fn ui(&mut self, ui: &mut egui::Ui, frame: &mut eframe::Frame) {
        self.app.ui(ui, frame);
        *self.timings.lock().unwrap_or_else(PoisonError::into_inner) = self.app.meter().timings();
    }
}
