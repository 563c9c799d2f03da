//! Mechanical systems for tests and benches, each derived once.

use lagrange_core::State;
use lagrange_random::Random;

/// Returns a random state: coordinates and velocities of either sign, up to 1.5, and a time from 0 to 3.
pub fn random_state<const N: usize>(random: &mut Random) -> State<f64, N> {
    let (q, v) = (random.array(Random::signed), random.array(Random::signed));
    State::new(q, v).at_time(random.between(0.0, 3.0))
}
