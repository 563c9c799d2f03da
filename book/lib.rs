//! The book's programs: `cargo test -p lagrange-book` compiles and runs every code block of every page.

mod blocks;

/// Checks that the block after the line `<!-- name -->` in this page is `text`; with `UPDATE_BOOK=1` it is made so.
pub fn shows(page: &str, name: &str, text: &str) {
    blocks::check(env!("CARGO_MANIFEST_DIR").as_ref(), page, name, text);
}

/// A page's code blocks are the examples of a module's documentation.
macro_rules! pages {
    ($($name:ident),* $(,)?) => {
        /// The pages whose programs are run.
        pub const PAGES: &[&str] = &[$(stringify!($name)),*];
        $(
            #[cfg(doctest)]
            #[doc = include_str!(concat!("src/", stringify!($name), ".md"))]
            mod $name {}
        )*
    };
}

pages!(
    start,
    bead,
    constraints,
    conserved,
    rolling,
    nonholonomic,
    moving_frames,
    bodies,
    any_number,
    printed,
    hamiltonian,
    small_motions,
    orbits,
    control,
    robots,
    fits,
    events,
    contacts,
    ensembles,
    embedded,
    interchange,
    own_method,
    own_numbers,
    pictures,
    problems,
    language,
    compile_time,
    methods,
    costs,
    limits,
    path,
    runtime,
);
