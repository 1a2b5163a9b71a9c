//! A render that is saved and resumed is the render at one go, bit for bit; a state that does not fit is refused.
#[path = "renders/result.rs"]
mod result;

use antumbra::image::SizeError;
use antumbra::render::{Error, Method, RenderSpec, Renderer, RunSpec, StateError};
use antumbra::scene::{Scene, preset};
use result::result;
use std::io::Cursor;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

const ONE: RunSpec = RunSpec { threads: Some(1) };

fn scene(name: &str) -> Arc<Scene> {
    Arc::new(preset(name).unwrap().unwrap())
}

fn spec(method: &str) -> RenderSpec {
    let method = Method::from_name(method).unwrap();
    // 15 tiles, some of them cut.
    RenderSpec { width: 136, height: 72, method, grid: 16, sub_beams: 3, floor: true, ..RenderSpec::default() }
}

fn saved(renderer: &Renderer) -> Vec<u8> {
    let mut state = vec![];
    renderer.save(&mut state).unwrap();
    state
}

fn resumed(name: &str, spec: &RenderSpec, run: RunSpec, state: &[u8]) -> Result<Renderer, StateError> {
    Renderer::resume(scene(name), spec.clone(), run, &mut Cursor::new(state))
}

#[test]
fn a_render_resumed_at_every_point_is_the_render_at_one_go() {
    for (name, method) in [("links", "certified"), ("chubs", "paper"), ("kusner", "rays-mc")] {
        let spec = spec(method);
        let mut whole = Renderer::new(scene(name), spec.clone(), ONE).unwrap();
        while !whole.refine(Duration::MAX) {}
        let wanted = result(&whole);
        let mut states = vec![];
        let mut chain = Renderer::new(scene(name), spec.clone(), ONE).unwrap();
        // Step by step, each in a new renderer ...
        loop {
            states.push(saved(&chain));
            let done = chain.refine(Duration::ZERO);
            chain = resumed(name, &spec, ONE, &saved(&chain)).unwrap();
            if done {
                break;
            }
        }
        assert!(result(&chain) == wanted, "{name}, {method}: step by step");
        assert!(states.len() >= 9, "{}", states.len());
        // ... and from every point to the end, with another number of threads.
        for state in states.iter().step_by(3) {
            let mut rest = resumed(name, &spec, RunSpec { threads: Some(3) }, state).unwrap();
            while !rest.refine(Duration::MAX) {}
            assert!(result(&rest) == wanted, "{name}, {method}");
        }
    }
}

#[test]
fn a_stop_flag_loses_nothing() {
    let spec = spec("certified");
    let mut whole = Renderer::new(scene("links"), spec.clone(), ONE).unwrap();
    while !whole.refine(Duration::MAX) {}
    let mut stopped = Renderer::new(scene("links"), spec, RunSpec { threads: Some(2) }).unwrap();
    let flag = stopped.stop_flag();
    let mut rounds = 0;
    while {
        // Set before the work: nothing is begun. Set during it: what is under way ends.
        flag.store(true, Ordering::Relaxed);
        let before = stopped.progress();
        let done = stopped.refine(Duration::MAX);
        assert!(done || rounds == 0 || stopped.progress() == before);
        flag.store(false, Ordering::Relaxed);
        let setter = Arc::clone(&flag);
        let timer = std::thread::spawn(move || {
            std::thread::yield_now();
            setter.store(true, Ordering::Relaxed);
        });
        let done = stopped.refine(Duration::ZERO);
        timer.join().unwrap();
        rounds += 1;
        !done
    } {}
    assert!(result(&stopped) == result(&whole));
}

#[test]
fn the_rest_is_guessed_when_there_is_a_pace() {
    let mut renderer = Renderer::new(scene("links"), spec("certified"), ONE).unwrap();
    assert_eq!((renderer.remaining(), renderer.progress()), (None, 0.0));
    let mut guesses = 0;
    while !renderer.refine(Duration::ZERO) {
        let (_, done, all) = renderer.activity();
        assert!(done <= all, "{done} of {all}");
        guesses += u32::from(renderer.remaining().is_some());
    }
    assert!(guesses > 5, "{guesses}");
    assert_eq!((renderer.remaining(), renderer.progress()), (Some(Duration::ZERO), 1.0));
}

#[test]
fn a_preview_shows_what_is_done() {
    let mut renderer = Renderer::new(scene("links"), spec("certified"), ONE).unwrap();
    for _ in 0..3 {
        renderer.refine(Duration::ZERO);
    }
    let frame = renderer.preview();
    let black = frame.rgb.iter().filter(|c| **c == [0.0; 3]).count();
    assert!(black > 1000 && black < frame.rgb.len() - 1000, "{black} of {}", frame.rgb.len());
}

