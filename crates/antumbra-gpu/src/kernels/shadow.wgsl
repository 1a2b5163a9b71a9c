// Which part of a light does a hit see? `whole` settles hits that see all or nothing of it, `cells` divides the light for the others,
// one thread per part: certified shares are added up as integers.

@group(0) @binding(2) var<storage, read> found: array<vec4<u32>>;
// Per pixel of the band: the lit share and the hidden share that are proved, in units of 2^-30.
@group(0) @binding(3) var<storage, read_write> sums: array<atomic<u32>>;
// The same before this pass: what a pass looks at does not depend on which of its threads come first.
@group(0) @binding(4) var<storage, read> before: array<u32>;
// Hits whose light is divided: pixel, series, and where their beam is open: outside of that stretch of parameters it is proved free.
struct Hits { count: atomic<u32>, items: array<vec4<u32>> }
@group(0) @binding(5) var<storage, read_write> hits: Hits;
// Parts of the light that are looked at again: pixel, row << 16 | column, the stretch, and the shares above which it may add, in the units of `sums`.
struct Part { index: u32, place: u32, first: u32, last: u32, lit: u32, dark: u32, series: u32, pad: u32 }
struct Parts { count: atomic<u32>, pad0: u32, pad1: u32, pad2: u32, items: array<Part> }
@group(0) @binding(6) var<storage, read_write> more: Parts;
struct Work { count: u32, pad0: u32, pad1: u32, pad2: u32, items: array<Part> }
@group(0) @binding(8) var<storage, read> work: Work;

const ONE = 1073741824u;    // 2^30
const HIT = 1u;
// The slope decides where t_lo <= 0.9 t_hi.
const SLOPE: f32 = 0.9;
const NEAR: f32 = 0.3;
// Evaluations that one part of the light may take; then nothing is known of it.
const MOST = 256u;
// The lines between eight strips of a part of the light, which is [-1, 1] wide: exact.
const LINES_A = vec3<f32>(-1.0, -0.75, -0.5);
const LINES_B = vec3<f32>(-0.25, 0.0, 0.25);
const LINES_C = vec3<f32>(0.5, 0.75, 1.0);

struct Hit { p: vec3<f32>, e: vec3<f32>, surface: u32, positive: bool }

// The box of a hit: the centre ray between its parameters.
fn hit_of(index: u32) -> Hit {
    let it = found[index];
    let q = camera_point(pixel_ray(frame.base + index, 0.0), it.y, it.z - it.y);
    let e = vec3<f32>(f_radius(q.x), f_radius(q.y), f_radius(q.z));
    return Hit(vec3<f32>(q.x.c, q.y.c, q.z.c), e, (it.x >> 8u) & 0xffu, (it.x >> 16u) == 1u);
}

// The beam from a hit to the part of the light with the middle m and half sides h, in coordinates [-1, 1] of the light (dyadic: exact).
// The directions are those from the middle of the hit's box; e bounds what is wrong with the light alone.
fn beam_of(hit: Hit, m: vec2<f32>, h: vec2<f32>) -> Ray {
    let at = add3(add3(frame.center.xyz, mul3(vec3<f32>(m.x), frame.edge_u.xyz)), mul3(vec3<f32>(m.y), frame.edge_v.xyz));
    let c = sub3(at, hit.p);
    let e = add3(frame.light_e.xyz, mul3(vec3<f32>(1.25 * U), abs(c)));
    return Ray(c, vec3<f32>(0.0), frame.edge_u.xyz * h.x, frame.edge_v.xyz * h.y, e);
}

// Points of the beam: with P = p + r, |r| <= e, P + t (L - P) = p + t (L - p) + (1 - t) r.
fn beam_point(hit: Hit, ray: Ray, pos: u32, len: u32) -> Point {
    return along(hit.p, vec3<f32>(0.0), hit.e, ray, f32(2u * pos + len) * frame.half_unit, f32(len) * frame.half_unit);
}

