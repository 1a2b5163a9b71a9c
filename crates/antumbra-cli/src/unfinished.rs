//! What is known of an unfinished render, beside its picture: `NAME.png.state`, from which `--resume` goes on, and, after
//! Ctrl-C or a spent budget, `NAME.unfinished.png` to look at. Both go away when the picture is there.

use std::{
    fs::{self, File},
    io::BufReader,
    path::{Path, PathBuf},
    sync::Arc,
    time::{Duration, Instant},
};

use antumbra::{
    render::{RenderSpec, Renderer, RunSpec},
    scene::Scene,
};
use anyhow::{Result, anyhow};

use crate::{
    bands::Rows,
    commands::frame_bytes,
    options::Format,
    output::{Sink, finish, remark},
};

/// Saving may take this part of the time at most.
const SHARE: u32 = 30;

/// The files of one unfinished picture.
pub(crate) struct Unfinished {
    state: PathBuf,
    preview: PathBuf,
    format: Format,
    /// Least time between two saves.
    every: Duration,
    saved: Instant,
    /// Whether the files, if there are any, are of this render.
    own: bool,
    /// A device has no place beside it.
    possible: bool,
}

impl Unfinished {
    /// Those of a picture, saved that often.
    pub(crate) fn of(picture: &Path, format: Format, every: Duration) -> Self {
        let name = picture.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let extension = picture.extension().unwrap_or_default().to_string_lossy().into_owned();
        let possible = fs::metadata(picture).map_or(true, |old| old.is_file());
        Self {
            state: picture.with_file_name(format!("{name}.state")),
            preview: picture.with_extension(format!("unfinished.{extension}")),
            format,
            every,
            saved: Instant::now(),
            own: false,
            possible,
        }
    }

    /// A renderer at the beginning, in bands of so many rows; or, if it is to resume and there is a state, where that one stopped.
    ///
    /// # Errors
    /// Where the state cannot be gone on with; where no renderer can be had.
    pub(crate) fn begin(
        &mut self,
        scene: &Arc<Scene>,
        spec: &RenderSpec,
        run: RunSpec,
        rows: usize,
        resume: bool,
    ) -> Result<Renderer> {
        let state = self.state.display();
        match File::open(&self.state) {
            Ok(file) if resume => {
                let found = Renderer::resume(Arc::clone(scene), spec.clone(), run, &mut BufReader::new(file));
                let renderer = found.map_err(|e| {
                    anyhow!("cannot go on with `{state}`: {e}; to begin anew, leave out --resume (or delete the file)")
                })?;
                self.own = true;
                remark(&format!("going on with `{state}`: {:.0} % was done", 100.0 * renderer.progress()));
                return Ok(renderer);
            }
            Ok(_) => remark(&format!(
                "`{state}` is there, of an unfinished render: it is not used, and replaced when this render is saved \
                 (--resume would go on with it)"
            )),
            Err(e) if e.kind() == std::io::ErrorKind::NotFound => {}
            Err(e) if resume => return Err(anyhow!("cannot read `{state}`: {e}")),
            Err(_) => {}
        }
        Ok(Renderer::in_bands(Arc::clone(scene), spec.clone(), run, rows)?)
    }

    /// The same for a frame of an animation, in which a state of something else is no reason to stop.
    ///
    /// # Errors
    /// Where no renderer can be had.
    pub(crate) fn begin_frame(
        &mut self,
        scene: &Arc<Scene>,
        spec: &RenderSpec,
        run: RunSpec,
        resume: bool,
    ) -> Result<Renderer> {
        if let Some(file) = File::open(&self.state).ok().filter(|_| resume) {
            let found = Renderer::resume(Arc::clone(scene), spec.clone(), run, &mut BufReader::new(file));
            self.own = true;
            match found {
                Ok(renderer) => return Ok(renderer),
                Err(e) => remark(&format!("`{}` is not used: {e}", self.state.display())),
            }
        }
        Ok(Renderer::new(Arc::clone(scene), spec.clone(), run)?)
    }

    /// What was here of another render cannot be gone on with any more: it goes with this one.
    pub(crate) fn take_over(&mut self) {
        self.own = true;
    }

    /// Saves if it is time. That it cannot be saved is said, and no reason to stop.
    pub(crate) fn save_now_and_then(&mut self, renderer: &Renderer) {
        if !self.possible || self.saved.elapsed() < self.every {
            return;
        }
        let begin = Instant::now();
        if let Err(e) = self.save(renderer) {
            remark(&format!("the render goes on, but its state is not saved: {e:#}"));
        }
        self.saved = Instant::now();
        self.every = self.every.max(SHARE * (self.saved - begin));
    }

    fn save(&mut self, renderer: &Renderer) -> Result<()> {
        let mut sink = Sink::open(&self.state)?;
        sink.write(|out| Ok(renderer.save(out)?))?;
        finish(vec![sink])?;
        self.own = true;
        Ok(())
    }

    /// Saves a render that stops here, with a picture of what is done (unless it is drawn in bands, whose finished rows are kept), and
    /// says in words what was written. Nothing is written where nothing is done.
    ///
    /// # Errors
    /// Where the files cannot be written.
    pub(crate) fn stop(&mut self, renderer: Renderer, bands: Option<Rows>) -> Result<String> {
        let share = 100.0 * renderer.progress();
        if !self.possible || share == 0.0 {
            bands.into_iter().for_each(Rows::remove);
            return Ok("nothing was written".to_owned());
        }
        self.save(&renderer)?;
        if let Some(bands) = bands {
            return Ok(format!(
                "about {share:.0} % is done and kept in `{}` and `{}`: the same command with --resume goes on with it",
                self.state.display(),
                bands.folder().display()
            ));
        }
        let mut preview = Sink::open(&self.preview)?;
        let look = renderer.scene().look;
        preview.fill(&frame_bytes(&renderer.preview(), &look, self.format)?)?;
        finish(vec![preview])?;
        Ok(format!(
            "about {share:.0} % is done and kept in `{}`: the same command with --resume goes on with it; `{}` shows it",
            self.state.display(),
            self.preview.display()
        ))
    }

    /// Saves a frame of an animation that stops here, and says so.
    ///
    /// # Errors
    /// Where the state cannot be written.
    pub(crate) fn stop_frame(&mut self, renderer: &Renderer) -> Result<String> {
        let share = 100.0 * renderer.progress();
        if !self.possible || share == 0.0 {
            return Ok(String::new());
        }
        self.save(renderer)?;
        Ok(format!(", and about {share:.0} % of the next is kept in `{}`", self.state.display()))
    }

    /// The picture is there: what this render left on the way goes.
    pub(crate) fn done(&self) {
        if self.own {
            // What cannot be removed does no harm: it still fits the picture.
            let _ = fs::remove_file(&self.state);
            let _ = fs::remove_file(&self.preview);
        }
    }
}
