//! Frusta that graze a surface, and patches of blocks that one piece of it covers, against the true hits of a ball.
use antumbra::eval::Workspace;
use antumbra::expr::Formula;
use antumbra::geom::{Beam, Box3, Camera, Clip, Film, Vec3};
use antumbra::tape::Tape;
use antumbra::trace::{
    Bracket, Bracketed, Brackets, Cost, Effort, Frusta, Frustum, Known, Meeting, Patch, Sign, Surface, enclose, narrow,
    patches,
};
use antumbra_interval::Interval;

/// The patches of all blocks of 4 x 4 pixels, with their windows.
fn all(text: &str, film: &Film) -> Vec<([usize; 2], Known, Option<Patch>)> {
    let formula = Formula::parse(text).unwrap();
    let tape = Tape::compile(formula.surface().formula()).unwrap();
    let cube = Clip::Box(Box3([Interval::new(-3.0, 3.0); 3]));
    let surfaces = [Surface { function: &tape, clip: cube, region: cube }];
    let mut work = Workspace::default();
    let corners = (0..film.height / 4).flat_map(|j| (0..film.width / 4).map(move |i| [4 * i, 4 * j]));
    let look = |corner: [usize; 2]| {
        let fan = film.fan(corner[0]..corner[0] + 4, corner[1]..corner[1] + 4);
        let parent = Known::nothing(&surfaces, &fan);
        let mut known = Known::default();
        narrow(&surfaces, &[Frustum { fan, parent: &parent }], &mut Default::default(), &mut work, |_, k, _| {
            known = k.clone();
        });
        let mut patch = None;
        if let [piece] = known.open[..]
            && known.inside
        {
            patches(&surfaces, &[(fan, piece)], &mut work, |_, found, _| patch = found);
        }
        (corner, known, patch)
    };
    corners.map(look).collect()
}

fn film(size: usize) -> Film {
    let camera = Camera::look_at(Vec3::new(3.0, -4.0, 3.0), Vec3::default(), 25.0, 1.0);
    Film { camera, width: size, height: size }
}

#[test]
fn brackets_hold_the_first_hit_of_their_ray_and_are_narrow() {
    let film = film(64);
    let (mut brackets, mut covered, mut widest) = (0, 0, 0.0_f64);
    for ([column, row], known, patch) in all("x^2 + y^2 + z^2 = 1", &film) {
        covered += u32::from(known.certainly_covered());
        let Some(patch) = patch else { continue };
        let [x, y] = film.window(column..column + 4, row..row + 4);
        for (i, j) in (0..16).map(|k| (column + k % 4, row + k / 4)) {
            let Some(bracket) = patch.bracket([film.column_symbol(x, i), film.row_symbol(y, j)]) else { continue };
            brackets += 1;
            let (o, d) = (film.camera.eye, film.ray(i, j).direction.mid());
            let (a, b, c) = (d.dot(d), o.dot(d), o.dot(o) - 1.0);
            let t = (-b - (b * b - a * c).sqrt()) / a;
            assert!(bracket.t.lo() <= t + 1e-14 && t - 1e-14 <= bracket.t.hi(), "{i} {j}: {t}, {bracket:?}");
            assert_eq!((bracket.before, bracket.surface), (Sign::Positive, 0));
            widest = widest.max(bracket.t.width());
        }
    }
    assert!(covered > 50 && brackets >= 15 * covered, "{brackets} of {covered} blocks");
    assert!(widest < 0.02, "{widest}");
}

/// Where rays meet a surface of which brackets are proved; all of them are answered once.
fn enclosed(text: &str, rays: &[Bracketed]) -> Vec<(Option<Meeting>, Cost)> {
    let tape = Tape::compile(Formula::parse(text).unwrap().surface().formula()).unwrap();
    let cube = Clip::Box(Box3([Interval::new(-3.0, 3.0); 3]));
    let surfaces = [Surface { function: &tape, clip: cube, region: cube }];
    let mut answers = vec![None; rays.len()];
    let (mut scratch, mut work) = (Brackets::default(), Workspace::default());
    enclose(&surfaces, rays, Effort::FINE, &mut scratch, &mut work, |k, meeting, cost| {
        assert!(answers[k].replace((meeting, cost)).is_none(), "ray {k} again");
    });
    answers.into_iter().map(|answer| answer.expect("an answer")).collect()
}

#[test]
fn rays_of_patches_are_enclosed_alike_in_any_company() {
    const BALL: &str = "x^2 + y^2 + z^2 = 1";
    let film = film(64);
    let mut rays = Vec::new();
    for ([column, row], _, patch) in all(BALL, &film) {
        let [x, y] = film.window(column..column + 4, row..row + 4);
        for (i, j) in (0..16).map(|k| (column + k % 4, row + k / 4)) {
            let symbols = [film.column_symbol(x, i), film.row_symbol(y, j)];
            let bracket = patch.and_then(|patch| patch.bracket(symbols));
            rays.extend(bracket.map(|bracket| Bracketed { beam: film.ray(i, j), bracket }));
        }
    }
    let found = enclosed(BALL, &rays);
    let mut evaluations = 0;
    for (ray, (meeting, cost)) in rays.iter().zip(&found) {
        let meeting = meeting.expect("one root in each bracket");
        assert!(meeting.t.is_subset_of(ray.bracket.t) && meeting.t.width() <= 1e-12 * meeting.t.hi());
        assert_eq!((meeting.before, meeting.reason), (Some(Sign::Positive), None));
        let (o, d) = (ray.beam.origin, ray.beam.direction.mid());
        let (a, b, c) = (d.dot(d), o.dot(d), o.dot(o) - 1.0);
        let t = (-b - (b * b - a * c).sqrt()) / a;
        assert!((meeting.t.mid() - t).abs() < 1e-12, "{t}, {meeting:?}");
        evaluations += cost.evaluations;
    }
    assert!(rays.len() > 1000 && evaluations < 3 * rays.len() as u64, "{evaluations} for {} rays", rays.len());
    for (ray, together) in rays.iter().zip(&found).step_by(29) {
        assert_eq!(enclosed(BALL, &[*ray]), [*together]);
    }
}

