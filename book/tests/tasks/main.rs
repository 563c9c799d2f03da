//! Nine tasks, as a lecturer, a control engineer and a programmer of games would set them, solved with what the book says.

mod engineer;
mod games;
mod lecturer;
