//! POV-Ray (Debian package povray): `polynomial` with Sturm's root solver, 17 x 17 samples of the light, adaptive 2: its best
//! correct setting by quality and time. Not the Orthocircle: its polynomial of degree 12 comes out wrong.
use crate::Skipped;
use crate::surfaces::Surface;
use antumbra::geom::Vec3;
use antumbra::scene::Scene;
use std::fmt::Write;
use std::fs::File;
use std::io::BufReader;
use std::process::Command;

/// CPU seconds of the whole program, and the light that each pixel throws back.
pub(crate) fn run(surface: &Surface, scene: &Scene, size: usize) -> Result<(f64, Vec<f64>), Skipped> {
    let object = surface.povray.ok_or_else(|| Skipped("its polynomials of degree 12 come out wrong".to_owned()))?;
    let folder = tempfile::tempdir().map_err(|e| Skipped(format!("no temporary folder: {e}")))?;
    let (input, output) = (folder.path().join("scene.pov"), folder.path().join("scene.png"));
    std::fs::write(&input, text(object, scene)).map_err(|e| Skipped(format!("no scene written: {e}")))?;
    // The shell's `time` is the one portable way to the CPU time of a child.
    let script = format!(
        "command -v povray >/dev/null || exit 127; TIMEFORMAT='%U %S'; time povray +I'{}' +O'{}' +W{size} +H{size} -A -D +WT1 +FN16 File_Gamma=1.0 2>'{}'",
        input.display(),
        output.display(),
        folder.path().join("log").display()
    );
    let ended = Command::new("bash").args(["-c", &script]).output().map_err(|e| Skipped(format!("bash: {e}")))?;
    let times = String::from_utf8_lossy(&ended.stderr);
    match ended.status.code() {
        Some(0) => {}
        Some(127) => return Err(Skipped("POV-Ray is not installed (Debian: povray)".to_owned())),
        _ => {
            let log = std::fs::read_to_string(folder.path().join("log")).unwrap_or_default();
            let last: Vec<&str> = log.lines().rev().filter(|l| !l.is_empty()).take(3).collect();
            return Err(Skipped(format!("POV-Ray failed: {}", last.join(" / "))));
        }
    }
    let seconds = times.lines().last().unwrap_or_default().split_whitespace().map(str::parse::<f64>);
    let seconds = seconds.sum::<Result<f64, _>>().map_err(|e| Skipped(format!("no time: {e}")))?;
    let picture = grey(&output).map_err(|e| Skipped(format!("its picture: {e}")))?;
    Ok((seconds, picture))
}

/// The scene: our camera and light by their vectors.
fn text(object: &str, scene: &Scene) -> String {
    let (camera, light) = (scene.view.camera(1.0), &scene.lights[0].rect);
    let v = |a: Vec3| format!("<{},{},{}>", a.0[0], a.0[1], a.0[2]);
    let mut out = "#version 3.7;\nglobal_settings { assumed_gamma 1.0 max_trace_level 1 }\n".to_owned();
    // The picture spans `right` and `up` around `direction`.
    let [right, up] = [camera.right, camera.up].map(|a| v(a * 2.0));
    let (eye, forward) = (v(camera.eye), v(camera.forward));
    let _ = writeln!(out, "camera {{ perspective location {eye} direction {forward} right {right} up {up} }}");
    let [u, w] = [light.edge_u, light.edge_v].map(|a| v(a * 2.0));
    let _ = writeln!(out, "light_source {{ {} rgb 1 area_light {u}, {w}, 17, 17 adaptive 2 }}", v(light.center));
    let _ = writeln!(out, "{object}\n  sturm texture {{ pigment {{ rgb 1 }} finish {{ ambient 0 diffuse 1 }} }} }}");
    out
}

/// The first channel of a picture of 16 bits.
fn grey(path: &std::path::Path) -> Result<Vec<f64>, Box<dyn std::error::Error>> {
    let mut reader = png::Decoder::new(BufReader::new(File::open(path)?)).read_info()?;
    let mut bytes = vec![0; reader.output_buffer_size().ok_or("too large")?];
    let info = reader.next_frame(&mut bytes)?;
    let pixel = info.line_size / info.width as usize;
    let value = |p: &[u8]| f64::from(u16::from_be_bytes([p[0], p[1]])) / 65535.0;
    Ok(bytes[..info.buffer_size()].chunks_exact(pixel).map(value).collect())
}
