mod decorations;
mod expressions;
mod forms;
mod infinity;
mod operators;
mod quadratic;
mod tightness;
mod user_functions;
