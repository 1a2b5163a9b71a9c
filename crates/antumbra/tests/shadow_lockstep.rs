//! Hits that are looked at together: the same answers at the same cost whatever instructions the batches use, brackets that meet those
//! of hits that are alone, and claims that stand in every company. Tiles of hits: the same answers in every company.
use antumbra::eval::{Gradient, Inclusion, Workspace};
use antumbra::geom::{Box3, Clip, Rect, Vec3};
use antumbra::scene::Object;
use antumbra::shadow::{
    Asking, Bracket, Known, Penumbra, Placed, Receiver, Scratch, Shaft, Tile, Tolerance, look, visible, visibles,
};
use antumbra::trace::{Cost, Sign, Surface};
use antumbra_interval::lanes::Level;
use antumbra_interval::{Decorated, Interval};

/// Points of the plane `z = 0`, in and around the penumbra of what hangs over it.
fn receivers(n: usize) -> Vec<Receiver> {
    let place = |k: usize| 1.2 * (k as f64 + 0.5) / n as f64 - 0.6;
    let at = |k: usize| Vec3::new(place(k % n), place(k / n), 0.0).to_box();
    (0..n * n).map(|k| Receiver { point: at(k), surface: 0, side: Sign::Positive }).collect()
}

fn bits(found: &[(Bracket, Cost)]) -> Vec<[u64; 4]> {
    found.iter().map(|(b, c)| [b.lo.to_bits(), b.hi.to_bits(), c.evaluations, c.beams]).collect()
}

fn check(occluder: &str, penumbra: Penumbra) {
    let object = |text: &str| Object::parse(text, Clip::Everywhere).unwrap_or_else(|e| panic!("{text}: {e}"));
    let objects = [object("z"), object(occluder)];
    let surfaces: Vec<Surface<'_>> =
        objects.iter().map(|o| Surface { function: o.surface.as_ref(), clip: o.clip(), region: o.region() }).collect();
    let (light, known) = (Rect::horizontal(Vec3::new(0.1, 0.0, 3.0), 0.8), Known::nothing(&surfaces));
    let receivers = receivers(12);
    let hits: Vec<Asking<'_>> =
        receivers.iter().map(|receiver| Asking { receiver, light: &light, known: &known }).collect();
    let tolerance = Tolerance { width: 1.0 / 255.0, rectangles: 4000, penumbra };
    let together = |level| {
        let mut work = Workspace::on(level);
        let found = visibles(&surfaces, &hits, tolerance, &mut Scratch::default(), &mut work);
        (found, work.take_occupancy().questions)
    };
    let (found, batched) = together(Level::Portable);
    for level in Level::all() {
        assert_eq!(bits(&together(level).0), bits(&found), "{occluder} {level:?}");
    }
    let all: u64 = found.iter().map(|(_, c)| c.evaluations).sum();
    assert!(batched * 2 > all || penumbra == Penumbra::First, "{occluder}: {batched} of {all} in batches");
    let mut partly = 0;
    for (hit, (bracket, _)) in hits.iter().zip(&found) {
        let (mut scratch, mut work, mut cost) = (Scratch::default(), Workspace::default(), Cost::default());
        let alone = visible(&surfaces, hit.receiver, &light, &known, tolerance, &mut scratch, &mut work, &mut cost);
        assert!(alone.lo <= bracket.hi && bracket.lo <= alone.hi, "{occluder}: {alone:?} {bracket:?}");
        assert!(bracket.hi - bracket.lo <= tolerance.width, "{occluder}: {bracket:?}");
        partly += usize::from(bracket.lo > 0.0 && bracket.hi < 1.0);
    }
    assert!(partly > 20, "{occluder}: {partly} in the penumbra");
}

#[test]
fn company_and_instructions_change_no_answer() {
    for occluder in
        ["x^2 + y^2 + (z - 1)^2 - 0.1", "(x^2 + y^2 + (z - 1)^2 + 0.2)^2 - x^2 - y^2", "x^4 + y^4 + (z - 1)^4 - 0.02"]
    {
        for penumbra in [Penumbra::Auto, Penumbra::Second, Penumbra::First] {
            check(occluder, penumbra);
        }
    }
}

/// A function of the user's own, which has no batches.
struct Own<'a>(&'a dyn Inclusion);

