// What every certified kernel knows of the picture. All numbers with an error beside them are those of the scene rounded to f32; the errors
// bound what that costs. Parameters t are whole multiples of a power of two below 2^24 of them: exact in f32.

struct Frame {
    zero: u32,              // 0, which the compiler does not know
    width: u32,
    height: u32,
    first: u32,             // first tile, pixel of the band, or item of this dispatch
    count: u32,             // so many
    begin: u32,             // camera rays are looked at from this multiple of the quantum ...
    end: u32,               // ... to this one
    longest: u32,           // the longest piece, a power of two
    half_quantum: f32,
    half_unit: f32,         // the same for shadow beams, whose parameters go from 0 to 1
    units: u32,             // multiples in [0, 1]
    base: u32,              // first pixel of the band that is in memory
    ticket: u32,            // of the first group of this dispatch
    series: u32,            // number of the band and the light: what is put on lists bears it
    pad0: u32, pad1: u32,
    eye: vec4<f32>,
    eye_e: vec4<f32>,
    forward: vec4<f32>,
    right: vec4<f32>,       // half a pixel
    up: vec4<f32>,          // half a pixel
    // What the five vectors lose by rounding, as floats; `forward`, `right` and `up` are whole multiples of 2^-22.
    eye_lo: vec4<f32>,
    forward_lo: vec4<f32>,
    right_lo: vec4<f32>,
    up_lo: vec4<f32>,
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

// What the kernels account for.
struct Account {
    receipts: atomic<u32>,      // the sum of the hashes of the tickets of all groups that are done
    evaluations: atomic<u32>,   // of lights
}
@group(0) @binding(9) var<storage, read_write> account: Account;

fn hash(ticket: u32) -> u32 {
    var x = (ticket ^ (ticket >> 16u)) * 0x85ebca6bu;
    x = (x ^ (x >> 13u)) * 0xc2b2ae35u;
    return x ^ (x >> 16u);
}

// The seal of the regions, a whole number.
fn region_seal() -> u32 { return u32(regions[0].clip_lo.w); }

// What a group does last, all its threads together: without it nothing that they have written is believed. `seal` is that of all that they have read
// and the host has written once.
fn sign_off(group: u32, local: u32, seal: u32) {
    storageBarrier();
    if local == 0u { atomicAdd(&account.receipts, hash(frame.ticket + group + seal)); }
}

struct Point { x: Form, y: Form, z: Form }
// Directions c + d + i s_1 + j s_2 +- e, per axis; d is small.
struct Ray { c: vec3<f32>, d: vec3<f32>, i: vec3<f32>, j: vec3<f32>, e: vec3<f32> }

// (p + q) + t D for t = tc +- th, |error of p + q| <= p_e: the centre, linear terms, and the bilinear ones as error.
//
// With T = fl(tc c), S = fl(q + fl(tc d)): the centre is off by u (|T| + |p + T| + |tc d| + |S| + |centre|), the coefficients by u times themselves;
// |p + T| <= |centre| + |S|. What is added up in the error loses less than 16 u of itself, and 1.25 covers the roundings of the bound.
fn along(p: vec3<f32>, q: vec3<f32>, p_e: vec3<f32>, ray: Ray, t: f32, half: f32) -> Point {
    let tc = vec3<f32>(t);
    let th = vec3<f32>(half);
    let large = mul3(tc, ray.c);
    let small = add3(q, mul3(tc, ray.d));
    let c = add3(add3(p, large), small);
    let at = mul3(th, ray.c);
    let ai = mul3(tc, ray.i);
    let aj = mul3(tc, ray.j);
    let across = add3(add3(abs(ray.i), abs(ray.j)), add3(ray.e, abs(ray.d)));
    let linear = add3(add3(abs(at), abs(ai)), abs(aj));
    let little = add3(abs(q), mul3(tc, abs(ray.d)));
    let size = add3(add3(abs(large), 2.0 * abs(c)), add3(linear, 4.0 * little));
    let e = add3(add3(mul3(tc, ray.e), mul3(th, across)), p_e);
    let padded = add3(mul3(e, vec3<f32>(1.0 + 16.0 * U)), mul3(vec3<f32>(1.25 * U), size));
    let error = add3(padded, vec3<f32>(F));
    return Point(
        Form(c.x, error.x, vec3<f32>(at.x, ai.x, aj.x)),
        Form(c.y, error.y, vec3<f32>(at.y, ai.y, aj.y)),
        Form(c.z, error.z, vec3<f32>(at.z, ai.z, aj.z)));
}

// The rays of a pixel: forward + x right + y up with the half pixels x = 2 column + 1 - width, exact integers; `spread` is 1 for the
// whole pixel, 0 for its centre. The sum of the large parts is exact: whole multiples of 2^-22 below 4.
fn pixel_ray(index: u32, spread: f32) -> Ray {
    let column = index % frame.width;
    let row = index / frame.width;
    let x = vec3<f32>(f32(i32(2u * column + 1u) - i32(frame.width)));
    let y = vec3<f32>(f32(i32(frame.height) - i32(2u * row + 1u)));
    let c = add3(add3(frame.forward.xyz, mul3(x, frame.right.xyz)), mul3(y, frame.up.xyz));
    let d = add3(add3(frame.forward_lo.xyz, mul3(x, frame.right_lo.xyz)), mul3(y, frame.up_lo.xyz));
    let i = add3(frame.right.xyz, frame.right_lo.xyz) * spread;
    let j = add3(frame.up.xyz, frame.up_lo.xyz) * spread;
    return Ray(c, d, i, j, frame.dir_e.xyz);
}

fn camera_point(ray: Ray, pos: u32, len: u32) -> Point {
    // Exact: whole numbers below 2^24 and a power of two.
    let t = f32(2u * pos + len) * frame.half_quantum;
    return along(frame.eye.xyz, frame.eye_lo.xyz, frame.eye_e.xyz, ray, t, f32(len) * frame.half_quantum);
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
