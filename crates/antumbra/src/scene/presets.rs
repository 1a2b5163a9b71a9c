//! Scenes by name: the four surfaces of the paper, and surfaces that other renderers get wrong.
use super::{Error, Light, Object, Scene, View, framing};
use crate::geom::{Box3, Clip, Rect, Vec3};

/// A named scene in one row.
#[derive(Clone, Copy, Debug)]
pub struct Preset {
    /// What one types.
    pub name: &'static str,
    /// What one reads.
    pub title: &'static str,
    /// The formula.
    pub formula: &'static str,
    /// Formulas of further surfaces, clipped to the same box.
    pub others: &'static [&'static str],
    /// The surface is clipped to `|x|, |y|, |z| <= half`.
    pub half: f64,
    /// Camera and light; `None` frames the clip box by the default rule.
    pub stage: Option<Stage>,
}

/// Camera, light and floor of a preset. The camera looks at the origin.
#[derive(Clone, Copy, Debug)]
pub struct Stage {
    /// Camera position.
    pub eye: [f64; 3],
    /// Full angle, degrees.
    pub fov_deg: f64,
    /// Middle of the horizontal square light.
    pub light: [f64; 3],
    /// Side of the light.
    pub side: f64,
    /// A second light.
    pub second: Option<Light>,
    /// Height of the floor.
    pub floor: f64,
}

const fn row(name: &'static str, title: &'static str, formula: &'static str, half: f64) -> Preset {
    Preset { name, title, formula, others: &[], half, stage: None }
}

/// Every preset; the paper's four first.
pub const PRESETS: &[Preset] = &[
    Preset {
        stage: Some(Stage {
            eye: [4.0, -2.0, 2.0],
            fov_deg: 30.5,
            light: [2.0, 3.0, 5.0],
            side: 0.25,
            second: None,
            floor: -1.25,
        }),
        ..row(
            "orthocircle",
            "Orthocircle",
            "((x^2 + y^2 - 1)^2 + z^2) ((y^2 + z^2 - 1)^2 + x^2) ((z^2 + x^2 - 1)^2 + y^2) \
             - 0.075^2 (1 + 3 (x^2 + y^2 + z^2)) = 0",
            1.16,
        )
    },
    Preset {
        stage: Some(Stage {
            eye: [3.0, -4.0, 3.0],
            fov_deg: 25.5,
            light: [1.0, -2.0, 6.0],
            side: 0.25,
            second: None,
            floor: -1.1,
        }),
        ..row("chubs", "Chubs", "x^4 + y^4 + z^4 - x^2 - y^2 - z^2 + 1/2 = 0", 1.01)
    },
    Preset {
        stage: Some(Stage {
            eye: [-3.0, -3.0, 1.0],
            fov_deg: 24.5,
            light: [-2.0, -5.0, 6.0],
            side: 0.2,
            second: None,
            floor: -1.1,
        }),
        ..row("kusner", "Kusner-Schmitt", "(x^2 + 3) (y^2 + 3) (z^2 + 3) - 32 (x y z + 1) = 0", 1.1)
    },
    Preset {
        stage: Some(Stage {
            eye: [2.0, -5.0, 4.0],
            fov_deg: 26.0,
            light: [4.0, -3.0, 3.0],
            side: 0.3,
            second: None,
            floor: -1.8,
        }),
        ..row("mcmullen", "McMullen K3", "(1 + x^2) (1 + y^2) (1 + z^2) + 8 x y z - 2 = 0", 1.77)
    },
    Preset {
        stage: Some(Stage {
            eye: [3.0, -3.5, 1.5],
            fov_deg: 42.0,
            light: [3.0, -2.0, 6.0],
            side: 0.5,
            second: None,
            floor: -1.61,
        }),
        ..row(
            "twister",
            "Twisted blade, 0.004 thick",
            "(x cos(3z) + y sin(3z))^2 + ((-x sin(3z) + y cos(3z)) / 0.002)^2 - 1 = 0",
            1.6,
        )
    },
    Preset {
        others: &["((x - 1/2)^2 + y^2 + z^2 + 1 - 1/16)^2 - 4 ((x - 1/2)^2 + z^2) = 0"],
        stage: Some(Stage {
            eye: [2.6, -5.2, 2.8],
            fov_deg: 33.0,
            light: [-2.5, -2.5, 6.0],
            side: 0.8,
            second: Some(Light {
                rect: Rect {
                    center: Vec3([5.0, -1.0, 2.5]),
                    edge_u: Vec3([0.0, 0.4, 0.0]),
                    edge_v: Vec3([0.2, 0.0, 0.4]),
                },
                color: [0.22, 0.32, 0.5],
            }),
            floor: -1.3,
        }),
        ..row(
            "links",
            "Two linked tori under two lights",
            "((x + 1/2)^2 + y^2 + z^2 + 1 - 1/16)^2 - 4 ((x + 1/2)^2 + y^2) = 0",
            1.77,
        )
    },
    row("sphere", "Sphere", "x^2 + y^2 + z^2 - 1 = 0", 1.01),
    row("torus", "Torus", "(x^2 + y^2 + z^2 + 1 - 1/16)^2 - 4 (x^2 + y^2) = 0", 1.26),
    row("wire3", "Ring of wire, radius 1e-3", "(x^2 + y^2 - 1)^2 + z^2 - 0.001^2 = 0", 1.1),
    row("wire6", "Ring of wire, radius 1e-6", "(x^2 + y^2 - 1)^2 + z^2 - 0.000001^2 = 0", 1.1),
    row("sphere2", "Squared sphere", "(x^2 + y^2 + z^2 - 1)^2 = 0", 1.01),
    row("viviani", "Viviani's curve as a sum of squares", "(x^2 + y^2 + z^2 - 4)^2 + ((x - 1)^2 + y^2 - 1)^2 = 0", 2.2),
    row("circle", "Circle as a sum of squares", "(x^2 + y^2 - 1)^2 + z^2 = 0", 1.1),
    row("pole", "A pole, not a surface", "1 / (x^2 + y^2 + z^2 - 1) = 0", 1.5),
    row("flat", "A solid ball of zeros", "max(0, x^2 + y^2 + z^2 - 1) = 0", 1.5),
];

