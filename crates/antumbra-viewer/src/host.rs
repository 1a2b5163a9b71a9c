//! What the window leaves to the program that opens it: finding scenes, and files that appear whole or not at all.
use antumbra::scene::SceneFile;
use std::{path::Path, sync::Arc};

/// A scene that was found, as a file that can be edited.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// What it is called; a part of the names of files.
    pub name: String,
    /// The scene.
    pub file: SceneFile,
    /// Whether it lies in a scene file of the user: then an edit of a formula keeps its camera, light and clips. Everything else is
    /// framed anew.
    pub own: bool,
}

/// A place for a file, tried before the work begins.
pub trait Place: Send {
    /// Writes the content; only then does the file appear under its name.
    ///
    /// # Errors
    /// What went wrong and what to do, in words.
    fn fill(self: Box<Self>, bytes: &[u8]) -> Result<(), String>;
}

/// The program around the window.
pub trait Host: Send + Sync {
    /// The scene that a user means by a text: a name, a path, a formula. May take a while; is never called by the thread that draws.
    ///
    /// # Errors
    /// What is wrong and what to do, in words.
    fn find(&self, text: &str) -> Result<Found, String>;

    /// Reserves a place for a file.
    ///
    /// # Errors
    /// Why it cannot be written there, in words.
    fn reserve(&self, path: &Path) -> Result<Box<dyn Place>, String>;
}

/// A host that many threads ask.
pub type SharedHost = Arc<dyn Host>;
