//! Facts of the paper's method on small pictures, and of its parts on functions with known zeros.
#[path = "paper/parts.rs"]
mod parts;
#[path = "paper/pictures.rs"]
mod pictures;
