//! Colours. Nothing here is certified; everything that is goes in as numbers and comes out as light.
use crate::geom::{Film, Vec3};

/// What is known of a lit point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Point {
    /// Where it is.
    pub(super) position: Vec3,
    /// Unit normal, turned to the viewer.
    pub(super) normal: Vec3,
    /// Colour of the side that is seen.
    pub(super) color: [f64; 3],
    /// Whether it belongs to the floor.
    pub(super) floor: bool,
    /// Whether f seems to touch 0 there without a change of sign: not proved to be a surface.
    pub(super) touching: bool,
}

/// A light as a point sees it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lamp {
    /// Its middle.
    pub(super) place: Vec3,
    /// Its colour times its strength over pi.
    pub(super) color: [f64; 3],
    /// Fraction of it that is visible.
    pub(super) visible: f64,
}

/// What may be a surface: violet, like nothing else.
const TOUCHING: [f64; 3] = [0.55, 0.20, 0.60];
const FLOOR: [f64; 3] = [0.62, 0.62, 0.64];
/// Fill light from above and from below.
const SKY: [f64; 3] = [0.20, 0.23, 0.28];
const GROUND: [f64; 3] = [0.10, 0.09, 0.085];

/// The backdrop behind everything: a soft grey, lighter around the middle.
pub(super) fn backdrop(film: &Film, column: f64, row: f64) -> [f64; 3] {
    let (w, h) = (film.width as f64, film.height as f64);
    let (x, y) = ((column - 0.5 * w) / w.min(h), (row - 0.45 * h) / w.min(h));
    let fall = 1.0 / (1.0 + 1.1 * (x * x + y * y));
    [0.60, 0.63, 0.67].map(|c| c * fall)
}

/// The colour of a point under lights, seen from `eye`.
pub(super) fn shade(
    p: &Point,
    lights: impl Iterator<Item = Lamp>,
    eye: Vec3,
    backdrop: [f64; 3],
    scale: f64,
) -> [f64; 3] {
    let to_eye = (eye - p.position).normalized();
    let up = 0.5 + 0.5 * p.normal[2];
    let base = match p {
        Point { touching: true, .. } => TOUCHING,
        Point { floor: true, .. } => FLOOR,
        Point { color, .. } => *color,
    };
    let mut color: [f64; 3] = std::array::from_fn(|i| {
        let fill = GROUND[i] + (SKY[i] - GROUND[i]) * up;
        // A thin rim of light where the surface turns away gives shape to the shadows.
        let turned = 1.0 - p.normal.dot(to_eye).abs();
        let rim = 0.10 * turned * turned * turned;
        base[i] * fill + rim * SKY[i]
    });
    for light in lights {
        let to_light = (light.place - p.position).normalized();
        let cosine = p.normal.dot(to_light);
        if cosine > 0.0 {
            let half = (to_light + to_eye).normalized();
            let gloss = if p.floor { 0.0 } else { 0.22 * core_math::pow(p.normal.dot(half).max(0.0), 48.0) };
            (0..3).for_each(|i| color[i] += light.visible * light.color[i] * (base[i] * cosine + gloss));
        }
    }
    if !p.floor {
        return color;
    }
    // The endless floor melts into the backdrop.
    let far = (p.position - eye).length() / (8.0 * scale);
    let fade = (far - 0.6).clamp(0.0, 1.0);
    std::array::from_fn(|i| color[i] + (backdrop[i] - color[i]) * fade)
}
