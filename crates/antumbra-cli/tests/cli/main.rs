//! The program as its users meet it: one file a subject, each test in an empty folder of its own.

mod animation;
mod audit;
mod bad_input;
mod bands;
mod bench;
mod commands;
mod gallery;
mod help;
mod interrupt;
mod resume;
mod scene;
mod serve;
