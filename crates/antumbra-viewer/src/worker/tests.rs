use super::*;
use antumbra::{
    render::{Frame, Overlay, RenderSpec, Renderer},
    scene::{CameraEntry, SceneFile, file_named},
};
use std::time::Instant;

const LONG: Duration = Duration::from_secs(120);

fn worker() -> Worker {
    Worker::start(RunSpec { threads: Some(2) }, || {}).unwrap()
}

fn job(revision: u64, text: &str) -> Job {
    let (name, file) = ("formula".to_owned(), SceneFile::of_formula(text));
    Job { revision, name, file, size: [64, 48], methods: vec![Method::Certified], overlay: None }
}

/// Everything up to the end of a job.
fn finish(worker: &Worker, revision: u64) -> (Vec<Image>, Option<Refusal>) {
    let mut images = vec![];
    loop {
        match worker.wait(LONG).expect("the thread answers") {
            Event::Image(image) => images.push(*image),
            Event::Refused { revision: r, refusal } if r == revision => return (images, Some(refusal)),
            Event::Done { revision: r, .. } if r == revision => return (images, None),
            Event::Built { .. } | Event::Refused { .. } | Event::Done { .. } => {}
        }
    }
}

#[test]
fn the_last_picture_is_the_renderers_own() {
    let worker = worker();
    let job = Job { size: [256, 192], ..job(1, "x^2 + y^2 + z^2 = 1") };
    worker.submit(job.clone());
    let (images, refusal) = finish(&worker, 1);
    assert_eq!(refusal, None);
    assert!(images.len() >= 2 && images[0].size[0] < 256, "coarse first");
    assert!(images.iter().all(|i| i.rgba.len() == i.size[0] * i.size[1]));
    let last = images.last().unwrap();
    assert!(last.whole && last.last && last.rgba.iter().all(|c| c.to_ne_bytes()[3] == 255));
    let scene = Arc::new(job.file.scene("formula").unwrap());
    let spec = RenderSpec { width: 256, height: 192, ..RenderSpec::default() };
    let mut renderer = Renderer::new(scene, spec, RunSpec::default()).unwrap();
    while !renderer.refine(Duration::MAX) {}
    assert_eq!(last.frame.verdict, renderer.frame().verdict);
    assert_eq!(last.frame.rgb, renderer.frame().rgb);
    // The first picture is as certified as the last one: the same renderer's, smaller.
    let first = &images[0];
    assert!(first.frame.verdict.iter().all(|v| *v != Frame::UNSEEN));
    assert!(first.stats.proved_hit > 0 && first.stats.proved_empty > 0);
}

#[test]
fn bad_scenes_are_refused_with_their_place_and_work_goes_on() {
    let worker = worker();
    worker.submit(Job { size: [300, 300], ..job(1, "x^2 + y^2 + z^2 = 1") });
    worker.submit(job(2, "x^2 + = 1"));
    let (_, refusal) = finish(&worker, 2);
    let refusal = refusal.unwrap();
    assert_eq!(refusal.place.as_ref().map(|(k, place)| (*k, place.start)), Some((0, 6)), "{refusal:?}");
    assert!(refusal.message.contains('^'), "{}", refusal.message);
    let mut file = SceneFile::parse("parameters = { a = 1 }\n[[surface]]\nformula = \"x + b\"\n").unwrap();
    worker.submit(Job { file: file.clone(), ..job(3, "") });
    let refusal = finish(&worker, 3).1.unwrap();
    assert_eq!(refusal.place, Some((0, 4..5)), "the parameters before it do not count");
    file.camera = Some(CameraEntry { angle: Some(f64::NAN), ..CameraEntry::default() });
    file.surface[0].formula = "x + a".to_owned();
    worker.submit(Job { file, ..job(4, "") });
    assert!(finish(&worker, 4).1.unwrap().message.contains("camera.angle"));
    let huge = format!("x{}", " + x".repeat(400_000));
    worker.submit(job(5, &huge));
    assert!(finish(&worker, 5).1.unwrap().message.contains("the most is"));
}

#[test]
fn a_first_picture_that_was_given_up_is_drawn_after_all() {
    let worker = worker();
    worker.submit(job(1, "x^2 + y^2 + z^2 = 1"));
    assert_eq!(finish(&worker, 1).1, None);
    // Its first picture takes long; meanwhile it is asked for in another way, which builds nothing anew.
    let file = file_named("barth-decic").unwrap().unwrap();
    let heavy = Job { file, name: "barth-decic".to_owned(), size: [96, 96], ..job(2, "") };
    worker.submit(heavy.clone());
    std::thread::sleep(Duration::from_millis(400));
    worker.submit(Job { revision: 3, overlay: Some(Overlay::Verdict), ..heavy });
    loop {
        match worker.wait(LONG).expect("the thread answers") {
            Event::Image(image) if image.revision == 3 && image.whole => {
                assert_eq!(image.size[0], image.size[1], "the picture before, as if it were this one");
                return;
            }
            Event::Done { revision: 3, .. } => panic!("nothing was drawn"),
            _ => {}
        }
    }
}

