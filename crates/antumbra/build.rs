//! Turns the grammar of the formula language into its parser, and the sources into a number that tells builds apart.

use std::{
    fs,
    hash::{DefaultHasher, Hash, Hasher},
    path::Path,
};

fn main() {
    println!("cargo::rerun-if-changed=src/expr/grammar.lalrpop");
    lalrpop::Configuration::new().emit_rerun_directives(true).process_dir("src/expr").unwrap_or_else(|error| {
        // A broken grammar is a mistake of ours and must stop the build.
        panic!("grammar.lalrpop: {error}")
    });
    // A render that was stopped goes on only in a program of the same sources: see `render::StateError`.
    let mut sources = DefaultHasher::new();
    for folder in ["../antumbra-interval/src", "src"] {
        println!("cargo::rerun-if-changed={folder}");
        hash(Path::new(folder), &mut sources);
    }
    println!("cargo::rustc-env=ANTUMBRA_SOURCES={:016x}", sources.finish());
}

/// Names and contents of the files in a folder and below, in the order of their names.
fn hash(folder: &Path, sources: &mut DefaultHasher) {
    let readable = "a folder of sources can be read";
    let mut paths: Vec<_> = fs::read_dir(folder).expect(readable).map(|entry| entry.expect(readable).path()).collect();
    paths.sort();
    for path in paths {
        if path.is_dir() {
            hash(&path, sources);
        } else {
            path.file_name().hash(sources);
            fs::read(&path).expect(readable).hash(sources);
        }
    }
}
