//! LaTeX accepts the equations of all systems, and no line is too long.

use std::process::Command;

use super::everywhere::pages;

/// Typesets the systems that the tests of the crates derive, in one document.
#[test]
fn latex_sets_all_systems_without_an_overfull_line() {
    if Command::new("pdflatex").arg("--version").output().is_err() {
        eprintln!(
            "NOTE: there is no pdflatex here: not set (Debian has it in texlive-latex-base, with texlive-latex-recommended)"
        );
        return;
    }
    let folder = std::env::temp_dir().join(format!("lagrange-typeset-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let mut document = String::from(
        "\\documentclass{article}\n\\usepackage[utf8]{inputenc}\n\\usepackage{amsmath}\n\\allowdisplaybreaks\n\\hfuzz=0.1pt\n\\begin{document}\n",
    );
    let systems = pages().flatten().map(|[_, latex, _]| latex);
    for (number, latex) in systems.enumerate() {
        // Systems of the same name would have equal labels.
        let latex = latex.replace("\\label{eq:", &format!("\\label{{eq:{number}-"));
        document += &format!("% {number}\n\\typeout{{system {number}}}\n{latex}\n\n");
    }
    document += "\\end{document}\n";
    std::fs::write(folder.join("all.tex"), &document).expect("a file");
    let run = Command::new("pdflatex")
        .args(["-interaction=nonstopmode", "-halt-on-error", "all.tex"])
        .current_dir(&folder)
        .output()
        .expect("pdflatex");
    let log = String::from_utf8_lossy(&run.stdout).into_owned();
    let overfull: Vec<&str> = log.lines().filter(|line| line.contains("Overfull")).collect();
    let multiply = log.lines().filter(|line| line.contains("multiply defined")).count();
    assert!(run.status.success(), "{}", &log[log.len().saturating_sub(3000)..]);
    assert!(overfull.is_empty() && multiply == 0, "{} overfull: {overfull:#?}", overfull.len());
    std::fs::remove_dir_all(&folder).expect("an empty folder");
}
