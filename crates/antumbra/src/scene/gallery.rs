//! The gallery: surfaces that one wants to see, each with its history, its light and its view. Their files lie in the folder
//! `gallery` of this crate; tests check what is known of each formula.
use super::{About, FileError, Scene, SceneFile, preset, presets::PRESETS};

/// A surface of the gallery.
#[derive(Clone, Copy, Debug)]
pub struct GalleryEntry {
    /// What one types.
    pub name: &'static str,
    content: Content,
}

#[derive(Clone, Copy, Debug)]
enum Content {
    /// The text of a scene file.
    File(&'static str),
    /// The preset of that name, and what there is to say about it: its view stays that of the paper.
    Preset { author: &'static str, year: Option<i32>, source: &'static str, history: &'static str },
}

impl GalleryEntry {
    /// The scene.
    ///
    /// # Errors
    /// None for the entries as they are (tested); the type is that of files.
    pub fn scene(&self) -> Result<Scene, FileError> {
        match self.content {
            Content::File(text) => SceneFile::parse(text)?.scene(self.name),
            Content::Preset { author, year, source, history } => {
                let mut scene = of_preset(self.name).unwrap_or_else(|| {
                    Err(FileError::Value { key: self.name.to_owned(), reason: "there is no such preset".to_owned() })
                })?;
                let text = |s: &str| Some(s.to_owned());
                scene.about = Some(About { author: text(author), year, source: text(source), history: text(history) });
                Ok(scene)
            }
        }
    }
}

/// The scene of that name as a file, with its parameters where it has some: what [`named`] reads.
///
/// # Errors
/// None, as for [`GalleryEntry::scene`].
#[must_use]
pub fn file_named(name: &str) -> Option<Result<SceneFile, FileError>> {
    let written = GALLERY.iter().find(|e| e.name == name).and_then(|e| match e.content {
        Content::File(text) => Some(SceneFile::parse(text)),
        Content::Preset { .. } => None,
    });
    written.or_else(|| named(name).map(|scene| scene.map(|scene| SceneFile::of(&scene))))
}

fn of_preset(name: &str) -> Option<Result<Scene, FileError>> {
    let refuse =
        |e: super::Error| FileError::Formula { key: format!("preset {name}"), message: e.to_string(), place: None };
    Some(preset(name)?.map_err(refuse))
}

/// The scene of that name, if there is one: a surface of the gallery, else a preset. Where the gallery hangs a preset, it is
/// the same scene with a history.
///
/// # Errors
/// None, as for [`GalleryEntry::scene`].
#[must_use]
pub fn named(name: &str) -> Option<Result<Scene, FileError>> {
    let entry = GALLERY.iter().find(|e| e.name == name).map(GalleryEntry::scene);
    entry.or_else(|| of_preset(name))
}

/// Names that [`named`] knows, each once: presets first.
pub fn names() -> impl Iterator<Item = &'static str> {
    let preset = |name: &str| PRESETS.iter().any(|p| p.name == name);
    PRESETS.iter().map(|p| p.name).chain(GALLERY.iter().map(|e| e.name).filter(move |name| !preset(name)))
}

macro_rules! file {
    ($name:literal) => {
        GalleryEntry { name: $name, content: Content::File(include_str!(concat!("../../gallery/", $name, ".toml"))) }
    };
}

/// Every surface of the gallery, in the order of a walk through it: the paper's four, surfaces with many nodes, one-sided and
/// knotted ones, tubes and bulges, singular ones, minimal ones, and what computers brought.
pub const GALLERY: &[GalleryEntry] = &[
    GalleryEntry {
        name: "orthocircle",
        content: Content::Preset {
            author: "public lists of the 1990s; drawn with certified shadows by Florez-Diaz and Sbert",
            year: None,
            source: "Reliable Soft Shadows over Implicit Surfaces, WSCG 2010",
            history: "Three rings through one another, in a polynomial of degree twelve. Ray casters that sample lose parts of \
                      them.",
        },
    },
    GalleryEntry {
        name: "chubs",
        content: Content::Preset {
            author: "public lists of the 1990s, from the family of Édouard Goursat",
            year: None,
            source: "Reliable Soft Shadows over Implicit Surfaces, WSCG 2010",
            history: "Eight chubby bodies joined in twelve nodes, the middles of the edges of a cube. At a node nothing can be \
                      proved: the gradient vanishes.",
        },
    },
    GalleryEntry {
        name: "kusner",
        content: Content::Preset {
            author: "Robert Kusner and Nick Schmitt",
            year: None,
            source: "Reliable Soft Shadows over Implicit Surfaces, WSCG 2010",
            history: "A pillow over a tetrahedron, whose four horns end in cusps. Meshes cut them off.",
        },
    },
    GalleryEntry {
        name: "mcmullen",
        content: Content::Preset {
            author: "Curtis McMullen",
            year: Some(2002),
            source: "Dynamics on K3 surfaces: Salem numbers and Siegel disks, Crelle's Journal 545",
            history: "The real part of a K3 surface. Swapping the two points on every line along an axis gives it three \
                      symmetries, whose product moves its points in chaos and in islands.",
        },
    },
    file!("cayley"),
    file!("clebsch"),
    file!("kummer"),
    file!("togliatti"),
    file!("barth-sextic"),
    file!("labs-septic"),
    file!("endrass-octic"),
    file!("barth-decic"),
    file!("chmutov-octic"),
    file!("steiner"),
    file!("cross-cap"),
    file!("boy"),
    file!("klein"),
    file!("whitney"),
    file!("swallowtail"),
    file!("trefoil"),
    file!("tangle"),
    file!("decocube"),
    file!("double-torus"),
    file!("bretzel"),
    file!("dupin-cyclide"),
    file!("tooth"),
    file!("sine-surface"),
    file!("cassini"),
    file!("heart"),
    file!("zitrus"),
    file!("himmel-hoelle"),
    file!("vis-a-vis"),
    file!("ding-dong"),
    file!("distel"),
    file!("stern"),
    file!("kreisel"),
    file!("eistuete"),
    file!("gyroid"),
    file!("schwarz-p"),
    file!("schwarz-d"),
    file!("neovius"),
    file!("scherk-tower"),
    file!("catenoid"),
    file!("helicoid"),
    file!("blobs"),
    file!("sine-blob"),
    file!("superellipsoid"),
    file!("die"),
    file!("bracket"),
    file!("supershape"),
    file!("nordstrand"),
    file!("calypso"),
];
