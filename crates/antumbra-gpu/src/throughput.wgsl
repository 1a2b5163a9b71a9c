// Products and sums in four chains, through the fence and without it: how many the adapter does in a second.

@group(0) @binding(0) var<uniform> zero: vec4<u32>;
@group(0) @binding(1) var<storage, read_write> out: array<u32>;

override ROUNDS: u32 = 64u;

fn bare(x: FLOAT) -> FLOAT { return x; }
fn fenced(x: FLOAT) -> FLOAT { return bitcast<FLOAT>(bitcast<BITS>(x) ^ BITS(zero.x)); }

@compute @workgroup_size(64)
fn chains(@builtin(global_invocation_id) id: vec3<u32>) {
    let k = FLOAT(0.75);
    let s = FLOAT(f32(id.x % 97u) * 0.01);
    var a = s;
    var b = s + FLOAT(0.25);
    var c = s + FLOAT(0.5);
    var d = s + FLOAT(1.0);
    for (var i = 0u; i < ROUNDS; i++) {
        a = FENCE(FENCE(a * k) + s);
        b = FENCE(FENCE(b * k) + s);
        c = FENCE(FENCE(c * k) + s);
        d = FENCE(FENCE(d * k) + s);
    }
    // Somebody might look.
    if a + b + c + d < FLOAT(-1.0) { out[0] = id.x + zero.x; }
}
