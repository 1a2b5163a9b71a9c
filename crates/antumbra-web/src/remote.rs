//! A GPU that somebody else holds: orders are left to be fetched, and the one answer that is waited for is brought.
use antumbra::render::Clock;
use antumbra_gpu::{Error, Machine, Usage};
use bytemuck::Pod;
use serde::{Deserialize, Serialize};
use std::cell::{Cell, RefCell};
use std::collections::{BTreeMap, HashMap};
use std::future::poll_fn;
use std::rc::Rc;
use std::task::Poll;

/// What whoever holds the GPU says of it.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct About {
    /// The adapter's name.
    pub name: String,
    /// Whether a processor plays the GPU.
    pub software: bool,
    /// No buffer may be larger; bytes.
    pub largest: u64,
}

/// What the holder is to do, one after the other. Things are known by numbers, each of which is given once.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "do", rename_all = "lowercase")]
pub enum Order {
    /// A new buffer of zeros; for numbers that kernels only read if `uniform`, else to be read and written.
    Buffer {
        /// Its number.
        id: u32,
        /// Its size.
        bytes: u64,
        /// `var<uniform>`.
        uniform: bool,
    },
    /// A kernel to compile.
    Pipeline {
        /// Its number.
        id: u32,
        /// All of its WGSL.
        text: String,
        /// The function to run.
        entry: String,
        /// Values of `override`s.
        constants: BTreeMap<String, f64>,
    },
    /// Buffers in the places that a kernel names.
    Bind {
        /// Its number.
        id: u32,
        /// The kernel.
        pipeline: u32,
        /// Places, and the buffers there.
        buffers: Vec<(u32, u32)>,
    },
    /// Nobody will ask for it again.
    Free {
        /// Whatever has that number.
        id: u32,
    },
    /// Words for the beginning of a buffer.
    Write {
        /// The buffer.
        id: u32,
        /// What is written.
        words: Vec<u32>,
    },
    /// Zeros for the whole of a buffer.
    Clear {
        /// The buffer.
        id: u32,
    },
    /// The whole of a buffer into another one.
    Copy {
        /// The one that is read.
        from: u32,
        /// The one that is written.
        to: u32,
    },
    /// Groups of a kernel. Answered by no bytes when they are done, and all orders before them.
    Run {
        /// The number of the answer.
        ticket: u32,
        /// The kernel.
        pipeline: u32,
        /// Its buffers.
        binding: u32,
        /// So many groups.
        groups: u32,
    },
    /// Answered by the first bytes of a buffer.
    Read {
        /// The number of the answer.
        ticket: u32,
        /// The buffer.
        id: u32,
        /// So many.
        bytes: u64,
    },
}

/// The near end of such a GPU.
#[derive(Clone)]
pub(crate) struct Remote(Rc<Desk>);

struct Desk {
    about: About,
    clock: Clock,
    orders: RefCell<Vec<Order>>,
    /// The number of the answer that is waited for, and the answer.
    ticket: Cell<u32>,
    answer: RefCell<Option<Result<Vec<u8>, String>>>,
    /// Numbers that were given, to things and to answers.
    given: Cell<u32>,
    /// What was compiled, by its text, entry point and constants.
    pipelines: RefCell<HashMap<(String, String), Rc<Thing>>>,
}

/// Something that the holder keeps until this is dropped.
pub(crate) struct Thing {
    id: u32,
    bytes: u64,
    desk: Rc<Desk>,
}

/// Buffers in their places; they are kept as long as it is.
pub(crate) struct Binding {
    thing: Thing,
    _buffers: Vec<Rc<Thing>>,
}

impl Drop for Thing {
    fn drop(&mut self) {
        self.desk.orders.borrow_mut().push(Order::Free { id: self.id });
    }
}

/// Kernels that are kept: some more than those of the last few formulas.
const KEPT: usize = 40;

impl Remote {
    pub(crate) fn new(about: About, clock: Clock) -> Self {
        let (orders, ticket, answer, given, pipelines) = Default::default();
        Self(Rc::new(Desk { about, clock, orders, ticket, answer, given, pipelines }))
    }

    /// What was ordered since the last call.
    pub(crate) fn take_orders(&self) -> Vec<Order> {
        self.0.orders.take()
    }

    /// An answer, or why there will be none. Only the one that is waited for is taken.
    pub(crate) fn answer(&self, ticket: u32, answer: Result<Vec<u8>, String>) {
        if ticket == self.0.ticket.get() {
            self.0.answer.replace(Some(answer));
        }
    }

    /// Forgets kernels: they refer to the desk, which refers to them.
    pub(crate) fn close(&self) {
        drop(self.0.pipelines.take());
    }