#[test]
fn what_was_good_is_finished_after_a_bad_formula() {
    let worker = worker();
    worker.submit(Job { size: [200, 200], ..job(1, "x^4 + y^4 + z^4 - x^2 - y^2 - z^2 + 1/2 = 0") });
    while !matches!(worker.wait(LONG), Some(Event::Image(_))) {}
    worker.submit(job(2, "x^"));
    let (images, refusal) = finish(&worker, 1);
    assert_eq!(refusal, None);
    assert!(images.last().unwrap().last);
}

#[test]
fn a_newer_job_ends_the_older_one_at_once() {
    let worker = worker();
    let file = file_named("orthocircle").unwrap().unwrap();
    // Would take many seconds.
    worker.submit(Job { file, name: "orthocircle".to_owned(), size: [2000, 2000], ..job(1, "") });
    while !matches!(worker.wait(LONG), Some(Event::Image(_))) {}
    let asked = Instant::now();
    worker.submit(job(2, "z"));
    let built = loop {
        if let Some(Event::Built { revision: 2, .. }) = worker.wait(LONG) {
            break asked.elapsed();
        }
    };
    // Far less than the rest of the picture; generous, since machines are busy.
    assert!(built < Duration::from_secs(5), "{built:?}");
    assert_eq!(finish(&worker, 2).1, None);
    let asked = Instant::now();
    worker.submit(Job { size: [2000, 2000], ..job(3, "sin(5x) + sin(5y) + sin(5z)") });
    drop(worker);
    assert!(asked.elapsed() < Duration::from_secs(20), "the thread ends when nobody wants it");
}

#[test]
fn another_overlay_draws_nothing_anew() {
    let worker = worker();
    worker.submit(job(1, "x^2 + y^2 + z^2 = 1"));
    let (images, _) = finish(&worker, 1);
    let colours = images.last().unwrap();
    worker.submit(Job { overlay: Some(Overlay::Verdict), ..job(2, "x^2 + y^2 + z^2 = 1") });
    let (again, _) = finish(&worker, 2);
    let [shown] = &again[..] else { panic!("{} pictures", again.len()) };
    assert!(Arc::ptr_eq(&shown.frame, &colours.frame) && shown.rgba != colours.rgba);
    assert_eq!(shown.legend.iter().map(|kind| kind.count).sum::<usize>(), 64 * 48);
}

#[test]
fn two_methods_are_drawn_for_two_sides() {
    let worker = worker();
    let methods = ["certified", "paper"].map(|name| Method::from_name(name).unwrap());
    worker.submit(Job { methods: methods.to_vec(), ..job(1, "x^2 + y^2 + z^2 = 1") });
    let (images, _) = finish(&worker, 1);
    for (side, method) in methods.into_iter().enumerate() {
        let last = images.iter().rfind(|i| i.side == side).unwrap();
        assert!(last.last && last.whole && last.method == method);
    }
}

#[test]
fn unknown_light_is_not_shown() {
    let mut frame = Frame::new(2, 1, 1).unwrap();
    assert!(!image::settled(&frame, 0));
    frame.verdict = vec![0, 1];
    (frame.lights[0].visible_lo[1], frame.lights[0].visible_hi[1]) = (0.0, 1.0);
    assert!(image::settled(&frame, 0) && !image::settled(&frame, 1));
    let (rgba, _) = image::shown(&frame, &antumbra::scene::Look::default(), None, false);
    assert_eq!((rgba[0].to_ne_bytes()[3], rgba[1]), (255, 0));
}

/// What a window has seen enough of is let go by this thread, also while there is nothing to draw.
#[test]
fn frames_are_given_back() {
    let worker = worker();
    worker.submit(job(1, "x^2 + y^2 + z^2 = 1"));
    let (images, _) = finish(&worker, 1);
    let frame = Arc::new(Frame::clone(&images[0].frame));
    let gone = Arc::downgrade(&frame);
    worker.give_back(frame);
    let begun = Instant::now();
    while gone.strong_count() > 0 {
        assert!(begun.elapsed() < LONG, "nobody lets it go");
        std::thread::yield_now();
    }
}
