//! The gallery: its files are complete, and its formulas are the surfaces that they claim to be.
#![allow(
    clippy::disallowed_methods,
    reason = "rounded points with tolerances, independent of the library's own functions"
)]

#[path = "gallery/field.rs"]
mod field;
#[path = "gallery/files.rs"]
mod files;
#[path = "gallery/minimal.rs"]
mod minimal;
#[path = "gallery/nodes.rs"]
mod nodes;
#[path = "gallery/points.rs"]
mod points;
#[path = "gallery/topology.rs"]
mod topology;
