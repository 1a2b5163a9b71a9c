//! Compiles the few lines that call Embree, where its header is.
use std::path::Path;

fn main() {
    println!("cargo:rustc-check-cfg=cfg(embree)");
    println!("cargo:rerun-if-changed=src/embree.c");
    println!("cargo:rerun-if-env-changed=EMBREE_INCLUDE");
    let include = std::env::var("EMBREE_INCLUDE").unwrap_or_else(|_| "/usr/include".to_owned());
    if Path::new(&include).join("embree3/rtcore.h").exists() {
        cc::Build::new()
            .file("src/embree.c")
            .include(include)
            .opt_level(3)
            .flag("-march=haswell")
            .compile("embree_calls");
        println!("cargo:rustc-link-lib=embree3");
        println!("cargo:rustc-cfg=embree");
    }
}
