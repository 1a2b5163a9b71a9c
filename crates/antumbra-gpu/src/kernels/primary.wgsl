// Which pixels are proved empty, and where does the centre ray of the others first meet a surface? One thread per pixel.

@group(0) @binding(2) var<storage, read_write> found: array<vec4<u32>>;

// 0 is what memory holds that nobody has written: it says nothing.
const EMPTY = 3u;           // no ray of the pixel meets anything
const HIT = 1u;             // every ray meets the surface; the centre ray for the first time between y and z
const OPEN = 2u;            // nothing is met before y
const NONE = 0xffffffffu;
// Evaluations that one pixel may take; then it stays open.
const MOST = 1024u;
// A piece longer than this many widths of the pixel is halved.
const ASPECT: f32 = 2.0;

// x: EMPTY, HIT or OPEN, and for a hit the surface << 8 and whether f > 0 before it << 16; y, z: parameters, w: evaluations.
fn pixel(index: u32) -> vec4<u32> {
    let ray = pixel_ray(index, 1.0);
    let speed = max(abs(ray.c.x), max(abs(ray.c.y), abs(ray.c.z)));
    let side = abs(ray.i) + abs(ray.j);
    let leaf = 2.0 * ASPECT * max(side.x, max(side.y, side.z)) / speed;

    var evaluations = 0u;
    var pos = frame.begin;
    var len = frame.longest;
    var known = 0u;         // surfaces whose sign in front of everything open is known, on all rays, inside their region
    var positive = 0u;      // and is positive
    var open = 0u;          // surfaces that may have been met
    var first = NONE;       // where the first of them may be
    var last = 0u;          // where the last open piece ends
    var gap = false;        // the open pieces are more than one
    var cover = NONE;       // from here every ray has met the surface `by`
    var by = 0u;
    while pos < frame.end && cover == NONE {
        if evaluations > MOST { return vec4<u32>(OPEN, min(first, pos), frame.end, evaluations); }
        let p = camera_point(ray, pos, len);
        var possible = 0u;
        for (var k = 0u; k < SURFACES; k++) {
            let bit = 1u << k;
            if outside(k, p) { continue; }
            evaluations++;
            let s = f_sign(field(k, p));
            if s == 0 { possible |= bit; continue; }
            // A sign counts only where every zero in between is on the surface.
            if !inside(k, p) { continue; }
            if (open & bit) == 0u {
                known |= bit;
                positive = select(positive & ~bit, positive | bit, s > 0);
            } else if (known & bit) != 0u && ((positive & bit) != 0u) != (s > 0) {
                cover = pos;
                by = k;
            }
        }
        if possible != 0u && cover == NONE {
            if len > 1u && f32(len) > leaf * f32(pos + len) {
                len = len >> 1u;
                continue;
            }
            gap = gap || (open != 0u && last != pos);
            open |= possible;
            first = min(first, pos);
            last = pos + len;
        }
        // Stackless, as in the paper: the next piece; after the second of a pair one level up.
        pos += len;
        if len < frame.longest && ((pos - frame.begin) & (2u * len - 1u)) == 0u { len = len << 1u; }
    }
    if first == NONE { return vec4<u32>(EMPTY, 0u, 0u, evaluations); }
    // A piece in which one surface is proved may hold another that is open.
    if cover == NONE || open != (1u << by) || gap || last < cover {
        return vec4<u32>(OPEN, first, min(select(cover, frame.end, cover == NONE), frame.end), evaluations);
    }

    // The centre ray has the sign s at `first`, and not before its end; the other one at `cover`.
    let s = select(-1, 1, (positive & open) != 0u);
    let centre = pixel_ray(index, 0.0);
    var a = first;
    var b = cover;
    // One question at a time, all at one place of the text: threads of a group that are at different places wait for each other.
    var ask = 0u;
    var step = 0u;
    var round = 0u;
    while b - a > 1u && round < 40u {
        // Half of what is left, or a quarter from one of its ends, where the middle is too near to the root.
        let half = a + ((b - a) >> 1u);
        let quarter = max((b - a) >> 2u, 1u);
        var at = half;
        var len = 0u;
        if ask == 1u { at = a; len = step; }
        if ask == 2u { at = a; len = quarter; }
        if ask == 3u { at = b - quarter; }
        evaluations++;
        let sign = f_sign(field(by, camera_point(centre, at, len)));
        if ask == 0u && sign != -s {
            step = select(quarter, half - a, sign == s);
            ask = 1u;
        } else if (ask == 1u || ask == 2u) && sign != s {
            ask = select(3u, 2u, ask == 1u && step > quarter);
        } else if ask == 3u && sign != -s {
            break;
        } else {
            // Proved: the root is in what is left.
            if ask == 0u { b = half; } else if ask == 3u { b -= quarter; } else { a += len; }
            ask = 0u;
            round++;
        }
    }
    return vec4<u32>(HIT | (by << 8u) | (select(0u, 1u, s > 0) << 16u), a, b, evaluations);
}

@compute @workgroup_size(8, 8)
fn primary(@builtin(workgroup_id) tile: vec3<u32>, @builtin(local_invocation_id) at: vec3<u32>,
           @builtin(local_invocation_index) local: u32) {
    // Tiles of 8 x 8 pixels: what threads of a group do is much the same.
    let across = (frame.width + 7u) / 8u;
    let number = frame.first + tile.x;
    let column = (number % across) * 8u + at.x;
    let row = (number / across) * 8u + at.y;
    if tile.x < frame.count && column < frame.width && row < frame.height {
        let index = row * frame.width + column;
        found[index - frame.base] = pixel(index);
    }
    sign_off(tile.x, local, region_seal());
}
