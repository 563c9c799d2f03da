//! Rounds of a test on random input, each with a seed of its own.

use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::{Duration, Instant};

use crate::{Random, cases};

/// Time limit of one round. A longer round counts as an endless loop.
const PATIENCE: Duration = Duration::from_secs(300);

/// Runs `round` with consecutive seeds, as often as [`cases`] says for the level. The environment variable
/// `LAGRANGE_SEED` sets the first seed, 1 by default. A round that panics prints its seed.
///
/// # Panics
///
/// If a round panics. Aborts if a round takes longer than five minutes.
pub fn rounds(name: &'static str, levels: [usize; 3], mut round: impl FnMut(&mut Random)) {
    let first =
        std::env::var("LAGRANGE_SEED").map_or(1, |seed| seed.parse().expect("LAGRANGE_SEED is a number"));
    let (begin, (begun, heard)) = (Instant::now(), channel());
    let watch = std::thread::spawn(move || watch(name, &heard));
    let count = cases(levels);
    for seed in (first..).take(count) {
        let _blame = Blame { name, seed };
        begun.send(seed).expect("the watch listens");
        round(&mut Random(seed));
    }
    drop(begun);
    watch.join().expect("the watch does not panic");
    println!("{name}: {count} rounds from LAGRANGE_SEED={first} in {:.1} s", begin.elapsed().as_secs_f64());
}

/// Aborts the process if a round exceeds [`PATIENCE`]. A thread cannot stop another thread.
fn watch(name: &str, heard: &Receiver<u64>) {
    let mut seed = 0;
    loop {
        match heard.recv_timeout(PATIENCE) {
            Ok(begun) => seed = begun,
            Err(RecvTimeoutError::Disconnected) => return,
            Err(RecvTimeoutError::Timeout) => {
                eprintln!("{name}: the round of LAGRANGE_SEED={seed} does not end");
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
            eprintln!("{name}: to see it again, set LAGRANGE_SEED={seed}");
        }
    }
}
