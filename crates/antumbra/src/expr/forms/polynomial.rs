//! Sparse polynomials with exact coefficients over the nodes of a graph.
use super::super::{Binary, exact};
use num_rational::BigRational;
use num_traits::{One, Zero};
use smallvec::SmallVec;
use std::collections::BTreeMap;

/// Largest exponent of a sum that is multiplied out.
const MOST_POWER: u32 = 16;
/// Operations on coefficients that an expansion, or writing a form, may take: some hundred microseconds.
const WORK: usize = 10_000;

/// Exponents are less: they fit into those of formulas.
const MOST_EXPONENT: u32 = 1 << 30;

/// What may still be done.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limit {
    terms: usize,
    work: usize,
}

impl Limit {
    /// Polynomials of that many terms at most.
    pub(super) fn new(terms: usize) -> Self {
        Self { terms, work: WORK }
    }

    /// `None` where that many operations are too many.
    pub(super) fn spend(&mut self, operations: usize) -> Option<()> {
        self.work = self.work.checked_sub(operations)?;
        Some(())
    }
}

/// Place, in the graph of the formula as written, of a node that is taken as an unknown.
pub(super) type Atom = u32;

/// A product of powers of atoms, in ascending order of atoms; exponents are at least 1.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Monomial(SmallVec<[(Atom, u32); 3]>);

impl Monomial {
    pub(super) fn powers(&self) -> &[(Atom, u32)] {
        &self.0
    }

    pub(super) fn exponent(&self, of: Atom) -> u32 {
        self.0.iter().find(|(atom, _)| *atom == of).map_or(0, |(_, n)| *n)
    }

    /// `None` if an exponent is too large.
    fn times(&self, other: &Self) -> Option<Self> {
        let (mut product, mut left, mut right) = (SmallVec::new(), &self.0[..], &other.0[..]);
        while let (Some(&(a, m)), Some(&(b, n))) = (left.first(), right.first()) {
            let (power, skip) = match a.cmp(&b) {
                std::cmp::Ordering::Less => ((a, m), (1, 0)),
                std::cmp::Ordering::Greater => ((b, n), (0, 1)),
                std::cmp::Ordering::Equal => ((a, m.checked_add(n).filter(|m| *m < MOST_EXPONENT)?), (1, 1)),
            };
            product.push(power);
            (left, right) = (&left[skip.0..], &right[skip.1..]);
        }
        product.extend_from_slice(left);
        product.extend_from_slice(right);
        Some(Self(product))
    }

    fn power(&self, n: u32) -> Option<Self> {
        let powers = self.0.iter().map(|&(atom, m)| Some((atom, m.checked_mul(n).filter(|m| *m < MOST_EXPONENT)?)));
        powers.collect::<Option<_>>().map(Self)
    }

    /// Without its power of that atom.
    pub(super) fn without(&self, of: Atom) -> Self {
        Self(self.0.iter().copied().filter(|(atom, _)| *atom != of).collect())
    }

    /// Divided by `of^n`, a factor of it.
    fn divided(&self, of: Atom, n: u32) -> Self {
        let less = |&(atom, m): &(Atom, u32)| if atom == of { (atom, m - n) } else { (atom, m) };
        Self(self.0.iter().map(less).filter(|(_, m)| *m > 0).collect())
    }

    /// The monomial whose square this is.
    pub(super) fn root(&self) -> Option<Self> {
        let even = !self.0.is_empty() && self.0.iter().all(|(_, n)| n % 2 == 0);
        even.then(|| Self(self.0.iter().map(|&(atom, n)| (atom, n / 2)).collect()))
    }
}

/// A sum of monomials with rational coefficients, none of which is 0.
///
/// `None` of an operation means that the result would be too large; nothing is ever rounded.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Polynomial(BTreeMap<Monomial, BigRational>);

impl Polynomial {
    pub(super) fn constant(q: BigRational) -> Self {
        let mut terms = BTreeMap::new();
        if !q.is_zero() {
            terms.insert(Monomial::default(), q);
        }
        Self(terms)
    }

    pub(super) fn atom(atom: Atom) -> Self {
        Self::power_of(atom, 1)
    }

    pub(super) fn power_of(atom: Atom, n: u32) -> Self {
        let powers = if n == 0 { SmallVec::new() } else { SmallVec::from_slice(&[(atom, n)]) };
        Self(BTreeMap::from([(Monomial(powers), BigRational::one())]))
    }

