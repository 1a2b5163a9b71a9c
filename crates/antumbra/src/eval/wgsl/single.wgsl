// What `forms.wgsl` needs to know of its numbers: f32.

const U: f32 = 1.1920929e-7;          // 2^-23
const F: f32 = 7.888609e-31;          // 2^-100

fn fence(x: f32) -> f32 { return bitcast<f32>(bitcast<u32>(x) ^ runtime_zero()); }
fn fence3(x: vec3<f32>) -> vec3<f32> { return bitcast<vec3<f32>>(bitcast<vec3<u32>>(x) ^ vec3<u32>(runtime_zero())); }
// About 1/c for c > 0, off by an eighth.
fn guess(c: f32) -> f32 { return bitcast<f32>(0x7ef311c7u - bitcast<u32>(c)); }
// 2^-k, for k < 100: by its bits, quotients need not be exact.
fn half_power(k: u32) -> f32 { return bitcast<f32>((127u - k) << 23u); }

