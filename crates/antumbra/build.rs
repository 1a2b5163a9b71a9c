//! Turns the grammar of the formula language into its parser.

fn main() {
    println!("cargo::rerun-if-changed=src/expr/grammar.lalrpop");
    lalrpop::Configuration::new().emit_rerun_directives(true).process_dir("src/expr").unwrap_or_else(|error| {
        // A broken grammar is a mistake of ours and must stop the build.
        panic!("grammar.lalrpop: {error}")
    });
}
