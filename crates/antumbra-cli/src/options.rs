//! Validated options: scenes found, formulas read, paths and formats understood.

use std::{
    fs,
    io::{
        ErrorKind::{NotADirectory, NotFound},
        Read,
    },
    path::{Path, PathBuf},
    sync::Arc,
    thread,
    time::Duration,
};

use antumbra::{
    expr::ErrorKind,
    image::Depth,
    render::{Method, Overlay, RenderSpec, RunSpec},
    report::Exhibit,
    scene::{self, GALLERY, GalleryEntry, Output, Scene, SceneFile},
};
use anyhow::{Result, anyhow};

use crate::{
    animation::{self, Film},
    args::{AuditArgs, CompareArgs, GalleryArgs, LookArgs, PaperArgs, RenderArgs, SpecArgs},
    failure::Usage,
    import, missing,
    values::{self, Device},
};

/// Bytes of formula read from standard input. The heart has its own, smaller limit; this one bounds the memory.
pub(crate) const MAX_FORMULA: u64 = 64 << 20;

/// A scene and what it is called.
#[derive(Debug)]
pub(crate) struct NamedScene {
    /// The preset's name or the formula.
    pub(crate) name: String,
    /// A name that can be part of a file name.
    pub(crate) stem: String,
    pub(crate) scene: Arc<Scene>,
    /// The scene as a file, where it may have parameters.
    pub(crate) file: Option<SceneFile>,
}

/// Where JSON goes.
#[derive(Debug, PartialEq, Eq)]
pub(crate) enum JsonTarget {
    Stdout,
    File(PathBuf),
}

/// The kind of a picture file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Format {
    Png(Depth),
    Exr,
}

/// Options of `render`.
#[derive(Debug)]
pub(crate) struct RenderOptions {
    pub(crate) scene: NamedScene,
    pub(crate) look: LookArgs,
    pub(crate) spec: RenderSpec,
    pub(crate) run: RunSpec,
    pub(crate) picture: PathBuf,
    pub(crate) format: Format,
    /// MiB that the picture may take.
    pub(crate) memory: Option<u64>,
    pub(crate) device: Device,
    pub(crate) overlay: Option<Overlay>,
    pub(crate) planes: Option<PathBuf>,
    /// What moves, if it is to be many pictures.
    pub(crate) film: Option<Film>,
    pub(crate) json: Option<JsonTarget>,
    /// Time after which to stop.
    pub(crate) budget: Option<Duration>,
    /// Whether to go on with a render that was stopped.
    pub(crate) resume: bool,
    /// Time between two saves.
    pub(crate) save_every: Duration,
    pub(crate) quiet: bool,
}

/// Options of `compare`.
#[derive(Debug)]
pub(crate) struct CompareOptions {
    pub(crate) scene: NamedScene,
    /// What to draw, by the first of the methods.
    pub(crate) spec: RenderSpec,
    /// At least one, none of them twice.
    pub(crate) methods: Vec<Method>,
    pub(crate) run: RunSpec,
    pub(crate) json: Option<JsonTarget>,
    /// Time after which to give up.
    pub(crate) budget: Option<Duration>,
    pub(crate) quiet: bool,
}

/// Options of `paper`.
#[derive(Debug)]
pub(crate) struct PaperOptions {
    pub(crate) exhibit: Exhibit,
    pub(crate) spec: RenderSpec,
    pub(crate) run: RunSpec,
    pub(crate) folder: Option<PathBuf>,
    pub(crate) quiet: bool,
}

impl RenderOptions {
    /// # Errors
    /// [`Usage`] where the scene, the formula or the extension of a file is not understood.
    pub(crate) fn new(args: RenderArgs) -> Result<Self> {
        let mut scene = animation::set(find_scene(&args.scene)?, &args.parameters.set)?;
        args.look.dress(Arc::make_mut(&mut scene.scene));
        let film = Film::new(&args.animation, &scene, args.output.as_deref())?;
        let picture = args
            .output
            .unwrap_or_else(|| PathBuf::from(format!("{}.{}", scene.stem, if film.is_some() { "gif" } else { "png" })));
        let depth = if args.bits == "16" { Depth::Sixteen } else { Depth::Eight };
        let format = if film.is_some() { Format::Png(depth) } else { format_of(&picture, depth)? };
        if film.is_some() && args.device != Device::Cpu {
            return Err(Usage("--device belongs to one picture, not to an animation".to_owned()).into());
        }
        if let Some(film) = &film {
            if args.planes.is_some() || args.json.is_some() {
                return Err(Usage("--planes and --json belong to one picture, not to an animation".to_owned()).into());
            }
            if depth == Depth::Sixteen && !matches!(film.output, animation::Output::Frames(_)) {
                return Err(Usage("16 bits fit only into frames of their own (-o frames/%04d.png)".to_owned()).into());
            }
        }
        let json = args.json.map(json_target);
        if json == Some(JsonTarget::File(picture.clone())) {
            return Err(Usage(format!("`{}` cannot be both picture and JSON", picture.display())).into());
        }
        let (mut spec, run) = specs(args.spec, args.method, scene.scene.output);
        spec.floor |= scene.scene.floor_shown;
        // A GPU takes few surfaces, of any length.
        spec.unions &= args.device == Device::Cpu;
        Ok(Self {
            scene,
            look: args.look,
            spec,
            run,
            picture,
            format,
            memory: args.memory,
            device: args.device,
            overlay: args.overlay,
            planes: args.planes,
            film,
            json,
            budget: args.budget,
            resume: args.resume,
            save_every: args.save_every,
            quiet: args.quiet,
        })
    }
}

