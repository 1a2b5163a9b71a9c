//! Opening the window: on wgpu where it finds an adapter, else on OpenGL.
use crate::{
    host::{Found, SharedHost},
    ui::{App, Timings},
};
use antumbra::render::RunSpec;
use eframe::egui;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Why there is no window.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// There is nothing to show it on.
    #[error("there is no display: {0}; `antumbra render` draws without one")]
    NoDisplay(String),
    /// Neither wgpu nor OpenGL can draw in it.
    #[error(
        "the window cannot be drawn: {0}. It needs a driver for Vulkan, Metal, Direct3D 12 or OpenGL, of which Mesa has some that need no GPU; \
         `antumbra render` draws without one"
    )]
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

/// What is known of a window that was closed.
#[derive(Clone, Debug, Default)]
pub struct Report {
    /// What was measured.
    pub timings: Timings,
    /// What drew it, in words.
    pub drawn_by: String,
}

/// Opens the window and returns when it is closed.
///
/// # Errors
/// Where there is no display, or nothing that can draw on it.
pub fn run(host: SharedHost, options: Options) -> Result<Report, Error> {
    display()?;
    let report = Arc::new(Mutex::new(Report::default()));
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
        let (host, options, report) = (Arc::clone(&host), options.clone(), Arc::clone(&report));
        eframe::run_native(
            "Antumbra",
            native,
            Box::new(move |creation| {
                let mut app = App::new(&creation.egui_ctx, host, options.run, options.start)?;
                let adapter = creation.wgpu_render_state.as_ref().map(|state| state.adapter.get_info());
                app.is_drawn_by(&words(adapter.as_ref()), adapter.is_none() && !options.glow);
                locked(&report).drawn_by = words(adapter.as_ref());
                Ok(Box::new(Measured { app, report }))
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
        Ok(()) => Ok(locked(&report).clone()),
        Err(eframe::Error::WinitEventLoop(e)) => Err(Error::NoDisplay(reason(&e.to_string()).to_owned())),
        Err(e) if options.glow => Err(Error::Graphics(e.to_string())),
        Err(e) => Err(Error::Graphics(format!("there is no adapter but OpenGL's, and that fails ({e})"))),
    }
}

/// What draws the window: an adapter of wgpu, or OpenGL.
fn words(adapter: Option<&wgpu::AdapterInfo>) -> String {
    adapter.map_or_else(|| "OpenGL".to_owned(), |a| format!("{} ({})", a.backend, a.name))
}

/// The reason in an error of the operating system, which begins with its place in a source file.
fn reason(error: &str) -> &str {
    let place = error.split_once(".rs:").and_then(|(_, rest)| rest.split_once(": "));
    place.map_or(error, |(_, reason)| reason)
}

fn locked(report: &Mutex<Report>) -> MutexGuard<'_, Report> {
    report.lock().unwrap_or_else(PoisonError::into_inner)
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
    report: Arc<Mutex<Report>>,
}

impl eframe::App for Measured {
    fn ui(&mut self, ui: &mut egui::Ui, frame: &mut eframe::Frame) {
        self.app.ui(ui, frame);
        locked(&self.report).timings = self.app.meter().timings();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_say_what_and_not_where() {
        let long = "os error at /a/b-1.0/src/linux/mod.rs:788: Failed to open connection to X server";
        assert_eq!(reason(long), "Failed to open connection to X server");
        assert_eq!(reason("no protocol: none"), "no protocol: none");
        assert_eq!(words(None), "OpenGL");
    }
}
