//! Arithmetic on the adapter at hand: bit for bit that of the Rust twin; the probe; tapes against enclosures in 64 bits.
use crate::device::{Gpu, Pass, finish};
use crate::error::Error;
use crate::probe;
use crate::twin::{R, Twin, TwinSlope, take_lost};
use antumbra::eval::wgsl::{self, FLOOR, FORMS, FUNCTIONS, INTERVAL_FUNCTIONS, INTERVALS, Kind};
use antumbra::eval::{Inclusion, Workspace, run};
use antumbra::expr::Formula;
use antumbra::geom::Box3;
use antumbra::tape::Tape;
use antumbra_interval::Interval;
use antumbra_interval::affine::Affine;
use wgpu::BufferUsages;

/// Formulas that use every operator that the GPU has.
const FORMULAS: [&str; 15] = [
    "x + y - z",
    "x y z - 3 x^2 + 0.1 y - 7/3",
    "x^4 + y^4 + z^4 - x^2 - y^2 - z^2 + 1/2",
    "((x^2 + y^2 - 1)^2 + z^2) ((y^2 + z^2 - 1)^2 + x^2) ((z^2 + x^2 - 1)^2 + y^2) - 0.075^2 (1 + 3 (x^2 + y^2 + z^2))",
    "(x^2 + 3) (y^2 + 3) (z^2 + 3) - 32 (x y z + 1)",
    "max(x, y) - min(y z, 0.3) + abs(z - 1/3)",
    "x^7 - 2 y^5 + (x - y)^3 z - pi",
    "-abs(x y) + 1e-30 z",
    "sin(3x) + cos(y - z) / 3",
    "exp(-4 (x^2 + y^2)) - z / 7 + exp(2z)",
    "(x + z) / (y^2 + 1/4) + 1 / (x - 3)",
    "sqrt(x^2 + y^2 + 0.01) - z + sqrt(abs(x - z))",
    "ln(1/8 + x^2) y + z",
    "cosh(x) - sinh(y) z",
    "(x^2 + y^2)^1.5 - (z^2 + 1)^-0.25 + (x^2 + 2)^-3",
];

/// The adapter; `None`, said loudly, where there is none and `ANTUMBRA_GPU_REQUIRED` is not set.
pub(crate) fn gpu() -> Option<Gpu> {
    match Gpu::open(true) {
        Ok(gpu) => Some(gpu),
        Err(Error::NoAdapter) if std::env::var_os("ANTUMBRA_GPU_REQUIRED").is_none() => {
            eprintln!("SKIPPED: no adapter here, nothing was run on a GPU");
            None
        }
        Err(error) => panic!("{error}"),
    }
}

fn tape(text: &str) -> Tape {
    Tape::compile(&Formula::parse(text).unwrap().simplify()).unwrap()
}

/// Runs `entry` once per input.
fn evaluate<I: bytemuck::Pod, O: bytemuck::Pod>(gpu: &Gpu, text: &str, inputs: &[I]) -> Vec<O> {
    let head = "@group(0) @binding(0) var<uniform> zero: vec4<u32>;\nfn runtime_zero() -> u32 { return zero.x; }\n";
    let pipeline = gpu.pipeline(&format!("{head}{text}"), "main", &[]).unwrap();
    let zero = gpu.filled(bytemuck::cast_slice(&[0_u32; 4]), BufferUsages::UNIFORM).unwrap();
    let input = gpu.filled(bytemuck::cast_slice(inputs), BufferUsages::STORAGE).unwrap();
    let output = gpu.storage((inputs.len() * size_of::<O>()) as u64).unwrap();
    let bind = gpu.bind(&pipeline, &[(0, &zero), (1, &input), (2, &output)]).unwrap();
    let groups = [inputs.len().div_ceil(64) as u32, 1, 1];
    gpu.run(&[Pass { pipeline: &pipeline, bind: &bind, groups }]).unwrap();
    gpu.read(&output).unwrap()
}

