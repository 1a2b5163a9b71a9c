//! A scene as kernels see it: formulas as text, numbers rounded outward.
use crate::error::Error;
use antumbra::eval::wgsl::{self, FLOOR, Kind, Reach, Width, ball, outward};
use antumbra::geom::{Clip, Film, Rect, Vec3};
use antumbra::tape::Tape;
use antumbra::trace::Surface;
use antumbra_interval::Interval;
use bytemuck::{Pod, Zeroable};
use std::fmt::Write;

/// `Frame` of `frame.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct Frame {
    pub(crate) zero: u32,
    pub(crate) width: u32,
    pub(crate) height: u32,
    pub(crate) first: u32,
    pub(crate) count: u32,
    pub(crate) begin: u32,
    pub(crate) end: u32,
    pub(crate) longest: u32,
    pub(crate) half_quantum: f32,
    pub(crate) half_unit: f32,
    pub(crate) units: u32,
    pub(crate) base: u32,
    pub(crate) ticket: u32,
    pub(crate) series: u32,
    pub(crate) pad: [u32; 2],
    pub(crate) eye: [f32; 4],
    pub(crate) eye_e: [f32; 4],
    pub(crate) forward: [f32; 4],
    pub(crate) right: [f32; 4],
    pub(crate) up: [f32; 4],
    pub(crate) eye_lo: [f32; 4],
    pub(crate) forward_lo: [f32; 4],
    pub(crate) right_lo: [f32; 4],
    pub(crate) up_lo: [f32; 4],
    pub(crate) dir_e: [f32; 4],
    pub(crate) center: [f32; 4],
    pub(crate) edge_u: [f32; 4],
    pub(crate) edge_v: [f32; 4],
    pub(crate) light_e: [f32; 4],
}

/// `Region` of `frame.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct Region {
    clip_lo: [f32; 4],
    clip_hi: [f32; 4],
    whole_lo: [f32; 4],
    whole_hi: [f32; 4],
}

/// The unit of rounding, 2^-23.
const U: f64 = f32::EPSILON as f64;
/// Beyond this nothing is looked at.
const FAR: f32 = 1e30;
/// Multiples of the quantum that parameters of shadow beams have: 2^20.
const UNITS: u32 = 1 << 20;
/// Most surfaces of a scene.
const MOST: usize = 8;

fn vec4(v: [f32; 3]) -> [f32; 4] {
    [v[0], v[1], v[2], 0.0]
}

fn round(v: Vec3) -> [f32; 4] {
    vec4(v.0.map(|x| ball(Interval::point(x)).0))
}

/// A float at least as large as `r`, and as [`FLOOR`].
fn bound(r: f64) -> f32 {
    outward(Interval::point(r))[1].max(FLOOR)
}

fn errors(of: impl Fn(usize) -> f64) -> [f32; 4] {
    vec4(std::array::from_fn(|k| bound(of(k))))
}

impl Region {
    fn of(surface: &Surface<'_>) -> Self {
        let (mut clip_lo, mut clip_hi) = ([-FAR; 4], [FAR; 4]);
        let (mut whole_lo, mut whole_hi) = ([-FAR; 4], [FAR; 4]);
        let clip = surface.clip.bounds();
        let whole = match surface.region {
            // A box inside the ball: half its side is at most r / sqrt(3).
            Clip::Ball { center, radius } => {
                center.0.map(|c| Interval::point(c) + Interval::new(-0.577 * radius, 0.577 * radius))
            }
            other => other.bounds().0,
        };
        let finite = |v: f32| v.clamp(-FAR, FAR);
        for k in 0..3 {
            // The clip outward, the region inward.
            [clip_lo[k], clip_hi[k]] = outward(clip[k]).map(finite);
            let [lo, hi] = outward(whole[k]).map(finite);
            // Never subnormal: such a bound might be taken for 0.
            let normal = |v: f32, tiny: f32| if v.is_subnormal() { tiny } else { v };
            whole_lo[k] = normal(lo.next_up(), f32::MIN_POSITIVE);
            whole_hi[k] = normal(hi.next_down(), -f32::MIN_POSITIVE);
        }
        Self { clip_lo, clip_hi, whole_lo, whole_hi }
    }
}

