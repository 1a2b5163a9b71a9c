//! Colours. Nothing here is certified; everything that is goes in as numbers and comes out as light.
use super::irradiance::irradiance;
use crate::geom::{Film, Vec3};
use crate::scene::{Backdrop, Finish, Light, Sky};

/// What is known of a lit point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Point {
    /// Where it is.
    pub(super) position: Vec3,
    /// Unit normal, turned to the viewer.
    pub(super) normal: Vec3,
    /// Colour of the surface.
    pub(super) color: [f64; 3],
    /// How it throws back light.
    pub(super) finish: Finish,
    /// Whether it belongs to the floor.
    pub(super) floor: bool,
    /// Whether f seems to touch 0 there without a change of sign: not proved to be a surface.
    pub(super) touching: bool,
}

/// A light as a point sees it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lamp<'a> {
    pub(super) light: &'a Light,
    /// Its form factor where it has its full strength.
    pub(super) full: f64,
    /// Fraction of it that is visible; without it, all that is above the horizon.
    pub(super) visible: Option<f64>,
}

/// What may be a surface: violet, like nothing else.
const TOUCHING: [f64; 3] = [0.55, 0.20, 0.60];
const FLOOR: [f64; 3] = [0.62, 0.62, 0.64];

/// The backdrop behind everything: lighter around the middle.
pub(super) fn backdrop(behind: &Backdrop, film: &Film, column: f64, row: f64) -> [f64; 3] {
    let (w, h) = (film.width as f64, film.height as f64);
    let (x, y) = ((column - 0.5 * w) / w.min(h), (row - 0.45 * h) / w.min(h));
    let fall = 1.0 / (1.0 + 1.1 * behind.falloff * (x * x + y * y));
    behind.color.map(|c| c * fall)
}

/// `base^exponent`, within some `2 exponent` roundings: much faster than a correctly rounded power.
fn power(mut base: f64, mut exponent: u32) -> f64 {
    let mut product = 1.0;
    while exponent > 0 {
        if exponent % 2 == 1 {
            product *= base;
        }
        base *= base;
        exponent /= 2;
    }
    product
}

/// The colour of a point under lights, seen from a camera (`eye` and `target`).
pub(super) fn shade<'a>(
    p: &Point,
    lights: impl Iterator<Item = Lamp<'a>>,
    sky: &Sky,
    [eye, target]: [Vec3; 2],
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
    // A thin rim of light where the surface turns away gives shape to the shadows.
    let turned = 1.0 - p.normal.dot(to_eye).abs();
    let rim = 0.10 * turned * turned * turned;
    let mut color: [f64; 3] = std::array::from_fn(|i| {
        let fill = sky.below[i] + (sky.above[i] - sky.below[i]) * up;
        base[i] * fill + rim * sky.above[i]
    });
    let reflection = if p.floor { Finish::Matte } else { p.finish }.reflection();
    for lamp in lights {
        let got = irradiance(p.position, p.normal, &lamp.light.rect);
        if got.above <= 0.0 {
            continue;
        }
        // The visible fraction counts what the horizon cuts off, and so does the form factor: once is enough.
        let visible = lamp.visible.map_or(1.0, |visible| (visible / got.above).min(1.0));
        let diffuse = reflection.diffuse * visible * got.form / lamp.full;
        let gloss = if reflection.strength > 0.0 {
            let to_light = (lamp.light.rect.center - p.position).normalized();
            let half = (to_light + to_eye).normalized();
            reflection.strength * power(p.normal.dot(half).max(0.0), reflection.exponent)
        } else {
            0.0
        };
        for i in 0..3 {
            let tint = 1.0 + (base[i] - 1.0) * reflection.tint;
            color[i] += lamp.light.color[i] * (base[i] * diffuse + visible * gloss * tint);
        }
    }
    if !p.floor {
        return color;
    }
    // The endless floor melts into the backdrop. How far away the camera itself is does not count, beyond the usual.
    let aside = ((eye - target).length() - 6.0 * scale).max(0.0);
    let far = ((p.position - eye).length() - aside) / (8.0 * scale);
    let fade = (far - 0.6).clamp(0.0, 1.0);
    std::array::from_fn(|i| color[i] + (backdrop[i] - color[i]) * fade)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_are_powers() {
        for exponent in [0, 1, 2, 36, 48, 220] {
            for base in [0.0, 0.3, 0.97, 1.0] {
                let (got, want) = (power(base, exponent), core_math::pow(base, f64::from(exponent)));
                assert!((got - want).abs() <= 1e-13 * want, "{base}^{exponent}: {got}, not {want}");
            }
        }
    }
}