/// Forms `c, e, a` of three coordinates, of many sizes.
fn forms(count: usize, seed: u64) -> Vec<[[f32; 5]; 3]> {
    let mut random = fastrand::Rng::with_seed(seed);
    let mut form = |case: usize| {
        let scale = |r: &mut fastrand::Rng, low: i32| f32::from_bits(((127 + r.i32(low..2)) as u32) << 23);
        let low = if case.is_multiple_of(3) { -30 } else { -8 };
        let number = |r: &mut fastrand::Rng| (2.0 * r.f32() - 1.0) * scale(r, low);
        let [c, a, b, d] = [0; 4].map(|_| if random.u8(..) < 16 { 0.0 } else { number(&mut random) });
        [c, (random.f32() * scale(&mut random, -30)).max(FLOOR), a, b, d]
    };
    (0..count).map(|case| [form(case), form(case), form(case)]).collect()
}

fn twin<const FLUSH: bool>([c, e, x, y, z]: [f32; 5]) -> Twin<FLUSH> {
    Twin::new(R(c), R(e), [R(x), R(y), R(z)])
}

/// What the kernels answer where something was lost: 0 +- 1, which proves nothing.
fn unknown<const FLUSH: bool>() -> Twin<FLUSH> {
    twin([0.0, 1.0, 0.0, 0.0, 0.0])
}

/// The answer, if nothing was lost on the way.
fn known<T>(answer: T) -> Option<T> {
    (!take_lost()).then_some(answer)
}

fn bits<const FLUSH: bool>(f: Twin<FLUSH>) -> [f32; 5] {
    [f.c.0, f.e.0, f.a[0].0, f.a[1].0, f.a[2].0]
}

/// The same bits, but for the sign of zero and subnormal numbers that a GPU may keep or flush.
fn same(a: &[f32; 5], b: &[f32; 5]) -> bool {
    a.iter().zip(b).all(|(a, b)| a == b || (a.abs() <= f32::MIN_POSITIVE && b.abs() <= f32::MIN_POSITIVE))
}

/// Holds what was found against the twin that keeps subnormal numbers and the one that flushes them. A GPU may do either at any operation: only
/// where both agree must it agree. Tells everything that is wrong, then fails.
#[derive(Default)]
struct Judge {
    cases: usize,
    vague: usize,
    wrong: Vec<String>,
}

impl Judge {
    fn look(&mut self, what: &dyn Fn() -> String, found: &[f32; 5], kept: [f32; 5], flushed: [f32; 5]) {
        self.cases += 1;
        if same(found, &kept) || same(found, &flushed) {
            return;
        }
        if same(&kept, &flushed) {
            self.wrong.push(format!("{}: {found:?} instead of {kept:?}", what()));
        } else {
            self.vague += 1;
        }
    }

    fn conclude(self) {
        println!(
            "{} cases, {} differ, {} of them where subnormal numbers took part",
            self.cases,
            self.wrong.len() + self.vague,
            self.vague
        );
        let most = self.wrong.len().min(12);
        assert!(self.wrong.is_empty(), "{} of {} differ: {:#?}", self.wrong.len(), self.cases, &self.wrong[..most]);
        assert!(50 * self.vague <= self.cases, "{} of {}", self.vague, self.cases);
    }
}

