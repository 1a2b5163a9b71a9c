//! What a linear function of places leaves of boxes that lie about it.
use super::Box3;
use antumbra_interval::Interval;
use antumbra_interval::round::{sub_down, sub_up};

/// Encloses `P_k - a_k i - b_k j` over places `(i, j)` with `|i|` and `|j|` at most `half`, and all points P of the boxes there; `slopes` are the
/// `(a, b)` of the three coordinates. A box is given by lower bounds of its coordinates, and of these with their signs turned. `None`
/// if a number is not finite; none is NaN, as the bounds are those of intervals.
///
/// The products `a i`, `b j` must be exact in 53 bits. Then a bound d in plain arithmetic is off by at most `u A` for the sum, `A = |a| half_i +
/// |b| half_j`, and `u |d|` for the difference: twice that of the largest is given away, which takes care of the few roundings in it. One
/// formula for six numbers, for vectors.
#[must_use]
pub fn remainder(
    slopes: [[f64; 2]; 3],
    half: [f64; 2],
    places: impl Iterator<Item = ([f64; 2], [f64; 6])>,
) -> Option<Box3> {
    let signed = |axis: usize| -> [f64; 6] {
        std::array::from_fn(|k| if k < 3 { slopes[k][axis] } else { -slopes[k - 3][axis] })
    };
    let (along, down) = (signed(0), signed(1));
    let (mut least, mut largest) = ([f64::INFINITY; 6], [0.0_f64; 6]);
    for ([i, j], ends) in places {
        for k in 0..6 {
            let bound = ends[k] - (along[k] * i + down[k] * j);
            let size = bound.abs();
            least[k] = if least[k] < bound { least[k] } else { bound };
            largest[k] = if largest[k] > size { largest[k] } else { size };
        }
    }
    let mut rest = [Interval::EMPTY; 3];
    for (k, rest) in rest.iter_mut().enumerate() {
        let [a, b] = slopes[k];
        let all = a.abs() * half[0] + b.abs() * half[1] + f64::max(largest[k], largest[k + 3]);
        let off = f64::EPSILON * all + f64::MIN_POSITIVE;
        *rest = Interval::try_new(sub_down(least[k], off), sub_up(off, least[k + 3])).filter(|x| x.is_bounded())?;
    }
    Some(Box3(rest))
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_rational::BigRational;

    /// Against exact fractions: no bound is inside, and none is far outside.
    #[test]
    fn what_is_left_is_enclosed_tightly() {
        let exact = |x: f64| BigRational::from_float(x).unwrap();
        let mut state = 29u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        };
        for round in 0..400 {
            let scale = [1.0, 1e6, 1e-6][round % 3];
            let slopes: [[f64; 2]; 3] =
                std::array::from_fn(|_| [next(), next()].map(|s| f64::from((scale * s) as f32)));
            let half = [3.5, 7.5];
            let hits: Vec<([f64; 2], [f64; 6])> = (0..16)
                .map(|k| {
                    let place = [f64::from(k % 8) - 3.5, f64::from(k) - 7.5];
                    // On the plane, but for a box of few roundings.
                    let lo: [f64; 3] =
                        std::array::from_fn(|k| slopes[k][0] * place[0] + slopes[k][1] * place[1] + next());
                    let ends = [lo[0], lo[1], lo[2], -lo[0].next_up(), -lo[1].next_up(), -lo[2]];
                    (place, ends)
                })
                .collect();
            let found = remainder(slopes, half, hits.iter().copied()).unwrap();
            for k in 0..3 {
                let left = |(place, ends): &([f64; 2], [f64; 6])| {
                    let plane = exact(slopes[k][0]) * exact(place[0]) + exact(slopes[k][1]) * exact(place[1]);
                    [exact(ends[k]) - &plane, -exact(ends[k + 3]) - plane]
                };
                let lo = hits.iter().map(|hit| left(hit)[0].clone()).min().unwrap();
                let hi = hits.iter().map(|hit| left(hit)[1].clone()).max().unwrap();
                let (low, high) = (exact(found[k].lo()), exact(found[k].hi()));
                assert!(low <= lo && hi <= high, "{found:?}");
                let slack = exact(16.0 * f64::EPSILON * (11.0 * scale + 1.0));
                assert!(lo - low <= slack && high - hi <= slack, "{found:?}");
            }
        }
        assert_eq!(remainder([[0.0; 2]; 3], [0.5; 2], [([0.0; 2], [f64::NEG_INFINITY; 6])].into_iter()), None);
        assert_eq!(remainder([[0.0; 2]; 3], [0.5; 2], std::iter::empty()), None);
    }
}
