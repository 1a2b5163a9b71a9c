//! What the commands write when all is well.

use std::{fs, io::Cursor, process::Stdio};

use crate::bench::Bench;
use predicates::{prelude::predicate, str::contains};
use serde_json::Value;

fn json(text: &[u8]) -> Value {
    serde_json::from_slice(text).expect("JSON")
}

#[test]
fn a_preset_becomes_a_picture_of_its_name() {
    let bench = Bench::new();
    let result = bench.antumbra(&["render", "chubs", "--size", "24x16"]).assert().success();
    result.stdout(predicate::str::is_empty()).stderr(contains("hits")).stderr(contains("wrote chubs.png"));
    assert_eq!(bench.names(), ["chubs.png"]);
    let bytes = fs::read(bench.file("chubs.png")).unwrap();
    let reader = png::Decoder::new(Cursor::new(bytes)).read_info().unwrap();
    let info = reader.info();
    assert_eq!((info.width, info.height, info.bit_depth), (24, 16, png::BitDepth::Eight));
    assert_eq!(info.srgb, Some(png::SrgbRenderingIntent::Perceptual));
}

#[test]
fn a_formula_becomes_a_picture() {
    let bench = Bench::new();
    let args = ["render", "x^2 + y^2 + z^2 - 1", "--size", "8", "--bits", "16", "--quiet"];
    bench.antumbra(&args).assert().success().stderr(predicate::str::is_empty());
    let bytes = fs::read(bench.file("antumbra.png")).unwrap();
    let reader = png::Decoder::new(Cursor::new(bytes)).read_info().unwrap();
    assert_eq!(reader.info().bit_depth, png::BitDepth::Sixteen);
    bench.antumbra(&["render", "-q", "-o", "m.png", "--size", "8", "--", "-x^2 + 1"]).assert().success();
    bench.antumbra(&["render", "-q", "-x^2 - y^2 - z^2 + 1 = 0", "-o", "n.png", "--size", "8"]).assert().success();
}

#[test]
fn exr_has_color_and_planes() {
    let bench = Bench::new();
    bench.antumbra(&["render", "chubs", "--size", "6x4", "-o", "p.exr"]).assert().success();
    let meta = exr::meta::MetaData::read_from_file(bench.file("p.exr"), false).unwrap();
    let names: Vec<String> = meta.headers[0].channels.list.iter().map(|c| c.name.to_string()).collect();
    for name in ["R", "G", "B", "t_lo", "verdict"] {
        assert!(names.iter().any(|n| n == name), "{name} is not in {names:?}");
    }
}

#[test]
fn planes_and_json_say_the_same_size() {
    let bench = Bench::new();
    let args = ["render", "chubs", "--size", "6x4", "-o", "planes/p.png", "--planes", "planes", "--json", "s.json"];
    bench.antumbra(&args).assert().success();
    let shape = |name: &str| {
        let bytes = fs::read(bench.file(name)).unwrap();
        npyz::NpyFile::new(&bytes[..]).unwrap().shape().to_vec()
    };
    assert_eq!(shape("planes/rgb.npy"), [4, 6, 3]);
    assert_eq!(shape("planes/t_lo.npy"), [4, 6]);
    assert!(bench.file("planes/p.png").exists());
    let stats = json(&fs::read(bench.file("s.json")).unwrap());
    assert_eq!((&stats["scene"], &stats["method"]), (&"chubs".into(), &"certified".into()));
    assert_eq!(stats["size"], serde_json::json!([6, 4]));
    for name in ["hits", "beams", "evaluations", "primary_seconds", "shadow_seconds", "seconds", "threads"] {
        assert!(stats[name].is_number(), "{name}: {stats}");
    }
    let class = |name: &str| stats["classes"][name].as_u64().unwrap();
    // A hit that is not proved has no class.
    assert!(class("lit") + class("partly") + class("dark") <= stats["hits"].as_u64().unwrap());
    for (name, dtype) in [("verdict", "|u1"), ("visible_lo", "<f8"), ("normal", "<f4"), ("cost", "<u4")] {
        let bytes = fs::read(bench.file(&format!("planes/{name}.npy"))).unwrap();
        assert_eq!(npyz::NpyFile::new(&bytes[..]).unwrap().dtype().descr(), format!("'{dtype}'"), "{name}");
    }
}

