
/// Chooses the mutant of this copy that runs.
#[allow(unused_imports)]
mod mutant {
    extern crate std;

    use std::io::Write;
    use std::sync::OnceLock;
    use std::sync::atomic::{AtomicBool, AtomicU32, Ordering::Relaxed};
    use std::{env, fs, writeln};

    const NONE: u32 = 0;
    const RECORDING: u32 = u32::MAX - 1;
    const UNREAD: u32 = u32::MAX;

    /// Number of the mutant, or what else to do.
    static ACTIVE: AtomicU32 = AtomicU32::new(UNREAD);

    /// Where executed mutants are recorded.
    static FILE: OnceLock<fs::File> = OnceLock::new();

    /// Mutants whose place was executed.
    static REACHED: [AtomicBool; 100_000] = [const { AtomicBool::new(false) }; 100_000];

    /// True for the mutant that `LAGRANGE_MUTANT` names. If `LAGRANGE_MUTANT_REACHED` names a file, no mutant runs, and
    /// the numbers of all whose place is executed are written to the file.
    ///
    /// The compiler warns of each use of a deprecated function, which shows the uses that are compiled.
    #[deprecated]
    pub(crate) fn is(number: u32) -> bool {
        match ACTIVE.load(Relaxed) {
            RECORDING => {
                if !REACHED[number as usize].swap(true, Relaxed) {
                    let mut file = FILE.get().expect("a file");
                    writeln!(file, "{number}").expect("a line");
                }
                false
            }
            UNREAD => {
                let chosen = env::var("LAGRANGE_MUTANT").ok().and_then(|text| text.parse().ok());
                let recorded = env::var_os("LAGRANGE_MUTANT_REACHED").map(|path| {
                    FILE.get_or_init(|| fs::File::options().append(true).open(path).expect("a file"));
                    RECORDING
                });
                ACTIVE.store(recorded.or(chosen).unwrap_or(NONE), Relaxed);
                is(number)
            }
            active => active == number,
        }
    }
}