// The slope of f over a piece: the direction from the true hit is L - p - r.
fn beam_slope(hit: Hit, ray: Ray, p: Point) -> Form {
    let e = mul3(add3(ray.e, hit.e), vec3<f32>(1.0 + 8.0 * U));
    let x = Slope(Ball(hit.p.x, hit.e.x), p.x, Form(ray.c.x, e.x, vec3<f32>(0.0, ray.i.x, ray.j.x)));
    let y = Slope(Ball(hit.p.y, hit.e.y), p.y, Form(ray.c.y, e.y, vec3<f32>(0.0, ray.i.y, ray.j.y)));
    let z = Slope(Ball(hit.p.z, hit.e.z), p.z, Form(ray.c.z, e.z, vec3<f32>(0.0, ray.i.z, ray.j.z)));
    return slope(hit.surface, x, y, z);
}

// Sign of a surface's function at the hit, where every zero beyond counts; 0 if unknown. For the hit's own: the viewer's side.
fn front_of(hit: Hit, k: u32) -> i32 {
    if k == hit.surface { return select(-1, 1, hit.positive); }
    let none = vec3<f32>(0.0);
    let p = Point(Form(hit.p.x, hit.e.x, none), Form(hit.p.y, hit.e.y, none), Form(hit.p.z, hit.e.z, none));
    if !inside(k, p) { return 0; }
    return f_sign(field(k, p));
}

// What is known of a part of the light: certainly lit and certainly hidden shares, and between which parameters the beam is open.
struct Shares { lit: f32, dark: f32, first: u32, last: u32 }

// Share of the square [-1, 1]^2 in which k + a u + b v > 0, at least that. With p = max(|a|, |b|), q the other: 0 up to -(p + q), then the
// triangle (k + p + q)^2 / (8 p q), from -(p - q) to p - q the trapezoid 1/2 + k / (2 p), then 1 less a triangle. Monotone in k. Roundings
// move the result by less than 2^-18: quotients are at most 2 and within 10 u, k + p + q is within 4 u p, which by p and q
// makes 8 u.
fn half_plane(k: f32, a: f32, b: f32) -> f32 {
    let p = max(abs(a), abs(b));
    var q = min(abs(a), abs(b));
    var c = sub(k, mul(8.0 * U, add(abs(k), add(p, q))));
    let s = add(p, q);
    if c <= -s || p < 1e-25 { return select(f32(0.0), f32(1.0), c > mul(s, 1.0 + 8.0 * U)); }
    if c >= mul(s, 1.0 + 8.0 * U) { return 1.0; }
    if q < p * 1e-5 {
        // A thin triangle counts as missing.
        c = sub(c, mul(q, 1.0 + 8.0 * U));
        q = 0.0;
    }
    var share: f32 = 0.0;
    if abs(c) <= sub(p, q) {
        share = 0.5 + 0.5 * (c / p);
    } else if c < 0.0 {
        let x = add(c, add(p, q));
        share = 0.125 * fence(x / p) * fence(x / q);
        if x <= 0.0 || q == 0.0 { share = 0.0; }
    } else {
        let x = sub(add(p, q), c);
        share = 1.0;
        if q > 0.0 { share = 1.0 - 0.125 * fence(x / p) * fence(x / q); }
    }
    return clamp(share - 7.6e-6, 0.0, 1.0);
}

// Where the lit part begins and ends along three lines.
struct Lines { begin: vec3<f32>, end: vec3<f32> }

// Of it, what is lit by a plane too: where a u + b v > rest, v being that of the line.
fn cut(lines: Lines, at: vec3<f32>, a: f32, b: f32, rest: f32, pad: f32) -> Lines {
    let rhs = add3(sub3(vec3<f32>(rest), mul3(vec3<f32>(b), at)), vec3<f32>(pad));
    let most = vec3<f32>(abs(a));
    // Nothing is divided by so little: a line is dark then, unless all of it is lit.
    let flat = abs(a) < 1e-25;
    let dark = (rhs >= most) | ((rhs >= -most) & vec3<bool>(flat));
    let crossed = !dark & (rhs > -most) & vec3<bool>(!flat);
    // The quotient of |rhs| < |a| is off by less than 8 u.
    let u = fence3(rhs / vec3<f32>(select(a, f32(1.0), flat)));
    let begin = select(lines.begin, max(lines.begin, u + vec3<f32>(4e-6)), crossed & vec3<bool>(a > 0.0));
    let end = select(lines.end, min(lines.end, u - vec3<f32>(4e-6)), crossed & vec3<bool>(a <= 0.0));
    return Lines(select(begin, vec3<f32>(2.0), dark), end);
}

