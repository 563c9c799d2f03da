//! `lagrange-urdf robot.urdf > robot.rs`

use std::process::ExitCode;

use lagrange_urdf::{HELP, Import, Options};

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if arguments.iter().any(|argument| argument == "--help") {
        print!("{HELP}");
        return ExitCode::SUCCESS;
    }
    match run(arguments) {
        Ok(Import { rust, notes }) => {
            notes.iter().for_each(|note| eprintln!("note: {note}"));
            print!("{rust}");
            ExitCode::SUCCESS
        }
        Err(errors) => {
            errors.iter().for_each(|error| eprintln!("error: {error}"));
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: Vec<String>) -> Result<Import, Vec<String>> {
    let (options, file) = Options::parse(arguments)?;
    let text = std::fs::read_to_string(&file).map_err(|error| vec![format!("{file}: {error}")])?;
    lagrange_urdf::import(&text, &options)
}
