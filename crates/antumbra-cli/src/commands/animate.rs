//! `antumbra render --frames`: one scene, many pictures.

use std::{
    fs,
    path::Path,
    process::{Command, Stdio},
    sync::Arc,
    time::Instant,
};

use antumbra::{
    image::{self, COLOR_PLANE, Movie, Still, png_bytes_noted},
    render::{Renderer, fingerprint},
    scene::Scene,
};
use anyhow::{Context, Result, anyhow, bail};

use super::{End, deadline, legend_left_out, pursue, spent};
use crate::{
    animation::{Container, Film, Output, Pattern},
    failure::{Interrupted, Usage},
    interrupt::Asking,
    options::{Format, RenderOptions},
    output::{Folder, Sink, finish, remark},
    progress::Progress,
    unfinished::Unfinished,
};

/// Renders the frames that are not there yet, each whole or not at all; then, if it is to be one, makes one file of them.
pub(super) fn run(options: &RenderOptions, film: &Film) -> Result<()> {
    let Format::Png(depth) = options.format else {
        return Err(Usage("frames are PNG files".to_owned()).into());
    };
    // Whatever can be wrong with the output is found before the work.
    let pattern = film.output.pattern();
    let whole = match &film.output {
        Output::Frames(_) => None,
        Output::Whole(container, path) => {
            if *container == Container::Mp4 {
                ffmpeg_is_there()?;
                if options.spec.width % 2 == 1 || options.spec.height % 2 == 1 {
                    return Err(
                        Usage("an .mp4 needs an even --size: its colours have half the resolution".to_owned()).into()
                    );
                }
            }
            Some((*container, Sink::open(path)?))
        }
    };
    let folder = Folder::open(&pattern.folder)?;
    let drawn = frames(options, film, &pattern, &|scene| {
        let note = format!("{} {depth:?} {:?}", fingerprint(scene, &options.spec)?, options.overlay);
        Ok(format!("Antumbra frame {}", note.replace(' ', "-")))
    })?;
    let n = film.animation.frames();
    let wrote = match whole {
        None => format!("{} to {}", pattern.file(0).display(), pattern.file(n - 1).display()),
        Some((container, mut sink)) => {
            let progress = Progress::new(options.quiet, "frames to one file");
            assemble(container, film, &pattern, &mut sink, &progress)?;
            finish(vec![sink])?;
            // They are in the file now.
            (0..n).try_for_each(|k| fs::remove_file(pattern.file(k))).context("cannot remove the frames")?;
            // Others may have put something there.
            let _ = fs::remove_dir(&pattern.folder);
            options.picture.display().to_string()
        }
    };
    drop(folder);
    if !options.quiet {
        let kept = if drawn < n { format!(", {} of them kept", n - drawn) } else { String::new() };
        remark(&format!("wrote {wrote}: {n} frames{kept}, {} per second", film.rate));
    }
    Ok(())
}

/// Renders every frame that is not there and gives their number. `note` names what a frame shows.
fn frames(
    options: &RenderOptions,
    film: &Film,
    pattern: &Pattern,
    note: &dyn Fn(&Scene) -> Result<String>,
) -> Result<usize> {
    let n = film.animation.frames();
    let progress = Progress::new(options.quiet, "frames");
    let (deadline, begin) = (deadline(options.budget), Instant::now());
    let (mut drawn, mut others, mut same, mut legend) = (0, 0, 0, None);
    for k in 0..n {
        let path = pattern.file(k);
        let mut scene = film.animation.frame(k)?;
        options.look.dress(&mut scene);
        let scene = Arc::new(scene);
        let note = note(&scene)?;
        if let Some(found) = found_note(&path) {
            match (found == note, options.resume) {
                (true, true) => continue,
                (true, false) => same += 1,
                (false, _) => others += 1,
            }
        }
        if deadline.is_some_and(|deadline| Instant::now() > deadline) {
            bail!(spent(options.budget, &done(k, n, "")));
        }
        let mut sink = Sink::open(&path)?;
        let mut unfinished = Unfinished::of(&path, options.format, options.save_every);
        let mut renderer = unfinished.begin_frame(&scene, &options.spec, options.run, options.resume)?;
        renderer.color_late();
        let asking = Asking::first(renderer.stop_flag());
        let mut between = |renderer: &Renderer| {
            let done = k as f64 + renderer.progress();
            let pace = begin.elapsed().div_f64(drawn as f64 + renderer.progress().max(1e-3));
            let left = (drawn > 0 || renderer.progress() > 0.1).then(|| pace.mul_f64(n as f64 - done));
            progress.show_frame(k, n, done / n as f64, left);
            unfinished.save_now_and_then(renderer);
        };
        let end = pursue(&mut renderer, deadline, None, &mut between);
        drop(asking);
        if end != End::Done {
            drop(progress);
            let words = done(k, n, &unfinished.stop_frame(&renderer)?);
            match end {
                End::Asked => bail!(Interrupted(words)),
                End::Budget | End::Done => bail!(spent(options.budget, &words)),
            }
        }
        let frame = match options.overlay {
            Some(kind) => renderer.frame().overlay(kind, options.spec.tolerance)?,
            None => renderer.frame().picture(&scene.look)?,
        };
        legend = legend.or_else(|| legend_left_out(renderer.frame(), options.overlay));
        let Format::Png(depth) = options.format else { bail!("frames are PNG files") };
        sink.fill(&png_bytes_noted(frame.require(COLOR_PLANE)?, depth, Some(&note))?)?;
        finish(vec![sink])?;
        unfinished.done();
        drawn += 1;
        progress.show_frame(k, n, (k + 1) as f64 / n as f64, None);
    }
    drop(progress);
    if let Some(words) = legend.filter(|_| !options.quiet) {
        remark(&words);
    }
    if others > 0 {
        remark(&format!("{others} of the frames that were there are of other scenes or options: they were replaced"));
    }
    if same > 0 {
        remark(&format!("{same} of the frames were there and have been drawn again (--resume keeps them)"));
    }
    Ok(drawn)
}

