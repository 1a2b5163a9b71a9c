//! What goes wrong on a GPU ends in an error that says so, and in a picture all the same: the processor's.
use crate::{Error, Gpu, Kernels, assist};
use antumbra::geom::{Film, Rect};
use antumbra::render::{RenderSpec, Renderer, RunSpec};
use antumbra::scene::named;
use antumbra::trace::Surface;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

const SIDE: usize = 24;

fn renderer() -> Renderer {
    let scene = named("sphere").unwrap().unwrap();
    let spec = RenderSpec { width: SIDE, height: SIDE, ..RenderSpec::default() };
    Renderer::new(Arc::new(scene), spec, RunSpec::default()).unwrap()
}

/// The GPU fails with that message, and the renderer goes on as if it had never been asked.
fn fails_and_the_processor_draws(gpu: &Gpu, message: &str) {
    let (mut alone, mut helped) = (renderer(), renderer());
    match assist(gpu, &mut helped, &mut |_| ()) {
        Err(error @ Error::Failed(_)) => assert!(error.to_string().contains(message), "{error}"),
        other => panic!("{other:?}"),
    }
    for renderer in [&mut alone, &mut helped] {
        while !renderer.refine(Duration::from_secs(60)) {}
    }
    assert_eq!(alone.frame().verdict, helped.frame().verdict);
    let bits =
        |renderer: &Renderer| renderer.frame().lights[0].visible_lo.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&alone), bits(&helped));
}

#[test]
fn a_lost_device_is_told_and_the_processor_draws() {
    let Some(gpu) = crate::tests::gpu() else { return };
    gpu.lose();
    fails_and_the_processor_draws(&gpu, "lost");
}

#[test]
fn too_little_memory_is_told_and_the_processor_draws() {
    let Some(mut gpu) = crate::tests::gpu() else { return };
    gpu.largest = 1000;
    fails_and_the_processor_draws(&gpu, "9216 bytes");
}

/// Lost in the middle, or stopped there: an error, soon, and no proof that is half read.
#[test]
fn in_the_middle_of_a_picture_it_stops_at_once() {
    let Some(gpu) = crate::tests::gpu() else { return };
    let scene = named("chubs").unwrap().unwrap();
    let objects = scene.objects.iter();
    let surfaces: Vec<Surface<'_>> =
        objects.map(|o| Surface { function: o.surface.as_ref(), clip: o.clip(), region: o.region() }).collect();
    let film = Film { camera: scene.view.camera(1.0), width: SIDE, height: SIDE };
    let lights: Vec<Rect> = scene.lights.iter().map(|l| l.rect).collect();
    let kernels = Kernels::new(&gpu, &surfaces, &film, &lights, 1.0 / 255.0).unwrap();
    let stop = AtomicBool::new(false);
    let mut heard = Vec::new();
    let all = kernels.prove(&gpu, &stop, &mut |done| heard.push(done)).unwrap();
    assert_eq!(all.pixels.len(), SIDE * SIDE);
    assert!(heard.is_sorted() && heard.first().is_some_and(|v| *v > 0.0) && heard.last() == Some(&1.0), "{heard:?}");
    let stopped = kernels.prove(&gpu, &stop, &mut |done| stop.store(done > 0.2, Ordering::Relaxed));
    assert_eq!(stopped.unwrap_err(), Error::Stopped);
    let lost = kernels.prove(&gpu, &AtomicBool::new(false), &mut |done| {
        if done > 0.2 {
            gpu.lose();
        }
    });
    assert!(matches!(&lost, Err(Error::Failed(text)) if text.contains("lost")), "{lost:?}");
}