impl CompareOptions {
    /// # Errors
    /// [`Usage`] where the scene or the formula is not understood, or a method is named twice.
    pub(crate) fn new(args: CompareArgs) -> Result<Self> {
        for (i, method) in args.methods.iter().enumerate() {
            if args.methods[..i].contains(method) {
                return Err(Usage(format!("method `{}` is named twice", method.name())).into());
            }
        }
        let Some(&first) = args.methods.first() else {
            return Err(Usage("--methods needs at least one method".to_owned()).into());
        };
        let scene = animation::set(find_scene(&args.scene)?, &args.parameters.set)?;
        let (mut spec, run) = specs(args.spec, first, scene.scene.output);
        spec.floor |= scene.scene.floor_shown;
        // The paper's methods have no parts of unions: all are to draw the same surfaces.
        spec.unions &= args.methods.iter().all(|method| *method == Method::Certified);
        Ok(Self {
            scene,
            spec,
            methods: args.methods,
            run,
            json: args.json.map(json_target),
            budget: args.budget,
            quiet: args.quiet,
        })
    }
}

impl PaperOptions {
    /// Pictures need a folder, the current one by default; a table needs none.
    pub(crate) fn new(args: PaperArgs) -> Self {
        let (spec, run) = specs(args.spec, RenderSpec::default().method, Output::default());
        let folder = args.output.or(args.exhibit.has_pictures().then(|| PathBuf::from(".")));
        Self { exhibit: args.exhibit, spec, run, folder, quiet: args.quiet }
    }
}

/// What `audit` looks at.
#[derive(Debug)]
pub(crate) enum Audited {
    /// A frame in a folder.
    Folder(PathBuf),
    /// A scene to be rendered.
    Scene(Box<NamedScene>, RenderSpec),
}

/// Options of `audit`.
#[derive(Debug)]
pub(crate) struct AuditOptions {
    pub(crate) audited: Audited,
    pub(crate) pixels: usize,
    pub(crate) seed: u64,
    pub(crate) run: RunSpec,
    pub(crate) json: Option<JsonTarget>,
    /// Time after which to give up.
    pub(crate) budget: Option<Duration>,
    pub(crate) quiet: bool,
}

impl AuditOptions {
    /// # Errors
    /// [`Usage`] where the scene or the formula is not understood.
    pub(crate) fn new(args: AuditArgs) -> Result<Self> {
        let folder = Path::new(&args.frame);
        // No formula is the name of a folder, but for very odd folders; a preset may be.
        let audited =
            if args.frame.ends_with('/') || (!scene::names().any(|name| name == args.frame) && folder.is_dir()) {
                None
            } else {
                Some(animation::set(find_scene(&args.frame)?, &args.parameters.set)?)
            };
        let wanted = audited.as_ref().map_or_else(Output::default, |scene| scene.scene.output);
        let (mut spec, run) = specs(args.spec, Method::Certified, wanted);
        let seed = spec.seed;
        let audited = match audited {
            None => Audited::Folder(folder.to_owned()),
            Some(scene) => {
                spec.floor |= scene.scene.floor_shown;
                Audited::Scene(Box::new(scene), spec)
            }
        };
        let json = args.json.map(json_target);
        Ok(Self { audited, pixels: args.pixels as usize, seed, run, json, budget: args.budget, quiet: args.quiet })
    }
}

/// Options of `gallery`.
#[derive(Debug)]
pub(crate) struct GalleryOptions {
    /// Only print what there is.
    pub(crate) list: bool,
    /// At least one, none of them twice.
    pub(crate) entries: Vec<&'static GalleryEntry>,
    pub(crate) spec: RenderSpec,
    pub(crate) run: RunSpec,
    pub(crate) folder: PathBuf,
    /// Pictures in a row of the sheet.
    pub(crate) columns: usize,
    /// Time after which to give up on a surface.
    pub(crate) budget: Option<Duration>,
    pub(crate) quiet: bool,
}

