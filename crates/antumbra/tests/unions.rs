//! Unions drawn as their parts say what unions drawn as they are say, and what is true.
use antumbra::audit::{Audit, AuditSpec};
use antumbra::geom::Vec3;
use antumbra::render::{Frame, Method, RenderSpec, Renderer, RunSpec, Stats};
use antumbra::scene::Scene;
use std::sync::Arc;
use std::time::Duration;

const SIZE: usize = 24;
const LIGHT: f64 = 3.0;

fn frame(scene: &Arc<Scene>, unions: bool) -> (Frame, Stats) {
    let spec = RenderSpec {
        width: SIZE,
        height: SIZE,
        light_scale: LIGHT,
        floor: true,
        rectangles: 30,
        unions,
        ..RenderSpec::default()
    };
    let mut renderer = Renderer::new(Arc::clone(scene), spec, RunSpec::default()).unwrap();
    while !renderer.refine(Duration::from_secs(60)) {}
    (renderer.frame().clone(), renderer.stats())
}

/// Counts pixels that are proved to be a hit in both frames, and panics where they contradict each other.
fn agree(a: &Frame, b: &Frame, what: &str) -> usize {
    let mut hits = 0;
    for i in 0..SIZE * SIZE {
        let codes = [a.verdict[i], b.verdict[i]];
        let of = |codes: [u8; 2]| codes == [0, 1] || codes == [0, Frame::PARTLY] || codes == [1, Frame::PARTLY];
        assert!(!of(codes) && !of([codes[1], codes[0]]), "{what}: pixel {i} has verdicts {codes:?}");
        assert!(a.coverage_lo[i] <= b.coverage_hi[i] && b.coverage_lo[i] <= a.coverage_hi[i], "{what}: pixel {i}");
        if codes != [1, 1] {
            continue;
        }
        hits += 1;
        assert!(a.t_lo[i] <= b.t_hi[i] && b.t_lo[i] <= a.t_hi[i], "{what}: hits of pixel {i}");
        let [a, b] = [a, b].map(|f| [f.lights[0].visible_lo[i], f.lights[0].visible_hi[i]]);
        assert!(a[0] <= b[1] && b[0] <= a[1], "{what}: light of pixel {i}, {a:?} and {b:?}");
    }
    hits
}

struct Random(u64);

impl Random {
    /// In [lo, hi], in thousandths.
    fn number(&mut self, lo: f64, hi: f64) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let x = (self.0 >> 11) as f64 / (1_u64 << 53) as f64;
        ((lo + (hi - lo) * x) * 1e3).round() / 1e3
    }

    /// A ball, an ellipsoid, a rounded box or a torus somewhere around the origin; negative inside.
    fn solid(&mut self) -> String {
        let [x, y, z] = ["x", "y", "z"].map(|axis| format!("({axis} - ({}))", self.number(-1.2, 1.2)));
        let r = self.number(0.3, 0.8);
        match self.number(0.0, 4.0) as u32 {
            0 => format!("({x}^2 + {y}^2 + {z}^2 - {r}^2)"),
            1 => format!("({x}^2 + 3 {y}^2 + {z}^2/2 - {r}^2)"),
            2 => format!("({x}^4 + {y}^4 + 2 {z}^4 - {r}^4)"),
            _ => format!("(({x}^2 + {y}^2 + {z}^2 + {r}^2 - 0.02)^2 - 4 * {r}^2 * ({x}^2 + {y}^2))"),
        }
    }
}

#[test]
fn parts_and_whole_agree_and_both_are_right() {
    let mut random = Random(5);
    let (mut hits, mut evaluations) = (0, [0, 0]);
    for round in 0..8 {
        let solids: Vec<String> = (0..2 + round % 4).map(|_| random.solid()).collect();
        // Signs of both kinds: a union is a maximum where the inside is positive.
        let union =
            |a: String, b: String| if round % 2 == 0 { format!("min({a}, {b})") } else { format!("max({a}, {b})") };
        let signed = |s: String| if round % 2 == 0 { s } else { format!("(1 - exp({s}))") };
        let formula = solids.into_iter().map(signed).reduce(union).unwrap();
        let scene = Arc::new(Scene::from_formula(&formula).unwrap());
        let ((parts, of_parts), (whole, of_whole)) = (frame(&scene, true), frame(&scene, false));
        assert!(of_parts.evaluations != of_whole.evaluations, "{formula} is divided");
        hits += agree(&parts, &whole, &formula);
        evaluations[0] += of_parts.evaluations;
        evaluations[1] += of_whole.evaluations;
        let spec = AuditSpec { pixels: 10, seed: round, light_scale: LIGHT, floor: true };
        let mut audit = Audit::new(&scene, &parts, spec, RunSpec::default()).unwrap();
        while !audit.step().unwrap() {}
        assert_eq!(audit.report().violations, Vec::<String>::new(), "{formula}");
    }
    println!("{hits} hits; evaluations of the parts {}, of the wholes {}", evaluations[0], evaluations[1]);
    assert!(hits > 3_000 && evaluations[0] < evaluations[1]);
}

/// Seen from inside, the parts' walls would show where the union has none: nothing is divided, so nothing differs.
#[test]
fn from_inside_a_union_stays_whole() {
    let formula = "min(x^2 + y^2 + z^2 - 1, (x - 1)^2 + y^2 + z^2 - 1)";
    let mut scene = Scene::from_formula(formula).unwrap();
    scene.view.eye = Vec3::new(-0.5, 0.1, 0.2);
    scene.view.target = Vec3::new(1.0, 0.0, 0.0);
    let scene = Arc::new(scene);
    let ((a, _), (b, _)) = (frame(&scene, true), frame(&scene, false));
    let (a, b) = (a.planes().unwrap(), b.planes().unwrap());
    assert!(a.iter().zip(b.iter()).all(|(a, b)| format!("{a:?}") == format!("{b:?}")));
}

/// Hits are on parts, for whatever method: a state remembers.
#[test]
fn a_union_goes_on_with_another_method_where_it_was_stopped() {
    let scene = Arc::new(Scene::from_formula("min(x^2 + y^2 + z^2 - 1, (x - 1)^2 + y^2 + z^2 - 1)").unwrap());
    let spec = RenderSpec { width: SIZE, height: SIZE, floor: true, grid: 8, sub_beams: 2, ..RenderSpec::default() };
    let paper = Method::from_name("paper").unwrap();
    let mut renderer = Renderer::new(Arc::clone(&scene), spec.clone(), RunSpec::default()).unwrap();
    while !renderer.refine(Duration::from_secs(60)) {}
    renderer.restart_shadows(paper);
    let mut state = vec![];
    renderer.save(&mut state).unwrap();
    // Whatever is said of unions then: it goes on as it began.
    let spec = RenderSpec { method: paper, unions: false, ..spec };
    let mut second = Renderer::resume(scene, spec, RunSpec::default(), &mut std::io::Cursor::new(state)).unwrap();
    for renderer in [&mut renderer, &mut second] {
        while !renderer.refine(Duration::from_secs(60)) {}
    }
    let planes = |r: &Renderer| format!("{:?}", r.frame().planes().unwrap().iter().collect::<Vec<_>>());
    assert!(planes(&renderer) == planes(&second));
}