impl Inclusion for Own<'_> {
    fn range(&self, region: &Box3, work: &mut Workspace) -> Interval {
        self.0.range(region, work)
    }
    fn decorated(&self, region: &Box3, work: &mut Workspace) -> Decorated {
        self.0.decorated(region, work)
    }
    fn gradient(&self, region: &Box3, work: &mut Workspace) -> Gradient {
        self.0.gradient(region, work)
    }
}

/// What tiles of `side` x `side` hits see of lights of two widths.
fn tiles<'a>(n: usize, side: usize, lights: &'a [Rect; 2], known: &'a Known) -> Vec<Tile<'a>> {
    let hits: Vec<Placed> = receivers(n)
        .into_iter()
        .enumerate()
        .map(|(k, receiver)| Placed::new([(k % n) as u32, (k / n) as u32], receiver))
        .collect();
    let of_tile = |k: usize| {
        let (column, row) = (k % (n / side) * side, k / (n / side) * side);
        let rows = (row..row + side).map(move |j| j * n + column..j * n + column + side);
        Shaft::fit(rows.flat_map(|row| &hits[row])).expect("a plane")
    };
    let shafts: Vec<Shaft> = (0..(n / side).pow(2)).map(of_tile).collect();
    let tile = |light| move |shaft: &Shaft| Tile { shaft: shaft.clone(), light, known };
    lights.iter().flat_map(|light| shafts.iter().map(tile(light))).collect()
}

#[test]
fn company_and_instructions_change_nothing_of_what_tiles_learn() {
    let object = |text: &str| Object::parse(text, Clip::Everywhere).unwrap_or_else(|e| panic!("{text}: {e}"));
    let (mut lit, mut dark, mut open, mut divided) = (0, 0, 0, 0);
    for (occluder, own) in [
        ("x^2 + y^2 + (z - 1)^2 - 0.1", false),
        ("(x^2 + y^2 + (z - 0.6)^2 + 0.2)^2 - x^2 - y^2", false),
        ("x^4 + y^4 + (z - 1)^4 - 0.02 - 0.001/(2 + x)", false),
        ("x^2 + y^2 + (z - 1)^2 - 0.1", true),
    ] {
        let objects = [object("z"), object(occluder)];
        let wrapped = Own(objects[1].surface.as_ref());
        let mut surfaces: Vec<Surface<'_>> = objects
            .iter()
            .map(|o| Surface { function: o.surface.as_ref(), clip: o.clip(), region: o.region() })
            .collect();
        if own {
            surfaces[1].function = &wrapped;
        }
        let known = Known::nothing(&surfaces);
        let lights = [0.05, 1.5].map(|width| Rect::horizontal(Vec3::new(0.1, 0.0, 3.0), width));
        for side in [2, 4] {
            let tiles = tiles(12, side, &lights, &known);
            let together = |level| {
                let (mut work, mut found) = (Workspace::on(level), Vec::new());
                let learn = |known: Known, cost: Cost| found.push((known, cost));
                look(&surfaces, &tiles, &mut Scratch::default(), &mut work, learn);
                (found, work.take_occupancy().questions)
            };
            let (found, batched) = together(Level::Portable);
            assert_eq!(found.len(), tiles.len());
            for level in Level::all() {
                assert_eq!(together(level).0, found, "{occluder} {level:?}");
            }
            let all: u64 = found.iter().map(|(_, cost)| cost.evaluations).sum();
            assert!(own || batched * 2 > all, "{occluder}: {batched} of {all} in batches");
            // One after another, with what others have left in the scratch memory.
            let (mut scratch, mut work, mut alone) = (Scratch::default(), Workspace::default(), Vec::new());
            for tile in &tiles {
                let learn = |known: Known, cost: Cost| alone.push((known, cost));
                look(&surfaces, std::slice::from_ref(tile), &mut scratch, &mut work, learn);
            }
            assert_eq!(alone, found, "{occluder}");
            for (known, _) in &found {
                lit += usize::from(known.settled() && known.bounds() == [1.0; 2]);
                dark += usize::from(known.settled() && known.bounds()[1] < 1e-9);
                open += usize::from(!known.settled());
                divided += usize::from(!known.whole());
            }
        }
    }
    assert!(lit > 10 && dark > 20 && open > 20 && divided > 20, "{lit} {dark} {open} {divided}");
}
