// Expressions that compilers of drivers like to rewrite, through the fence and without it, and the bare operations.

@group(0) @binding(0) var<uniform> zero: vec4<u32>;
@group(0) @binding(1) var<storage, read> cases: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read_write> fenced: array<array<f32, 12>>;
@group(0) @binding(3) var<storage, read_write> bare: array<array<f32, 6>>;

@group(0) @binding(4) var<storage, read_write> functions: array<array<vec2<f32>, 6>>;

fn runtime_zero() -> u32 { return zero.x; }

@compute @workgroup_size(64)
fn probe(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&cases) { return; }
    let at = cases[id.x];
    let x = at.x;
    let y = at.y;
    let z = at.z;
    fenced[id.x][0] = add(x, y);
    fenced[id.x][1] = sub(x, y);
    fenced[id.x][2] = mul(x, y);
    fenced[id.x][3] = sub(add(x, y), x);
    fenced[id.x][4] = sub(add(x, 1e6), 1e6);
    fenced[id.x][5] = add(mul(x, y), mul(x, z));
    fenced[id.x][6] = mul(mul(x, 3.0), 0.3333);
    fenced[id.x][7] = add(mul(x, y), z);
    fenced[id.x][8] = sub(mul(x, y), mul(y, x));
    fenced[id.x][9] = sub(add(add(x, y), z), add(x, add(y, z)));
    fenced[id.x][10] = fence(x / y);
    fenced[id.x][11] = f_mul(Form(x, 1e-6, vec3<f32>(y, z, x)), Form(y, 1e-6, vec3<f32>(z, x, y))).e;
    bare[id.x][0] = (x + y) - x;
    bare[id.x][1] = (x + 1e6) - 1e6;
    bare[id.x][2] = x * y + x * z;
    bare[id.x][3] = (x * 3.0) * 0.3333;
    bare[id.x][4] = x * y + z;
    bare[id.x][5] = 1.0 / (1.0 / x);
    lost = false;
    let a = clamp(abs(x), SMALL, LARGE);
    let q = b_recip(a);
    let r = b_sqrt(a);
    let l = b_ln(a);
    let e = b_exp(clamp(x, -59.0, 40.0));
    let w = b_wave(clamp(x, -1000.0, 1000.0));
    functions[id.x] = array<vec2<f32>, 6>(vec2(q.m, q.r), vec2(r.m, r.r), vec2(l.m, l.r), vec2(e.m, e.r), vec2(w.s, w.e), vec2(w.c, w.e));
    if lost { functions[id.x][0] = vec2(0.0, 0.0); }
}
