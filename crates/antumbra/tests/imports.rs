//! Files of other programs: each operation means what its format says, and errors show the place in the file.
#![allow(clippy::disallowed_methods, reason = "expected values, compared with a tolerance")]
use antumbra::eval::value_at;
use antumbra::expr::Formula;
use antumbra::geom::{Clip, Vec3};
use antumbra::import::{Format, scene};
use antumbra::scene::Scene;
use antumbra::tape::Tape;

fn read(text: &str, format: Format) -> Scene {
    scene(text, format, "test").unwrap_or_else(|e| panic!("{text}: {e}"))
}

fn refused(text: &str, format: Format) -> String {
    match scene(text, format, "test") {
        Ok(scene) => panic!("{text:?} is read as {:?}", scene.objects),
        Err(error) => error.to_string(),
    }
}

/// The value of a surface's formula as it was written.
fn value(scene: &Scene, object: usize, p: [f64; 3]) -> f64 {
    let tape = Tape::compile(&Formula::parse_as_written(&scene.objects[object].text).unwrap()).unwrap();
    value_at(&tape, Vec3(p), &mut vec![])
}

/// Adds a ball to an operation on x and y, so that there is a surface in every file: `max(op, x^2 + y^2 + z^2 - 4)`.
fn beside_a_ball(operation: &str) -> String {
    format!(
        "x var-x\ny var-y\nz var-z\nxx square x\nyy square y\nzz square z\ns add xx yy\ns add s zz\nfour const 4\n\
         ball sub s four\n{operation}\nr min ball v"
    )
}

#[test]
fn operations_of_fidget_mean_what_its_format_says() {
    let compare = |a: f64, b: f64| f64::from(i8::from(a > b) - i8::from(a < b));
    type Meaning<'a> = &'a dyn Fn(f64, f64) -> f64;
    let cases: [(&str, Meaning<'_>); 12] = [
        ("v ceil x", &|x, _| x.ceil()),
        ("v round x", &|x, _| x.round()),
        ("v mod x y", &|x, y| x.rem_euclid(y)),
        ("v compare x y", &compare),
        ("v not x", &|x, _| f64::from(u8::from(x == 0.0))),
        ("v and x y", &|x, y| if x == 0.0 { x } else { y }),
        ("v or x y", &|x, y| if x == 0.0 { y } else { x }),
        ("v atan2 x y", &|x, y| x.atan2(y)),
        ("v const -1e-3\nv mul v x", &|x, _| -1e-3 * x),
        ("x neg x\nv sub x y", &|x, y| -x - y),
        ("v abs x\nv sqrt v", &|x, _| x.abs().sqrt()),
        ("v max x y\nv min v x", &|x, y| x.max(y).min(x)),
    ];
    for (operation, meaning) in cases {
        let scene = read(&beside_a_ball(operation), Format::Fidget);
        for (x, y) in [(1.25, 0.5), (-1.75, 0.5), (0.0, 0.75), (-0.25, 2.0), (1.0, 1.0)] {
            let (found, expected) = (value(&scene, 0, [x, y, 3.0]), meaning(x, y).min(x * x + y * y + 5.0));
            assert!((found - expected).abs() < 1e-12, "{operation} at {x}, {y}: {found}, not {expected}");
        }
    }
}

#[test]
fn decimals_are_exact() {
    let scene = read("a const 0.1\nx var-x\nr sub x a", Format::Fidget);
    assert!(scene.objects[0].text.contains("0.1"), "{}", scene.objects[0].text);
}

#[test]
fn a_drawing_becomes_a_plate() {
    let scene =
        read("x var-x\ny var-y\nxx square x\nyy square y\ns add xx yy\none const 1\nr sub s one", Format::Fidget);
    assert!(value(&scene, 0, [0.0, 0.0, 0.0]) < 0.0);
    assert!(value(&scene, 0, [0.0, 0.0, 5.0]) > 0.0 && value(&scene, 0, [1.5, 0.0, 0.0]) > 0.0);
}

#[test]
fn a_sheet_that_bounds_nothing_goes() {
    // A ball without the half x > 0, written with the ball inside twice: on the sphere's other half it is |ball|.
    let text = "x var-x\ny var-y\nz var-z\na square x\nb square y\nc square z\ns add a b\ns add s c\none const 1\ne sub s one\n\
                m max e x\nn neg m\nr max e n";
    let scene = read(text, Format::Fidget);
    for (p, inside) in
        [([-0.5, 0.0, 0.0], false), ([0.5, 0.0, 0.0], true), ([-2.0, 0.0, 0.0], false), ([2.0, 0.0, 0.0], false)]
    {
        let v = value(&scene, 0, p);
        assert_eq!(v < 0.0, inside, "{p:?}: {v}");
    }
    // On the sheet, the sphere's half with x < 0, the file's formula is 0.
    assert!(value(&scene, 0, [-1.0, 0.0, 0.0]) > 0.5, "{}", scene.objects[0].text);
}

#[test]
fn surfer_files_have_parameters_and_a_ball() {
    let text = "# made by hand\nsurface_parameter_a=0.25\nsurface_equation=x^2+y^2+a*z^2-0.5\nscale_factor=0.30103\n";
    let scene = read(text, Format::Surfer);
    assert!((value(&scene, 0, [1.0, 0.0, 2.0]) - 1.5).abs() < 1e-12);
    let Clip::Ball { radius, .. } = scene.objects[0].clip() else { panic!("{:?}", scene.objects[0].clip()) };
    assert!((radius - 2.0).abs() < 1e-4);
}

#[test]
fn mathmod_scripts_have_constants_functions_and_a_box() {
    let text = r#"{"Iso3D": {"Name": ["two"], "Component": ["a"], "Const": ["c=1/4"], "Funct": ["f=x^2+y^2"],
        "Fxyz": ["f(x,y,z,t)+z^2-c"], "Xmin": ["-2"], "Xmax": ["2"], "Ymin": ["-2"], "Ymax": ["2"], "Zmin": ["-2"], "Zmax": ["2"]}}"#;
    let scene = read(text, Format::MathMod);
    assert!((value(&scene, 0, [1.0, 1.0, 1.0]) - 2.75).abs() < 1e-12);
    assert!(matches!(scene.objects[0].clip(), Clip::Box(b) if b[0].hi() == 2.0), "{:?}", scene.objects[0].clip());
}

