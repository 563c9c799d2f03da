//! Methods written against the public interface alone: a pair, one with an interpolant of its own, and ones that go wrong;
//! Radau; and what all methods can be asked for.

mod combinations;
mod heun;
mod lengths;
mod many_bodies;
mod many_constraints;
mod midpoint;
mod one_line;
mod radau;
mod wrong;
