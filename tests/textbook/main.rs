//! Systems of the textbooks against closed solutions: K. Milton, chapter 8.

mod chapter_frames;
mod chapter_pendulums;
mod chapter_rolling;
mod rolling_bodies;
mod spherical_pendulum;
