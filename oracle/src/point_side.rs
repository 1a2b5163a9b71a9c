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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::box_side;
    use crate::function::Operands;

    /// Violations and the widest excess of the exponential function as it is changed.
    fn violations(ours: fn(Operands<Interval>) -> Interval) -> usize {
        let exp = crate::list::functions().into_iter().find(|f| f.name == "exp").expect("a function");
        let function = Function { ours, ..exp };
        let mut count = Count::new(function.name, function.steps);
        check(&function, 2000, 1, &mut count);
        box_side::check(&function, 500, 1, &mut count);
        count.violations.len()
    }

    /// The oracle must be able to fail: bounds that are not stepped outward, that are two steps out, and a wrong domain.
    #[test]
    fn planted_errors_are_found() {
        assert_eq!(violations(|[x, ..]| x.exp()), 0);
        assert!(violations(|[x, ..]| Interval::from_bounds_or_entire(x.exp().lo().next_up(), x.exp().hi())) > 100);
        assert!(violations(|[x, ..]| Interval::from_bounds_or_entire(x.exp().lo().next_down(), x.exp().hi())) > 100);
        assert!(violations(|[x, ..]| if x.lo() > 700.0 { Interval::EMPTY } else { x.exp() }) > 10);
    }
}
