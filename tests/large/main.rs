//! Systems so large that the compiler takes a minute for each.

mod long_functions;
mod stack;
