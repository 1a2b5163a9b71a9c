//! Text -> syntax tree with spans -> shared graph with exact constants.
mod op;

pub use op::{Axis, Binary, Unary};
