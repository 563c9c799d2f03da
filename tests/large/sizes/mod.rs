//! Systems of all sizes at which rustc does something of its own with a loop of N or M rounds. `.ci/sizes`
//! compiles them in release, with a limit on processor time, and many more.

mod oscillators;
mod stack;

oscillators!(free_31, f64, 31);
oscillators!(free_32, f64, 32);
oscillators!(free_33, f64, 33);
oscillators!(free_64, f64, 64);
oscillators!(held_32, f64, 32, 32);

#[test]
fn systems_of_31_32_33_and_64_coordinates_compile_and_move() -> Result<(), lagrange_core::Error> {
    free_31::run()?;
    free_32::run()?;
    free_33::run()?;
    free_64::run()?;
    held_32::run()
}
