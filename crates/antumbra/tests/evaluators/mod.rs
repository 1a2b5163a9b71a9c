mod operators;
mod user_functions;
