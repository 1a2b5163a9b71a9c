//! Scratch.
use antumbra::image::{Depth, Plane, png_bytes};
use antumbra::render::*;
use std::sync::Arc;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let scene = antumbra::scene::preset(&a[1]).map(|s| s.unwrap()).unwrap_or_else(|| antumbra::scene::Scene::from_formula(&a[1]).unwrap());
    let n: usize = a[2].parse().unwrap();
    let spec = RenderSpec { width: n, height: n, method: Method::from_name(&a[3]).unwrap(), floor: a.get(5).is_some_and(|f| f == "1"), offset: a.get(6).map(|o| o.parse().unwrap()), light_scale: a.get(7).map_or(1.0, |x| x.parse().unwrap()), ..Default::default() };
    let mut r = Renderer::new(Arc::new(scene), spec, RunSpec { threads: None }).unwrap();
    while !r.refine(std::time::Duration::from_secs(1)) {}
    let rgb: Vec<f32> = r.frame().rgb.iter().flatten().copied().collect();
    std::fs::write(&a[4], png_bytes(&Plane::with_channels("rgb", n, n, 3, rgb).unwrap(), Depth::Eight).unwrap()).unwrap();
    println!("{:#?}", r.stats());
}
