//! Nanoseconds of one evaluation of the four surfaces of the paper over a piece of a beam, for each kind of number, and of
//! a batch of interval operations.
use antumbra::eval::{Gradient, Inclusion, Workspace, run};
use antumbra::expr::Formula;
use antumbra::geom::{Box3, Fan, Rect, Vec3};
use antumbra::scene::PRESETS;
use antumbra::tape::Tape;
use antumbra_interval::lanes::{self, Lanes, LanesMut, Level};
use antumbra_interval::{Decorated, Interval};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use std::hint::black_box;
use std::time::Duration;

/// A piece of a shadow beam: from near the surface to a square light, a hundredth of the way long.
fn piece() -> (Fan, Interval) {
    let light = Rect::horizontal(Vec3::new(2.0, 3.0, 5.0), 0.25);
    let apex = Vec3::new(0.6, 0.5, 0.4).to_box();
    let unit = Interval::new(-1.0, 1.0);
    (Fan::towards(apex, &light, unit, unit), Interval::new(0.05, 0.06))
}

fn surfaces() -> impl Iterator<Item = (&'static str, Tape)> {
    PRESETS[..4].iter().map(|preset| {
        let formula = Formula::parse(preset.formula).expect("a preset");
        (preset.name, Tape::compile(formula.surface().formula()).expect("a preset"))
    })
}

fn evaluations(c: &mut Criterion) {
    let (fan, t) = piece();
    let region: Box3 = fan.box_at(t);
    let (points, slopes) = (fan.at(t), fan.slopes_at(t));
    for (name, tape) in surfaces() {
        let mut group = c.benchmark_group(name);
        let (mut work, mut decorated, mut gradients) = (Workspace::default(), vec![], vec![]);
        group.bench_function("interval", |b| b.iter(|| tape.range(black_box(&region), &mut work)));
        group.bench_function("decorated", |b| {
            b.iter(|| run(&tape, black_box(region.0).map(Decorated::from), &mut decorated));
        });
        group.bench_function("gradient", |b| {
            b.iter(|| run(&tape, Gradient::coordinates(black_box(region.0)), &mut gradients));
        });
        group.bench_function("affine of 3 symbols", |b| b.iter(|| tape.beam(black_box(points), &mut work)));
        group.bench_function("slope of 3 symbols", |b| b.iter(|| tape.beam_slope(black_box(slopes), &mut work)));
        group.finish();
    }
}

fn batches(c: &mut Criterion) {
    const LANES: usize = 64;
    let lo: [f64; LANES] = std::array::from_fn(|i| 0.01 * i as f64 - 0.3);
    let hi = lo.map(|v| v + 0.005);
    let (mut out_lo, mut out_hi) = ([0.0; LANES], [0.0; LANES]);
    let mut group = c.benchmark_group("64 interval products");
    group.throughput(Throughput::Elements(LANES as u64));
    for level in [Level::Portable, Level::detect()] {
        group.bench_function(format!("{level:?}"), |b| {
            b.iter(|| {
                let x = Lanes::new(black_box(&lo), black_box(&hi));
                lanes::mul(level, x, x, LanesMut::new(&mut out_lo, &mut out_hi));
                black_box(out_hi[0])
            });
        });
        if level == Level::detect() {
            break;
        }
    }
    group.bench_function("one by one", |b| {
        let x: [Interval; LANES] = std::array::from_fn(|i| Interval::new(lo[i], hi[i]));
        b.iter(|| black_box(&x).map(|x| x * x));
    });
    group.finish();
}

fn settings() -> Criterion {
    Criterion::default()
        .warm_up_time(Duration::from_millis(300))
        .measurement_time(Duration::from_secs(1))
        .sample_size(20)
}

criterion_group! { name = benches; config = settings(); targets = evaluations, batches }
criterion_main!(benches);
