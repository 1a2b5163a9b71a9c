mod decorations;
mod expressions;
mod forms;
mod infinity;
mod operators;
mod tightness;
mod user_functions;
