// What `forms.wgsl`, in 64 bits, needs to know of its numbers: f64. The least error stays as large as that of f32, so that what is said
// there of subnormal numbers, which begin at 2^-1022 here, holds all the more.

const U: f64 = 2.220446049250313e-16lf;      // 2^-52
const F: f64 = 7.888609052210118e-31lf;      // 2^-100

fn fence(x: f64) -> f64 { return bitcast<f64>(bitcast<u64>(x) ^ u64(runtime_zero())); }
fn fence3(x: vec3<f64>) -> vec3<f64> { return vec3<f64>(fence(x.x), fence(x.y), fence(x.z)); }
// From 2^-100 to 2^120, as in f32: nothing gets lost or too large.
fn guess(c: f64) -> f64 { return f64(bitcast<f32>(0x7ef311c7u - bitcast<u32>(f32(c)))); }
fn half_power(k: u32) -> f64 { return f64(bitcast<f32>((127u - k) << 23u)); }

