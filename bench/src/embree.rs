//! Marching over a grid of 256^3 samples, and Embree's rays on the mesh.
use crate::Skipped;
use crate::surfaces::Surface;
use antumbra::geom::Rect;

/// Samples along each side of the grid.
pub(crate) const GRID: u32 = 256;

/// What one run took, in CPU seconds, and the visible share of the light at each pixel; NaN where the mesh is not hit.
pub(crate) struct Run {
    pub(crate) mesh: f64,
    pub(crate) hierarchy: f64,
    pub(crate) rays: f64,
    pub(crate) visible: Vec<f32>,
}

/// Where rays come from: their origin, and a direction for each pixel.
pub(crate) struct Rays {
    pub(crate) eye: [f32; 3],
    pub(crate) directions: Vec<[f32; 3]>,
}

#[cfg(not(embree))]
pub(crate) fn run(_: &Surface, _: &Rays, _: &Rect) -> Result<Run, Skipped> {
    Err(Skipped("Embree 3 was not there when this program was built (Debian: libembree-dev)".to_owned()))
}

#[cfg(embree)]
pub(crate) use real::run;

#[cfg(embree)]
mod real {
    use super::{GRID, Rays, Rect, Run, Skipped, Surface};
    use cpu_time::ThreadTime;
    use fast_surface_nets::{SurfaceNetsBuffer, surface_nets};
    use ndshape::{ConstShape, ConstShape3u32};

    /// Rays begin at this part of the way to the light: nearer, triangles shade their own neighbours.
    const BIAS: f32 = 1e-3;

    enum Scene {}

    unsafe extern "C" {
        fn embree_build(p: *const f32, vertices: usize, t: *const u32, triangles: usize) -> *mut Scene;
        fn embree_free(scene: *mut Scene);
        fn embree_hits(scene: *mut Scene, eye: *const f32, directions: *const f32, n: usize, t: *mut f32);
        fn embree_visible(s: *mut Scene, points: *const f32, n: usize, targets: *const f32, bias: f32, share: *mut f32);
    }

    /// A mesh of the surface in the cube `[-half, half]^3`: positions and triangles.
    fn mesh(surface: &Surface) -> (Vec<[f32; 3]>, Vec<u32>) {
        type Shape = ConstShape3u32<GRID, GRID, GRID>;
        let half = surface.half;
        let step = 2.0 * half / (GRID - 1) as f32;
        let mut samples = vec![0.0f32; Shape::USIZE];
        for (i, value) in samples.iter_mut().enumerate() {
            let [x, y, z] = Shape::delinearize(i as u32).map(|k| f64::from(k as f32 * step - half));
            *value = (surface.value)(x, y, z) as f32;
        }
        let mut buffer = SurfaceNetsBuffer::default();
        surface_nets(&samples, &Shape {}, [0; 3], [GRID - 1; 3], &mut buffer);
        let place = |p: &[f32; 3]| p.map(|c| c * step - half);
        (buffer.positions.iter().map(place).collect(), buffer.indices)
    }

    pub(crate) fn run(surface: &Surface, rays: &Rays, light: &Rect) -> Result<Run, Skipped> {
        let begin = ThreadTime::now();
        let (positions, indices) = mesh(surface);
        let mesh = begin.elapsed().as_secs_f64();
        let begin = ThreadTime::now();
        // SAFETY: the arrays hold 3 numbers for each vertex and triangle, and Embree copies them.
        let scene =
            unsafe { embree_build(positions.as_ptr().cast(), positions.len(), indices.as_ptr(), indices.len() / 3) };
        if scene.is_null() {
            return Err(Skipped("Embree would not build a scene".to_owned()));
        }
        let hierarchy = begin.elapsed().as_secs_f64();
        let n = rays.directions.len();
        let mut t = vec![0.0f32; n];
        // SAFETY: `n` directions in, `n` parameters out.
        unsafe { embree_hits(scene, rays.eye.as_ptr(), rays.directions.as_ptr().cast(), n, t.as_mut_ptr()) };
        let hit: Vec<usize> = (0..n).filter(|i| t[*i] >= 0.0).collect();
        let point = |i: &usize| std::array::from_fn::<f32, 3, _>(|k| rays.eye[k] + t[*i] * rays.directions[*i][k]);
        let points: Vec<[f32; 3]> = hit.iter().map(point).collect();
        let place = |k: usize| (2 * k + 1) as f64 / 7.0 - 1.0;
        let target = |k: usize| light.point(place(k % 7), place(k / 7)).0.map(|c| c as f32);
        let targets: Vec<[f32; 3]> = (0..49).map(target).collect();
        let mut share = vec![0.0f32; points.len()];
        let begin = ThreadTime::now();
        // SAFETY: as many points as shares; 49 targets.
        unsafe {
            embree_visible(
                scene,
                points.as_ptr().cast(),
                points.len(),
                targets.as_ptr().cast(),
                BIAS,
                share.as_mut_ptr(),
            );
        }
        let rays_seconds = begin.elapsed().as_secs_f64();
        // SAFETY: built above, freed once.
        unsafe { embree_free(scene) };
        let mut visible = vec![f32::NAN; n];
        hit.iter().zip(share).for_each(|(i, share)| visible[*i] = share);
        Ok(Run { mesh, hierarchy, rays: rays_seconds, visible })
    }
}
