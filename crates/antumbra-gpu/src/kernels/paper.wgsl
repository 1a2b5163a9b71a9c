// The paper's method: the grid, one beam per pixel, an initial shadow beam, sub-beams; stackless bisection in the cells of the grid.
// Natural extensions in f32; over the beams of pixels the affine form too, as on the CPU.

struct Paper {
    cells: u32,             // along each axis
    sub_beams: u32,         // along each side of the light
    always: u32,            // 1: sub-beams without an initial beam
    far: f32,               // no surface is met beyond this parameter
    width: f32,             // sections narrower than this are not divided
    offset: f32,            // distance at which shadow beams start
    seal: u32,
    pad: u32,
}
@group(0) @binding(2) var<uniform> paper: Paper;
// Outward bounds of the cells: SURFACES times 3 times `cells`; and a seal.
@group(0) @binding(3) var<storage, read> slabs: array<vec2<f32>>;
// Per surface and cell, z y x, a bit: whether the surface may cross it.
@group(0) @binding(4) var<storage, read_write> marked: array<u32>;
// Per pixel of the band: 1 + the surface that may be met, or NOTHING; parameters as bits; evaluations.
@group(0) @binding(5) var<storage, read_write> found: array<vec4<u32>>;
// Per pixel of the band, four words: what its light is, plus 256 for each 2^32 evaluations of sub-beams; evaluations of the initial beam; sub-beams
// that may be blocked; evaluations of the sub-beams. Stored by `initial`, then added to.
@group(0) @binding(6) var<storage, read_write> shade: array<atomic<u32>>;
// Pixels whose sub-beams are traced, with the series.
struct List { count: atomic<u32>, pad: u32, items: array<vec2<u32>> }
@group(0) @binding(7) var<storage, read_write> list: List;

// What nobody has written is 0, and no answer.
const NOTHING = 255u;       // no ray of the pixel meets anything
const NEAR = 1u;            // the light is nearer than the offset: nothing lies between
const FREE = 2u;            // the initial beam meets nothing
const BLOCKED = 3u;         // it may meet something: sub-beams
const ALWAYS = 4u;          // sub-beams without an initial beam

fn seal() -> u32 { return region_seal() + paper.seal + u32(slabs[arrayLength(&slabs) - 1u].x); }

fn possibly_zero(x: vec2<f32>) -> bool { return !(x.x > 0.0 || x.y < 0.0); }

fn crossed(number: u32) -> bool {
    let n = paper.cells;
    let surface = number / (n * n * n);
    let cell = number % (n * n * n);
    let base = surface * 3u * n;
    let x = slabs[base + cell % n];
    let y = slabs[base + n + (cell / n) % n];
    let z = slabs[base + 2u * n + cell / (n * n)];
    return possibly_zero(range(surface, x, y, z));
}

// A thread for 32 cells.
@compute @workgroup_size(64)
fn grid(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let word = frame.first + 64u * group.x + local;
    let cells = SURFACES * paper.cells * paper.cells * paper.cells;
    if word < arrayLength(&marked) {
        var bits = 0u;
        for (var k = 0u; k < 32u; k++) {
            let number = 32u * word + k;
            if number < cells && crossed(number) { bits |= 1u << k; }
        }
        marked[word] = bits;
    }
    sign_off(group.x, local, seal());
}

fn possibly_crossed(number: u32) -> bool { return ((marked[number / 32u] >> (number % 32u)) & 1u) == 1u; }

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
    var a = min(u32(clamp((v.x - first) * scale, 0.0, f32(n))), n);
    while a < n && slabs[base + a].y < v.x { a++; }
    while a > 0u && slabs[base + a - 1u].y >= v.x { a--; }
    var b = max(a, min(u32(clamp((v.y - first) * scale, 0.0, f32(n))), n));
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
                if !possibly_crossed(surface * n * n * n + index * stride[axis] + i * stride[u] + j * stride[v]) { continue; }
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

