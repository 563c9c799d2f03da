//! Reproducible random numbers for tests, and how many random cases each level of testing takes.

mod random;
mod rounds;

pub use random::Random;
pub use rounds::rounds;

/// How thorough a run of the tests is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Level {
    /// `cargo test`, after each edit.
    Test,
    /// `.ci/run`, before a change lands.
    Run,
    /// `.ci/full`, once a week.
    Full,
}

impl Level {
    /// Returns the level that the environment variable `LAGRANGE_CASES` names: `test` (also if it is not set), `run` or
    /// `full`.
    ///
    /// # Panics
    ///
    /// If it is something else.
    pub fn asked() -> Self {
        match std::env::var("LAGRANGE_CASES").as_deref() {
            Err(_) | Ok("test") => Self::Test,
            Ok("run") => Self::Run,
            Ok("full") => Self::Full,
            Ok(other) => panic!("LAGRANGE_CASES is `test`, `run` or `full`, not `{other}`"),
        }
    }
}

/// True for `option_env!("LAGRANGE_CASES")` at the level [`Full`](Level::Full): tests that take long to compile at that
/// level alone ask for it in a constant.
pub const fn is_full(level: Option<&str>) -> bool {
    match level {
        Some(level) => matches!(level.as_bytes(), b"full"),
        None => false,
    }
}

/// Returns the number of random cases for the level that is asked for, of those for `cargo test`, `.ci/run` and
/// `.ci/full`.
///
/// ```
/// use lagrange_random::{Random, cases};
///
/// let mut random = Random(1);
/// for _ in 0..cases([20, 200, 100_000]) {
///     let x = random.between(-3.0, 3.0);
///     assert!((x.sin().powi(2) + x.cos().powi(2) - 1.0).abs() < 1e-15);
/// }
/// ```
pub fn cases([test, run, full]: [usize; 3]) -> usize {
    match Level::asked() {
        Level::Test => test,
        Level::Run => run,
        Level::Full => full,
    }
}