    pub(super) fn terms(&self) -> impl DoubleEndedIterator<Item = (&Monomial, &BigRational)> + Clone {
        self.0.iter()
    }

    pub(super) fn len(&self) -> usize {
        self.0.len()
    }

    /// The value, if it is a constant.
    pub(super) fn as_constant(&self) -> Option<BigRational> {
        match self.0.first_key_value() {
            None => Some(BigRational::zero()),
            Some((m, q)) if self.0.len() == 1 && m.0.is_empty() => Some(q.clone()),
            _ => None,
        }
    }

    /// Each atom that occurs, once, in ascending order.
    pub(super) fn atoms(&self) -> Vec<Atom> {
        let mut atoms: Vec<Atom> = self.0.keys().flat_map(|m| m.0.iter().map(|(atom, _)| *atom)).collect();
        atoms.sort_unstable();
        atoms.dedup();
        atoms
    }

    /// `self + c m`.
    fn add_term(&mut self, m: Monomial, c: &BigRational, limit: &Limit) -> Option<()> {
        match self.0.entry(m) {
            std::collections::btree_map::Entry::Vacant(place) => {
                place.insert(c.clone());
            }
            std::collections::btree_map::Entry::Occupied(mut place) => {
                let sum = exact::binary(Binary::Add, place.get(), c)?;
                if sum.is_zero() {
                    place.remove();
                } else {
                    place.insert(sum);
                }
            }
        }
        (self.0.len() <= limit.terms).then_some(())
    }

    /// `self + c other`.
    pub(super) fn plus(mut self, c: &BigRational, other: &Self, limit: &mut Limit) -> Option<Self> {
        limit.spend(other.len())?;
        for (m, q) in &other.0 {
            self.add_term(m.clone(), &exact::binary(Binary::Mul, c, q)?, limit)?;
        }
        Some(self)
    }

    pub(super) fn scaled(&self, c: &BigRational) -> Option<Self> {
        if c.is_zero() {
            return Some(Self::default());
        }
        let terms = self.0.iter().map(|(m, q)| Some((m.clone(), exact::binary(Binary::Mul, c, q)?)));
        terms.collect::<Option<_>>().map(Self)
    }

    /// The product.
    pub(super) fn times(&self, other: &Self, limit: &mut Limit) -> Option<Self> {
        limit.spend(self.len() * other.len())?;
        let mut product = Self::default();
        for (m, p) in &self.0 {
            for (n, q) in &other.0 {
                product.add_term(m.times(n)?, &exact::binary(Binary::Mul, p, q)?, limit)?;
            }
        }
        Some(product)
    }

    pub(super) fn power(&self, n: u32, limit: &mut Limit) -> Option<Self> {
        if let (1, Some((m, q))) = (self.len(), self.0.first_key_value()) {
            let q = exact::powi(q, i32::try_from(n).ok()?)?;
            return Some(Self(BTreeMap::from([(m.power(n)?, q)])));
        }
        if n > MOST_POWER {
            return None;
        }
        (0..n).try_fold(Self::constant(BigRational::one()), |power, _| power.times(self, limit))
    }

    /// `(q, r)` with `self = of^n q + r`: q has the terms that `of^n` divides.
    pub(super) fn split(&self, of: Atom, n: u32) -> (Self, Self) {
        let (with, without): (Vec<_>, Vec<_>) = self.0.iter().partition(|(m, _)| m.exponent(of) >= n);
        let own = |(m, q): (&Monomial, &BigRational)| (m.clone(), q.clone());
        let divided = with.into_iter().map(|(m, q)| (m.divided(of, n), q.clone()));
        (Self(divided.collect()), Self(without.into_iter().map(own).collect()))
    }

    /// The coefficients by `of^step`: `self = sum of c_k of^(k step)`, c_k free of that atom. The exponents are multiples of `step`.
    pub(super) fn coefficients(&self, of: Atom, step: u32, degree: u32) -> Vec<Self> {
        let mut all = vec![Self::default(); degree as usize + 1];
        for (m, q) in &self.0 {
            all[(m.exponent(of) / step) as usize].0.insert(m.without(of), q.clone());
        }
        all
    }
}