/// The scene of that name, if there is one.
///
/// # Errors
/// None for the presets as they are (tested); the type is that of formulas.
pub fn preset(name: &str) -> Option<Result<Scene, Error>> {
    let row = PRESETS.iter().find(|p| p.name == name)?;
    let object = |formula| Object::parse(formula, Clip::Box(Box3::cube(row.half)));
    let others: Result<Vec<Object>, Error> = row.others.iter().map(|formula| object(formula)).collect();
    Some(object(row.formula).and_then(|first| {
        let objects = std::iter::once(first).chain(others?).collect();
        let mut scene = framing::scene(row.name.to_owned(), row.title.to_owned(), objects);
        if let Some(stage) = row.stage {
            scene.floor_height = stage.floor;
            scene.view = View { eye: Vec3(stage.eye), target: Vec3::default(), fov_deg: stage.fov_deg };
            scene.lights = vec![Light::white(Rect::horizontal(Vec3(stage.light), stage.side))];
            scene.lights.extend(stage.second);
        }
        Ok(scene)
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_preset_is_a_scene_and_the_papers_surfaces_are_whole() {
        for row in PRESETS {
            let scene = preset(row.name).expect("it is in the table").expect("its formula is right");
            let object = &scene.objects[0];
            if ["orthocircle", "chubs", "kusner", "mcmullen"].contains(&row.name) {
                assert_ne!(object.region(), object.clip(), "{}: the clip is not proved to cut nothing away", row.name);
            }
        }
        assert!(preset("nothing").is_none());
    }
}