#[test]
fn forms_are_those_of_the_twin_bit_for_bit() {
    let Some(gpu) = gpu() else { return };
    let mut judge = Judge::default();
    for (k, text) in FORMULAS.iter().enumerate() {
        let tape = tape(text);
        let function = wgsl::function(&tape, "value", Kind::Form).unwrap();
        let main = "
            @group(0) @binding(1) var<storage, read> inputs: array<array<array<f32, 5>, 3>>;
            @group(0) @binding(2) var<storage, read_write> outputs: array<array<f32, 5>>;
            fn form(i: u32, k: u32) -> Form {
                return Form(inputs[i][k][0], inputs[i][k][1], vec3<f32>(inputs[i][k][2], inputs[i][k][3], inputs[i][k][4]));
            }
            @compute @workgroup_size(64) fn main(@builtin(global_invocation_id) id: vec3<u32>) {
                if id.x >= arrayLength(&inputs) { return; }
                let f = value(form(id.x, 0u), form(id.x, 1u), form(id.x, 2u));
                outputs[id.x] = array<f32, 5>(f.c, f.e, f.a.x, f.a.y, f.a.z);
            }";
        let inputs = forms(4096, k as u64);
        let found: Vec<[f32; 5]> = evaluate(&gpu, &format!("{FORMS}{FUNCTIONS}{function}{main}"), &inputs);
        for (input, found) in inputs.iter().zip(&found) {
            let kept = known(run(&tape, input.map(twin::<false>), &mut Vec::new())).unwrap_or_else(unknown);
            let flushed = known(run(&tape, input.map(twin::<true>), &mut Vec::new())).unwrap_or_else(unknown);
            judge.look(&|| format!("{text} of {input:?}"), found, bits(kept), bits(flushed));
        }
    }
    judge.conclude();
}

#[test]
fn slopes_are_those_of_the_twin_bit_for_bit() {
    let Some(gpu) = gpu() else { return };
    let mut judge = Judge::default();
    for (k, text) in FORMULAS.iter().enumerate() {
        let tape = tape(text);
        let function = wgsl::function(&tape, "value", Kind::Slope).unwrap();
        let main = "
            @group(0) @binding(1) var<storage, read> inputs: array<array<array<array<f32, 5>, 3>, 3>>;
            @group(0) @binding(2) var<storage, read_write> outputs: array<array<f32, 5>>;
            fn form(i: u32, k: u32, j: u32) -> Form {
                let f = inputs[i][k][j];
                return Form(f[0], f[1], vec3<f32>(f[2], f[3], f[4]));
            }
            fn number(i: u32, k: u32) -> Slope {
                return Slope(Ball(inputs[i][k][0][0], inputs[i][k][0][1]), form(i, k, 1u), form(i, k, 2u));
            }
            @compute @workgroup_size(64) fn main(@builtin(global_invocation_id) id: vec3<u32>) {
                if id.x >= arrayLength(&inputs) { return; }
                let f = value(number(id.x, 0u), number(id.x, 1u), number(id.x, 2u)).g;
                outputs[id.x] = array<f32, 5>(f.c, f.e, f.a.x, f.a.y, f.a.z);
            }";
        let flat = forms(3 * 2048, 100 + k as u64);
        let inputs: Vec<[[[f32; 5]; 3]; 3]> = flat.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect();
        let found: Vec<[f32; 5]> = evaluate(&gpu, &format!("{FORMS}{FUNCTIONS}{function}{main}"), &inputs);
        for (input, found) in inputs.iter().zip(&found) {
            let kept = known(run(&tape, input.map(slope::<false>), &mut Vec::new()).g).unwrap_or_else(unknown);
            let flushed = known(run(&tape, input.map(slope::<true>), &mut Vec::new()).g).unwrap_or_else(unknown);
            judge.look(&|| format!("{text} of {input:?}"), found, bits(kept), bits(flushed));
        }
    }
    judge.conclude();
}

fn slope<const FLUSH: bool>([p, v, g]: [[f32; 5]; 3]) -> TwinSlope<FLUSH> {
    TwinSlope { p: [R(p[0]), R(p[1])], v: twin(v), g: twin(g) }
}

#[test]
fn the_twin_encloses_and_is_tight() {
    containment::<false>(0);
}

#[test]
fn the_twin_encloses_where_subnormal_numbers_are_flushed() {
    containment::<true>(0);
    // Mostly tiny numbers.
    containment::<true>(-118);
    containment::<false>(-118);
}