#[test]
fn late_colors_are_those_of_a_picture_that_was_looked_at() {
    for method in ["certified", "paper"] {
        let drawn = |late: bool, steps: usize| {
            let mut renderer = Renderer::new(scene("links"), spec(method), ONE).unwrap();
            if late {
                renderer.color_late();
            }
            for _ in 0..steps {
                if renderer.refine(Duration::ZERO) {
                    break;
                }
            }
            renderer
        };
        assert!(result(&drawn(true, usize::MAX)) == result(&drawn(false, usize::MAX)), "{method}");
        // In the middle of the surfaces, and of the light.
        let mut black = 0;
        for steps in [6, 18, 22] {
            let (late, early) = (drawn(true, steps), drawn(false, steps));
            black += late.frame().rgb.iter().zip(&early.frame().rgb).filter(|(l, e)| l != e).count();
            let resumed = resumed("links", &spec(method), ONE, &saved(&late)).unwrap();
            assert!(resumed.frame().rgb == early.frame().rgb, "{method}, a state after {steps} steps");
            assert!(late.preview().rgb == early.preview().rgb, "{method}, a preview after {steps} steps");
        }
        assert!(black > 100, "{method}: colours were late for {black} pixels");
    }
}

#[test]
fn a_state_of_something_else_is_refused() {
    let spec = spec("certified");
    let mut renderer = Renderer::new(scene("links"), spec.clone(), ONE).unwrap();
    (0..4).for_each(|_| {
        renderer.refine(Duration::ZERO);
    });
    let state = saved(&renderer);
    let refused = |name: &str, spec: RenderSpec| resumed(name, &spec, ONE, &state).err().expect("it does not fit");
    assert!(matches!(refused("torus", spec.clone()), StateError::Scene));
    let message = refused("links", RenderSpec { width: 137, ..spec.clone() }).to_string();
    assert_eq!(message, "it is of other options: width: 136 there, width: 137 here");
    let message = refused("links", RenderSpec { tolerance: 0.5, floor: false, ..spec.clone() }).to_string();
    assert!(message.contains("floor: true, tolerance: 0.00392156"), "{message}");
    let wrong = RenderSpec { width: 0, ..spec.clone() };
    assert!(matches!(refused("links", wrong), StateError::Render(Error::Size(SizeError::Empty))));
    // The same words, another function: a formula that only its values tell apart.
    let mut other = preset("links").unwrap().unwrap();
    other.objects[0].surface = Arc::clone(&other.objects[1].surface);
    let refused = Renderer::resume(Arc::new(other), spec.clone(), ONE, &mut Cursor::new(&state)).err();
    assert!(matches!(refused, Some(StateError::Scene)));
}

#[test]
fn a_damaged_state_is_refused() {
    let spec = spec("certified");
    let mut renderer = Renderer::new(scene("links"), spec.clone(), ONE).unwrap();
    (0..6).for_each(|_| {
        renderer.refine(Duration::ZERO);
    });
    let state = saved(&renderer);
    assert!(resumed("links", &spec, ONE, &state).is_ok());
    let of = |state: &[u8]| resumed("links", &spec, ONE, state).err().expect("it is damaged");
    for length in (0..state.len()).step_by(state.len() / 50).chain(state.len() - 40..state.len()) {
        let error = of(&state[..length]);
        let wanted = if length < 8 { "it is not the state of a render" } else { "it is damaged" };
        assert!(error.to_string().starts_with(wanted), "{length}: {error}");
    }
    for place in (12..state.len()).step_by(state.len() / 50).chain(state.len() - 40..state.len()) {
        let mut changed = state.clone();
        changed[place] ^= 1 << (place % 8);
        assert!(matches!(of(&changed), StateError::Damaged), "byte {place}");
    }
    let mut longer = state.clone();
    longer.push(0);
    assert!(matches!(of(&longer), StateError::Damaged));
    assert!(matches!(of(b"\x89PNG\r\n\x1a\n, a picture"), StateError::NotAState));
    let mut newer = state.clone();
    newer[8] += 1;
    assert!(of(&newer).to_string().contains("states of format 2, and this is Antumbra"));
    // Whole, but of another build: the build stands in the header, the checksum is made anew.
    let mut built = state.clone();
    let at = state.windows(7).position(|w| w == b"(build ").unwrap() + 7;
    built[at] = if built[at] == b'0' { b'1' } else { b'0' };
    let end = built.len() - 32;
    let checksum = blake3::hash(&built[..end]);
    built[end..].copy_from_slice(checksum.as_bytes());
    assert!(matches!(of(&built), StateError::Program { .. }));
}

#[test]
fn time_is_told_by_the_clock_that_is_set() {
    static SECONDS: AtomicU64 = AtomicU64::new(0);
    /// A second passes whenever somebody looks.
    fn clock() -> Duration {
        Duration::from_secs(SECONDS.fetch_add(1, Ordering::Relaxed))
    }
    let mut renderer = Renderer::new(scene("chubs"), spec("certified"), ONE).unwrap();
    renderer.set_clock(clock);
    assert!(!renderer.refine(Duration::from_millis(1)), "one step, after which the time is over");
    assert_eq!(renderer.stats().seconds, 1.0);
}