#[test]
fn planes_do_not_depend_on_threads() {
    let bench = Bench::new();
    for threads in ["1", "2", "7"] {
        // Not a multiple of the tile, and random rays: both could depend on the order of the work.
        for method in ["certified", "paper", "rays-mc"] {
            let folder = format!("{method}-{threads}");
            let picture = format!("{folder}/p.exr");
            let args = ["render", "orthocircle", "--size", "37x19", "--floor", "--method", method, "-q"];
            let files = ["--threads", threads, "--planes", &folder, "-o", &picture];
            bench.antumbra(&[&args[..], &files].concat()).assert().success();
        }
    }
    for method in ["certified", "paper", "rays-mc"] {
        let mut names = 0;
        for entry in fs::read_dir(bench.file(&format!("{method}-1"))).unwrap() {
            let name = entry.unwrap().file_name();
            let bytes = |threads: &str| fs::read(bench.file(&format!("{method}-{threads}")).join(&name)).unwrap();
            assert!(bytes("1") == bytes("2") && bytes("1") == bytes("7"), "{method}: {name:?}");
            names += 1;
        }
        assert_eq!(names, 14, "twelve planes, the record and the picture");
    }
}

#[test]
fn beams_are_counted_as_the_paper_counts_them() {
    let bench = Bench::new();
    let stats = |method: &str, more: &[&str]| {
        let args = ["render", "mcmullen", "--size", "24", "--method", method, "--json", "-", "-q"];
        json(&bench.antumbra(&[&args[..], more].concat()).assert().success().get_output().stdout)
    };
    let number = |stats: &Value, name: &str| stats[name].as_u64().unwrap();
    let fixed = stats("fixed49", &[]);
    assert_eq!((number(&fixed, "beams"), number(&fixed, "initial_beams")), (49 * number(&fixed, "hits"), 0));
    let paper = stats("paper", &[]);
    assert_eq!(number(&paper, "hits"), number(&fixed, "hits"));
    assert_eq!(number(&paper, "initial_beams"), number(&paper, "hits"));
    assert_eq!(number(&paper, "beams"), 49 * number(&paper, "initial_occluded"));
    assert!(number(&paper, "initial_occluded") < number(&paper, "hits"));
    assert!(number(&paper, "evaluations") < number(&fixed, "evaluations"));
    // An initial beam may be blocked where no sub-beam is, never the other way round.
    assert_eq!(paper["classes"], fixed["classes"]);
    assert_eq!(number(&stats("paper", &["--sub-beams", "3"]), "beams"), 9 * number(&paper, "initial_occluded"));
    assert!(number(&stats("paper", &["--light-scale", "8"]), "partly") > number(&paper, "partly"));
    assert!(number(&stats("paper", &["--floor"]), "floor_hits") > 0);
    assert_eq!(number(&stats("paper", &["--grid", "8"]), "grid_evaluations"), 512);
    assert_eq!(number(&stats("paper", &["--offset", "100"]), "lit"), number(&paper, "hits"));
}

#[test]
fn json_on_standard_output_is_alone_there() {
    let bench = Bench::new();
    let output = bench.antumbra(&["render", "chubs", "--size", "4", "--json", "-"]).assert().success();
    assert!(json(&output.get_output().stdout)["hits"].is_number());
    let output = bench.antumbra(&["compare", "chubs", "--size", "4", "--json", "-"]).assert().success();
    assert_eq!(json(&output.get_output().stdout)["methods"].as_array().map(Vec::len), Some(3));
    output.stderr(contains("evaluations"));
}

#[test]
fn compare_prints_a_table_and_writes_its_json() {
    let bench = Bench::new();
    let args = ["compare", "chubs", "--size", "8", "--methods", "fixed49,paper,rays", "--threads", "1"];
    let result = bench.antumbra(&[&args[..], &["--json", "c.json"]].concat()).assert().success();
    result.stdout(contains("evaluations")).stdout(contains("fixed49")).stdout(contains("1.00x"));
    let record = json(&fs::read(bench.file("c.json")).unwrap());
    assert_eq!((&record["scene"], &record["threads"]), (&"chubs".into(), &1.into()));
    let methods = record["methods"].as_array().unwrap();
    assert_eq!(methods.iter().map(|m| m["method"].as_str().unwrap()).collect::<Vec<_>>(), ["fixed49", "paper", "rays"]);
    for name in ["hits", "beams", "evaluations", "primary_seconds", "shadow_seconds", "seconds"] {
        assert!(methods.iter().all(|m| m[name].is_number()), "{name}");
    }
    assert_eq!(bench.names(), ["c.json"]);
    // The same hits for all, and each method as if it ran alone.
    assert!(methods.iter().all(|m| m["hits"] == methods[0]["hits"]));
    assert!(methods.iter().all(|m| m["primary_evaluations"] == methods[0]["primary_evaluations"]));
    let args = ["render", "chubs", "--size", "8", "--method", "paper", "--json", "-", "-q"];
    let alone = json(&bench.antumbra(&args).assert().success().get_output().stdout);
    for name in ["hits", "beams", "evaluations"] {
        assert_eq!(methods[1][name], alone[name], "{name}");
    }
}