/// At random values of the symbols, and at the ends of the errors, the function lies in the twin's form; and the form is not much wider than
/// it must be. Inputs are scaled by a power of two.
fn containment<const FLUSH: bool>(power: i32) {
    let mut random = fastrand::Rng::with_seed(5);
    let mut work = Workspace::default();
    for (k, text) in FORMULAS.iter().enumerate() {
        let tape = tape(text);
        let mut lost = 0;
        for mut input in forms(2000, 50 + k as u64) {
            if power != 0 {
                // One coordinate stays as it is.
                let stays = random.usize(..3);
                let factor = f32::from_bits(((127 + power) as u32) << 23);
                for k in (0..3).filter(|k| *k != stays) {
                    input[k] = input[k].map(|v| v * factor);
                    input[k][1] = input[k][1].max(FLOOR);
                }
            }
            let Some(form) = known(run(&tape, input.map(twin::<FLUSH>), &mut Vec::new())) else {
                lost += 1;
                continue;
            };
            let symbols = [0; 3].map(|_| Interval::point(if random.bool() { 1.0 } else { 2.0 * random.f64() - 1.0 }));
            let number = |v: f32| Interval::point(f64::from(v));
            let linear = |c: f32, a: [f32; 3]| (0..3).fold(number(c), |sum, i| sum + number(a[i]) * symbols[i]);
            let point = input.map(|[c, e, x, y, z]| {
                let error = if random.bool() { e } else { -e };
                linear(c, [x, y, z]) + number(error)
            });
            let value = tape.range(&Box3(point), &mut work);
            let off = value - linear(form.c.0, form.a.map(|a| a.0));
            let e = f64::from(form.e.0);
            assert!(off.lo() <= e && off.hi() >= -e, "{text} of {input:?}: {value:?}");
        }
        // Points: what is left is rounding, some hundred units of the largest number on the way.
        for _ in 0..200 {
            let point = [0; 3].map(|_| 2.0 * random.f32() - 1.0);
            let form = known(run(&tape, point.map(|c| twin::<FLUSH>([c, FLOOR, 0.0, 0.0, 0.0])), &mut Vec::new()));
            assert!(form.is_some_and(|form| form.e.0 < 1e-3), "{text} at {point:?}: {form:?}");
        }
        // Few forms are lost, and what the smaller ones leave open is what the processor's leave, but for rounding.
        assert!(lost < 400, "{text}: {lost}");
        for input in forms(500, 90 + k as u64) {
            let input = input.map(|[c, e, x, y, z]| [c, e.min(1e-5), 0.02 * x, 0.02 * y, 0.02 * z]);
            let wide = |f: [f32; 5]| {
                let [c, e, x, y, z] = f.map(f64::from);
                Affine::<3>::linear(c, [x, y, z], e)
            };
            let cpu = run(&tape, input.map(wide), &mut Vec::new());
            let Some(form) = known(run(&tape, input.map(twin::<FLUSH>), &mut Vec::new())) else { continue };
            let (range, e) = (cpu.range(), f64::from(form.e.0));
            let most = 6.0 * cpu.error() + 3e-4 * (1.0 + range.magnitude());
            assert!(e <= most, "{text} of {input:?}: {form:?} {cpu:?}");
        }
    }
}

