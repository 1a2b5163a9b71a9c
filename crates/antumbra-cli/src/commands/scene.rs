//! `antumbra scene`: scene files written, checked and printed.

use antumbra::{
    geom::Clip,
    scene::{Extent, SceneFile, extent},
};
use anyhow::{Result, bail};

use crate::{
    args::SceneCommand,
    options::find_scene,
    output::{Sink, finish, print, remark},
};

/// A scene to begin with; its test renders it.
const TEMPLATE: &str = include_str!("scene.toml");

/// Writes, checks or prints.
pub(super) fn run(command: &SceneCommand) -> Result<()> {
    match command {
        SceneCommand::New { file } => {
            if file.extension().is_none_or(|e| e != "toml") {
                bail!("`{}` should end in .toml, so that `antumbra render` knows it as a scene file", file.display());
            }
            if file.exists() {
                bail!("`{}` exists and is kept; choose another name", file.display());
            }
            let mut sink = Sink::open(file)?;
            sink.fill(TEMPLATE.as_bytes())?;
            finish(vec![sink])?;
            remark(&format!("wrote {0}: edit it, then `antumbra render {0}`", file.display()));
            Ok(())
        }
        SceneCommand::Check { scene } => {
            let found = find_scene(scene)?;
            let (objects, lights) = (&found.scene.objects, found.scene.lights.len());
            let whole = objects.iter().filter(|o| o.region() != o.clip() || o.clip() == Clip::Everywhere).count();
            for (k, o) in objects.iter().enumerate().filter(|(_, o)| extent(o.surface.as_ref()) == Extent::Nowhere) {
                remark(&format!(
                    "surface {}, `{}`, has no zero (proved for |x|, |y|, |z| <= 2^20)",
                    k + 1,
                    o.text.trim()
                ));
            }
            print(&format!(
                "{}: surfaces: {} ({whole} proved to lie wholly inside their clips), lights: {lights}, floor: {}\n",
                found.scene.title,
                objects.len(),
                if found.scene.floor_shown { "yes" } else { "no" },
            ))
        }
        SceneCommand::Show { scene } => {
            let found = find_scene(scene)?;
            let file = match &found.file {
                Some(file) => file.completed(&found.stem)?,
                None => SceneFile::of(&found.scene),
            };
            print(&file.text()?)
        }
    }
}