#[test]
fn errors_show_the_place() {
    for (text, format, words) in [
        ("x var-x\nr sub x a\n", Format::Fidget, "line 2"),
        ("x var-x\nr frob x\n", Format::Fidget, "frob"),
        ("x var-x\nr rand x\n", Format::Fidget, "rand"),
        ("a const 1e\n", Format::Fidget, "line 1"),
        ("", Format::Fidget, "no operation"),
        ("surface_parameter_a=1\n", Format::Surfer, "surface_equation"),
        ("surface_equation=x^\n", Format::Surfer, "line 1"),
        ("surface_equation=x\nscale_factor=lots\n", Format::Surfer, "scale"),
        ("surface_equation=1/0", Format::Surfer, "exactly 0"),
        ("{\"Param3D\": {}}", Format::MathMod, "parametric"),
        ("{", Format::MathMod, "line 1"),
    ] {
        let message = refused(text, format);
        assert!(message.contains(words), "{text:?}: {message}");
    }
}

/// Pieces of a file are put together to one text: none may become more than it is.
#[test]
fn pieces_stay_what_they_are() {
    for (text, format, words) in [
        ("surface_parameter_1#=2\nsurface_equation=1/0", Format::Surfer, "needs a name"),
        ("surface_parameter_a=1) # (\nsurface_equation=x", Format::Surfer, "bracket"),
        ("surface_parameter_a=1; b = (2\nsurface_equation=x+b", Format::Surfer, "';'"),
        ("surface_parameter_a=(1\nsurface_equation=x", Format::Surfer, "not closed"),
        ("surface_equation=x # y", Format::Surfer, "'#'"),
        (r##"{"Iso3D": {"Fxyz": ["x-c"], "Const": ["c=1#"]}}"##, Format::MathMod, "'#'"),
        (r#"{"Iso3D": {"Fxyz": ["x-c"], "Const": ["c d=1"]}}"#, Format::MathMod, "needs a name"),
    ] {
        let message = refused(text, format);
        assert!(message.contains(words), "{text:?}: {message}");
    }
}
