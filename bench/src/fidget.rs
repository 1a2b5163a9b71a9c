//! Fidget (crates.io): height maps, and intervals, by its compiler, in single precision; nothing is proved.
use crate::surfaces::Surface;
use antumbra::scene::Scene;
use cpu_time::ThreadTime;
use fidget::context::Tree;
use fidget::jit::JitShape;
use fidget::raster::voxel::{EvalConfig, RenderConfig, RenderSize, render};
use fidget::shape::{BoundShape, EzShape, ShapeVars};
use nalgebra::Matrix4;
use std::hint::black_box;

fn shape(surface: &Surface) -> JitShape {
    let (x, y, z) = Tree::axes();
    JitShape::from((surface.tree)(x, y, z))
}

/// CPU seconds of a height map with normals of `size`^3 voxels, from where the scene's camera is, orthographic, without light:
/// the nearest thing to our surfaces that it does.
pub(crate) fn height_map(surface: &Surface, scene: &Scene, size: u32) -> f64 {
    let camera = scene.view.camera(1.0);
    // The ball around the picture's middle that the film shows.
    let half = (scene.view.target - camera.eye).length() * camera.right.length();
    let columns = [camera.right.normalized(), camera.up.normalized(), -camera.forward];
    let [r, u, b] = columns.map(|v| v.0.map(|c| (half * c) as f32));
    #[rustfmt::skip]
    let world_to_model = Matrix4::new(
        r[0], u[0], b[0], 0.0,
        r[1], u[1], b[1], 0.0,
        r[2], u[2], b[2], 0.0,
        0.0, 0.0, 0.0, 1.0,
    );
    let begin = ThreadTime::now();
    let config = RenderConfig { image_size: RenderSize::from(size), world_to_model };
    let one_thread = EvalConfig { threads: None, ..Default::default() };
    let (shape, none) = (shape(surface), ShapeVars::new());
    let bound = BoundShape::new(shape, &none).expect("no variables");
    black_box(render(bound, &config, &one_thread));
    begin.elapsed().as_secs_f64()
}

/// Nanoseconds per interval on boxes.
pub(crate) fn interval(surface: &Surface, boxes: &[[[f64; 2]; 3]]) -> f64 {
    let shape = shape(surface);
    let tape = shape.ez_interval_tape();
    let mut eval = JitShape::new_interval_eval();
    let side = |s: [f64; 2]| fidget::types::Interval::new(s[0] as f32, s[1] as f32);
    let boxes: Vec<_> = boxes.iter().map(|b| b.map(side)).collect();
    let begin = ThreadTime::now();
    for [x, y, z] in &boxes {
        black_box(eval.eval(&tape, *x, *y, *z).expect("no variables").0);
    }
    begin.elapsed().as_secs_f64() * 1e9 / boxes.len() as f64
}
