// Expressions that compilers of drivers like to rewrite, in 64 bits, through the fence.

@group(0) @binding(0) var<uniform> zero: vec4<u32>;
@group(0) @binding(1) var<storage, read> cases: array<array<f64, 3>>;
@group(0) @binding(2) var<storage, read_write> fenced: array<array<f64, 12>>;

fn runtime_zero() -> u32 { return zero.x; }

@compute @workgroup_size(64)
fn probe(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&cases) { return; }
    let x = cases[id.x][0];
    let y = cases[id.x][1];
    let z = cases[id.x][2];
    fenced[id.x][0] = add(x, y);
    fenced[id.x][1] = sub(x, y);
    fenced[id.x][2] = mul(x, y);
    fenced[id.x][3] = sub(add(x, y), x);
    fenced[id.x][4] = sub(add(x, 1e6), 1e6);
    fenced[id.x][5] = add(mul(x, y), mul(x, z));
    fenced[id.x][6] = mul(mul(x, 3.0), 0.3333lf);
    fenced[id.x][7] = add(mul(x, y), z);
    fenced[id.x][8] = sub(mul(x, y), mul(y, x));
    fenced[id.x][9] = sub(add(add(x, y), z), add(x, add(y, z)));
    fenced[id.x][10] = add3(vec3<f64>(x), mul3(vec3<f64>(y), vec3<f64>(z))).y;
    fenced[id.x][11] = f_mul(Form(x, 1e-6lf, vec3<f64>(y, z, x)), Form(y, 1e-6lf, vec3<f64>(z, x, y))).e;
}
