//! Kernels in 64 bits: the arithmetic against its Rust twin, the probe, and pictures against those in 32 bits.
use crate::device::{Gpu, finish};
use crate::machine::{Machine, Usage};
use crate::twin::double::{R, Twin, TwinSlope};
use crate::{Kernels, Pixel, Proved, compare, probe_double};
use antumbra::eval::wgsl::{self, FLOOR, Kind, Refusal, Width};
use antumbra::eval::{Inclusion, Workspace, run};
use antumbra::expr::Formula;
use antumbra::geom::{Box3, Film, Rect};
use antumbra::render::{RenderSpec, Renderer, RunSpec};
use antumbra::scene::named;
use antumbra::tape::Tape;
use antumbra::trace::Surface;
use antumbra_interval::Interval;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

const FORMULAS: [&str; 7] = [
    "x + y - z",
    "x y z - 3 x^2 + 0.1 y - 7/3",
    "x^4 + y^4 + z^4 - x^2 - y^2 - z^2 + 1/2",
    "((x^2 + y^2 - 1)^2 + z^2) ((y^2 + z^2 - 1)^2 + x^2) ((z^2 + x^2 - 1)^2 + y^2) - 0.075^2 (1 + 3 (x^2 + y^2 + z^2))",
    "max(x, y) - min(y z, 0.3) + abs(z - 1/3)",
    "x^7 - 2 y^5 + (x - y)^3 z - pi",
    "-abs(x y) + 1e-20 z",
];

/// An adapter whose 64-bit numbers can be asked for.
fn gpu() -> Option<Gpu> {
    let gpu = crate::tests::gpu()?;
    if gpu.knows_double() {
        return Some(gpu);
    }
    eprintln!("SKIPPED: no 64-bit numbers here");
    None
}

fn tape(text: &str) -> Tape {
    Tape::compile(&Formula::parse(text).unwrap().simplify()).unwrap()
}

fn evaluate<I: bytemuck::Pod, O: bytemuck::Pod>(gpu: &Gpu, text: &str, inputs: &[I]) -> Vec<O> {
    let head = "@group(0) @binding(0) var<uniform> zero: vec4<u32>;\nfn runtime_zero() -> u32 { return zero.x; }\n";
    let pipeline = Machine::pipeline(gpu, &format!("{head}{text}"), "main", &[]).unwrap();
    let zero = Machine::filled(gpu, bytemuck::cast_slice(&[0_u32; 4]), Usage::Uniform).unwrap();
    let input = Machine::filled(gpu, bytemuck::cast_slice(inputs), Usage::Storage).unwrap();
    let output = Machine::buffer(gpu, (inputs.len() * size_of::<O>()) as u64, Usage::Storage).unwrap();
    let bind = Machine::bind(gpu, &pipeline, &[(0, &zero), (1, &input), (2, &output)]).unwrap();
    finish(Machine::run(gpu, &pipeline, &bind, inputs.len().div_ceil(64) as u32)).unwrap();
    finish(gpu.read_all(&output)).unwrap()
}

/// Forms `c, e, a`, of many sizes.
fn forms(count: usize, seed: u64) -> Vec<[f64; 5]> {
    let mut random = fastrand::Rng::with_seed(seed);
    let mut form = |case: usize| {
        let low = if case.is_multiple_of(3) { -40 } else { -8 };
        let number = |r: &mut fastrand::Rng| (2.0 * r.f64() - 1.0) * 2.0_f64.powi(r.i32(low..2));
        let [c, a, b, d] = [0; 4].map(|_| if random.u8(..) < 16 { 0.0 } else { number(&mut random) });
        [c, (random.f64() * 2.0_f64.powi(random.i32(-60..2))).max(FLOOR.into()), a, b, d]
    };
    (0..count).map(&mut form).collect()
}

fn twin([c, e, x, y, z]: [f64; 5]) -> Twin<false> {
    Twin::new(R(c), R(e), [R(x), R(y), R(z)])
}

fn bits(f: Twin<false>) -> [f64; 5] {
    [f.c.0, f.e.0, f.a[0].0, f.a[1].0, f.a[2].0]
}

