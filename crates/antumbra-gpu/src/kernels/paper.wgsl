// The paper's method: the grid, one beam per pixel, an initial shadow beam, sub-beams; stackless bisection in the cells of the grid.
// Natural extensions in f32; over the beams of pixels the affine form too, as on the CPU.

struct Paper {
    cells: u32,             // along each axis
    sub_beams: u32,         // along each side of the light
    always: u32,            // 1: sub-beams without an initial beam
    far: f32,               // no surface is met beyond this parameter
    width: f32,             // sections narrower than this are not divided
    offset: f32,            // distance at which shadow beams start
    pad0: u32, pad1: u32,
}
@group(0) @binding(2) var<uniform> paper: Paper;
// Outward bounds of the cells: SURFACES times 3 times `cells`.
@group(0) @binding(3) var<storage, read> slabs: array<vec2<f32>>;
// Per surface and cell, z y x: 1 if the surface may cross it.
@group(0) @binding(4) var<storage, read_write> marked: array<u32>;
// Per pixel: 1 if something may be met; parameters as bits.
@group(0) @binding(5) var<storage, read_write> found: array<vec4<u32>>;
// Per pixel: sub-beams that may be blocked.
@group(0) @binding(6) var<storage, read_write> blocked: array<atomic<u32>>;
// count, then pixels whose initial beam may be blocked.
struct List { count: atomic<u32>, items: array<u32> }
@group(0) @binding(7) var<storage, read_write> list: List;
// Evaluations: of pixels, of initial beams, of sub-beams, the latter in two words.
@group(0) @binding(8) var<storage, read_write> spent: array<atomic<u32>, 4>;

fn possibly_zero(x: vec2<f32>) -> bool { return !(x.x > 0.0 || x.y < 0.0); }

@compute @workgroup_size(64)
fn grid(@builtin(global_invocation_id) id: vec3<u32>) {
    let n = paper.cells;
    if id.x >= SURFACES * n * n * n { return; }
    let surface = id.x / (n * n * n);
    let cell = id.x % (n * n * n);
    let base = surface * 3u * n;
    let x = slabs[base + cell % n];
    let y = slabs[base + n + (cell / n) % n];
    let z = slabs[base + 2u * n + cell / (n * n)];
    marked[id.x] = select(0u, 1u, possibly_zero(range(surface, x, y, z)));
}

// A quotient is off by 2.5 units: up to 5 steps of the finer side of a power of two, and one more.
fn step_by(r: f32, k: i32) -> f32 {
    if abs(r) < MIN_NORMAL { return select(-MIN_NORMAL, MIN_NORMAL, k > 0); }
    return bitcast<f32>(bitcast<i32>(r) + select(k, -k, r < 0.0) * i32(1u + runtime_zero()));
}
fn quotient_down(x: f32, y: f32) -> f32 { return step_by(fence(x / y), -6); }
fn quotient_up(x: f32, y: f32) -> f32 { return step_by(fence(x / y), 6); }

// A beam X = P + T D (paper, section 2).
struct Beam { p: array<vec2<f32>, 3>, d: array<vec2<f32>, 3> }

fn at(b: Beam, axis: u32, t: vec2<f32>) -> vec2<f32> { return i_add(b.p[axis], i_mul(t, b.d[axis])); }

const TINY: f32 = 1e-20;
// Nothing.
const EMPTY = vec2<f32>(1.0, 0.0);
fn meet(a: vec2<f32>, b: vec2<f32>) -> vec2<f32> { return vec2<f32>(max(a.x, b.x), min(a.y, b.y)); }

// T = (V - p) / D for T >= 0 (paper, "Beam Traversal").
fn parameters_in(b: Beam, axis: u32, v: vec2<f32>) -> vec2<f32> {
    var n = i_sub(v, b.p[axis]);
    var d = b.d[axis];
    if n.y < 0.0 { n = i_neg(n); d = i_neg(d); }
    if n.x > 0.0 {
        if d.y <= 0.0 { return EMPTY; }
        var t = vec2<f32>(0.0, paper.far);
        if d.y > TINY { t.x = max(quotient_down(n.x, d.y), 0.0); }
        if d.x > TINY { t.y = min(quotient_up(n.y, d.x), paper.far); }
        return t;
    }
    // 0 is in n.
    if d.x > TINY { return vec2<f32>(0.0, clamp(quotient_up(n.y, d.x), 0.0, paper.far)); }
    if d.y < -TINY { return vec2<f32>(0.0, clamp(quotient_up(n.x, d.y), 0.0, paper.far)); }
    return vec2<f32>(0.0, paper.far);
}

