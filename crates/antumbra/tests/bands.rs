//! A picture drawn band by band is the picture drawn at one go, bit for bit, and takes the memory of a band.
#[path = "renders/result.rs"]
mod result;

use antumbra::render::{Method, RenderSpec, Renderer, RunSpec};
use antumbra::scene::preset;
use result::{counters, planes, result};
use std::io::Cursor;
use std::sync::Arc;
use std::time::Duration;

const RUN: RunSpec = RunSpec { threads: Some(1) };

fn spec(method: &str) -> RenderSpec {
    let method = Method::from_name(method).unwrap();
    RenderSpec { width: 72, height: 200, method, grid: 16, sub_beams: 3, floor: true, ..RenderSpec::default() }
}

fn in_bands(name: &str, method: &str, rows: usize) -> Renderer {
    Renderer::in_bands(Arc::new(preset(name).unwrap().unwrap()), spec(method), RUN, rows).unwrap()
}

fn finish(renderer: &mut Renderer) {
    while !renderer.refine(Duration::MAX) {}
}

/// Holds the rows that are finished against those of the whole, and tells how many they are.
fn compared(banded: &Renderer, whole: &Renderer) -> usize {
    let (rows, frame) = banded.finished_rows().unwrap();
    assert_eq!(frame.height, rows.len());
    assert_eq!(planes(&frame), planes(&whole.frame().rows(rows.clone())), "rows {rows:?}");
    rows.len()
}

#[test]
fn bands_are_the_whole() {
    // Steps, edges of pixels and inner edges, several surfaces, random rays: each has its way to look at neighbours or places.
    for (name, method, rows) in [
        ("links", "certified", 1),
        ("chubs", "certified", 64),
        ("links", "certified", 100),
        ("kusner", "paper", 64),
        ("chubs", "rays-mc", 32),
        ("chubs", "certified", 1000),
    ] {
        let mut whole = in_bands(name, method, 200);
        finish(&mut whole);
        let mut banded = in_bands(name, method, rows);
        let (mut seen, mut progress) = (0, 0.0);
        loop {
            assert!(banded.frame().height <= rows.next_multiple_of(32) + 64);
            assert!(banded.finished_rows().is_none());
            finish(&mut banded);
            assert!(banded.progress() > progress && banded.progress() <= 1.0);
            progress = banded.progress();
            seen += compared(&banded, &whole);
            if !banded.next_band() {
                break;
            }
        }
        assert_eq!(seen, 200);
        assert_eq!(progress, 1.0);
        assert_eq!(counters(&banded), counters(&whole), "{name} {method} in bands of {rows}");
    }
}

#[test]
fn a_picture_in_bands_goes_on_where_it_was_stopped() {
    let mut whole = in_bands("links", "certified", 200);
    finish(&mut whole);
    // Stopped in the first band, in a later one, and between two.
    for (bands, steps) in [(0, 2), (2, 3), (1, 0)] {
        let mut banded = in_bands("links", "certified", 32);
        for _ in 0..bands {
            finish(&mut banded);
            assert!(banded.next_band());
        }
        for _ in 0..steps {
            banded.refine(Duration::ZERO);
        }
        let mut state = vec![];
        banded.save(&mut state).unwrap();
        let scene = Arc::new(preset("links").unwrap().unwrap());
        let mut second = Renderer::resume(scene, spec("certified"), RUN, &mut Cursor::new(state)).unwrap();
        loop {
            finish(&mut second);
            compared(&second, &whole);
            if !second.next_band() {
                break;
            }
        }
        assert_eq!(counters(&second), counters(&whole));
    }
}

#[test]
fn there_is_no_band_below_one_that_is_not_finished_or_the_last() {
    let mut banded = in_bands("sphere", "certified", 32);
    assert!(!banded.next_band());
    banded.refine(Duration::ZERO);
    assert!(!banded.next_band());
    let mut whole = in_bands("sphere", "certified", 200);
    finish(&mut whole);
    let before = result(&whole);
    assert!(!whole.next_band());
    assert_eq!(result(&whole), before);
}
