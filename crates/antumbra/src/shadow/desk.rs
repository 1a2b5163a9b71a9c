//! Searches in lockstep: in each round every one asks, and what they ask is answered together, in batches.
//!
//! A search is written as if it were alone; where it asks the [`Desk`] it waits (it is `async`, the desk is all that it ever waits
//! for). Answers are the bits of those to single questions, so the company of a search changes nothing of what it finds.
use super::second::Learned;
use crate::eval::{Inclusion, JetPoint, JetSlopePoint, PointJet, QuadraticPoint, QuadraticSlopePoint, Workspace};
use crate::trace::Surface;
use antumbra_interval::affine::{Affine, Jet};
use antumbra_interval::quadratic::Quadratic;
use std::cell::{Cell, RefCell, RefMut};
use std::pin::Pin;
use std::task::{Context, Poll};

/// Where searches of one thread ask.
pub(super) struct Desk<'a> {
    surfaces: &'a [Surface<'a>],
    work: RefCell<&'a mut Workspace>,
    learned: RefCell<Learned>,
    /// One for each surface.
    piles: Vec<Piles>,
    /// How many are over.
    round: Cell<u64>,
}

/// Questions of one kind about one surface, and the answers of the round before.
#[derive(Debug)]
pub(super) struct Pile<Q, A> {
    questions: Vec<Q>,
    answers: Vec<A>,
}

impl<Q, A> Default for Pile<Q, A> {
    fn default() -> Self {
        Self { questions: Vec::new(), answers: Vec::new() }
    }
}

/// A kind of question.
pub(super) trait Question: Copy {
    type Answer: Copy;
    /// What stands for an answer that is not yet there.
    const BLANK: Self::Answer;
    fn pile(of: &Piles) -> &RefCell<Pile<Self, Self::Answer>>;
    fn answer(f: &dyn Inclusion, questions: &[Self], out: &mut [Self::Answer], work: &mut Workspace);
}

macro_rules! questions {
    ($($pile:ident: $question:ty => $answer:ty, $blank:expr;)*) => {
        /// What is asked about one surface.
        #[derive(Debug, Default)]
        pub(super) struct Piles {
            $( $pile: RefCell<Pile<$question, $answer>>, )*
        }

        impl Piles {
            /// Answers everything.
            fn answer(&self, f: &dyn Inclusion, work: &mut Workspace) {
                $( self.$pile.borrow_mut().answer(f, work); )*
            }
        }

        $(
            impl Question for $question {
                type Answer = $answer;
                const BLANK: $answer = $blank;
                fn pile(of: &Piles) -> &RefCell<Pile<Self, $answer>> {
                    &of.$pile
                }
                fn answer(f: &dyn Inclusion, questions: &[Self], out: &mut [$answer], work: &mut Workspace) {
                    f.$pile(questions, out, work);
                }
            }
        )*
    };
}
const NO_JET: Jet<Affine<3>> = Jet { value: Affine::UNKNOWN, first: Affine::UNKNOWN, second: Affine::UNKNOWN };
questions! {
    quadratics: QuadraticPoint => Quadratic, Quadratic::UNKNOWN;
    quadratic_slopes: QuadraticSlopePoint => Quadratic, Quadratic::UNKNOWN;
    jets: JetPoint => Jet<Affine<3>>, NO_JET;
    jet_slopes: JetSlopePoint => Jet<Affine<3>>, NO_JET;
    abouts: [PointJet; 3] => PointJet, PointJet { value: f64::NAN, first: f64::NAN, second: f64::NAN };
}

impl<Q: Question> Pile<Q, Q::Answer> {
    fn answer(&mut self, f: &dyn Inclusion, work: &mut Workspace) {
        self.answers.clear();
        self.answers.resize(self.questions.len(), Q::BLANK);
        if !self.questions.is_empty() {
            Q::answer(f, &self.questions, &mut self.answers, work);
        }
        self.questions.clear();
    }
}

impl<'a> Desk<'a> {
    pub(super) fn new(surfaces: &'a [Surface<'a>], work: &'a mut Workspace, learned: Learned) -> Self {
        let piles = surfaces.iter().map(|_| Piles::default()).collect();
        Self { surfaces, work: RefCell::new(work), learned: RefCell::new(learned), piles, round: Cell::new(0) }
    }

    pub(super) fn surfaces(&self) -> &'a [Surface<'a>] {
        self.surfaces
    }

    /// What searches have learned of choices: one at once from another. Rounds go in a fixed order, so it is always the same.
    pub(super) fn learned(&self) -> RefMut<'_, Learned> {
        self.learned.borrow_mut()
    }

    /// For what is asked without waiting.
    pub(super) fn work(&self) -> RefMut<'_, &'a mut Workspace> {
        self.work.borrow_mut()
    }

    /// Asks some questions about a surface at once. Waits for a round.
    pub(super) fn ask<Q: Question, const K: usize>(&self, surface: usize, questions: [Q; K]) -> Wait<'_, Q, K> {
        let pile = Q::pile(&self.piles[surface]);
        let mut asked = pile.borrow_mut();
        let first = asked.questions.len();
        if first == 0 {
            // Once, not step by step: questions are large.
            asked.questions.reserve(Learned::COMPANY);
        }
        asked.questions.extend(questions);
        Wait { pile, first, round: &self.round, asked: self.round.get() }
    }

    /// Answers what has been asked. Every search that asked must be polled once before the next round.
    pub(super) fn answer(&self) {
        let mut work = self.work.borrow_mut();
        for (surface, piles) in self.surfaces.iter().zip(&self.piles) {
            piles.answer(surface.function, &mut work);
        }
        self.round.set(self.round.get() + 1);
    }
}

#[cfg(test)]
impl Desk<'_> {
    /// What a search finds alone.
    pub(super) fn alone<T>(&self, search: impl Future<Output = T>) -> T {
        let (mut search, mut context) = (std::pin::pin!(search), Context::from_waker(std::task::Waker::noop()));
        loop {
            if let Poll::Ready(found) = search.as_mut().poll(&mut context) {
                return found;
            }
            self.answer();
        }
    }
}

/// Waits for the end of the round.
pub(super) struct Wait<'d, Q: Question, const K: usize> {
    pile: &'d RefCell<Pile<Q, Q::Answer>>,
    first: usize,
    /// Rounds that are over, now and when it was asked.
    round: &'d Cell<u64>,
    asked: u64,
}

impl<Q: Question, const K: usize> Future for Wait<'_, Q, K> {
    type Output = [Q::Answer; K];
    /// Panics where its round is over for long: what stands there now are answers to others.
    fn poll(self: Pin<&mut Self>, _: &mut Context<'_>) -> Poll<Self::Output> {
        let rounds = self.round.get() - self.asked;
        if rounds == 0 {
            return Poll::Pending;
        }
        assert_eq!(rounds, 1, "an answer is taken in the round after the question");
        let pile = self.pile.borrow();
        Poll::Ready(std::array::from_fn(|k| pile.answers[self.first + k]))
    }
}
