//! Tests on random input. A test runs a fixed number of rounds, or rounds for a given time; each round has its own
//! seed.
//!
//! `LAGRANGE_FUZZ_SECONDS` is the duration of each test, `LAGRANGE_FUZZ_SEED` the first seed; round k has that seed
//! plus k. `LAGRANGE_FUZZ_SECONDS=0` runs one round. The inputs are random: no coverage feedback guides them.

use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::{Duration, Instant};

/// Pseudorandom numbers with a fixed seed (SplitMix64 of Steele, Lea and Flood).
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    pub(crate) fn below(&mut self, bound: usize) -> usize {
        (self.next() % bound as u64) as usize
    }

    /// Returns true with probability 1/`times`.
    pub(crate) fn once_in(&mut self, times: usize) -> bool {
        self.below(times) == 0
    }

    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub(crate) fn one_of<T: Clone>(&mut self, choices: &[T]) -> T {
        choices[self.below(choices.len())].clone()
    }
}

/// Time limit of one round. A longer round counts as an endless loop.
const PATIENCE: Duration = Duration::from_secs(300);

/// Runs `round` with consecutive seeds: `few` times, or for `LAGRANGE_FUZZ_SECONDS`.
pub(crate) fn rounds(name: &'static str, few: u64, mut round: impl FnMut(&mut Random)) {
    let asked = |variable: &str| std::env::var(variable).ok().and_then(|number| number.parse::<u64>().ok());
    let (first, seconds) = (asked("LAGRANGE_FUZZ_SEED").unwrap_or(1), asked("LAGRANGE_FUZZ_SECONDS"));
    let (begin, (begun, heard)) = (Instant::now(), channel());
    let watch = std::thread::spawn(move || watch(name, &heard));
    let is_over = |done: u64| match seconds {
        Some(seconds) => done > 0 && begin.elapsed().as_secs() >= seconds,
        None => done >= few,
    };
    let mut done = 0;
    while !is_over(done) {
        let seed = first.wrapping_add(done);
        let _blame = Blame { name, seed };
        begun.send(seed).expect("somebody watches");
        round(&mut Random(seed));
        done += 1;
    }
    drop(begun);
    watch.join().expect("it only watches");
    println!(
        "{name}: {done} rounds from LAGRANGE_FUZZ_SEED={first} in {:.1} s",
        begin.elapsed().as_secs_f64()
    );
}

/// Aborts the process if a round exceeds [`PATIENCE`]. A thread cannot stop another thread.
fn watch(name: &str, heard: &Receiver<u64>) {
    let mut seed = 0;
    loop {
        match heard.recv_timeout(PATIENCE) {
            Ok(begun) => seed = begun,
            Err(RecvTimeoutError::Disconnected) => return,
            Err(RecvTimeoutError::Timeout) => {
                eprintln!("{name}: the round of LAGRANGE_FUZZ_SEED={seed} does not end");
                std::process::abort();
            }
        }
    }
}

/// Prints the seed of a round that panics.
struct Blame {
    name: &'static str,
    seed: u64,
}

impl Drop for Blame {
    fn drop(&mut self) {
        if std::thread::panicking() {
            let Self { name, seed } = self;
            eprintln!("{name}: to see it again, LAGRANGE_FUZZ_SEED={seed} LAGRANGE_FUZZ_SECONDS=0");
        }
    }
}
