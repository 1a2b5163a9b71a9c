//! Intervals against inari, and against MPFR at a member.
use crate::count::Count;
use crate::function::Function;
use crate::sample::Sampler;
use antumbra_interval::Interval;

/// Our interval as inari's.
fn theirs(x: Interval) -> inari::Interval {
    if x.is_empty() {
        inari::Interval::EMPTY
    } else {
        inari::Interval::try_from((x.lo(), x.hi())).expect("the same invariant")
    }
}

fn ours(x: inari::Interval) -> Interval {
    if x.is_empty() { Interval::EMPTY } else { Interval::new(x.inf(), x.sup()) }
}

pub(crate) fn check(function: &Function, boxes: u64, seed: u64, count: &mut Count) {
    let mut sampler = Sampler::new(function, !seed);
    for _ in 0..boxes {
        let x = sampler.boxes(function.arity);
        let got = (function.ours)(x);
        let text = || format!("{:?}", &x[..function.arity]);
        if let Some(inari) = function.inari {
            count.boxes += 1;
            let tight = ours(inari(x.map(theirs)));
            if let Some([lo, hi]) = count.excess(got, tight, text) {
                count.at_boxes = [count.at_boxes[0].max(lo), count.at_boxes[1].max(hi)];
            }
        }
        if x[..function.arity].iter().any(|x| x.is_empty()) {
            continue;
        }
        let member = x.map(|x| if x.is_empty() { 0.0 } else { sampler.generator.member(x) });
        if (function.defined)(member) {
            count.members += 1;
            // Bounds that are floats and contain the value contain the floats next to it.
            let value = function.at(member);
            if !value.is_subset_of(got) {
                count.violations.push(format!("{}{}: {got} misses {value} at {member:?}", function.name, text()));
            }
        }
    }
}