// Lit points on two lines span a lit trapezoid: the lit part is convex.
fn trapezoid(x: f32, y: f32) -> f32 { return select(f32(0.0), x + y, x > 0.0 && y > 0.0); }

// Looks at a part of the light with all surfaces, between the parameters `from` and `until`. Where planes are wanted, they bound the shares
// of the lit and of the hidden part.
fn look(hit: Hit, m: vec2<f32>, h: vec2<f32>, aspect: f32, planes: bool, from_: u32, until: u32) -> Shares {
    // No stretch at all is an item that was counted and never written: nothing is known of it.
    if until <= from_ { return Shares(0.0, 0.0, from_, until); }
    let ray = beam_of(hit, m, h);
    let distance = max(abs(ray.c.x), max(abs(ray.c.y), abs(ray.c.z)));
    let size = 2.0 * max(length(ray.i), length(ray.j));
    let leaf = aspect * size / distance;
    // The lit part of the square is an intersection of half planes: where does it begin and end along the lines between strips?
    var lines_a = Lines(vec3<f32>(-1.0), vec3<f32>(1.0));
    var lines_b = lines_a;
    var lines_c = lines_a;
    var hidden: f32 = 0.0;
    var swap = false;
    var open = 0u;
    var evaluations = 0u;
    var first = until;
    var last = from_;
    // The largest piece that may begin here.
    var longest = 1u << firstLeadingBit(max(until - from_, 1u));
    if from_ > 0u { longest = min(longest, 1u << firstTrailingBit(from_)); }

    for (var k = 0u; k < SURFACES; k++) {
        let front = front_of(hit, k);
        let own = k == hit.surface;
        var pos = from_;
        var len = longest;
        while pos < until {
            let p = beam_point(hit, ray, pos, len);
            var settled = outside(k, p);
            if !settled {
                evaluations++;
                var f: Form;
                if own && f32(pos) <= SLOPE * f32(pos + len) {
                    f = beam_slope(hit, ray, p);
                    // Slopes of functions are good near the hit only; farther away the value may have a sign.
                    if FUNCTIONS && pos > 0u && f_sign(f) == 0 {
                        evaluations++;
                        let g = field(k, p);
                        if f_sign(g) != 0 { f = g; }
                    }
                } else {
                    f = field(k, p);
                }
                if front < 0 { f = f_neg(f); }
                let s = f_sign(f);
                // Lower plane at the parameter where it is lowest, and its upper bound there.
                let bottom = sub(f.c, abs(f.a.x));
                let e = add(f.e, mul(4.0 * U, add(abs(f.c), abs(f.a.x))));
                let across = add(abs(f.a.y), abs(f.a.z));
                let top = add(add(bottom, across), e);
                let hides = front != 0 && inside(k, p);
                if hides && top < -mul(4.0 * U, add(add(abs(bottom), across), e)) {
                    atomicAdd(&account.evaluations, evaluations);
                    return Shares(0.0, 1.0, 0u, 0u);
                }
                // The segments leave to the wrong side.
                if s < 0 && own && pos == 0u {
                    atomicAdd(&account.evaluations, evaluations);
                    return Shares(0.0, 1.0, 0u, 0u);
                }
                settled = s != 0;
                if !settled && len > 1u && f32(len) > leaf * max(f32(pos + len), NEAR * f32(frame.units)) {
                    len = len >> 1u;
                    continue;
                }
                if evaluations > MOST {
                    atomicAdd(&account.evaluations, evaluations);
                    // Of surfaces that come later nothing is known.
                    return Shares(0.0, 0.0, select(min(first, pos), from_, SURFACES > 1u), until);
                }
                if !settled {
                    first = min(first, pos);
                    last = max(last, min(pos + len, until));
                }
                if !settled && !planes { open++; }
                if !settled && planes {
                    // Sweep along the axis on which the first plane depends less.
                    if open == 0u { swap = abs(f.a.z) > abs(f.a.y); }
                    open++;
                    let a = select(f.a.y, f.a.z, swap);
                    let b = select(f.a.z, f.a.y, swap);
                    if hides {
                        // Hidden where bottom + a u + b v < -e.
                        hidden = max(hidden, half_plane(sub(-bottom, mul(e, 1.0 + 8.0 * U)), a, b));
                    }
                    let pad = mul(12.0 * U, add(add(abs(bottom), across), e));
                    let rest = sub(e, bottom);
                    lines_a = cut(lines_a, LINES_A, a, b, rest, pad);
                    lines_b = cut(lines_b, LINES_B, a, b, rest, pad);
                    lines_c = cut(lines_c, LINES_C, a, b, rest, pad);
                }
            }
            pos += len;
            if len < frame.units && (pos & (2u * len - 1u)) == 0u && pos + len < until { len = len << 1u; }
        }
    }
    atomicAdd(&account.evaluations, evaluations);
    if open == 0u { return Shares(1.0, 0.0, 0u, 0u); }
    if !planes { return Shares(0.0, 0.0, first, last); }
    let x = lines_a.end - lines_a.begin;
    let y = lines_b.end - lines_b.begin;
    let z = lines_c.end - lines_c.begin;
    let area = trapezoid(x.x, x.y) + trapezoid(x.y, x.z) + trapezoid(x.z, y.x) + trapezoid(y.x, y.y)
        + trapezoid(y.y, y.z) + trapezoid(y.z, z.x) + trapezoid(z.x, z.y) + trapezoid(z.y, z.z);
    // Lengths of up to 2, twice per strip; some roundings of 2^-23.
    let share = clamp(area * (0.25 / 8.0) - 4e-6, 0.0, 1.0);
    return Shares(share, hidden, first, last);
}

