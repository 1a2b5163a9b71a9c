//! Validated options of animations: what moves, and where the frames go.

use std::path::{Path, PathBuf};

use antumbra::scene::{Animation, FileError, Motion, SceneFile};
use anyhow::Result;

use crate::{
    args::AnimationArgs,
    failure::Usage,
    options::NamedScene,
    values::{Assignment, Span},
};

/// Frames per second, unless it is said.
pub(crate) const RATE: f64 = 25.0;

/// An animation and its files.
#[derive(Debug)]
pub(crate) struct Film {
    pub(crate) animation: Animation,
    pub(crate) output: Output,
    /// Frames per second.
    pub(crate) rate: f64,
}

/// What becomes of the frames.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Output {
    /// Each is a file.
    Frames(Pattern),
    /// All of them make one, from a folder that then goes away.
    Whole(Container, PathBuf),
}

/// Files that hold moving pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Container {
    Gif,
    Apng,
    Mp4,
}

impl Output {
    /// # Errors
    /// [`Usage`] where the path names no frames and no moving picture.
    pub(crate) fn of(path: &Path) -> Result<Self> {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let folder = path.parent().unwrap_or(Path::new("")).to_string_lossy().into_owned();
        let shown = path.display();
        let advice = "end it in .gif, .apng, .png or .mp4, or name frames: frames/%04d.png";
        if folder.contains('%') {
            return Err(
                Usage(format!("`{shown}`: the frame's number belongs in the name of the file; {advice}")).into()
            );
        }
        let extension = Path::new(&name).extension().unwrap_or_default().to_string_lossy().to_lowercase();
        if name.contains('%') {
            let pattern = Pattern::of(path, &name).map_err(|e| Usage(format!("`{shown}`: {e}")))?;
            if extension == "png" {
                return Ok(Self::Frames(pattern));
            }
            return Err(Usage(format!("`{shown}`: frames are PNG files; end it in .png")).into());
        }
        let container = match extension.as_str() {
            "gif" => Container::Gif,
            "apng" | "png" => Container::Apng,
            "mp4" => Container::Mp4,
            _ => return Err(Usage(format!("`{shown}` cannot hold an animation: {advice}")).into()),
        };
        Ok(Self::Whole(container, path.to_owned()))
    }

    /// The files of the frames.
    pub(crate) fn pattern(&self) -> Pattern {
        match self {
            Self::Frames(pattern) => pattern.clone(),
            Self::Whole(_, path) => {
                let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
                let folder = path.with_file_name(format!("{name}.frames"));
                Pattern { folder, before: String::new(), width: 5, after: ".png".to_owned() }
            }
        }
    }
}

/// Names of frames: `%04d` stands for the number, from 0, with at least four digits; `%%` for a per cent sign.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Pattern {
    pub(crate) folder: PathBuf,
    before: String,
    width: usize,
    after: String,
}

impl Pattern {
    fn of(path: &Path, name: &str) -> Result<Self, String> {
        let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new(".")).to_owned();
        let mut found = None;
        let (mut text, mut rest) = (String::new(), name);
        while let Some((plain, directive)) = rest.split_once('%') {
            text += plain;
            if let Some(after) = directive.strip_prefix('%') {
                text.push('%');
                rest = after;
                continue;
            }
            let digits: String = directive.chars().take_while(char::is_ascii_digit).collect();
            let Some(after) = directive[digits.len()..].strip_prefix('d') else {
                return Err("after `%` comes the number of digits and `d`, as in frames/%04d.png".to_owned());
            };
            let width = if digits.is_empty() { 1 } else { digits.parse().unwrap_or(usize::MAX) };
            if width > 20 {
                return Err("a frame's number has at most 20 digits".to_owned());
            }
            if found.replace((std::mem::take(&mut text), width)).is_some() {
                return Err("the frame's number stands in the name twice".to_owned());
            }
            rest = after;
        }
        text += rest;
        let Some((before, width)) = found else {
            return Err("where is the frame's number? Write it as in frames/%04d.png".to_owned());
        };
        Ok(Self { folder, before, width, after: text })
    }

    /// The file of a frame.
    pub(crate) fn file(&self, k: usize) -> PathBuf {
        self.folder.join(format!("{}{k:0width$}{}", self.before, self.after, width = self.width))
    }
}