/// Along random segments `P + t D` the quotient `(f(P + t D) - f(P)) / t` lies in the slope of the twin.
#[test]
fn slopes_of_the_twin_enclose() {
    let mut random = fastrand::Rng::with_seed(9);
    let mut work = Workspace::default();
    let number = |v: f32| Interval::point(f64::from(v));
    for text in FORMULAS {
        let tape = tape(text);
        let mut known_ones = 0;
        for _ in 0..1000 {
            let [p, d] = [0; 2].map(|_| [0; 3].map(|_| 2.0 * random.f32() - 1.0));
            // Parameters that make products exact enough; the rest is in the errors.
            let (t, h) = (f32::from(random.u8(1..=255)) / 128.0, f32::from(random.u8(0..=255)) / 1024.0);
            let h = h.min(t / 2.0);
            let input: [TwinSlope<false>; 3] = std::array::from_fn(|k| {
                let v = twin([p[k] + t * d[k], 1e-6, h * d[k], 0.0, 0.0]);
                TwinSlope { p: [R(p[k]), R(FLOOR)], v, g: twin([d[k], FLOOR, 0.0, 0.0, 0.0]) }
            });
            let Some(slope) = known(run(&tape, input, &mut Vec::new())) else { continue };
            known_ones += 1;
            for s in [-1.0_f32, 1.0, 2.0 * random.f32() - 1.0] {
                let at = number(t) + number(h) * number(s);
                let start = tape.range(&Box3(p.map(number)), &mut work);
                let there = tape.range(&Box3(std::array::from_fn(|k| number(p[k]) + at * number(d[k]))), &mut work);
                let off = (there - start) / at - (number(slope.g.c.0) + number(slope.g.a[0].0) * number(s));
                let e = f64::from(slope.g.e.0);
                assert!(off.lo() <= e && off.hi() >= -e, "{text} from {p:?} along {d:?} at {at:?}: {off:?} {slope:?}");
                let (value, apex) =
                    (there - number(slope.v.c.0) - number(slope.v.a[0].0) * number(s), start - number(slope.p[0].0));
                assert!(value.magnitude() <= f64::from(slope.v.e.0) + 1e-12, "{text}: {value:?} {slope:?}");
                assert!(apex.magnitude() <= f64::from(slope.p[1].0) + 1e-12, "{text}: {apex:?} {slope:?}");
            }
        }
        assert!(known_ones > 500, "{text}: {known_ones}");
    }
}

#[test]
fn intervals_on_the_gpu_enclose_and_are_tight() {
    let Some(gpu) = gpu() else { return };
    let mut work = Workspace::default();
    for (k, text) in FORMULAS.iter().enumerate() {
        let tape = tape(text);
        let function = wgsl::function(&tape, "value", Kind::Interval).unwrap();
        let main = "
            @group(0) @binding(1) var<storage, read> inputs: array<array<vec2<f32>, 3>>;
            @group(0) @binding(2) var<storage, read_write> outputs: array<vec2<f32>>;
            @compute @workgroup_size(64) fn main(@builtin(global_invocation_id) id: vec3<u32>) {
                if id.x >= arrayLength(&inputs) { return; }
                outputs[id.x] = value(inputs[id.x][0], inputs[id.x][1], inputs[id.x][2]);
            }";
        let inputs: Vec<[[f32; 2]; 3]> =
            forms(4096, 200 + k as u64).iter().map(|point| point.map(|f| [f[0].min(f[2]), f[0].max(f[2])])).collect();
        let found: Vec<[f32; 2]> =
            evaluate(&gpu, &format!("{FORMS}{INTERVALS}{FUNCTIONS}{INTERVAL_FUNCTIONS}{function}{main}"), &inputs);
        for (input, [lo, hi]) in inputs.iter().zip(&found) {
            let region = Box3(input.map(|[a, b]| Interval::new(f64::from(a), f64::from(b))));
            let wanted = tape.range(&region, &mut work);
            // The CPU's is at most a few units of 2^-53 wider than the natural extension.
            let size = 1e-12 * (wanted.magnitude() + 1.0);
            let (lo, hi) = (f64::from(*lo), f64::from(*hi));
            assert!(
                lo <= wanted.lo() + size && wanted.hi() - size <= hi,
                "{text} of {input:?}: [{lo}, {hi}] {wanted:?}"
            );
            let slack = 1e-4 * (wanted.magnitude() + 100.0);
            assert!(
                lo > wanted.lo() - slack && wanted.hi() + slack > hi,
                "{text} of {input:?}: [{lo}, {hi}] {wanted:?}"
            );
        }
    }
}