// The sums begin here: with what is known of the whole light.
fn begin(index: u32) {
    var lit = 0u;
    var dark = 0u;
    if (found[index].x & 0xffu) == HIT {
        let shares = look(hit_of(index), vec2<f32>(0.0), vec2<f32>(1.0), 1.0, false, 0u, frame.units);
        if shares.lit == 1.0 {
            lit = ONE;
        } else if shares.dark == 1.0 {
            dark = ONE;
        } else {
            let at = atomicAdd(&hits.count, 1u);
            if at < arrayLength(&hits.items) { hits.items[at] = vec4<u32>(index, frame.series, shares.first, shares.last); }
        }
    }
    atomicStore(&sums[2u * index], lit);
    atomicStore(&sums[2u * index + 1u], dark);
}

@compute @workgroup_size(64)
fn whole(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let number = 64u * group.x + local;
    if number < frame.count { begin(frame.first + number); }
    sign_off(group.x, local, region_seal());
}

// The light is divided in SIDE x SIDE parts.
override SIDE: u32 = 8u;
// What may remain unknown of a light, as a number of parts of the first division: the tolerance.
override ROOM: f32 = 0.25;
// Pieces longer than so many widths of the part are halved.
override ASPECT: f32 = 1.0;
// Where more is unknown than so many parts of 64, the numbers are too coarse or the place too narrow: that is for the processor.
const HOPELESS: f32 = 40.0;

struct Seen { shares: Shares, lit: u32, dark: u32, unknown: f32 }
const NOTHING = Seen(Shares(0.0, 0.0, 0u, 0u), 0u, 0u, 0.0);

fn part_of(hit: Hit, column: u32, row: u32, first: u32, last: u32) -> Seen {
    // 1 / n by its bits, for n is a power of two: quotients need not be exact.
    let h = half_power(firstTrailingBit(SIDE));
    let m = vec2<f32>(f32(2u * column + 1u) * h - 1.0, f32(2u * row + 1u) * h - 1.0);
    let shares = look(hit, m, vec2<f32>(h), ASPECT, true, first, last);
    // The integer part is rounded down; f32(unit) is exact.
    let unit = ONE / (SIDE * SIDE);
    let lit = select(u32(shares.lit * f32(unit)), unit, shares.lit == 1.0);
    let dark = select(u32(shares.dark * f32(unit)), unit, shares.dark == 1.0);
    return Seen(shares, lit, dark, max(1.0 - shares.lit - shares.dark, 0.0));
}

