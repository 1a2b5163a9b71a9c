//! The audit agrees with honest frames and finds planted errors of every kind.
use antumbra::audit::{Audit, AuditSpec, Kind, Report};
use antumbra::render::{Frame, RenderSpec, Renderer, RunSpec};
use antumbra::scene::{Scene, named};
use std::sync::Arc;
use std::time::Duration;

const SIZE: usize = 24;
const LIGHT: f64 = 4.0;

fn frame_of(scene: &Arc<Scene>) -> Frame {
    let spec = RenderSpec { width: SIZE, height: SIZE, light_scale: LIGHT, floor: true, ..RenderSpec::default() };
    let mut renderer = Renderer::new(Arc::clone(scene), spec, RunSpec::default()).unwrap();
    while !renderer.refine(Duration::from_secs(60)) {}
    renderer.frame().clone()
}

fn audit(scene: &Scene, frame: &Frame, pixels: usize) -> Report {
    let spec = AuditSpec { pixels, seed: 3, light_scale: LIGHT, floor: true };
    let mut audit = Audit::new(scene, frame, spec, RunSpec::default()).unwrap();
    while !audit.step().unwrap() {}
    assert_eq!(audit.progress(), 1.0);
    audit.report().clone()
}

/// Floor, two lights' worth of claims, open surfaces with poles, a square without change of sign; surfaces drawn in another form than that of
/// their text, which is what the audit reads.
#[test]
fn honest_frames_stand() {
    for name in ["sphere", "links", "sphere2", "pole", "whitney", "steiner", "tangle"] {
        let scene = Arc::new(named(name).unwrap().unwrap());
        let report = audit(&scene, &frame_of(&scene), 24);
        assert_eq!(report.violations, Vec::<String>::new(), "{name}");
        let total = report.total();
        assert!(total.claims > 200 && total.unclear * 10 <= total.claims, "{name}: {total:?}");
    }
}

/// An error planted in every pixel of a kind.
type Corruption = fn(&mut Frame, usize);

/// The pixels to plant it in.
type Wanted = fn(&Frame, usize) -> bool;

#[test]
fn planted_errors_are_found() {
    let scene = Arc::new(named("links").unwrap().unwrap());
    let honest = frame_of(&scene);
    let lit: Wanted = |f, i| f.verdict[i] == 1 && f.lights[1].visible_lo[i] == 1.0;
    let dark: Wanted = |f, i| f.verdict[i] == 1 && f.lights[0].visible_hi[i] == 0.0;
    let partly: Wanted = |f, i| f.verdict[i] == 1 && (0.2..0.8).contains(&f.lights[0].visible_lo[i]);
    let hit: Wanted = |f, i| f.verdict[i] == 1;
    let errors: [(Kind, Wanted, Corruption); 7] = [
        (Kind::Empty, hit, |f, i| f.verdict[i] = 0),
        (Kind::Hit, hit, |f, i| (f.t_lo[i], f.t_hi[i]) = (f.t_lo[i] - 2e-9, f.t_lo[i] - 1e-9)),
        (Kind::Before, hit, |f, i| (f.t_lo[i], f.t_hi[i]) = (f.t_lo[i] + 0.01, f.t_hi[i] + 0.02)),
        (Kind::CentreFree, hit, |f, i| f.verdict[i] = Frame::PARTLY),
        (Kind::Lit, dark, |f, i| (f.lights[0].visible_lo[i], f.lights[0].visible_hi[i]) = (1.0, 1.0)),
        (Kind::Dark, lit, |f, i| (f.lights[1].visible_lo[i], f.lights[1].visible_hi[i]) = (0.0, 0.0)),
        (Kind::Bracket, partly, |f, i| {
            let light = &mut f.lights[0];
            (light.visible_lo[i], light.visible_hi[i]) = (light.visible_lo[i] - 0.15, light.visible_hi[i] - 0.15);
        }),
    ];
    for (kind, wanted, corrupt) in errors {
        let mut frame = honest.clone();
        let places: Vec<usize> = (0..SIZE * SIZE).filter(|&i| wanted(&honest, i)).collect();
        assert!(places.len() > 4, "{kind:?}: {} places to corrupt", places.len());
        places.iter().for_each(|&i| corrupt(&mut frame, i));
        // Enough pixels that some of the corrupted ones are among them.
        let report = audit(&scene, &frame, 120);
        let found = report.kinds.get(&kind).map_or(0, |t| t.violations);
        assert!(found > 0 && !report.violations.is_empty(), "{kind:?}: {report:?}");
    }
}
