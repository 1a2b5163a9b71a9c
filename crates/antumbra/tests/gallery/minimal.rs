//! Mean curvature: zero for the exact minimal surfaces, not for the trigonometric approximations.
use super::field::{Field, apply, random_point};
use fastrand::Rng;

/// Largest mean curvature at random points of the surface, times the size of the region.
fn mean_curvature(name: &'static str, half: f64) -> f64 {
    let f = Field::of(name);
    let mut r = Rng::with_seed(3);
    let mut most = 0.0_f64;
    let mut seen = 0;
    while seen < 100 {
        let Some(p) = f.near(random_point(&mut r, half)).filter(|p| p.length() < 2.0 * half) else { continue };
        let (g, h) = (f.gradient(p), f.hessian(p));
        let trace = h[0][0] + h[1][1] + h[2][2];
        // 2 H = (g.h g - |g|^2 trace h) / |g|^3
        let twice = (g.dot(apply(&h, g)) - g.dot(g) * trace) / (g.dot(g) * g.length());
        most = most.max((0.5 * twice * half).abs());
        seen += 1;
    }
    most
}

#[test]
fn minimal_surfaces_have_no_mean_curvature() {
    for (name, half) in [("catenoid", 1.3), ("helicoid", 2.0), ("scherk-tower", 2.0)] {
        let h = mean_curvature(name, half);
        assert!(h < 1e-6, "{name}: {h}");
    }
}

/// What their histories say: the usual formulas of the periodic ones are only near.
#[test]
fn approximations_have_a_little() {
    for name in ["gyroid", "schwarz-p", "schwarz-d", "neovius"] {
        let h = mean_curvature(name, 3.0);
        assert!((0.01..3.0).contains(&h), "{name}: {h}");
    }
}