#[test]
fn the_probe_passes_here_and_finds_a_broken_fence() {
    let Some(gpu) = gpu() else { return };
    let report = finish(probe::run(&gpu)).unwrap();
    let text = probe::text();
    for (what, broken) in [
        (
            "no rounding of its own",
            (
                "fn sub(x: f32, y: f32) -> f32 { return fence(x - y); }",
                "fn sub(x: f32, y: f32) -> f32 { return fence(x - y) * 1.0000002; }",
            ),
        ),
        (
            "another operation",
            (
                "fn mul(x: f32, y: f32) -> f32 { return fence(x * y); }",
                "fn mul(x: f32, y: f32) -> f32 { return fence(fma(x, y, 1e-9)); }",
            ),
        ),
        (
            "too small an error",
            ("return Ball(mul(p, scale), mul(4.0 * U, scale));", "return Ball(mul(p, scale), mul(0.25 * U, scale));"),
        ),
    ] {
        let changed = text.replace(broken.0, broken.1);
        assert_ne!(changed, text);
        assert!(matches!(finish(probe::run_text(&gpu, &changed)), Err(Error::Doubt { .. })), "{what} was not found");
    }
    // Where this compiler rewrites at all, a fence that is none must be found.
    if report.rewritten[..4].iter().any(|n| *n > 0) {
        let bare = text.replace("return bitcast<f32>(bitcast<u32>(x) ^ runtime_zero());", "return x;");
        assert_ne!(bare, text);
        assert!(
            matches!(finish(probe::run_text(&gpu, &bare)), Err(Error::Doubt { .. })),
            "a missing fence was not found"
        );
    }
}

#[test]
fn what_the_gpu_cannot_do_is_refused_by_name() {
    let refused = |text: &str| wgsl::function(&tape(text), "f", Kind::Form).unwrap_err().to_string();
    assert!(refused("atan(x) + y").contains("`atan`"));
    assert!(refused("(x^2 + 1)^y").contains("exponent"));
    assert!(refused("floor(x) + y").contains("`floor`"));
    let far = [4.0; 3];
    assert!(wgsl::Reach::check(&tape("x^4 + y"), far, far).is_ok());
    assert!(matches!(wgsl::Reach::check(&tape("(x y z)^40"), far, far), Err(wgsl::Refusal::Overflow(_))));
    assert!(wgsl::Reach::check(&tape("1 / x"), far, far).is_ok());
    assert!(wgsl::Reach::check(&tape("(1 / x)^8"), far, far).is_err());
    assert!(wgsl::Reach::check(&tape("exp(9x) - y^3"), far, far).is_ok());
}

/// What a GPU that flushes subnormal numbers would answer passes; a contracted product, or a step too many, does not.
#[test]
fn the_probe_allows_flushing_and_nothing_else() {
    let at = |k: usize, [x, y, z]: [f32; 3]| {
        let [x, y, z] = [R::<true>(x), R(y), R(z)];
        match k {
            0 => x + y,
            1 => x - y,
            2 => x * y,
            3 => (x + y) - x,
            5 => x * y + x * z,
            7 => x * y + z,
            9 => ((x + y) + z) - (x + (y + z)),
            _ => R(0.0),
        }
        .0
    };
    let (mut contracted, mut stepped) = (0, 0);
    for [x, y, z, _] in probe::cases() {
        let case = [x, y, z];
        for k in [0, 1, 2, 3, 5, 7, 9] {
            assert_eq!(probe::judge(&mut probe::Report::default(), k, case, at(k, case)), None, "{k} of {case:?}");
            let step = at(k, case).next_up();
            stepped += usize::from(probe::judge(&mut probe::Report::default(), k, case, step).is_some());
        }
        contracted += usize::from(probe::judge(&mut probe::Report::default(), 7, case, x.mul_add(y, z)).is_some());
    }
    assert!(contracted > 1000 && stepped > 50_000, "{contracted} {stepped}");
}