impl GalleryOptions {
    /// # Errors
    /// [`Usage`] where there is no surface of a name.
    pub(crate) fn new(args: GalleryArgs) -> Result<Self> {
        let names: Vec<&str> = GALLERY.iter().map(|e| e.name).collect();
        if let Some(unknown) = args.names.iter().find(|name| !names.contains(&name.as_str())) {
            let advice = match values::nearest(unknown, &names) {
                Some(name) => format!("did you mean `{name}`?"),
                None => "`antumbra gallery --list` prints the names".to_owned(),
            };
            return Err(Usage(format!("the gallery has no surface named `{unknown}`; {advice}")).into());
        }
        let wanted = |e: &&GalleryEntry| args.names.is_empty() || args.names.iter().any(|name| name == e.name);
        let entries = GALLERY.iter().filter(wanted).collect();
        let (spec, run) = specs(args.spec, Method::Certified, Output::default());
        Ok(Self {
            list: args.list,
            entries,
            spec,
            run,
            folder: args.output,
            columns: args.columns,
            budget: args.budget,
            quiet: args.quiet,
        })
    }
}

/// Threads that a run will use.
pub(crate) fn thread_count(run: &RunSpec) -> usize {
    run.threads.or_else(|| thread::available_parallelism().ok().map(Into::into)).unwrap_or(1)
}

impl LookArgs {
    /// What the command line says of the look holds for all surfaces of a scene.
    pub(crate) fn dress(&self, scene: &mut Scene) {
        let look = &mut scene.look;
        look.tone = self.tone.unwrap_or(look.tone);
        look.exposure = self.exposure.unwrap_or(look.exposure);
        look.outline |= self.outline;
        for object in &mut scene.objects {
            object.finish = self.finish.unwrap_or(object.finish);
            if let Some(by) = self.color_by {
                object.coloring = by.coloring();
            }
        }
    }
}

/// What to draw and how to run: what the command line says, else what the scene wants, else the usual.
fn specs(args: SpecArgs, method: Method, wanted: Output) -> (RenderSpec, RunSpec) {
    let usual = RenderSpec::default();
    let [width, height] = wanted.size.unwrap_or([usual.width, usual.height]);
    let spec = RenderSpec {
        width: args.size.map_or(width, |size| size.width),
        height: args.size.map_or(height, |size| size.height),
        method,
        light_scale: args.light_scale,
        floor: args.floor,
        grid: args.grid,
        sub_beams: args.sub_beams,
        offset: args.offset,
        seed: args.seed,
        tolerance: args.tolerance.or(wanted.tolerance).unwrap_or(usual.tolerance),
        rectangles: args.rectangles,
        penumbra: args.penumbra,
        regions: !args.no_regions,
        unions: !args.no_regions,
        ..RenderSpec::default()
    };
    (spec, RunSpec { threads: args.threads })
}

fn json_target(path: PathBuf) -> JsonTarget {
    if path == Path::new("-") { JsonTarget::Stdout } else { JsonTarget::File(path) }
}

fn format_of(path: &Path, depth: Depth) -> Result<Format> {
    // A folder has no format: opening it says so.
    let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase());
    match extension.as_deref() {
        Some("png") => Ok(Format::Png(depth)),
        Some("exr") => Ok(Format::Exr),
        _ if path.is_dir() => Ok(Format::Png(depth)),
        Some("gif" | "apng" | "mp4") => Err(Usage(format!(
            "`{}` holds moving pictures, and nothing moves: say what, with --turntable or --animate NAME=FROM:TO, and --frames N; \
             a still picture ends in .png or .exr",
            path.display()
        ))
        .into()),
        _ => {
            let message = format!("`{}` has no format that is known: end it in .png or .exr", path.display());
            Err(Usage(message).into())
        }
    }
}