const FORM: &str = "
    @group(0) @binding(1) var<storage, read> inputs: array<array<f64, 5>>;
    @group(0) @binding(2) var<storage, read_write> outputs: array<array<f64, 5>>;
    fn form(k: u32) -> Form { return Form(inputs[k][0], inputs[k][1], vec3<f64>(inputs[k][2], inputs[k][3], inputs[k][4])); }
    fn number(k: u32) -> Slope { return Slope(Ball(inputs[k][0], inputs[k][1]), form(k + 1u), form(k + 2u)); }
    fn put(k: u32, f: Form) { outputs[k] = array<f64, 5>(f.c, f.e, f.a.x, f.a.y, f.a.z); }";

#[test]
fn forms_and_slopes_in_64_bits_are_those_of_the_twin_bit_for_bit() {
    let Some(gpu) = gpu() else { return };
    for (k, text) in FORMULAS.iter().enumerate() {
        let tape = tape(text);
        for (kind, per, call) in [
            (Kind::Form, 3, "put(3u * id.x, value(form(3u * id.x), form(3u * id.x + 1u), form(3u * id.x + 2u)))"),
            (
                Kind::Slope,
                9,
                "put(9u * id.x, value(number(9u * id.x), number(9u * id.x + 3u), number(9u * id.x + 6u)).g)",
            ),
        ] {
            let function = wgsl::function_of(&tape, "value", kind, Width::Double).unwrap();
            let main = format!(
                "@compute @workgroup_size(64) fn main(@builtin(global_invocation_id) id: vec3<u32>) {{
                    if id.x < arrayLength(&inputs) / {per}u {{ {call}; }}
                }}"
            );
            let inputs = forms(1024 * per, k as u64);
            let text_of = format!("{}{function}{FORM}{main}", Width::Double.forms());
            let found: Vec<[f64; 5]> = evaluate(&gpu, &text_of, &inputs);
            for (input, found) in inputs.chunks_exact(per).zip(found.chunks_exact(per)) {
                let wanted = if kind == Kind::Form {
                    run(&tape, [0, 1, 2].map(|k| twin(input[k])), &mut Vec::new())
                } else {
                    let number = |k: usize| {
                        let [p, v, g] = [input[3 * k], input[3 * k + 1], input[3 * k + 2]];
                        TwinSlope::<false> { p: [R(p[0]), R(p[1])], v: twin(v), g: twin(g) }
                    };
                    run(&tape, [0, 1, 2].map(number), &mut Vec::new()).g
                };
                assert_eq!(found[0], bits(wanted), "{text}, {kind:?} of {input:?}");
            }
        }
    }
}

/// At random values of the symbols the function lies in the form; over points little is left, of the rounding of 64 bits.
#[test]
fn the_twin_in_64_bits_encloses_and_is_tight() {
    let mut random = fastrand::Rng::with_seed(5);
    let mut work = Workspace::default();
    let number = Interval::point;
    for (k, text) in FORMULAS.iter().enumerate() {
        let tape = tape(text);
        for input in forms(3000, 70 + k as u64).chunks_exact(3) {
            let form = run(&tape, [0, 1, 2].map(|k| twin(input[k])), &mut Vec::new());
            let symbols = [0; 3].map(|_| number(if random.bool() { 1.0 } else { 2.0 * random.f64() - 1.0 }));
            let linear = |c: f64, a: [f64; 3]| (0..3).fold(number(c), |sum, i| sum + number(a[i]) * symbols[i]);
            let point = [0, 1, 2].map(|k| {
                let [c, e, x, y, z] = input[k];
                linear(c, [x, y, z]) + number(if random.bool() { e } else { -e })
            });
            let off = tape.range(&Box3(point), &mut work) - linear(form.c.0, form.a.map(|a| a.0));
            assert!(off.lo() <= form.e.0 && off.hi() >= -form.e.0, "{text} of {input:?}: {off:?} {form:?}");
        }
        for _ in 0..200 {
            let point = [0; 3].map(|_| 2.0 * random.f64() - 1.0);
            let form = run(&tape, point.map(|c| twin([c, FLOOR.into(), 0.0, 0.0, 0.0])), &mut Vec::new());
            assert!(form.e.0 < 1e-12, "{text} at {point:?}: {form:?}");
        }
    }
}