/// The numbers of a picture: scene, film, and none or one light.
pub(crate) fn frame(surfaces: &[Surface<'_>], film: &Film) -> Result<(Frame, Vec<Region>), Error> {
    let camera = &film.camera;
    let (right, up) = (camera.right * (1.0 / film.width as f64), camera.up * (1.0 / film.height as f64));
    // Whole multiples of 2^-22 and what they leave: differences of numbers that near are exact in f64.
    let coarse = |v: Vec3| Vec3(v.0.map(|x| (x * 4_194_304.0).round() / 4_194_304.0));
    let rest = |v: Vec3| v - coarse(v);
    if [camera.forward, camera.right, camera.up].iter().any(|v| v.0.iter().any(|x| x.abs() > 1.3)) {
        return Err(Error::Scene("a camera as wide as this one stays on the processor"));
    }
    // Of the small parts, for all pixels: below 2^-23 (1 + width + height) each. Roundings of the vectors (1/2 each), two products, two sums;
    // and what half pixels lose. Dividing by the size of the film took another 2^-52 of the pixel.
    let (width, height) = (film.width as f64, film.height as f64);
    let size = |k: usize| {
        let parts = rest(camera.forward)[k].abs() + width * rest(right)[k].abs() + height * rest(up)[k].abs();
        let whole = camera.forward[k].abs() + camera.right[k].abs() + camera.up[k].abs();
        6.0 * U * parts + 2.0 * U * (right[k].abs() + up[k].abs()) + 1e-15 * whole
    };
    let eye = Vec3(camera.eye.0.map(|x| f64::from(ball(Interval::point(x)).0)));
    let fan = film.fan(0..film.width, 0..film.height);
    let directions = fan.directions();
    let mut reach = Interval::EMPTY;
    for surface in surfaces {
        reach = reach.hull(surface.passage(&fan.apex, &directions).outer);
    }
    // Nothing in sight: any stretch will do.
    let reach = if reach.is_empty() { Interval::new(0.0, 1.0) } else { reach };
    if reach.hi() > 1e6 {
        return Err(Error::Scene("the scene is not bounded"));
    }
    // The quantum: a power of two, the end below 2^22 of them.
    let mut quantum = 1.0 / 16_777_216.0;
    while reach.hi() > 4_000_000.0 * quantum {
        quantum *= 2.0;
    }
    let begin = (reach.lo() / quantum).floor().max(1.0) as u32 - 1;
    let end = (reach.hi() / quantum).ceil() as u32 + 1;
    let longest = ((end - begin) / 4).next_power_of_two().min(1 << 21);
    let frame = Frame {
        zero: 0,
        width: film.width as u32,
        height: film.height as u32,
        first: 0,
        count: 0,
        begin,
        end,
        longest,
        half_quantum: (0.5 * quantum) as f32,
        half_unit: 0.5 / UNITS as f32,
        units: UNITS,
        base: 0,
        ticket: 0,
        series: 0,
        pad: [0; 2],
        eye: round(camera.eye),
        eye_e: errors(|k| U * (camera.eye[k] - eye[k]).abs() + 1e-15 * camera.eye[k].abs()),
        forward: round(coarse(camera.forward)),
        right: round(coarse(right)),
        up: round(coarse(up)),
        eye_lo: round(camera.eye - eye),
        forward_lo: round(rest(camera.forward)),
        right_lo: round(rest(right)),
        up_lo: round(rest(up)),
        dir_e: errors(size),
        center: [0.0; 4],
        edge_u: [0.0; 4],
        edge_v: [0.0; 4],
        light_e: [FLOOR; 4],
    };
    Ok((frame, surfaces.iter().map(Region::of).collect()))
}

/// Seals the regions.
pub(crate) fn seal(regions: &mut [Region]) -> u32 {
    let seal = crate::receipt::seal();
    // Whole numbers below 2^24 are exact.
    regions[0].clip_lo[3] = seal as f32;
    seal
}

/// Numbers as a kernel of that width reads them from uniform memory.
pub(crate) trait Upload: Pod {
    /// Its words as f64, in the layout that f64 has.
    fn double(&self) -> Vec<u8>;

    /// Its bytes.
    fn bytes(&self, width: Width) -> Vec<u8> {
        match width {
            Width::Single => bytemuck::bytes_of(self).to_vec(),
            Width::Double => self.double(),
        }
    }
}

fn widened(words: &[f32]) -> impl Iterator<Item = u8> {
    words.iter().flat_map(|word| f64::from(*word).to_le_bytes())
}

impl Upload for Frame {
    fn double(&self) -> Vec<u8> {
        let words: &[u32] = bytemuck::cast_slice(bytemuck::bytes_of(self));
        let whole = |words: &[u32]| words.iter().flat_map(|word| word.to_le_bytes()).collect::<Vec<u8>>();
        let mut out = whole(&words[..8]);
        out.extend(widened(bytemuck::cast_slice(&words[8..10])));
        out.extend(whole(&words[10..16]));
        // Vectors of four f64 begin at multiples of 32.
        out.resize(out.len().next_multiple_of(32), 0);
        out.extend(widened(bytemuck::cast_slice(&words[16..])));
        out
    }
}

impl Upload for Region {
    fn double(&self) -> Vec<u8> {
        widened(bytemuck::cast_slice(bytemuck::bytes_of(self))).collect()
    }
}

impl Frame {
    /// Multiples of this are the parameters of camera rays.
    pub(crate) fn quantum(&self) -> f64 {
        2.0 * f64::from(self.half_quantum)
    }

    /// Rows of the bands that it is drawn in, whole tiles of 8 x 8 pixels: of at most so many pixels, if that makes 8 rows.
    pub(crate) fn band(&self, pixels: u32) -> u32 {
        (pixels / self.width / 8 * 8).max(8).min(self.height)
    }

    /// The same picture under that light.
    pub(crate) fn lit_by(self, light: &Rect) -> Self {
        let size = |k: usize| 0.5 * light.center[k].abs() + light.edge_u[k].abs() + light.edge_v[k].abs();
        Self {
            center: round(light.center),
            edge_u: round(light.edge_u),
            edge_v: round(light.edge_v),
            // Roundings of the vectors (1/2 each), two products, two sums: u (5/2 |C| + 9/2 |U| + 7/2 |V|).
            light_e: errors(|k| 6.0 * U * size(k)),
            ..self
        }
    }
}

/// Magnitudes that coordinates and directions of any beam stay below, per axis.
fn magnitudes(frame: &Frame, film: &Film, lights: &[Rect]) -> [f64; 3] {
    let far = frame.quantum() * f64::from(frame.end + frame.longest);
    std::array::from_fn(|k| {
        let c = &film.camera;
        let seen = c.eye[k].abs() + far * (c.forward[k].abs() + c.right[k].abs() + c.up[k].abs());
        let light = |l: &Rect| l.center[k].abs() + l.edge_u[k].abs() + l.edge_v[k].abs();
        // Form over a piece: at most twice the distance there; a direction, at most once; and much to spare.
        4.0 * (seen + lights.iter().map(light).fold(0.0, f64::max)) + 1.0
    })
}

/// Formulas of the surfaces as WGSL, in the kinds of number that are wanted.
///
/// # Errors
/// Why they stay on the CPU.
pub(crate) fn functions(
    surfaces: &[Surface<'_>],
    width: Width,
    kinds: &[Kind],
    frame: &Frame,
    film: &Film,
    lights: &[Rect],
) -> Result<String, Error> {
    if surfaces.is_empty() || surfaces.len() > MOST {
        return Err(Error::Scene("a scene on the GPU has 1 to 8 surfaces"));
    }
    let mut reach = magnitudes(frame, film, lights);
    if kinds.contains(&Kind::Interval) {
        // Cells of a grid fill the clip, wherever the camera looks.
        let clips = surfaces.iter().map(|s| s.clip.bounds());
        clips.for_each(|clip| (0..3).for_each(|k| reach[k] = reach[k].max(2.0 * clip[k].magnitude())));
    }
    // Where a formula does not use an axis nothing else asks; far places have no 32-bit numbers around them.
    if !reach.iter().all(|m| *m < f64::from(FAR) / 4.0) {
        return Err(Error::Scene("coordinates as large as these are not for 32-bit numbers"));
    }
    let beyond = surfaces.iter().filter_map(|s| s.function.as_tape()).any(wgsl::needs_functions);
    // Whether there is more than `+ - *`, abs, min and max.
    let mut text = format!("const SURFACES = {}u;\nconst FUNCTIONS = {beyond};\n", surfaces.len());
    if beyond {
        text.push_str(wgsl::FUNCTIONS);
        if kinds.contains(&Kind::Interval) {
            text.push_str(wgsl::INTERVAL_FUNCTIONS);
        }
    }
    let mut choose: Vec<String> = vec![String::new(); kinds.len()];
    for (k, surface) in surfaces.iter().enumerate() {
        let tape: &Tape = surface.function.as_tape().ok_or(wgsl::Refusal::NoFormula)?;
        for (kind, choose) in kinds.iter().zip(&mut choose) {
            let name = format!("{}{k}", name(*kind));
            text.push_str(&wgsl::function_of(tape, &name, *kind, width)?);
            let last = k + 1 == surfaces.len();
            let label = if last { "default".to_owned() } else { format!("case {k}u") };
            writeln!(choose, "        {label}: {{ return {}; }}", call(*kind, &name)).expect("strings take any text");
        }
        Reach::check(tape, reach, reach)?;
        if !tape.is_continuous_everywhere() {
            return Err(Error::Scene("a formula that is not continuous everywhere stays on the CPU"));
        }
    }
    for (kind, choose) in kinds.iter().zip(choose) {
        let head = match kind {
            Kind::Form => "fn field(k: u32, p: Point) -> Form",
            Kind::Slope => "fn slope(k: u32, x: Slope, y: Slope, z: Slope) -> Form",
            Kind::Interval => "fn range(k: u32, x: vec2<f32>, y: vec2<f32>, z: vec2<f32>) -> vec2<f32>",
        };
        write!(text, "{head} {{\n    switch k {{\n{choose}    }}\n}}\n").expect("strings take any text");
    }
    Ok(text)
}

fn name(kind: Kind) -> &'static str {
    match kind {
        Kind::Form => "form",
        Kind::Slope => "slope",
        Kind::Interval => "interval",
    }
}

fn call(kind: Kind, name: &str) -> String {
    match kind {
        Kind::Form => format!("{name}(p.x, p.y, p.z)"),
        Kind::Slope => format!("{name}(x, y, z).g"),
        Kind::Interval => format!("{name}(x, y, z)"),
    }
}
