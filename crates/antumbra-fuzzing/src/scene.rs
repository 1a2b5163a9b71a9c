//! Scene files: from raw bytes, and nearly right ones.
use crate::input::Input;
use antumbra::scene::SceneFile;

const LINES: &[&str] = &[
    "[[surface]]",
    "formula = \"x^2 + y^2 + z^2 - 1\"",
    "formula = \"r x - y\"",
    "formula = \"x^\"",
    "formula = ''",
    "clip = { ball = 2 }",
    "clip = { ball = 1e200, center = [0, 1, 2] }",
    "clip = { min = [0, 0, 0], max = [1, 1, 0] }",
    "clip = { ball = nan }",
    "outside = [0.5, 0, 1]",
    "inside = [2, -1, nan]",
    "[[light]]",
    "center = [1, 2, 3]",
    "center = [1, 2]",
    "side = 0.5",
    "side = -inf",
    "u = [1, 0, 0]",
    "v = [0, 1e-320, 0]",
    "color = [1, 1, 1e9]",
    "strength = 0",
    "[camera]",
    "eye = [3, -4, 3]",
    "target = [3, -4, 3]",
    "angle = 30",
    "angle = 1e-9",
    "[floor]",
    "height = -1.5",
    "[parameters]",
    "r = 0.25",
    "r = { value = 2, min = 0, max = 1 }",
    "\"a b; x\" = 3",
    "title = \"a\\u0000\"",
    "light = []",
    "# a comment",
    "formla = 3",
];

/// Reading never panics, refusals have words, and what is read is the same after writing and reading.
pub fn scene(bytes: &[u8]) {
    let mut input = Input::new(bytes);
    let text = if input.below(3) == 0 {
        input.rest_as_text()
    } else {
        let mut text = String::new();
        while !input.is_spent() && text.len() < 2000 {
            text += input.pick(LINES);
            text.push('\n');
        }
        text
    };
    let file = match SceneFile::parse(&text) {
        Ok(file) => file,
        Err(error) => {
            assert!(!error.to_string().is_empty());
            return;
        }
    };
    let printed = file.text().unwrap_or_else(|e| panic!("{text:?} cannot be written: {e}"));
    let again = SceneFile::parse(&printed).unwrap_or_else(|e| panic!("{text:?} is written as {printed:?}: {e}"));
    // NaN is not itself: the texts are compared.
    assert_eq!(again.text().ok().as_deref(), Some(printed.as_str()), "{text:?}");
    // Boxes are searched for what they cut off, which takes long; balls are not.
    if file.surface.iter().all(|s| s.formula.len() < 200 && s.clip.is_some_and(|c| c.ball.is_some())) {
        match file.scene("fuzz") {
            Err(error) => assert!(!error.to_string().is_empty()),
            Ok(scene) => {
                let shown = SceneFile::of(&scene);
                let back = shown.scene("fuzz").unwrap_or_else(|e| panic!("{text:?} is shown as {shown:?}: {e}"));
                assert_eq!(SceneFile::of(&back), shown, "{text:?}");
            }
        }
    }
}