// First cell that does not end before v, and first one behind it that begins after v.
fn cells_meeting(base: u32, v: vec2<f32>) -> vec2<u32> {
    let n = paper.cells;
    let first = slabs[base].x;
    let last = slabs[base + n - 1u].y;
    // A guess, then exact comparisons.
    let scale = f32(n) / (last - first);
    var a = u32(clamp((v.x - first) * scale, 0.0, f32(n)));
    while a < n && slabs[base + a].y < v.x { a++; }
    while a > 0u && slabs[base + a - 1u].y >= v.x { a--; }
    var b = max(a, u32(clamp((v.y - first) * scale, 0.0, f32(n))));
    while b < n && slabs[base + b].x <= v.y { b++; }
    while b > a && slabs[base + b - 1u].x > v.y { b--; }
    return vec2<u32>(a, b);
}

// What a search needs to know besides the beam: the rays of a pixel, if they are to be asked too.
struct Search { rays: bool, ray: Ray }

fn admits_zero(surface: u32, b: Beam, search: Search, t: vec2<f32>, evaluations: ptr<function, u32>) -> bool {
    *evaluations += 1u;
    if !possibly_zero(range(surface, at(b, 0u, t), at(b, 1u, t), at(b, 2u, t))) { return false; }
    if !search.rays { return true; }
    *evaluations += 1u;
    // Middle and half width, the latter enlarged by what both lose.
    let middle = mul(0.5, add(t.x, t.y));
    let half = add(mul(0.5, sub(t.y, t.x)), mul(4.0 * U, t.y));
    return f_sign(field(surface, along(frame.eye.xyz, frame.eye_lo.xyz, frame.eye_e.xyz, search.ray, middle, half))) == 0;
}

// Section number k of 2^level of t; neighbours compute their common edge in the same way.
fn edge(t: vec2<f32>, k: u32, level: u32) -> f32 {
    if k == 1u << level { return t.y; }
    let size = mul(sub(t.y, t.x), bitcast<f32>((127u - level) << 23u));
    return min(add(t.x, mul(size, f32(k))), t.y);
}

// The paper's stackless bisection: ns and cs, counted from 0. EMPTY proves that there is no zero.
fn first_section(surface: u32, b: Beam, search: Search, t: vec2<f32>, evaluations: ptr<function, u32>) -> vec2<f32> {
    if t.y - t.x < paper.width {
        return select(EMPTY, t, admits_zero(surface, b, search, t, evaluations));
    }
    var ns = 1u;
    var cs = 0u;
    loop {
        let part = vec2<f32>(edge(t, cs, ns), edge(t, cs + 1u, ns));
        if admits_zero(surface, b, search, part, evaluations) {
            // Whole numbers up to 2^22 are exact.
            if part.y - part.x < paper.width || ns == 22u { return part; }
            ns += 1u;
            cs *= 2u;
            continue;
        }
        if cs % 2u == 0u {
            cs += 1u;
        } else {
            ns -= 1u;
            cs = cs / 2u + 1u;
            if cs >= (1u << ns) { return EMPTY; }
        }
    }
    return EMPTY;
}

fn mignitude(x: vec2<f32>) -> f32 { return select(min(abs(x.x), abs(x.y)), 0.0, x.x <= 0.0 && x.y >= 0.0); }

// The nearest section in which the beam may meet a surface; with `any`, the first one found.
fn nearest(surface: u32, b: Beam, t: vec2<f32>, search: Search, any: bool, evaluations: ptr<function, u32>) -> vec2<f32> {
    let n = paper.cells;
    let base = surface * 3u * n;
    // The main direction: a heuristic.
    var axis = 0u;
    for (var k = 1u; k < 3u; k++) { if mignitude(b.d[k]) > mignitude(b.d[axis]) { axis = k; } }
    let ascending = b.d[axis].x + b.d[axis].y >= 0.0;
    let u = (axis + 1u) % 3u;
    let v = (axis + 2u) % 3u;
    var stride = array<u32, 3>(1u, n, n * n);
    let reach = cells_meeting(base + axis * n, at(b, axis, t));
    var best = EMPTY;
    for (var k = reach.x; k < reach.y; k++) {
        let index = select(reach.y - 1u - (k - reach.x), k, ascending);
        let row = meet(parameters_in(b, axis, slabs[base + axis * n + index]), t);
        if row.x > row.y { continue; }
        if best.x <= best.y && row.x >= best.x { break; }
        let columns = cells_meeting(base + u * n, at(b, u, row));
        let lines = cells_meeting(base + v * n, at(b, v, row));
        for (var j = lines.x; j < lines.y; j++) {
            for (var i = columns.x; i < columns.y; i++) {
                if marked[surface * n * n * n + index * stride[axis] + i * stride[u] + j * stride[v]] == 0u { continue; }
                var crossing = meet(meet(row, parameters_in(b, u, slabs[base + u * n + i])),
                                    parameters_in(b, v, slabs[base + v * n + j]));
                if best.x <= best.y { crossing.y = min(crossing.y, best.x); }
                if crossing.x > crossing.y { continue; }
                let section = first_section(surface, b, search, crossing, evaluations);
                if section.x <= section.y {
                    if any { return section; }
                    best = section;
                }
            }
        }
    }
    return best;
}