#[test]
fn the_first_of_several_roots_is_not_guessed() {
    let direction = Vec3::new(1.0, 0.0, 0.0).to_box();
    let beam = Beam { origin: Vec3::default(), direction };
    let asked = |lo: f64, hi: f64, before: Sign| {
        let bracket = Bracket { surface: 0, t: Interval::new(lo, hi), before };
        enclosed("(x - 1)(x - 2)(x - 3) = 0", &[Bracketed { beam, bracket }])[0].0
    };
    assert_eq!(asked(0.25, 3.75, Sign::Negative), None, "three roots");
    let second = asked(1.75, 2.25, Sign::Positive).unwrap();
    assert!(second.t.contains(2.0) && second.t.width() < 1e-11, "{second:?}");
}

#[test]
fn nothing_is_claimed_of_a_surface_that_is_touched_or_torn() {
    let film = film(16);
    let anywhere = |patch: &Patch| {
        let places = [-1.0, -0.4, 0.0, 0.7, 1.0].map(Interval::point);
        places.iter().any(|a| places.iter().any(|b| patch.bracket([*a, *b]).is_some()))
    };
    let found = |text: &str| all(text, &film).iter().filter(|(_, _, p)| p.as_ref().is_some_and(anywhere)).count();
    assert!(found("x + y/3 = 0") > 0);
    assert_eq!(found("(x + y/3)^2 + z^4/1000 = 0"), 0, "no change of sign");
    assert_eq!(found("floor(3 x + y) + 1/2 = 0"), 0, "a step");
    assert_eq!(found("1/(x + y/3) = 0"), 0, "a pole");
}

/// Frusta of every pixel of a ball whose rays graze it, against the true hits of rays in them.
#[test]
fn frusta_that_graze_a_ball_are_told_apart_with_few_questions() {
    let tape = Tape::compile(Formula::parse("x^2 + y^2 + z^2 = 1").unwrap().surface().formula()).unwrap();
    let cube = Clip::Box(Box3([Interval::new(-2.0, 2.0); 3]));
    let surfaces = [Surface { function: &tape, clip: cube, region: cube }];
    let camera = Camera::look_at(Vec3::new(3.0, -4.0, 3.0), Vec3::default(), 25.0, 1.0);
    let film = Film { camera, width: 1024, height: 1024 };
    let hit = |x: f64, y: f64| {
        let (o, d) = (camera.eye, camera.forward + camera.right * x + camera.up * y);
        let (a, b, c) = (d.dot(d), o.dot(d), o.dot(o) - 1.0);
        let root = b * b - a * c;
        (root > 0.0).then(|| (-b - root.sqrt()) / a)
    };
    let (mut empty, mut covered, mut partly, mut evaluations) = (0, 0, 0, 0);
    for (column, row) in (0..1024).map(|k| (k, 301)).chain((0..1024).map(|k| (477, k))) {
        let [x, y] = film.window(column..column + 1, row..row + 1);
        let place = |k: u32, t: Interval| t.lo() + (0.001 + 0.998 * f64::from(k) / 8.0) * (t.hi() - t.lo());
        let hits: Vec<Option<f64>> = (0..81).map(|k| hit(place(k % 9, x), place(k / 9, y))).collect();
        let corners = [0, 8, 72, 80].map(|k: usize| hits[k].is_some());
        if corners == [true; 4] && hit(place(12, x), place(12, y)).is_some() && (column + row) % 16 > 0 {
            continue;
        }
        let fan = film.fan_of(x, y);
        let parent = Known::nothing(&surfaces, &fan);
        let (jobs, mut work) = ([Frustum { fan, parent: &parent }], Workspace::default());
        narrow(&surfaces, &jobs, &mut Frusta::default(), &mut work, |_, known, cost| {
            evaluations += cost.evaluations;
            if known.certainly_empty() {
                empty += 1;
                assert!(hits.iter().all(Option::is_none), "{column} {row}: {known:?}");
            } else if known.certainly_covered() {
                covered += 1;
                assert!(hits.iter().all(|t| t.is_some_and(|t| t <= known.cover)), "{column} {row}: {known:?}");
            } else {
                partly += 1;
                assert!(corners != [true; 4] || corners != [false; 4], "{column} {row}: {known:?}");
            }
            for t in hits.iter().flatten() {
                let held = known.open.iter().any(|p| p.t.lo() <= t + 1e-12 && t - 1e-12 <= p.t.hi());
                assert!(held, "{column} {row}: {t} in {known:?}");
            }
        });
    }
    assert!(empty > 500 && covered > 30 && (4..40).contains(&partly), "{empty} {covered} {partly}");
    assert!(evaluations < 4 * (empty + covered + partly), "{evaluations} of {}", empty + covered + partly);
}
