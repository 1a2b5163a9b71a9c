//! A whole small picture, one thread: grid, hits and shadows.
use antumbra::render::{Method, RenderSpec, Renderer, RunSpec};
use antumbra::scene::preset;
use criterion::{Criterion, criterion_group, criterion_main};
use std::sync::Arc;
use std::time::Duration;

fn pictures(c: &mut Criterion) {
    let mut group = c.benchmark_group("64 x 64 pixels");
    for name in ["orthocircle", "kusner"] {
        let scene = Arc::new(preset(name).expect("a preset").expect("a preset"));
        for (method, method_name, _) in Method::ALL {
            if method_name.starts_with("rays") || method_name.starts_with("paper-") {
                continue;
            }
            let spec = RenderSpec { width: 64, height: 64, method, ..RenderSpec::default() };
            group.bench_function(format!("{name}, {method_name}"), |b| {
                b.iter(|| {
                    let run = RunSpec { threads: Some(1) };
                    let mut renderer = Renderer::new(scene.clone(), spec.clone(), run).expect("a valid spec");
                    while !renderer.refine(Duration::MAX) {}
                    renderer.stats().hits
                });
            });
        }
    }
    group.finish();
}

fn settings() -> Criterion {
    Criterion::default()
        .warm_up_time(Duration::from_millis(100))
        .measurement_time(Duration::from_secs(2))
        .sample_size(10)
}

criterion_group! { name = benches; config = settings(); targets = pictures }
criterion_main!(benches);
