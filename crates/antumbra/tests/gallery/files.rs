//! The files as files, and as pictures.
use antumbra::render::{RenderSpec, Renderer, RunSpec};
use antumbra::scene::{GALLERY, SceneFile, named, names, preset};
use std::collections::BTreeSet;
use std::sync::Arc;
use std::time::Duration;

#[test]
fn every_surface_has_a_history() {
    assert!(GALLERY.len() >= 44, "{}", GALLERY.len());
    for entry in GALLERY {
        let scene = entry.scene().unwrap_or_else(|e| panic!("{}: {e}", entry.name));
        let about = scene.about.as_ref().unwrap_or_else(|| panic!("{} has no [about]", entry.name));
        for (key, text) in [("author", &about.author), ("source", &about.source), ("history", &about.history)] {
            let text = text.as_ref().unwrap_or_else(|| panic!("{}: about.{key} is missing", entry.name));
            assert!(text.trim() == text && !text.is_empty() && text.len() < 400, "{}: about.{key}", entry.name);
        }
        assert!(about.year.is_none_or(|y| (1600..=2030).contains(&y)), "{}", entry.name);
        // What is printed can be drawn, and says the same.
        let printed = SceneFile::of(&scene).text().unwrap();
        let again = SceneFile::parse(&printed).unwrap().scene(entry.name).unwrap();
        assert_eq!((&again.about, &again.title), (&scene.about, &scene.title));
        assert_eq!((again.view, &again.lights), (scene.view, &scene.lights));
    }
}

#[test]
fn names_and_titles_are_unique() {
    let unique = |names: Vec<String>| names.iter().collect::<BTreeSet<_>>().len() == names.len();
    assert!(unique(GALLERY.iter().map(|e| e.name.to_owned()).collect()));
    assert!(unique(GALLERY.iter().map(|e| e.scene().unwrap().title).collect()));
    assert!(unique(names().map(str::to_owned).collect()));
    for name in names() {
        assert!(named(name).is_some_and(|s| s.is_ok()), "{name}");
        assert!(name.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-'), "{name}");
    }
    assert!(named("nothing").is_none());
}

/// The paper's scenes hang in the gallery as they are.
#[test]
fn the_papers_scenes_are_untouched() {
    for name in ["orthocircle", "chubs", "kusner", "mcmullen"] {
        let (hung, plain) = (named(name).unwrap().unwrap(), preset(name).unwrap().unwrap());
        assert!(hung.about.is_some() && plain.about.is_none());
        assert_eq!((hung.view, &hung.lights, hung.floor_height), (plain.view, &plain.lights, plain.floor_height));
        assert_eq!(hung.objects[0].text, plain.objects[0].text);
        assert_eq!(hung.objects[0].clip(), plain.objects[0].clip());
    }
}

#[test]
fn every_surface_is_in_its_picture() {
    for entry in GALLERY {
        let scene = Arc::new(entry.scene().unwrap());
        // Shadows are not the question here.
        let spec = RenderSpec { width: 20, height: 20, tolerance: 1.0, rectangles: 1, ..RenderSpec::default() };
        let mut renderer = Renderer::new(scene, spec, RunSpec::default()).unwrap();
        while !renderer.refine(Duration::from_secs(1)) {}
        let stats = renderer.stats();
        assert!(stats.proved_hit >= 25, "{}: {} hits", entry.name, stats.proved_hit);
        assert!(stats.proved_empty >= 4, "{}: the picture is full", entry.name);
    }
}
