//! A picture drawn in parts is the picture drawn by one, bit for bit; what is no part is refused.
#[path = "renders/result.rs"]
mod result;

use antumbra::render::{Method, RenderSpec, Renderer, RunSpec, StateError};
use antumbra::scene::preset;
use result::result;
use std::io::Cursor;
use std::sync::Arc;
use std::time::Duration;

fn renderer(name: &str, method: &str) -> Renderer {
    let method = Method::from_name(method).unwrap();
    // 15 tiles, some of them cut.
    let spec =
        RenderSpec { width: 136, height: 72, method, grid: 16, sub_beams: 3, floor: true, ..RenderSpec::default() };
    Renderer::new(Arc::new(preset(name).unwrap().unwrap()), spec, RunSpec { threads: Some(1) }).unwrap()
}

fn part(name: &str, method: &str, number: usize, of: usize) -> Renderer {
    let mut part = renderer(name, method);
    part.take_part(number, of);
    while !part.refine(Duration::MAX) {}
    part
}

fn saved(renderer: &Renderer) -> Vec<u8> {
    let mut state = vec![];
    renderer.save(&mut state).unwrap();
    state
}

#[test]
fn parts_make_the_whole() {
    // More parts than tiles too: the last ones are empty.
    for (name, method, of) in [("links", "certified", 3), ("chubs", "certified", 17), ("kusner", "paper", 2)] {
        let mut whole = renderer(name, method);
        while !whole.refine(Duration::MAX) {}
        let states: Vec<Vec<u8>> = (1..of).map(|number| saved(&part(name, method, number, of))).collect();
        let mut first = part(name, method, 0, of);
        assert!(first.refine(Duration::MAX), "nothing is left to do before the others are there");
        for state in states.iter().rev() {
            first.join(&mut Cursor::new(state)).unwrap();
        }
        while !first.refine(Duration::MAX) {}
        assert_eq!(result(&first), result(&whole), "{name} {method} in {of} parts");
    }
}

#[test]
fn a_part_goes_on_where_it_was_stopped() {
    let of = 2;
    let mut begun = renderer("chubs", "certified");
    begun.take_part(1, of);
    begun.refine(Duration::ZERO);
    begun.refine(Duration::ZERO);
    let spec = RenderSpec { width: 136, height: 72, grid: 16, sub_beams: 3, floor: true, ..RenderSpec::default() };
    let scene = Arc::new(preset("chubs").unwrap().unwrap());
    let mut second =
        Renderer::resume(scene, spec, RunSpec { threads: Some(1) }, &mut Cursor::new(saved(&begun))).unwrap();
    while !second.refine(Duration::MAX) {}
    assert_eq!(result(&second), result(&part("chubs", "certified", 1, of)));
}

#[test]
fn what_is_no_part_is_refused() {
    let mut first = part("chubs", "certified", 0, 2);
    let mut whole = renderer("chubs", "certified");
    let unfinished = saved(&whole);
    while !whole.refine(Duration::MAX) {}
    for state in [unfinished, saved(&whole), saved(&first)] {
        assert!(matches!(first.join(&mut Cursor::new(state)), Err(StateError::Part)));
    }
    let other = saved(&part("kusner", "certified", 1, 2));
    assert!(matches!(first.join(&mut Cursor::new(other)), Err(StateError::Scene)));
    let second = saved(&part("chubs", "certified", 1, 2));
    assert!(matches!(whole.join(&mut Cursor::new(&second)), Err(StateError::Part)), "it is whole already");
    first.join(&mut Cursor::new(second)).unwrap();
    while !first.refine(Duration::MAX) {}
    assert_eq!(result(&first), result(&whole));
}
