//! The GPU of whoever shows the page: probed, then asked what it can prove of a picture; never waited for.
use crate::remote::{About, Order, Remote};
use antumbra::render::{Clock, Renderer};
use antumbra_gpu::{Error, Machine, Proved, kernels, probe};
use serde::Serialize;
use std::cell::Cell;
use std::pin::Pin;
use std::rc::Rc;
use std::sync::atomic::AtomicBool;
use std::task::{Context, Poll, Waker};

type Work<T> = Pin<Box<dyn Future<Output = Result<T, Error>>>>;

/// A GPU that was offered. Proofs are of the renderer's present picture: [`leave`](Self::leave) comes before another one.
pub(crate) struct Gpu {
    remote: Remote,
    /// It passed the probe.
    trusted: bool,
    task: Option<Task>,
}

enum Task {
    Probe(Work<probe::Report>),
    Prove { work: Work<Proved>, done: Rc<Cell<f64>>, begin: f64 },
}

/// Where the work stands, and what is to be done next.
#[derive(Debug, PartialEq, Serialize)]
pub(crate) struct Step {
    #[serde(flatten)]
    state: State,
    orders: Vec<Order>,
}

#[derive(Debug, PartialEq, Serialize)]
#[serde(tag = "state", rename_all = "lowercase")]
enum State {
    /// Nothing was asked.
    Idle,
    /// For an answer.
    Waits { progress: f64 },
    /// Its arithmetic is what proofs need, in so many cases; in so many of them it is not without the fence ([`probe::BARE`]).
    Passed { cases: usize, rewritten: [usize; 6] },
    /// The renderer has what was proved.
    Proved { pixels: usize, settled: usize, brackets: usize, narrow: usize, seconds: f64 },
    /// The processor does all of it.
    Failed { message: String },
}

impl Gpu {
    /// Begins the probe.
    pub(crate) fn open(about: About, clock: Clock) -> Self {
        let remote = Remote::new(about, clock);
        let probed = remote.clone();
        let work = Box::pin(async move { probe::run(&probed).await });
        Self { remote, trusted: false, task: Some(Task::Probe(work)) }
    }

    /// Begins to prove what it can of a picture that has not begun.
    pub(crate) fn begin(&mut self, renderer: &Renderer) -> Result<(), Error> {
        if !self.trusted {
            return Err(Error::Failed("it has not passed the probe".to_owned()));
        }
        let (gpu, kernels) = (self.remote.clone(), kernels(&self.remote, renderer)?);
        let done = Rc::new(Cell::new(0.0));
        let told = Rc::clone(&done);
        let work = Box::pin(async move {
            // Whoever wants it to stop drops it.
            let stop = AtomicBool::new(false);
            kernels.prove_async(&gpu, &stop, &mut |part| told.set(part)).await
        });
        self.task = Some(Task::Prove { work, done, begin: self.remote.seconds() });
        Ok(())
    }

    /// Goes on as far as answers allow.
    pub(crate) fn step(&mut self, renderer: Option<&mut Renderer>) -> Step {
        let state = self.advance(renderer);
        if !matches!(state, State::Waits { .. }) {
            self.task = None;
        }
        Step { state, orders: self.remote.take_orders() }
    }

    fn advance(&mut self, renderer: Option<&mut Renderer>) -> State {
        let failed = |error: Error| State::Failed { message: error.to_string() };
        let mut context = Context::from_waker(Waker::noop());
        match &mut self.task {
            None => State::Idle,
            Some(Task::Probe(work)) => match work.as_mut().poll(&mut context) {
                Poll::Pending => State::Waits { progress: 0.0 },
                Poll::Ready(Err(error)) => failed(error),
                Poll::Ready(Ok(report)) => {
                    self.trusted = true;
                    State::Passed { cases: report.cases, rewritten: report.rewritten }
                }
            },
            Some(Task::Prove { work, done, begin }) => match work.as_mut().poll(&mut context) {
                Poll::Pending => State::Waits { progress: done.get() },
                Poll::Ready(Err(error)) => failed(error),
                Poll::Ready(Ok(proved)) => {
                    let seconds = self.remote.seconds() - *begin;
                    let Some(renderer) = renderer else { return State::Idle };
                    match proved.give_to(renderer, [0.0, seconds]) {
                        Err(error) => failed(error),
                        Ok(share) => State::Proved {
                            pixels: share.pixels,
                            settled: share.settled,
                            brackets: share.brackets,
                            narrow: share.narrow,
                            seconds,
                        },
                    }
                }
            },
        }
    }

    /// An answer, or why there is none.
    pub(crate) fn answer(&self, ticket: u32, answer: Result<Vec<u8>, String>) {
        self.remote.answer(ticket, answer);
    }

    /// Nobody wants any more what is being proved: the picture is another one.
    pub(crate) fn leave(&mut self) {
        self.task.take_if(|task| matches!(task, Task::Prove { .. }));
    }
}

impl Drop for Gpu {
    fn drop(&mut self) {
        self.task = None;
        self.remote.close();
    }
}
