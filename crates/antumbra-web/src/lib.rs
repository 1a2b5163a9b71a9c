//! The heart as WebAssembly: a [`Studio`] holds one scene and one render, and speaks in JSON and bytes.
//!
//! The functions that JavaScript calls (`abi.rs`) are plain exports of numbers, no generated glue: a text or a picture lies in the
//! module's memory, and a call returns where. All that they do is to call a [`Studio`], which native tests call as well.
#![deny(unsafe_code)]

#[cfg(target_family = "wasm")]
mod abi;
mod answer;
mod gpu;
mod remote;
mod request;
mod studio;

pub use remote::{About, Order};
pub use request::{CameraRequest, LightRequest, Request};
pub use studio::Studio;