/// A preset or a surface of the gallery if there is one of that name, else a formula; what is neither but looks like a name is a misspelt
/// preset, and what looks like a path a misspelt file.
pub(crate) fn find_scene(text: &str) -> Result<NamedScene> {
    if text == "-" {
        let mut formula = String::new();
        std::io::stdin()
            .take(MAX_FORMULA + 1)
            .read_to_string(&mut formula)
            .map_err(|e| anyhow!("cannot read a formula from standard input: {e}"))?;
        if formula.len() as u64 > MAX_FORMULA {
            return Err(Usage(format!("the formula on standard input is longer than {MAX_FORMULA} bytes")).into());
        }
        return from_formula(formula.trim_end());
    }
    let path = Path::new(text);
    let scene_file = text.ends_with(".toml");
    if scene_file || import::is_known(path) {
        let nothing = fs::metadata(path).is_err_and(|e| matches!(e.kind(), NotFound | NotADirectory));
        return match scene_file {
            _ if nothing => Err(missing::message(text, None).into()),
            true => from_file(path),
            false => import::from_file(path),
        };
    }
    if let Some(scene) = scene::named(text) {
        let scene = Arc::new(scene.map_err(|e| Usage(e.to_string()))?);
        return Ok(NamedScene { name: text.to_owned(), stem: text.to_owned(), scene, file: None });
    }
    // A file whose name says nothing is read only where there is no other way to understand the words.
    from_formula(text).or_else(|e| match () {
        () if path.is_file() => import::from_file(path),
        () if missing::is_path(text) && !path.exists() => Err(missing::message(text, Some(&e.to_string())).into()),
        () => Err(e),
    })
}

/// The scene in a file, named as its file.
fn from_file(path: &Path) -> Result<NamedScene> {
    let refuse = |reason: String| anyhow!(Usage(format!("`{}`: {reason}", path.display())));
    let size = fs::metadata(path).map_err(|e| anyhow!("cannot read `{}`: {e}", path.display()))?.len();
    if size > MAX_FORMULA {
        return Err(refuse(format!("a scene file has at most {MAX_FORMULA} bytes, this one {size}")));
    }
    let bytes = fs::read(path).map_err(|e| anyhow!("cannot read `{}`: {e}", path.display()))?;
    let text = String::from_utf8(bytes).map_err(|e| refuse(format!("it is not text in UTF-8: {e}")))?;
    let stem = path.file_stem().map_or_else(|| "antumbra".to_owned(), |s| s.to_string_lossy().into_owned());
    let file = SceneFile::parse(&text).map_err(|e| refuse(e.to_string()))?;
    let scene = Arc::new(file.scene(&stem).map_err(|e| refuse(e.in_text(&text)))?);
    Ok(NamedScene { name: path.display().to_string(), stem, scene, file: Some(file) })
}

fn from_formula(text: &str) -> Result<NamedScene> {
    let scene = Arc::new(Scene::from_formula(text).map_err(|e| match &e {
        scene::Error::Formula(e) if e.kind() == ErrorKind::UnknownName && looks_like_a_name(text) => no_preset(text),
        _ => Usage(explain(&e, text)),
    })?);
    let file = Some(SceneFile::of_formula(text));
    Ok(NamedScene { name: text.to_owned(), stem: "antumbra".to_owned(), scene, file })
}

/// A formula's error with the place in its text, under the word `error: ` that `main` writes.
pub(crate) fn explain(error: &scene::Error, text: &str) -> String {
    match error {
        scene::Error::Formula(error) => {
            let message = error.render(text);
            message.strip_prefix("error: ").unwrap_or(&message).to_owned()
        }
        scene::Error::Tape(_) => error.to_string(),
    }
}

fn looks_like_a_name(text: &str) -> bool {
    text.starts_with(|c: char| c.is_alphabetic())
        && text.chars().all(|c| c.is_alphanumeric() || matches!(c, '-' | '_' | ' '))
}

fn no_preset(text: &str) -> Usage {
    let names: Vec<&str> = scene::names().collect();
    let advice = match values::nearest(text, &names) {
        Some(name) => format!("did you mean `{name}`?"),
        None => format!("the presets and the gallery are {}; a formula in x, y, z will do too", names.join(", ")),
    };
    Usage(format!("no preset named `{text}`; {advice}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formats_by_extension() {
        assert_eq!(format_of(Path::new("a.PNG"), Depth::Sixteen).unwrap(), Format::Png(Depth::Sixteen));
        assert_eq!(format_of(Path::new("a.b/c.exr"), Depth::Eight).unwrap(), Format::Exr);
        for bad in ["a", "a.jpg", ".png", "a.png.txt"] {
            assert!(format_of(Path::new(bad), Depth::Eight).unwrap_err().is::<Usage>(), "{bad}");
        }
    }

    #[test]
    fn names_and_formulas() {
        assert_eq!(find_scene("chubs").unwrap().stem, "chubs");
        assert_eq!(find_scene("x^2 + y^2 + z^2 - 1").unwrap().stem, "antumbra");
        // `xyz` looks like a name but is a product.
        assert_eq!(find_scene("xyz").unwrap().name, "xyz");
        let message = |text: &str| find_scene(text).unwrap_err().to_string();
        assert_eq!(message("orthocirle"), "no preset named `orthocirle`; did you mean `orthocircle`?");
        assert!(message("teapot").contains("the presets and the gallery are"));
        assert!(!message("x^2 + $").contains("no preset"));
    }
}