#[test]
fn table_1_has_every_row_and_the_published_numbers() {
    let bench = Bench::new();
    let args = ["paper", "table1", "--size", "24", "-q", "-o", "tables"];
    let result = bench.antumbra(&args).assert().success().stderr(predicate::str::is_empty());
    let text = String::from_utf8(result.get_output().stdout.clone()).unwrap().replace('\u{202f}', " ");
    for surface in ["Orthocircle", "Chubs", "Kusner-Schmitt", "McMullen"] {
        assert_eq!(text.lines().filter(|l| l.starts_with(&format!("| {surface}"))).count(), 3, "{surface}\n{text}");
    }
    for number in ["13 328 (5.1 %)", "14 691", "\\*", "719 859", "8 749 244", "6.57", "38 %", "14.961", "73.386"] {
        assert!(text.contains(number), "{number}\n{text}");
    }
    assert_eq!(fs::read(bench.file("tables/table1.md")).unwrap(), result.get_output().stdout);
    assert_eq!(bench.names(), ["tables"]);
}

#[test]
fn paper_prints_tables_and_writes_figures() {
    let bench = Bench::new();
    bench.antumbra(&["paper", "table1", "--size", "4"]).assert().success().stdout(contains("Table 1"));
    assert_eq!(bench.names(), [""; 0]);
    bench.antumbra(&["paper", "fig6", "--size", "4", "-o", "figures"]).assert().success().stderr(contains("wrote"));
    for name in ["fig6.md", "fig6.png", "fig6-chubs.png", "fig6-kusner.png", "fig6-mcmullen.png"] {
        assert!(bench.file("figures").join(name).exists(), "{name}");
    }
    bench.antumbra(&["paper", "fig7", "--size", "4"]).assert().success().stderr(contains("fig7-orthocircle.png"));
    assert!(bench.file("fig7.png").exists() && bench.file("fig7.md").exists());
    for name in ["offsets", "grids"] {
        let args = ["paper", name, "--size", "2", "--sub-beams", "2"];
        bench.antumbra(&args).assert().success().stdout(contains("Orthocircle")).stdout(contains("McMullen"));
    }
}

#[test]
fn overlays_have_a_legend_or_say_why_not() {
    let bench = Bench::new();
    let rows = |size: &str, name: &str| {
        let args = ["render", "sphere", "--overlay", "width", "--size", size, "-o", name];
        let result = bench.antumbra(&args).assert().success();
        let picture = fs::File::open(bench.file(name)).unwrap();
        let reader = png::Decoder::new(std::io::BufReader::new(picture)).read_info().unwrap();
        let said = String::from_utf8(result.get_output().stderr.clone()).unwrap();
        ([reader.info().width, reader.info().height], said.contains("too small for the legend"))
    };
    assert_eq!(rows("40", "small.png"), ([40, 40], true));
    let ([width, height], said) = rows("256", "large.png");
    assert!(width == 256 && height > 300 && !said, "{width} x {height}");
    let film = [
        "render",
        "sphere",
        "--overlay",
        "verdict",
        "--size",
        "256x200",
        "--turntable",
        "--frames",
        "2",
        "-o",
        "o.gif",
    ];
    bench.antumbra(&film).assert().success();
    let size = [256_u16, 200 + 116].map(u16::to_le_bytes);
    assert_eq!(fs::read(bench.file("o.gif")).unwrap()[6..10], *size.as_flattened(), "the legend is in the film");
}

#[test]
fn info_names_presets_and_methods() {
    let result = Bench::new().antumbra(&["info"]).assert().success();
    for word in [env!("CARGO_PKG_VERSION"), "threads", "orthocircle", "mcmullen", "paper-quadtree", "rays-mc"] {
        assert!(String::from_utf8_lossy(&result.get_output().stdout).contains(word), "{word}");
    }
    let text = String::from_utf8_lossy(&result.get_output().stdout).into_owned();
    for name in antumbra::scene::names() {
        let lines =
            text.lines().filter(|line| line.strip_prefix("  ").is_some_and(|l| l.split(' ').next() == Some(name)));
        assert_eq!(lines.count(), 1, "{name}");
    }
}

#[test]
fn help_has_examples_and_exit_codes() {
    let bench = Bench::new();
    for command in ["render", "compare", "paper"] {
        let result = bench.antumbra(&[command, "--help"]).assert().success();
        result.stdout(contains("Examples:")).stdout(contains("130"));
    }
    bench.antumbra(&["--help"]).assert().success().stdout(contains("Exit codes:"));
    bench.antumbra(&["--version"]).assert().success().stdout(contains(env!("CARGO_PKG_VERSION")));
}