    fn order(&self, order: Order) {
        self.0.orders.borrow_mut().push(order);
    }

    fn number(&self) -> u32 {
        self.0.given.set(self.0.given.get() + 1);
        self.0.given.get()
    }

    fn thing(&self, bytes: u64) -> Thing {
        Thing { id: self.number(), bytes, desk: Rc::clone(&self.0) }
    }

    /// Gives an order and waits for its answer.
    async fn ask(&self, order: impl FnOnce(u32) -> Order) -> Result<Vec<u8>, Error> {
        let ticket = self.number();
        self.order(order(ticket));
        // Whatever was said to somebody who does not listen any more is gone.
        self.0.ticket.set(ticket);
        self.0.answer.take();
        let taken = || self.0.answer.take();
        poll_fn(|_| taken().map_or(Poll::Pending, Poll::Ready)).await.map_err(Error::Failed)
    }
}

impl Machine for Remote {
    type Buffer = Rc<Thing>;
    type Pipeline = Rc<Thing>;
    type Binding = Binding;

    fn name(&self) -> &str {
        &self.0.about.name
    }

    fn is_software(&self) -> bool {
        self.0.about.software
    }

    fn seconds(&self) -> f64 {
        (self.0.clock)().as_secs_f64()
    }

    fn buffer(&self, bytes: u64, usage: Usage) -> Result<Rc<Thing>, Error> {
        if bytes > self.0.about.largest {
            return Err(Error::Failed(format!("a buffer of {bytes} bytes is larger than it allows")));
        }
        let thing = self.thing(bytes.max(16));
        self.order(Order::Buffer { id: thing.id, bytes: thing.bytes, uniform: usage == Usage::Uniform });
        Ok(Rc::new(thing))
    }

    fn size(&self, buffer: &Rc<Thing>) -> u64 {
        buffer.bytes
    }

    fn write(&self, buffer: &Rc<Thing>, content: &[u8]) {
        let word = |bytes: &[u8]| u32::from_le_bytes(bytes.try_into().expect("four bytes are a word"));
        self.order(Order::Write { id: buffer.id, words: content.chunks_exact(4).map(word).collect() });
    }

    fn pipeline(&self, text: &str, entry: &str, constants: &[(&str, f64)]) -> Result<Rc<Thing>, Error> {
        let key = (text.to_owned(), format!("{entry} {constants:?}"));
        let kept = self.0.pipelines.borrow().get(&key).cloned();
        if let Some(pipeline) = kept {
            return Ok(pipeline);
        }
        if self.0.pipelines.borrow().len() >= KEPT {
            self.close();
        }
        let pipeline = Rc::new(self.thing(0));
        let constants = constants.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect();
        let (text, entry) = (text.to_owned(), entry.to_owned());
        self.order(Order::Pipeline { id: pipeline.id, text, entry, constants });
        self.0.pipelines.borrow_mut().insert(key, Rc::clone(&pipeline));
        Ok(pipeline)
    }

    fn bind(&self, pipeline: &Rc<Thing>, buffers: &[(u32, &Rc<Thing>)]) -> Result<Binding, Error> {
        let thing = self.thing(0);
        let kept = buffers.iter().map(|(_, buffer)| Rc::clone(buffer)).collect();
        let buffers = buffers.iter().map(|(place, buffer)| (*place, buffer.id)).collect();
        self.order(Order::Bind { id: thing.id, pipeline: pipeline.id, buffers });
        Ok(Binding { thing, _buffers: kept })
    }

    fn clear(&self, buffers: &[&Rc<Thing>]) {
        buffers.iter().for_each(|buffer| self.order(Order::Clear { id: buffer.id }));
    }

    fn copy(&self, from: &Rc<Thing>, to: &Rc<Thing>) {
        self.order(Order::Copy { from: from.id, to: to.id });
    }

    async fn run(&self, pipeline: &Rc<Thing>, binding: &Binding, groups: u32) -> Result<Option<f64>, Error> {
        let order = |ticket| Order::Run { ticket, pipeline: pipeline.id, binding: binding.thing.id, groups };
        self.ask(order).await.map(|_| None)
    }

    async fn read<T: Pod>(&self, buffer: &Rc<Thing>, bytes: u64) -> Result<Vec<T>, Error> {
        let answer = self.ask(|ticket| Order::Read { ticket, id: buffer.id, bytes }).await?;
        if answer.len() as u64 == bytes {
            Ok(bytemuck::pod_collect_to_vec(&answer))
        } else {
            Err(Error::Failed(format!("{} bytes were read instead of {bytes}", answer.len())))
        }
    }
}