/// The message of an animation that stops; `kept` says what of the next frame.
fn done(k: usize, n: usize, kept: &str) -> String {
    format!("{k} of {n} frames are done{kept}: the same command with --resume goes on")
}

/// What a frame that is there says it shows; nothing where there is no whole picture. Another program's picture says "".
fn found_note(path: &Path) -> Option<String> {
    let still = Still::read(&fs::read(path).ok()?).ok()?;
    Some(still.note.unwrap_or_default())
}

/// Makes one file of all frames.
fn assemble(container: Container, film: &Film, pattern: &Pattern, sink: &mut Sink, progress: &Progress) -> Result<()> {
    let n = film.animation.frames();
    let still = |k: usize| {
        let path = pattern.file(k);
        let refused = |reason: String| image::Error::Decode { name: path.display().to_string(), reason };
        Still::read(&fs::read(&path).map_err(|e| refused(e.to_string()))?)
    };
    // A legend makes frames higher than what was asked for.
    let Still { width, height, .. } = still(0)?;
    let mut frame = |k: usize| {
        progress.set(k as f64 / n as f64);
        Ok(still(k)?.codes)
    };
    if container == Container::Mp4 {
        return encode_mp4(film, [width, height], n, &mut frame, sink);
    }
    let movie = Movie { width, height, frames: n, rate: film.rate, frame: &mut frame };
    sink.write(|out| {
        match container {
            Container::Gif => movie.write_gif(out)?,
            Container::Apng | Container::Mp4 => movie.write_apng(out)?,
        }
        Ok(())
    })
}

/// # Errors
/// Where there is no ffmpeg that can write H.264.
fn ffmpeg_is_there() -> Result<()> {
    let instead = "or write a .gif, an .apng or frames (%04d.png) instead";
    let asked = Command::new("ffmpeg").args(["-hide_banner", "-encoders"]).stdin(Stdio::null()).output();
    match asked {
        Ok(answer) if String::from_utf8_lossy(&answer.stdout).contains("libx264") => Ok(()),
        Ok(_) => Err(anyhow!(
            "an .mp4 needs an ffmpeg with the encoder libx264, and this one has none: install one, {instead}"
        )),
        Err(e) => {
            Err(anyhow!("an .mp4 needs the program ffmpeg, which cannot be started ({e}): install it, {instead}"))
        }
    }
}

/// Frames through a pipe to ffmpeg, as raw RGB; H.264 in the colours of Rec. 709.
fn encode_mp4(
    film: &Film,
    [width, height]: [usize; 2],
    n: usize,
    frame: &mut dyn FnMut(usize) -> Result<Vec<u8>, image::Error>,
    sink: &mut Sink,
) -> Result<()> {
    let mut command = Command::new("ffmpeg");
    command.args(["-hide_banner", "-loglevel", "error", "-nostdin", "-f", "rawvideo", "-pix_fmt", "rgb24"]);
    command.args(["-s", &format!("{width}x{height}"), "-r", &film.rate.to_string(), "-i", "pipe:0"]);
    command.args(["-vf", "scale=out_color_matrix=bt709:out_range=tv", "-pix_fmt", "yuv420p"]);
    command.args(["-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "iec61966-2-1"]);
    command.args(["-c:v", "libx264", "-crf", "16", "-preset", "slow"]);
    // A pipe cannot be gone back in: the index comes in parts.
    command.args(["-movflags", "frag_keyframe+empty_moov+default_base_moof", "-f", "mp4", "pipe:1"]);
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().context("cannot start ffmpeg")?;
    let (Some(mut input), Some(mut output), Some(mut errors)) =
        (child.stdin.take(), child.stdout.take(), child.stderr.take())
    else {
        bail!("ffmpeg has no pipes");
    };
    // Its three pipes at the same time, so that none of them fills up.
    let (fed, said) = std::thread::scope(|scope| {
        let said = scope.spawn(move || std::io::read_to_string(&mut errors).unwrap_or_default());
        let written =
            scope.spawn(move || sink.write(|out| std::io::copy(&mut output, out).map(|_| ()).map_err(Into::into)));
        let mut fed = (0..n).try_for_each(|k| {
            let codes = frame(k)?;
            std::io::Write::write_all(&mut input, &codes).context("ffmpeg stopped reading")
        });
        drop(input);
        if let Ok(written) = written.join() {
            fed = fed.and(written);
        }
        (fed, said.join().unwrap_or_default())
    });
    let status = child.wait().context("ffmpeg is lost")?;
    if !status.success() {
        bail!("ffmpeg failed ({status}): {}", said.trim());
    }
    fed
}
