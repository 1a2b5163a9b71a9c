//! tmp
use antumbra::eval::wgsl::Width;
use antumbra::geom::{Film, Rect};
use antumbra::scene::{GALLERY, PRESETS, named};
use antumbra::trace::Surface;
use antumbra_gpu::{Gpu, Kernels, Pixel};
use std::sync::atomic::AtomicBool;

fn main() {
    let side: usize = std::env::args().nth(1).and_then(|s| s.parse().ok()).unwrap_or(64);
    let gpu = Gpu::open(true).unwrap();
    for name in PRESETS.iter().map(|p| p.name).chain(GALLERY.iter().map(|e| e.name)) {
        let scene = named(name).unwrap().unwrap();
        let surfaces: Vec<Surface<'_>> = scene
            .objects
            .iter()
            .map(|o| Surface { function: o.surface.as_ref(), clip: o.clip(), region: o.region() })
            .collect();
        let film = Film { camera: scene.view.camera(1.0), width: side, height: side };
        let lights: Vec<Rect> = scene.lights.iter().map(|l| l.rect).collect();
        let mut text = format!("| {name} |");
        for width in [Width::Single, Width::Double] {
            match Kernels::of_width(&gpu, &surfaces, &film, &lights, 1.0 / 255.0, width).and_then(|k| {
                k.prove(&gpu, &AtomicBool::new(false), &mut |_| ())?;
                k.prove(&gpu, &AtomicBool::new(false), &mut |_| ())
            }) {
                Ok(p) => {
                    let open = p.pixels.iter().filter(|p| matches!(p, Pixel::Open { .. })).count();
                    let hits: Vec<usize> =
                        (0..p.pixels.len()).filter(|k| matches!(p.pixels[*k], Pixel::Hit { .. })).collect();
                    let wide: usize = p
                        .lights
                        .iter()
                        .map(|l| hits.iter().filter(|k| l[**k][1] - l[**k][0] > 1.0 / 255.0).count())
                        .sum();
                    text += &format!(
                        " {open} | {} | {wide} | {:?} | {:.1} | {:.1} |",
                        hits.len(),
                        p.evaluations,
                        1e3 * p.seconds[0],
                        1e3 * p.seconds[1..].iter().sum::<f64>()
                    );
                }
                Err(e) => text += &format!(" {} |", e.to_string().chars().take(1500).collect::<String>()),
            }
        }
        println!("{text}");
    }
}
