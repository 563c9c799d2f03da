//! Frames: each word of their language against poses multiplied by hand, systems against the same systems without frames.

mod bicycle;
mod moving;
mod powers;
mod same;
mod vocabulary;
