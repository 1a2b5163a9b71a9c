//! The command line of `view`, and what the window asks of this program.

use std::path::Path;

use antumbra::scene::{self, SceneFile};
use antumbra_viewer::host::{Found, Host, Place};
use anyhow::Result;

use crate::{
    failure::{EXIT_CODES, Usage},
    options::find_scene,
    output::{Sink, finish},
    values,
};

const EXAMPLES: &str = "\
Examples:
  antumbra view                                     # begins with the Chubs
  antumbra view boy
  antumbra view 'a = 1; x^2 + y^2 + a z^2 = 1'      # a slider for a
  antumbra view rings.toml";

/// Open a window: type a formula, turn it around, see what is proved.
///
/// While something moves the picture is coarse, but as proved as any other; when nothing moves it is refined until everything is proved.
/// The window needs a display and a driver for Vulkan, Metal, Direct3D 12 or OpenGL.
#[derive(Debug, clap::Args)]
#[command(after_help = format!("{EXAMPLES}\n\n{EXIT_CODES}"))]
pub(crate) struct ViewArgs {
    /// A preset or a surface of the gallery, a scene file (.toml), a file of another program, or a formula in x, y, z
    #[arg(value_name = "SCENE-OR-FORMULA", default_value = "chubs")]
    pub(crate) scene: String,

    /// Threads to draw with; the picture does not depend on it [default: every processor]
    #[arg(long, value_name = "N", value_parser = values::threads, allow_negative_numbers = true)]
    pub(crate) threads: Option<usize>,

    /// Draw the window with OpenGL even where there is Vulkan, Metal or Direct3D 12
    #[arg(long)]
    pub(crate) opengl: bool,

    /// Print how long frames of the window and first pictures took, when it is closed
    #[arg(long)]
    pub(crate) timings: bool,
}

/// Finds a scene as a file that can be edited.
///
/// # Errors
/// [`Usage`] where the scene or the formula is not understood.
pub(crate) fn find(text: &str) -> Result<Found> {
    // A name keeps its parameters.
    if let Some(file) = scene::file_named(text) {
        let file = file.map_err(|e| Usage(e.to_string()))?;
        return Ok(Found { name: text.to_owned(), file, own: false });
    }
    let found = find_scene(text)?;
    let own = text.ends_with(".toml");
    let file = found.file.unwrap_or_else(|| SceneFile::of(&found.scene));
    Ok(Found { name: found.stem, file, own })
}

/// This program, as the window knows it.
pub(crate) struct Program;

impl Host for Program {
    fn find(&self, text: &str) -> Result<Found, String> {
        // Standard input belongs to the terminal, not to the window.
        if text == "-" {
            return Err("`-` is no scene here: type a name, a path or a formula".to_owned());
        }
        find(text).map_err(|e| format!("{e:#}"))
    }

    fn reserve(&self, path: &Path) -> Result<Box<dyn Place>, String> {
        Ok(Box::new(Reserved(Sink::open(path).map_err(|e| format!("{e:#}"))?)))
    }
}

struct Reserved(Sink);

impl Place for Reserved {
    fn fill(self: Box<Self>, bytes: &[u8]) -> Result<(), String> {
        let Self(mut sink) = *self;
        sink.fill(bytes).and_then(|()| finish(vec![sink])).map_err(|e| format!("{e:#}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scenes_are_found_with_their_parameters() {
        let found = find("a = 1; x^2 + y^2 + a z^2 = 1").unwrap();
        assert_eq!((found.file.parameter_names(), found.own), (vec!["a".to_owned()], false));
        assert_eq!(find("boy").unwrap().name, "boy");
        assert!(Program.find("x +").unwrap_err().contains('^'), "the place is shown");
        assert!(Program.find("-").is_err() && Program.find("nothing.toml").is_err());
    }

    #[test]
    fn files_appear_whole_and_wrong_places_are_refused_first() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scene.toml");
        let place = Program.reserve(&path).unwrap();
        assert!(!path.exists());
        place.fill(b"title = 1").unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"title = 1");
        let refused = Program.reserve(&folder.path().join("none/scene.toml")).err().unwrap();
        assert!(refused.contains("make it first"), "{refused}");
    }
}
