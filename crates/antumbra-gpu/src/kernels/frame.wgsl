// What every certified kernel knows of the picture. All numbers with an error beside them are those of the scene rounded to f32; the errors
// bound what that costs. Parameters t are whole multiples of a power of two below 2^24 of them: exact in f32.

struct Frame {
    zero: u32,              // 0, which the compiler does not know
    width: u32,
    height: u32,
    first: u32,             // first pixel of this dispatch
    count: u32,             // pixels of this dispatch
    begin: u32,             // camera rays are looked at from this multiple of the quantum ...
    end: u32,               // ... to this one
    longest: u32,           // the longest piece, a power of two
    half_quantum: f32,
    half_unit: f32,         // the same for shadow beams, whose parameters go from 0 to 1
    units: u32,             // multiples in [0, 1]
    light: u32,             // index of the light
    eye: vec4<f32>,
    eye_e: vec4<f32>,
    forward: vec4<f32>,
    right: vec4<f32>,       // half a pixel
    up: vec4<f32>,          // half a pixel
    dir_e: vec4<f32>,       // of the direction of any pixel, rounding of its computation included
    center: vec4<f32>,
    edge_u: vec4<f32>,
    edge_v: vec4<f32>,
    light_e: vec4<f32>,     // of any point of the light, rounding included
}

struct Region { clip_lo: vec4<f32>, clip_hi: vec4<f32>, whole_lo: vec4<f32>, whole_hi: vec4<f32> }

@group(0) @binding(0) var<uniform> frame: Frame;
@group(0) @binding(1) var<uniform> regions: array<Region, SURFACES>;

fn runtime_zero() -> u32 { return frame.zero; }

struct Point { x: Form, y: Form, z: Form }
// Directions c + i s_1 + j s_2 +- e, per axis.
struct Ray { c: vec3<f32>, i: vec3<f32>, j: vec3<f32>, e: vec3<f32> }

// P + t D for t = tc +- th: centre P + tc D, linear terms, and the bilinear ones as error.
//
// Steps, each times u ((|tc| + th) (|D| + |i| + |j| + e) + |P|): coefficients 2 + 1 + 1 + 1, error at most 8, size 5, last sums 3.
fn along(p: vec3<f32>, p_e: vec3<f32>, ray: Ray, t: f32, half: f32) -> Point {
    let tc = vec3<f32>(t);
    let th = vec3<f32>(half);
    let c = add3(p, mul3(tc, ray.c));
    let at = mul3(th, ray.c);
    let ai = mul3(tc, ray.i);
    let aj = mul3(tc, ray.j);
    let across = add3(add3(abs(ray.i), abs(ray.j)), ray.e);
    let size = add3(mul3(add3(tc, th), add3(abs(ray.c), across)), abs(p));
    let e = add3(add3(mul3(tc, ray.e), mul3(th, across)), p_e);
    let error = add3(add3(e, mul3(vec3<f32>(24.0 * U), size)), vec3<f32>(F));
    return Point(
        Form(c.x, error.x, vec3<f32>(at.x, ai.x, aj.x)),
        Form(c.y, error.y, vec3<f32>(at.y, ai.y, aj.y)),
        Form(c.z, error.z, vec3<f32>(at.z, ai.z, aj.z)));
}

// The rays of a pixel: forward + x right + y up with the half pixels x = 2 column + 1 - width, exact integers; `spread` is 1 for the
// whole pixel, 0 for its centre.
fn pixel_ray(index: u32, spread: f32) -> Ray {
    let column = index % frame.width;
    let row = index / frame.width;
    let x = f32(i32(2u * column + 1u) - i32(frame.width));
    let y = f32(i32(frame.height) - i32(2u * row + 1u));
    let across = mul3(vec3<f32>(x), frame.right.xyz);
    let above = mul3(vec3<f32>(y), frame.up.xyz);
    let c = add3(add3(frame.forward.xyz, across), above);
    return Ray(c, frame.right.xyz * spread, frame.up.xyz * spread, frame.dir_e.xyz);
}

fn camera_point(ray: Ray, pos: u32, len: u32) -> Point {
    // Exact: whole numbers below 2^24 and a power of two.
    return along(frame.eye.xyz, frame.eye_e.xyz, ray, f32(2u * pos + len) * frame.half_quantum, f32(len) * frame.half_quantum);
}

// Whether all points are certainly outside of the clip of a surface: there is none of it.
fn outside(k: u32, p: Point) -> bool {
    let x = f_range(p.x);
    let y = f_range(p.y);
    let z = f_range(p.z);
    let lo = regions[k].clip_lo;
    let hi = regions[k].clip_hi;
    return x.y < lo.x || x.x > hi.x || y.y < lo.y || y.x > hi.y || z.y < lo.z || z.x > hi.z;
}
// Whether all points are certainly where every zero belongs to the surface.
fn inside(k: u32, p: Point) -> bool {
    let x = f_range(p.x);
    let y = f_range(p.y);
    let z = f_range(p.z);
    let lo = regions[k].whole_lo;
    let hi = regions[k].whole_hi;
    return x.x >= lo.x && x.y <= hi.x && y.x >= lo.y && y.y <= hi.y && z.x >= lo.z && z.y <= hi.z;
}
