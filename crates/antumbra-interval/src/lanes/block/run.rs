//! One operation on all vectors of its slots.
use super::kernels::Kernel;
use super::sealed::{Act, Operation};
use super::vector::{Eight, Vector, WIDTH};
use super::{Arithmetic, Packed};

/// The operation on all vectors. Operands are read before the result is written: slots may be the same.
///
/// Always inlined, macros instead of closures: the code takes the features of the function that it is inlined into.
#[inline(always)]
pub(super) fn act<V: Vector, F: Packed>(act: Act, memory: &mut [Eight], vectors: usize) {
    let (starts, steps) = (act.operands, act.steps);
    // Asked once: the checks of each part would take as long as a sum.
    let fits = |start: usize, step: usize| start + vectors.saturating_sub(1) * step + F::COMPONENTS <= memory.len();
    assert!(fits(act.out, F::COMPONENTS) && (0..3).all(|k| fits(starts[k], steps[k])), "slots of the block");
    macro_rules! each {
        ($($x:ident = $k:literal),* => $value:expr) => {
            for i in 0..vectors {
                let at = act.out + i * F::COMPONENTS;
                $(
                    let from = starts[$k] + i * steps[$k];
                    // SAFETY: `i < vectors`, so the part ends within the memory, as asked above.
                    let part = unsafe { memory.get_unchecked(from..from + F::COMPONENTS) };
                    let $x = <F::Of<V> as Kernel<V>>::load(part);
                )*
                let (value, proper): (F::Of<V>, V::Mask) = $value;
                let proper = V::bits(proper);
                if proper == u8::MAX {
                    // SAFETY: as above.
                    value.store(unsafe { memory.get_unchecked_mut(at..at + F::COMPONENTS) });
                } else {
                    let again = again::<F>(act, memory, i, !proper);
                    value.store(&mut memory[at..][..F::COMPONENTS]);
                    replace(&mut memory[at..][..F::COMPONENTS], !proper, &again);
                }
            }
        };
    }
    match act.op {
        Operation::Arithmetic(Arithmetic::Neg) => each!(x = 0 => x.neg()),
        Operation::Arithmetic(Arithmetic::Add) => each!(x = 0, y = 1 => x.add(y)),
        Operation::Arithmetic(Arithmetic::Sub) => each!(x = 0, y = 1 => x.sub(y)),
        Operation::Arithmetic(Arithmetic::Mul) => each!(x = 0, y = 1 => x.mul(y)),
        Operation::Arithmetic(Arithmetic::Div) => each!(x = 0, y = 1 => x.div(y)),
        Operation::Arithmetic(Arithmetic::Sqr) => each!(x = 0 => x.sqr()),
        Operation::Arithmetic(Arithmetic::Sqrt) => each!(x = 0 => x.sqrt()),
        Operation::Arithmetic(Arithmetic::Abs) => each!(x = 0 => x.abs()),
        Operation::Arithmetic(Arithmetic::Min) => each!(x = 0, y = 1 => x.min(y)),
        Operation::Arithmetic(Arithmetic::Max) => each!(x = 0, y = 1 => x.max(y)),
        Operation::Power(n) => each!(x = 0 => x.power(n)),
        Operation::Coordinate => each!(t = 0, d = 1, p = 2 => Kernel::coordinate(t, d, p)),
        Operation::Spanning => each!(x = 0 => x.spanning()),
    }
}

/// The operation on the chosen lanes of one vector, by the scalar operator; of the others, an operand.
#[cold]
#[inline(never)]
fn again<F: Packed>(act: Act, memory: &[Eight], vector: usize, chosen: u8) -> [F; WIDTH] {
    std::array::from_fn(|k| {
        let operand = |j: usize| F::from_components(|i| memory[act.operands[j] + vector * act.steps[j] + i].0[k]);
        if chosen >> k & 1 == 0 {
            return operand(0);
        }
        match act.op {
            Operation::Arithmetic(op) => F::arithmetic(op, operand(0), operand(1)),
            Operation::Power(n) => operand(0).power(n as i32),
            Operation::Coordinate => F::coordinate(operand(0), operand(1), operand(2)),
            Operation::Spanning => operand(0).spanning(),
        }
    })
}

/// Puts the chosen lanes in place.
#[cold]
#[inline(never)]
fn replace<F: Packed>(to: &mut [Eight], chosen: u8, from: &[F; WIDTH]) {
    for (k, x) in from.iter().enumerate().filter(|(k, _)| chosen >> k & 1 == 1) {
        for (i, vector) in to.iter_mut().enumerate() {
            vector.0[k] = x.component(i);
        }
    }
}
