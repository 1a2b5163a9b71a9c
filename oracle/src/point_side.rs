//! Single floats against MPFR.
use crate::count::Count;
use crate::function::Function;
use crate::sample::Sampler;
use antumbra_interval::Interval;

pub(crate) fn check(function: &Function, points: u64, seed: u64, count: &mut Count) {
    let mut sampler = Sampler::new(function, seed);
    for _ in 0..points {
        let x = sampler.point(function.arity);
        let got = (function.ours)(x.map(Interval::point));
        let tight = if (function.defined)(x) { function.at(x) } else { Interval::EMPTY };
        let text = || format!("{:?}", &x[..function.arity]);
        count.points += 1;
        if let Some([lo, hi]) = count.excess(got, tight, text) {
            count.at_points = [count.at_points[0].max(lo), count.at_points[1].max(hi)];
            count.tightest += u64::from(lo == 0 && hi == 0);
        }
    }
}
