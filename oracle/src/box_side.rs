//! Intervals against inari, and against MPFR at a member.
use crate::count::Count;
use crate::function::Function;
use crate::sample::Sampler;
use crate::turns::Wave;
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
            let mut tight = ours(inari(x.map(theirs)));
            if let Some(wave) = Wave::of(function.name).filter(|_| x[0].is_bounded()) {
                // inari may widen narrow boxes far from 0: MPFR knows which multiples of pi/2 are inside.
                let tightest = sampler.turns.tightest(wave, function, x[0]);
                assert!(tightest.is_subset_of(tight), "{} of {}: inari {tight}, MPFR {tightest}", function.name, x[0]);
                count.narrower += u64::from(tightest != tight);
                tight = tightest;
            }
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
