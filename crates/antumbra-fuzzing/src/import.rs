//! Files of other programs: from raw bytes, and nearly right ones.
use crate::input::Input;
use antumbra::import::{Format, scene};

const FIDGET: &[&str] = &[
    "# a comment",
    "_0 var-x",
    "_1 var-y",
    "_2 var-z",
    "_3 const 0.75",
    "_3 const -1e-40",
    "_3 const nan",
    "_4 add _0 _1",
    "_5 max _4 _3",
    "_6 mod _5 _3",
    "_7 compare _6 _2",
    "_8 not _7",
    "_9 and _8 _7",
    "a or _9 _0",
    "_4 sqrt _4",
    "_4 ln _3",
    "_b rand _0",
    "_c",
    "_c div _0",
    "   ",
    "_3 const 1e400",
    "_0 square _0",
    "_0 atan2 _0 _0",
];
const SURFER: &[&str] = &[
    "surface_equation=x^2+y^2+a*z^2-1",
    "surface_equation=x^",
    "surface_parameter_a=0.5",
    "surface_parameter_a=",
    "scale_factor=0.3",
    "scale_factor=nan",
    "#comment",
    "camera_type=ORTHOGRAPHIC_CAMERA",
    "surface_equation=x\\",
    "=",
];
const MATHMOD: &[&str] = &[
    "{",
    "\"Iso3D\": {",
    "\"Description\": [\"a\"],",
    "\"Name\": [\"b\"],",
    "\"Component\": [\"c\"],",
    "\"Fxyz\": [\"x^2+y^2-c\"],",
    "\"Const\": [\"c=1/2\"],",
    "\"Funct\": [\"f=x*y\"],",
    "\"Xmax\": [\"2\"],",
    "\"Xmin\": [\"-2\"]",
    "}",
    "]",
    "[",
    "null",
    "1e999,",
];

/// Reading never panics, and refusals have words. The last line is wrong, so that no time goes into searching for the surface.
pub fn import(bytes: &[u8]) {
    let mut input = Input::new(bytes);
    let (format, lines, wrong) = input.pick(&[
        (Format::Fidget, FIDGET, "_z nothing"),
        (Format::Surfer, SURFER, "surface_equation=1/0"),
        (Format::MathMod, MATHMOD, "?"),
    ]);
    let mut text = String::new();
    if input.below(3) == 0 {
        text = input.rest_as_text();
        text.push('\n');
    } else {
        while !input.is_spent() && text.len() < 2000 {
            text += input.pick(lines);
            text.push('\n');
        }
    }
    text += wrong;
    let _ = Format::of_content(&text);
    match scene(&text, format, "fuzz") {
        Ok(_) => panic!("read, though the last line is wrong: {text:?}"),
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}
