//! What is seen and not certified: inner edges, floors beside edges, parallel lines.
use antumbra::render::{Frame, RenderSpec, Renderer, RunSpec, Stats};
use antumbra::scene::{self, SceneFile};
use std::sync::Arc;
use std::time::Duration;

fn picture(text: &str, size: usize) -> (Frame, Stats) {
    let scene = Arc::new(SceneFile::parse(text).unwrap().scene("test").unwrap());
    let floor = scene.floor_shown;
    let spec = RenderSpec { width: size, height: size, floor, tolerance: 0.25, ..RenderSpec::default() };
    let mut renderer = Renderer::new(scene, spec, RunSpec::default()).unwrap();
    while !renderer.refine(Duration::from_secs(1)) {}
    (renderer.frame().clone(), renderer.stats())
}

/// The faces of a cube have three flat colours without lamps; between them there are others.
#[test]
fn inner_edges_are_smooth() {
    let cube = "light = []\n[[surface]]\nformula = \"max(abs(x), abs(y), abs(z)) = 1\"\noutside = [0.8, 0.8, 0.8]\n\
                clip = { box = [1.1, 1.1, 1.1] }\n[sky]\nabove = [1, 1, 1]\nbelow = [0, 0, 0]\n\
                [camera]\neye = [2.6, -4.3, 2.9]\nangle = 10\n";
    let (frame, stats) = picture(cube, 48);
    assert_eq!((stats.proved_hit + stats.undecided(), stats.proved_empty), (48 * 48, 0));
    assert!(stats.edge_evaluations > 0);
    let (mut mixed, mut steps) = (0, 0);
    for row in 0..48 {
        for column in 1..46 {
            let at = |k: usize| frame.normal[row * 48 + k][2];
            if (at(column) - at(column + 1)).abs() < 0.5 {
                continue;
            }
            // From the upper face to a side one: up to two pixels between lie on the edge.
            steps += 1;
            let grey = |k: usize| frame.rgb[row * 48 + k][0];
            let (left, right) = (grey(column - 1), grey(column + 2));
            let share = |k: usize| (grey(k) - left) / (right - left);
            mixed += usize::from([column, column + 1].into_iter().any(|k| (0.1..0.9).contains(&share(k))));
        }
    }
    assert!(steps >= 10 && 2 * mixed > steps, "{mixed} of {steps} steps are smooth");
}

/// Enclosures over pixels reach beyond the surface; on the floor beside it nothing of that may show.
#[test]
fn floors_are_clean_beside_edges() {
    let bretzel = "light = []\n[[surface]]\nformula = \"((x^2 + y^2/4 - 1) (x^2/4 + y^2 - 1))^2 + z^2 / 2 = 0.08\"\n\
                   clip = { box = [2.2, 2.2, 0.5] }\noutside = [0, 0, 0]\ninside = [0, 0, 0]\n[floor]\nheight = -0.5\n\
                   [camera]\neye = [2.707, -6.767, 7.669]\nangle = 28\n[sky]\nabove = [1, 1, 1]\nbelow = [0, 0, 0]\n";
    let size = 90;
    let (frame, _) = picture(bretzel, size);
    let bright = |row: usize, column: usize| frame.rgb[row * size + column][0] > 0.45;
    let mut dots = 0;
    for row in 2..size - 2 {
        for column in 2..size - 2 {
            let around = [(0, 1), (1, 0), (1, 2), (2, 1)].map(|(r, c)| bright(row + r - 1, column + c - 1));
            dots += usize::from(!bright(row, column) && around == [true; 4]);
        }
    }
    assert_eq!(dots, 0, "dark pixels alone on a bright floor");
}

#[test]
fn orthographic_cameras_see_no_distance() {
    let balls = "[[surface]]\nformula = \"(x + 1.2)^2 + (y - 5)^2 + z^2 = 1\"\n\
                 [[surface]]\nformula = \"(x - 1.2)^2 + (y + 5)^2 + z^2 = 1\"\n\
                 [camera]\nfrom = [0, -1, 0]\ntarget = [0, 0, 0]\n";
    let hits = |camera: &str| {
        let (frame, _) = picture(&format!("{balls}{camera}\n"), 80);
        let side = |right: bool| {
            let met = |i: &usize| !frame.t_lo[*i].is_nan() && (i % 80 >= 40) == right;
            (0..80 * 80).filter(met).count()
        };
        [side(false), side(true)]
    };
    let [far, near] = hits("width = 5");
    assert!(far > 500 && far.abs_diff(near) <= far / 50, "{far} and {near}");
    let [far, near] = hits("angle = 15");
    assert!(2 * near > 3 * far && far > 50, "{far} and {near}");
}

/// Where the two parts of a smooth union meet, f has a kink, and brackets stay open: between lit and lit nothing dark may show.
#[test]
fn open_brackets_are_no_specks() {
    let scene = Arc::new(scene::Scene::from_formula("smooth_union(torus(1, 0.3), sphere(0.6), 0.4)").unwrap());
    let (size, tolerance) = (128, 1.0 / 64.0);
    let spec = RenderSpec { width: size, height: size, tolerance, rectangles: 40, ..RenderSpec::default() };
    let mut renderer = Renderer::new(scene, spec, RunSpec::default()).unwrap();
    while !renderer.refine(Duration::from_secs(1)) {}
    let (frame, light) = (renderer.frame(), &renderer.frame().lights[0]);
    let (mut open, mut specks) = (0, 0);
    for row in 1..size - 1 {
        for column in 1..size - 1 {
            let index = row * size + column;
            let around = [index - size, index - 1, index + 1, index + size];
            let hit = |at: usize| frame.verdict[at] == 1;
            if !hit(index) || !around.into_iter().all(hit) || light.visible_hi[index] - light.visible_lo[index] < 0.3 {
                continue;
            }
            open += 1;
            let least = around.map(|at| frame.rgb[at][0]).into_iter().fold(f32::INFINITY, f32::min);
            specks += usize::from(frame.rgb[index][0] < 0.95 * least);
        }
    }
    assert!(open >= 5, "{open} brackets are open");
    assert_eq!(specks, 0, "of {open}");
}
