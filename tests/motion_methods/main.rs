//! Methods written against the public interface alone: a pair, an implicit one, and ones that go wrong; Radau; and what all
//! methods can be asked for.

mod combinations;
mod midpoint;
mod radau;
mod rosenbrock;
mod wrong;