#[test]
fn the_probe_in_64_bits_passes_here_and_finds_what_is_broken() {
    let Some(gpu) = gpu() else { return };
    let text = probe_double::text();
    assert!(gpu.has_double() && finish(probe_double::passes(&gpu, &text)).unwrap());
    for (good, broken) in [
        ("return fence(x * y);", "return fence(f64(f32(x) * f32(y)));"),
        ("return fence(x - y);", "return fence(x - y * 1.0000000000000003lf);"),
        ("add(mul(4.0 * U, abs(c)), mul(28.0 * U, rest))", "add(mul(4.0 * U, abs(c)), mul(27.0 * U, rest))"),
    ] {
        let changed = text.replace(good, broken);
        assert_ne!(changed, text);
        assert!(!finish(probe_double::passes(&gpu, &changed)).unwrap(), "{broken} was not found");
    }
    // A product that is contracted with the sum that follows is another number in many cases.
    let contracted = |[x, y, z]: &[f64; 3]| x.mul_add(*y, *z) != x * y + z;
    assert!(probe_double::cases().iter().filter(|case| contracted(case)).count() > 500);
}

#[test]
fn functions_and_intervals_stay_in_32_bits() {
    let of = |text: &str, kind| wgsl::function_of(&tape(text), "f", kind, Width::Double);
    assert!(of("x y - 1/3", Kind::Form).unwrap().contains("lu)"));
    assert_eq!(of("sin(x) + y", Kind::Form), Err(Refusal::Single));
    assert_eq!(of("x / y", Kind::Slope), Err(Refusal::Single));
    assert_eq!(of("x y", Kind::Interval), Err(Refusal::Single));
}

/// Pictures in 64 bits: no contradiction with the processor's, no fewer pixels than in 32 bits, and most of the brackets that those leave wide.
#[test]
fn pictures_in_64_bits_are_proved_without_contradictions() {
    let Some(gpu) = gpu() else { return };
    let side = 64;
    for name in ["chubs", "mcmullen"] {
        let scene = named(name).unwrap().unwrap();
        let objects = scene.objects.iter();
        let surfaces: Vec<Surface<'_>> =
            objects.map(|o| Surface { function: o.surface.as_ref(), clip: o.clip(), region: o.region() }).collect();
        let film = Film { camera: scene.view.camera(1.0), width: side, height: side };
        let lights: Vec<Rect> = scene.lights.iter().map(|l| l.rect).collect();
        let tolerance = 1.0 / 255.0;
        let prove = |width| -> Proved {
            let kernels = Kernels::of_width(&gpu, &surfaces, &film, &lights, tolerance, width).unwrap();
            kernels.prove(&gpu, &AtomicBool::new(false), &mut |_| ()).unwrap()
        };
        let [single, double] = [Width::Single, Width::Double].map(prove);
        let spec = RenderSpec { width: side, height: side, ..RenderSpec::default() };
        let mut cpu = Renderer::new(Arc::new(scene.clone()), spec, RunSpec::default()).unwrap();
        while !cpu.refine(Duration::from_secs(60)) {}
        let [a, b] = [&single, &double].map(|proved| compare(proved, cpu.frame(), tolerance));
        assert!(b.contradictions.is_empty(), "{name}: {:#?}", b.contradictions);
        let open = |p: &Proved| p.pixels.iter().filter(|p| matches!(p, Pixel::Open { .. })).count();
        let wide = |c: &crate::Comparison| c.lights - c.settled;
        println!("{name}: open {} {}, wide {} {}", open(&single), open(&double), wide(&a), wide(&b));
        assert!(open(&double) <= open(&single) && 2 * wide(&b) < wide(&a), "{name}: {a:?} {b:?}");
    }
}
