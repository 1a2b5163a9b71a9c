//! Nanoseconds per enclosure over a box: ours in batches and one by one, Fidget's compiler (single precision, rounded to nearest:
//! no proof), inari (sound, double precision, the formula written in Rust).
use crate::surfaces::Surface;
use antumbra::eval::{Inclusion, RayPiece, Workspace};
use antumbra::expr::Formula;
use antumbra::geom::{Beam, Box3, Vec3};
use antumbra::scene::PRESETS;
use antumbra::tape::Tape;
use antumbra_interval::Interval;
use cpu_time::ThreadTime;
use inari::Interval as Inari;
use std::hint::black_box;

/// Boxes of one run.
const BOXES: usize = 4096;

/// A program, and what it took for each surface.
pub(crate) const NAMES: [&str; 4] = ["ours, batches", "ours, one by one", "inari", "Fidget (not sound)"];

fn boxes() -> Vec<[[f64; 2]; 3]> {
    let at = |k: usize| -0.9 + 1.8 * (k % 101) as f64 / 101.0;
    (0..BOXES).map(|k| [at(k * 7), at(k * 31), at(k * 53)].map(|x| [x, x + 0.01])).collect()
}

/// In the order of [`NAMES`].
pub(crate) fn run(surface: &Surface) -> [f64; 4] {
    let boxes = boxes();
    let formula = PRESETS.iter().find(|p| p.name == surface.name).expect("a preset").formula;
    let tape = Tape::compile(Formula::parse(formula).expect("a preset").surface().formula()).expect("a preset");
    let regions: Vec<Box3> = boxes.iter().map(|b| Box3(b.map(|[lo, hi]| Interval::new(lo, hi)))).collect();
    // A box as a piece of a ray from its lowest corner to its highest.
    let piece = |b: &[[f64; 2]; 3]| RayPiece {
        ray: Beam { origin: Vec3(b.map(|s| s[0])), direction: Box3(b.map(|s| Interval::point(s[1] - s[0]))) },
        t: Interval::new(0.0, 1.0),
    };
    let pieces: Vec<RayPiece> = boxes.iter().map(piece).collect();
    let (mut work, mut out) = (Workspace::default(), vec![Interval::ZERO; BOXES]);
    let per_box = |begin: ThreadTime| begin.elapsed().as_secs_f64() * 1e9 / BOXES as f64;
    let begin = ThreadTime::now();
    for (pieces, out) in pieces.chunks(64).zip(out.chunks_mut(64)) {
        tape.ranges(pieces, out, &mut work);
    }
    black_box(&out);
    let batches = per_box(begin);
    let begin = ThreadTime::now();
    for region in &regions {
        black_box(tape.range(region, &mut work));
    }
    let single = per_box(begin);
    let of = |b: &[f64; 2]| inari::interval!(b[0], b[1]).expect("in order");
    let cells: Vec<[Inari; 3]> = boxes.iter().map(|[x, y, z]| [of(x), of(y), of(z)]).collect();
    let begin = ThreadTime::now();
    for &[x, y, z] in &cells {
        black_box(by_inari(surface.name, x, y, z));
    }
    let other = per_box(begin);
    [batches, single, other, crate::fidget::interval(surface, &boxes)]
}

fn by_inari(name: &str, x: Inari, y: Inari, z: Inari) -> Inari {
    let n = |c: f64| inari::interval!(c, c).expect("a number");
    let (a, b, c) = (x.sqr(), y.sqr(), z.sqr());
    match name {
        "orthocircle" => {
            let ring = |p: Inari, q: Inari, r: Inari| (p + q - n(1.0)).sqr() + r;
            ring(a, b, c) * ring(b, c, a) * ring(c, a, b) - n(0.075).sqr() * (n(1.0) + n(3.0) * (a + b + c))
        }
        "chubs" => a.sqr() + b.sqr() + c.sqr() - a - b - c + n(0.5),
        "kusner" => (a + n(3.0)) * (b + n(3.0)) * (c + n(3.0)) - n(32.0) * (x * y * z + n(1.0)),
        _ => (n(1.0) + a) * (n(1.0) + b) * (n(1.0) + c) + n(8.0) * x * y * z - n(2.0),
    }
}