fn again(index: u32, column: u32, row: u32, seen: Seen) {
    let at = atomicAdd(&more.count, 1u);
    if at < arrayLength(&more.items) {
        more.items[at] = Part(index, (row << 16u) | column, seen.shares.first, seen.shares.last, seen.lit, seen.dark,
                              frame.series, 0u);
    }
}

// Unknown shares of the parts of this group's hit, in 2^-20.
var<workgroup> unknown_sum: atomic<u32>;
var<workgroup> unknown_parts: atomic<u32>;

// The first division: a group for each hit, a thread for each of its 8 x 8 parts. All shares are added.
@compute @workgroup_size(64)
fn cells(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    if local == 0u {
        atomicStore(&unknown_sum, 0u);
        atomicStore(&unknown_parts, 0u);
    }
    workgroupBarrier();
    let item = hits.items[frame.first + group.x];
    let column = local % SIDE;
    let row = local / SIDE;
    var seen = NOTHING;
    // What another band or light has left here is nobody's.
    if item.y == frame.series {
        seen = part_of(hit_of(item.x), column, row, item.z, item.w);
        if seen.unknown > 0.0 {
            atomicAdd(&unknown_sum, u32(seen.unknown * 1048576.0) + 1u);
            atomicAdd(&unknown_parts, 1u);
        }
        atomicAdd(&sums[2u * item.x], seen.lit);
        atomicAdd(&sums[2u * item.x + 1u], seen.dark);
    }
    workgroupBarrier();
    // Policy: nothing is looked at again where all that is unknown has room; else half of the room is for parts of which little is unknown.
    let sum = f32(atomicLoad(&unknown_sum)) * (1.0 / 1048576.0);
    if sum > ROOM && sum < HOPELESS && seen.unknown * f32(atomicLoad(&unknown_parts)) > 0.5 * ROOM {
        again(item.x, column, row, seen);
    }
    sign_off(group.x, local, region_seal());
}

// What a quarter of the part of the four threads before and behind shares.
var<workgroup> quarters: array<vec2<u32>, 64>;

// Four threads for each part on the list, as long as the hit's bracket is wider than the tolerance. SIDE is that of the quarters.
//
// A part has a floor b: whoever proves a share v > b of it may add v - b. Its quarters prove S = s_1 + ... + s_4: added is max(S, b) - b, and the quarters get the floors
// s_q + d, d = max(S, b) - S. That is right: if some quarters later prove v_q > s_q + d, then max(S, b) - b and all the v_q - s_q - d are together at most
// V - b, where V = S + sum of these v_q - s_q is proved of the part.
@compute @workgroup_size(64)
fn refine(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    let number = (group.x * 64u + local) / 4u;
    var item = Part(0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u);
    var wide = false;
    if number < frame.count { item = work.items[frame.first + number]; }
    if number < frame.count && item.series == frame.series {
        let known = before[2u * item.index] + before[2u * item.index + 1u];
        wide = f32(ONE - known) > ROOM * f32(ONE / 64u);
    }
    quarters[local] = vec2<u32>(0u);
    let column = 2u * (item.place & 0xffffu) + (local & 1u);
    let row = 2u * (item.place >> 16u) + ((local >> 1u) & 1u);
    var seen = NOTHING;
    if wide {
        seen = part_of(hit_of(item.index), column, row, item.first, item.last);
        quarters[local] = vec2<u32>(seen.lit, seen.dark);
    }
    workgroupBarrier();
    if wide {
        let first = local & ~3u;
        let sum = quarters[first] + quarters[first + 1u] + quarters[first + 2u] + quarters[first + 3u];
        let floors = vec2<u32>(item.lit, item.dark);
        let best = max(sum, floors);
        if local == first {
            atomicAdd(&sums[2u * item.index], best.x - floors.x);
            atomicAdd(&sums[2u * item.index + 1u], best.y - floors.y);
        }
        // Policy: a part of 32 x 32 has a quarter of the tolerance of 1/255; where nothing at all was proved of any quarter, smaller ones will not help.
        if seen.unknown > 0.03 && sum.x + sum.y > 0u {
            seen.lit += best.x - sum.x;
            seen.dark += best.y - sum.y;
            again(item.index, column, row, seen);
        }
    }
    sign_off(group.x, local, region_seal());
}
