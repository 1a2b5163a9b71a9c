//! Completed squares.
use super::polynomial::{Atom, Limit, Polynomial};
use num_integer::Integer;
use num_rational::BigRational;
use num_traits::{One, Zero};

/// `p = factor root^2 + rest`.
pub(super) struct Square {
    pub(super) factor: BigRational,
    pub(super) root: Polynomial,
    pub(super) rest: Polynomial,
}

/// Most powers of the atom, in units of their common divisor, of a polynomial whose square is completed.
const MOST_DEGREE: u32 = 16;

/// Completes the square of p as a polynomial in u, a power of one atom v.
///
/// Let `p = A u^2k + ..` with a rational A. The upper half of its coefficients determines `s = u^k + ..` with
/// `A s^2 = p + (terms of degree below k)`, as a square root by hand: the coefficient of `u^(k+j)` in `s^2` is `2 s_j` and products of
/// those known before. So `p = A s^2 + r`, where r is *defined* as the exact difference: whatever s is, nothing changes but the form.
///
/// `None` where that is no square worth completing: none of a sum, or one that leaves more terms than there were.
pub(super) fn complete(p: &Polynomial, v: Atom, limit: &mut Limit) -> Option<Square> {
    let exponents = || p.terms().map(|(m, _)| m.exponent(v));
    let step = exponents().fold(0, |a, b| a.gcd(&b));
    let degree = exponents().max()?.checked_div(step)?;
    if degree % 2 != 0 || degree > MOST_DEGREE {
        return None;
    }
    let k = degree as usize / 2;
    let c = p.coefficients(v, step, degree);
    let factor = c[2 * k].as_constant()?;
    let half = (BigRational::from_integer(2.into()) * &factor).recip();
    let minus = BigRational::from_integer((-1).into());
    // s[j] is the coefficient of u^j; from the second highest down.
    let mut s = vec![Polynomial::default(); k];
    for j in (0..k).rev() {
        // Those of s_i s_l with i + l = k + j, both below k and above j.
        let mut known = Polynomial::default();
        for i in j + 1..k {
            known = known.plus(&factor, &s[i].times(&s[k + j - i], limit)?, limit)?;
        }
        s[j] = c[k + j].clone().plus(&minus, &known, limit)?.scaled(&half)?;
    }
    let mut root = Polynomial::power_of(v, k as u32 * step);
    for (j, s) in s.iter().enumerate() {
        let term = s.times(&Polynomial::power_of(v, j as u32 * step), limit)?;
        root = root.plus(&BigRational::one(), &term, limit)?;
    }
    let square = root.times(&root, limit)?.scaled(&factor)?;
    let rest = p.clone().plus(&minus, &square, limit)?;
    let worth = root.len() >= 2 && rest.len() < p.len() && !factor.is_zero();
    worth.then_some(Square { factor, root, rest })
}