#[cfg(unix)]
#[test]
fn a_reader_that_goes_away_is_no_failure() {
    let program = assert_cmd::cargo::cargo_bin("antumbra");
    let mut child = std::process::Command::new(program)
        .args(["compare", "chubs", "--size", "64", "--quiet"])
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    assert_eq!(child.wait().unwrap().code(), Some(0));
    if let Ok(full) = fs::OpenOptions::new().write(true).open("/dev/full") {
        let result = std::process::Command::new(assert_cmd::cargo::cargo_bin("antumbra"))
            .arg("info")
            .stdout(full)
            .output()
            .unwrap();
        assert_eq!(result.status.code(), Some(1));
        assert!(String::from_utf8_lossy(&result.stderr).contains("cannot write to standard output"));
    }
}

#[test]
fn devices_are_written_directly() {
    if cfg!(target_os = "linux") {
        let bench = Bench::new();
        let args = ["render", "chubs", "--size", "4", "-o", "p.png", "--json", "/dev/stdout", "--quiet"];
        let result = bench.antumbra(&args).assert().success();
        assert!(json(&result.get_output().stdout)["hits"].is_number());
        assert_eq!(bench.names(), ["p.png"]);
    }
}

#[test]
fn devices_are_chosen_and_adapters_listed() {
    let bench = Bench::new();
    bench.antumbra(&["info"]).assert().success().stdout(contains("adapters:"));
    // Whatever is there: a picture.
    let auto = ["render", "sphere", "--size", "16", "--device", "auto"];
    bench.antumbra(&auto).assert().success().stderr(contains("wrote sphere.png"));
    // With an adapter, a GPU's share is told; without one, what is missing.
    let gpu = bench.antumbra(&["render", "sphere", "--size", "16", "--device", "gpu"]).output().unwrap();
    let said = String::from_utf8_lossy(&gpu.stderr).into_owned();
    assert_eq!(gpu.status.success(), said.contains("of their brackets proved"), "{said}");
    assert!(gpu.status.success() || said.contains("--device auto goes on"), "{said}");
    // What the GPU does not have, the processor does.
    let sine = ["render", "sin(x) + y = 0", "--size", "16", "--device", "auto", "-o", "a.png"];
    bench.antumbra(&sine).assert().success().stderr(contains("the processor does it"));
    let rays = ["render", "sphere", "--size", "16", "--device", "auto", "--method", "rays", "-o", "b.png"];
    bench.antumbra(&rays).assert().success().stderr(contains("the processor does `rays`"));
    bench.antumbra(&["render", "sphere", "--device", "npu"]).assert().failure().stderr(contains("gpu"));
}

/// The paper's methods on the GPU, where there is one, and what stays on the processor.
#[test]
fn the_paper_is_drawn_by_devices() {
    let bench = Bench::new();
    let picture = |method: &str, device: &str, more: &[&str]| {
        let args = ["render", "chubs", "--size", "24", "--method", method, "--device", device, "--json", "-"];
        let output = bench.antumbra(&[&args, more].concat()).output().unwrap();
        (output.status.success(), output.stdout, String::from_utf8_lossy(&output.stderr).into_owned())
    };
    for method in ["paper", "fixed49"] {
        let (drawn, gpu, said) = picture(method, "gpu", &[]);
        if !drawn {
            assert!(said.contains("--device auto goes on"), "{said}");
            continue;
        }
        assert!(said.contains("sub-beams traced"), "{said}");
        let (_, cpu, _) = picture(method, "cpu", &[]);
        let [gpu, cpu] = [gpu, cpu].map(|text| json(&text));
        for count in ["hits", "lit", "partly", "beams", "shadow_evaluations"] {
            let [a, b] = [&gpu, &cpu].map(|record| record[count].as_f64().unwrap());
            assert!((a - b).abs() <= 0.05 * b + 3.0, "{method}: {count} {a} and {b}");
        }
        // Some bits do differ: it was not the processor that did it.
        assert_ne!(gpu["primary_evaluations"], cpu["primary_evaluations"]);
        let (drawn, _, said) = picture(method, "gpu", &["--floor"]);
        assert!(drawn && said.contains("the processor does it") && said.contains("floor"), "{said}");
    }
}

/// What was begun goes on where it was begun, whatever device is asked for.
#[test]
fn the_processor_goes_on_with_what_it_began_whatever_the_device() {
    let bench = Bench::new();
    for method in ["certified", "paper"] {
        let args = ["render", "chubs", "--size", "96", "--threads", "1", "--method", method];
        // Until a budget is large enough for a beginning.
        let stopped = (0..12).any(|k| {
            let budget = format!("{}", 0.001 * f64::from(1 << k));
            let end = bench.antumbra(&[&args[..], &["--budget", &budget]].concat()).output().unwrap();
            !end.status.success() && bench.file("chubs.png.state").exists()
        });
        assert!(stopped, "{method}");
        let resumed = bench.antumbra(&[&args[..], &["--resume", "--device", "gpu"]].concat()).assert().success();
        resumed.stderr(contains("the processor does it alone: the picture was begun"));
    }
}
