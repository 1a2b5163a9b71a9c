//! Hits that are looked at together: the same answers at the same cost whatever instructions the batches use, brackets that meet those
//! of hits that are alone, and claims that stand in every company.
use antumbra::eval::Workspace;
use antumbra::geom::{Clip, Rect, Vec3};
use antumbra::scene::Object;
use antumbra::shadow::{Asking, Bracket, Known, Penumbra, Receiver, Scratch, Tolerance, visible, visibles};
use antumbra::trace::{Cost, Sign, Surface};
use antumbra_interval::lanes::Level;

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