impl Film {
    /// The film that is asked for, if one is. Looks at the scene of every frame.
    ///
    /// # Errors
    /// [`Usage`] for whatever cannot move so, or cannot be written there.
    pub(crate) fn new(args: &AnimationArgs, scene: &NamedScene, path: Option<&Path>) -> Result<Option<Self>> {
        let Some(frames) = args.frames else { return Ok(None) };
        let output = match path {
            Some(path) => Output::of(path)?,
            None => Output::Whole(Container::Gif, PathBuf::from(format!("{}.gif", scene.stem))),
        };
        let refuse = |e: FileError| Usage(words(&e));
        let animation = if args.animate.is_empty() {
            if !args.turntable {
                let words = "--frames: nothing moves; say what, with --animate NAME=FROM:TO or --turntable";
                return Err(Usage(words.to_owned()).into());
            }
            Animation::turntable((*scene.scene).clone(), frames).map_err(refuse)?
        } else {
            let motion = |s: &Span| Motion { name: s.name.clone(), from: s.from, to: s.to };
            let motions = args.animate.iter().map(motion).collect();
            let (file, course) = (parametric(scene)?, args.course.unwrap_or_default());
            let moving = Animation::new(file.clone(), &scene.stem, motions, course, frames).map_err(refuse)?;
            if args.turntable { moving.turning().map_err(refuse)? } else { moving }
        };
        Ok(Some(Self { animation, output, rate: args.fps.unwrap_or(RATE) }))
    }
}

/// The scene as a file in which parameters can be set.
fn parametric(scene: &NamedScene) -> Result<&SceneFile, Usage> {
    scene.file.as_ref().ok_or_else(|| {
        Usage(format!(
            "`{}` has no parameters: they stand in a scene file, or in a formula as definitions (`a = 0.05; ...`)",
            scene.name
        ))
    })
}

/// The scene with other values of its parameters.
///
/// # Errors
/// [`Usage`] where there is none of that name, or the value is outside its range.
pub(crate) fn set(scene: NamedScene, values: &[Assignment]) -> Result<NamedScene> {
    if values.is_empty() {
        return Ok(scene);
    }
    let mut file = parametric(&scene)?.clone();
    for Assignment { name, value } in values {
        file.set(name, *value).map_err(|e| Usage(words(&e)))?;
    }
    let new = file.scene(&scene.stem).map_err(|e| Usage(e.to_string()))?;
    Ok(NamedScene { scene: new.into(), file: Some(file), ..scene })
}

/// The error without the key of a file that nobody has written.
fn words(error: &FileError) -> String {
    let words = error.to_string();
    words.strip_prefix("parameters.").map_or(words.clone(), |rest| format!("parameter {rest}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patterns_name_frames() {
        let file = |pattern: &str, k: usize| match Output::of(Path::new(pattern)).unwrap() {
            Output::Frames(pattern) => pattern.file(k).display().to_string(),
            Output::Whole(..) => panic!("{pattern} is a pattern"),
        };
        assert_eq!(file("frames/%04d.png", 7), "frames/0007.png");
        assert_eq!(file("a%d-100%%.PNG", 12), "./a12-100%.PNG");
        assert_eq!(file("%02d.png", 123), "./123.png");
        for (bad, words) in [
            ("%s.png", "the number of digits"),
            ("%4", "the number of digits"),
            ("%d%d.png", "twice"),
            ("100%%.png", "where is the frame's number"),
            ("%04d.jpg", "frames are PNG"),
            ("%d/a.png", "name of the file"),
            ("%99d.png", "at most 20"),
            ("out.webm", ".gif"),
            ("out", ".gif"),
        ] {
            let error = Output::of(Path::new(bad)).unwrap_err();
            assert!(error.is::<Usage>() && error.to_string().contains(words), "{bad}: {error}");
        }
    }

    #[test]
    fn moving_pictures_by_extension() {
        for (name, container) in [
            ("a.gif", Container::Gif),
            ("a.PNG", Container::Apng),
            ("b/a.apng", Container::Apng),
            ("a.mp4", Container::Mp4),
        ] {
            assert_eq!(Output::of(Path::new(name)).unwrap(), Output::Whole(container, PathBuf::from(name)));
        }
        let pattern = Output::of(Path::new("b/a.gif")).unwrap().pattern();
        assert_eq!(pattern.file(3), Path::new("b/a.gif.frames/00003.png"));
    }
}