fn around(m: f32, r: f32) -> vec2<f32> {
    let s = add(r, mul(4.0 * U, add(abs(m), r)));
    return vec2<f32>(sub(m, s), add(m, s));
}

@compute @workgroup_size(8, 8)
fn pixels(@builtin(workgroup_id) tile: vec3<u32>, @builtin(local_invocation_id) place: vec3<u32>) {
    let across = (frame.width + 7u) / 8u;
    let number = frame.first + tile.x;
    let column = (number % across) * 8u + place.x;
    let row = (number / across) * 8u + place.y;
    if column >= frame.width || row >= frame.height { return; }
    let index = row * frame.width + column;
    let ray = pixel_ray(index, 1.0);
    var beam: Beam;
    for (var k = 0u; k < 3u; k++) {
        beam.p[k] = around(frame.eye[k], add(abs(frame.eye_lo[k]), frame.eye_e[k]));
        beam.d[k] = around(ray.c[k], add(add(abs(ray.i[k]), abs(ray.j[k])), add(ray.e[k], abs(ray.d[k]))));
    }
    var evaluations = 0u;
    var best = EMPTY;
    for (var k = 0u; k < SURFACES; k++) {
        let t = nearest(k, beam, vec2<f32>(0.0, paper.far), Search(true, ray), false, &evaluations);
        if t.x <= t.y && (best.x > best.y || t.x < best.x) { best = t; }
    }
    found[index] = vec4<u32>(select(0u, 1u, best.x <= best.y), bitcast<u32>(best.x), bitcast<u32>(best.y), evaluations);
    atomicAdd(&spent[0], evaluations);
}

// The point from which shadow beams start, and their parameters.
fn start(index: u32) -> vec3<f32> {
    let it = found[index];
    let t = 0.5 * (bitcast<f32>(it.y) + bitcast<f32>(it.z));
    return frame.eye.xyz + t * pixel_ray(index, 0.0).c;
}

// Whether the beam towards the part (column, row) of n x n of the light may be blocked.
fn possibly_blocked(index: u32, column: u32, row: u32, n: u32, evaluations: ptr<function, u32>) -> bool {
    let p = start(index);
    let begin = paper.offset / length(frame.center.xyz - p);
    if begin > 1.0 { return false; }
    // Half a tile is 1/n of half an edge; the tile is enlarged by all roundings.
    let h = 1.0 / f32(n);
    let m = vec2<f32>(f32(2u * column + 1u) * h - 1.0, f32(2u * row + 1u) * h - 1.0);
    var beam: Beam;
    for (var k = 0u; k < 3u; k++) {
        let edge = abs(frame.edge_u[k]) + abs(frame.edge_v[k]);
        let c = add(add(frame.center[k], mul(m.x, frame.edge_u[k])), mul(m.y, frame.edge_v[k]));
        let r = add(mul(mul(edge, h), 1.0 + 16.0 * U), add(frame.light_e[k], mul(8.0 * U, edge)));
        beam.p[k] = vec2<f32>(p[k], p[k]);
        beam.d[k] = i_sub(around(c, r), beam.p[k]);
    }
    for (var k = 0u; k < SURFACES; k++) {
        let none = vec3<f32>(0.0);
        let t = nearest(k, beam, vec2<f32>(max(begin, 0.0), 1.0), Search(false, Ray(none, none, none, none, none)), true, evaluations);
        if t.x <= t.y { return true; }
    }
    return false;
}

@compute @workgroup_size(64)
fn initial(@builtin(global_invocation_id) id: vec3<u32>) {
    let index = frame.first + id.x;
    if id.x >= frame.count || found[index].x == 0u { return; }
    if paper.always == 0u {
        var evaluations = 0u;
        let hidden = possibly_blocked(index, 0u, 0u, 1u, &evaluations);
        atomicAdd(&spent[1], evaluations);
        if !hidden { return; }
    }
    list.items[atomicAdd(&list.count, 1u)] = index;
}

@compute @workgroup_size(64)
fn sub_beams(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>,
             @builtin(local_invocation_index) local: u32) {
    let n = paper.sub_beams;
    // Counted from the first item of this dispatch, whose host sees to it that the numbers fit.
    let end = (min(frame.first + frame.count, atomicLoad(&list.count)) - frame.first) * n * n;
    var total = 0u;
    for (var number = group.x * 64u + local; number < end; number += groups.x * 64u) {
        let index = list.items[frame.first + number / (n * n)];
        let tile = number % (n * n);
        var evaluations = 0u;
        if possibly_blocked(index, tile % n, tile / n, n, &evaluations) { atomicAdd(&blocked[index], 1u); }
        total += evaluations;
    }
    // With carry.
    let before = atomicAdd(&spent[2], total);
    if before + total < before { atomicAdd(&spent[3], 1u); }
}
