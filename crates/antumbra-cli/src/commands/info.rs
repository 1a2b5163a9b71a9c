//! `antumbra info`: what this program and this machine offer.

use antumbra::{
    render::{Method, RenderSpec, RunSpec},
    scene::{GALLERY, GalleryEntry, PRESETS},
};
use antumbra_gpu::Adapter;
use anyhow::Result;

use crate::{options::thread_count, output::print};

/// Prints version, processor, presets, gallery and methods.
pub(super) fn run() -> Result<()> {
    let methods: Vec<String> = Method::ALL.iter().map(|(_, name, about)| format!("  {name:<15} {about}")).collect();
    let presets: Vec<String> = PRESETS.iter().map(|p| format!("  {:<15} {}", p.name, p.title)).collect();
    // The paper's scenes begin the gallery, and are presets: each name once.
    let preset = |e: &&GalleryEntry| PRESETS.iter().any(|p| p.name == e.name);
    let (above, others): (Vec<&GalleryEntry>, Vec<&GalleryEntry>) = GALLERY.iter().partition(preset);
    let above: Vec<&str> = above.iter().map(|e| e.name).collect();
    let gallery =
        others.iter().map(|e| Ok(format!("  {:<15} {}", e.name, e.scene()?.title))).collect::<Result<Vec<_>>>()?;
    print(&format!(
        "antumbra {}\nprocessor: {}{}\nthreads:   {}\nadapters:\n{}\npresets:\n{}\ngallery ({} surfaces: {} from above, and):\n{}\nmethods (default: {}):\n{}\n",
        env!("CARGO_PKG_VERSION"),
        std::env::consts::ARCH,
        processor_features(),
        thread_count(&RunSpec::default()),
        graphics_adapters(),
        presets.join("\n"),
        GALLERY.len(),
        above.join(", "),
        gallery.join("\n"),
        RenderSpec::default().method.name(),
        methods.join("\n"),
    ))
}

/// Every GPU, and whether its arithmetic can be trusted with a proof.
fn graphics_adapters() -> String {
    let line = |a: &Adapter| {
        let verdict = match &a.probe {
            Ok(_) => "passed the probe".to_owned(),
            Err(error) => error.to_string(),
        };
        format!("  {} ({}, {}, {}): {verdict}", a.name, a.backend, a.kind, a.driver)
    };
    let lines: Vec<String> = antumbra_gpu::adapters().iter().map(line).collect();
    if lines.is_empty() { "  none".to_owned() } else { lines.join("\n") }
}

/// The features that the arithmetic can use, each with yes or no.
fn processor_features() -> String {
    #[cfg(target_arch = "x86_64")]
    {
        let yes_no = |has: bool| if has { "yes" } else { "no" };
        let avx512 = is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("avx512dq");
        format!(
            ", AVX2: {}, FMA: {}, AVX-512 (embedded rounding): {}",
            yes_no(is_x86_feature_detected!("avx2")),
            yes_no(is_x86_feature_detected!("fma")),
            yes_no(avx512)
        )
    }
    #[cfg(not(target_arch = "x86_64"))]
    {
        ", portable arithmetic".to_owned()
    }
}