fn pixel(index: u32) -> vec4<u32> {
    let ray = pixel_ray(index, 1.0);
    var beam: Beam;
    for (var k = 0u; k < 3u; k++) {
        beam.p[k] = around(frame.eye[k], add(abs(frame.eye_lo[k]), frame.eye_e[k]));
        beam.d[k] = around(ray.c[k], add(add(abs(ray.i[k]), abs(ray.j[k])), add(ray.e[k], abs(ray.d[k]))));
    }
    var evaluations = 0u;
    var best = EMPTY;
    var met = NOTHING;
    for (var k = 0u; k < SURFACES; k++) {
        let t = nearest(k, beam, vec2<f32>(0.0, paper.far), Search(true, ray), false, &evaluations);
        if t.x <= t.y && (met == NOTHING || t.x < best.x) { best = t; met = k + 1u; }
    }
    return vec4<u32>(met, bitcast<u32>(best.x), bitcast<u32>(best.y), evaluations);
}

@compute @workgroup_size(8, 8)
fn pixels(@builtin(workgroup_id) tile: vec3<u32>, @builtin(local_invocation_id) place: vec3<u32>,
          @builtin(local_invocation_index) local: u32) {
    let across = (frame.width + 7u) / 8u;
    let number = frame.first + tile.x;
    let column = (number % across) * 8u + place.x;
    let row = (number / across) * 8u + place.y;
    if column < frame.width && row < frame.height {
        let index = row * frame.width + column;
        found[index - frame.base] = pixel(index);
    }
    sign_off(tile.x, local, seal());
}

// The point from which shadow beams start: the middle of the section, on the centre ray. The same one for the initial beam and for sub-beams,
// which are other kernels: so nothing here is left to their compilers.
fn start(index: u32) -> vec3<f32> {
    let it = found[index];
    let t = mul(0.5, add(bitcast<f32>(it.y), bitcast<f32>(it.z)));
    return add3(frame.eye.xyz, mul3(vec3<f32>(t), pixel_ray(frame.base + index, 0.0).c));
}

// The offset as a parameter of shadow beams from p, more than 1 where the light is nearer. A choice: what is said of a beam is said of what lies beyond.
fn offset(p: vec3<f32>) -> f32 {
    let way = length(frame.center.xyz - p);
    if way <= paper.offset { return 2.0; }
    return clamp(paper.offset / way, 0.0, 1.0);
}

// Whether the beam from p towards the part (column, row) of n x n of the light may be blocked after `begin`.
fn possibly_blocked(p: vec3<f32>, begin: f32, column: u32, row: u32, n: u32, evaluations: ptr<function, u32>) -> bool {
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
        let t = nearest(k, beam, vec2<f32>(begin, 1.0), Search(false, Ray(none, none, none, none, none)), true, evaluations);
        if t.x <= t.y { return true; }
    }
    return false;
}

@compute @workgroup_size(64)
fn initial(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let number = 64u * group.x + local;
    if number < frame.count {
        let index = frame.first + number;
        var evaluations = 0u;
        var state = NEAR;
        if found[index].x != NOTHING {
            let p = start(index);
            let begin = offset(p);
            if begin <= 1.0 {
                state = ALWAYS;
                if paper.always == 0u { state = select(FREE, BLOCKED, possibly_blocked(p, begin, 0u, 0u, 1u, &evaluations)); }
            }
        }
        atomicStore(&shade[4u * index], state);
        atomicStore(&shade[4u * index + 1u], evaluations);
        atomicStore(&shade[4u * index + 2u], 0u);
        atomicStore(&shade[4u * index + 3u], 0u);
        if state >= BLOCKED {
            let at = atomicAdd(&list.count, 1u);
            if at < arrayLength(&list.items) { list.items[at] = vec2<u32>(index, frame.series); }
        }
    }
    sign_off(group.x, local, seal());
}

// A thread for each sub-beam of the items of this dispatch.
@compute @workgroup_size(64)
fn sub_beams(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let n = paper.sub_beams;
    let number = 64u * group.x + local;
    if number < frame.count * n * n {
        let item = list.items[frame.first + number / (n * n)];
        if item.y == frame.series {
            let tile = number % (n * n);
            let p = start(item.x);
            var evaluations = 0u;
            if possibly_blocked(p, offset(p), tile % n, tile / n, n, &evaluations) { atomicAdd(&shade[4u * item.x + 2u], 1u); }
            let before = atomicAdd(&shade[4u * item.x + 3u], evaluations);
            if before + evaluations < before { atomicAdd(&shade[4u * item.x], 256u); }
        }
    }
    sign_off(group.x, local, seal());
}
