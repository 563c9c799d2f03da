//! A hundred spheres that are thrown on a floor with friction, far apart from one another. Whatever happens on the way, each of
//! them ends up rolling with 5/7 of its first velocity along the floor: friction has no moment about its points of contact.

use std::io::{BufRead, stdin};
use std::time::Duration;

pub const COUNT: usize = 100;
pub const MASS: f64 = 1.0;
pub const RADIUS: f64 = 0.5;
pub const GRAVITY: f64 = 9.81;
pub const FRICTION: f64 = 0.4;
pub const RESTITUTION: f64 = 0.3;
pub const SECONDS: usize = 10;

/// Position of sphere `i` at the start, with the height of its centre last.
pub fn position(i: usize) -> [f64; 3] {
    [(i % 10) as f64 * 30.0, (i / 10) as f64 * 30.0, 1.0 + 0.01 * i as f64]
}

/// Velocity of sphere `i` along the floor at the start.
pub fn velocity(i: usize) -> [f64; 2] {
    let (sine, cosine) = (i as f64).sin_cos();
    [sine, cosine]
}

/// What a run was, and what it took.
#[derive(Debug, Default)]
pub struct Run {
    /// Time that the steps took, without what is measured of them.
    pub spent: Duration,
    /// Largest depth of a sphere in the floor.
    pub depth: f64,
    /// Largest error of a velocity at the end.
    pub error: f64,
    /// Largest velocity of a lowest point along the floor at the end.
    pub slip: f64,
}

impl Run {
    /// Takes note of where a sphere is.
    pub fn passes(&mut self, height: f64) {
        self.depth = self.depth.max(RADIUS - height);
    }

    /// Takes note of how a sphere ends: velocity along the floor, and that of its lowest point.
    pub fn ends(&mut self, i: usize, along: [f64; 2], lowest: [f64; 2]) {
        for k in 0..2 {
            self.error = self.error.max((along[k] - velocity(i)[k] * 5.0 / 7.0).abs());
            self.slip = self.slip.max(lowest[k].abs());
        }
    }
}

/// Runs once for each line of the standard input, and answers with what it was; `ends` is the file that is expected at the end.
pub fn answer(ends: &str, mut run: impl FnMut() -> Run) {
    for line in stdin().lock().lines() {
        line.expect("a line");
        let Run { spent, depth, error, slip } = run();
        let seconds = spent.as_secs_f64();
        println!("{{\"seconds\": {seconds}, \"depth\": {depth}, \"error\": {error}, \"slip\": {slip}}}");
    }
    std::fs::write(ends, []).expect("a file");
}
