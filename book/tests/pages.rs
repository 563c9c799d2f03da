//! The pages among each other: what they show are files, links lead somewhere, none is prose alone.

use std::collections::HashSet;
use std::fs::read_to_string;
use std::path::{Path, PathBuf};

fn book() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn read(path: &Path) -> String {
    read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn pages() -> Vec<PathBuf> {
    let pages = lagrange_book::PAGES.iter().map(|page| book().join("src").join(format!("{page}.md")));
    pages.collect()
}

#[test]
fn programs_that_are_files_are_shown_as_they_are() {
    for (page, folder, files) in [
        ("start.md", "examples", &["swing.rs"][..]),
        ("problems.md", "tests/tasks", &["lecturer.rs", "engineer.rs", "games.rs"]),
        (
            "interchange.md",
            "interchange",
            &[
                "solvers/Cargo.toml",
                "solvers/tests/ode_solvers.rs",
                "solvers/tests/diffsol.rs",
                "python/Cargo.toml",
                "python/pyproject.toml",
                "python/src/lib.rs",
                "python/swing.py",
            ],
        ),
    ] {
        for file in files {
            lagrange_book::shows(page, file, &read(&book().join(folder).join(file)));
        }
    }
}

/// Its attributes, which is where it differs from others.
#[test]
fn the_robot_is_shown_as_it_is_written() {
    let robot = read(&book().join("../lagrange-urdf/tests/robots/two_link.rs"));
    let end = robot.find("pub struct").expect("a struct");
    lagrange_book::shows("robots.md", "two_link.rs", &robot[..end]);
}

#[test]
fn the_summary_has_every_page_once() {
    let summary = read(&book().join("src/SUMMARY.md"));
    let mut listed: Vec<_> = links(&summary).collect();
    let mut run: Vec<_> = lagrange_book::PAGES.iter().map(|page| format!("{page}.md")).collect();
    listed.sort_unstable();
    run.sort_unstable();
    assert_eq!(listed, run);
}

#[test]
fn no_page_is_prose_alone() {
    for page in pages() {
        // What is shown of a file is run where that is.
        let runs = read(&page).lines().any(|line| line == "```rust" || line.ends_with(".rs -->"));
        assert!(runs, "{} has no program that is run", page.display());
    }
}

#[test]
fn every_link_leads_somewhere() {
    let root = book().join("..");
    let texts = ["README.md", "CONTRIBUTING.md", "CHANGELOG.md"].map(|name| root.join(name));
    let mut broken = Vec::new();
    for file in pages().into_iter().chain(texts) {
        let text = read(&file);
        for link in links(&text).filter(|link| !link.contains("://")) {
            let (path, anchor) = link.split_once('#').unwrap_or((&link, ""));
            let target = match path {
                "" => file.clone(),
                path => file.with_file_name(path),
            };
            let is_there = target.exists() && (anchor.is_empty() || anchors(&read(&target)).contains(anchor));
            if !is_there {
                broken.push(format!("{}: {link}", file.display()));
            }
        }
    }
    assert!(broken.is_empty(), "{broken:#?}");
}

/// The targets of `[text](target)` and `<img src="target"` outside of code.
fn links(text: &str) -> impl Iterator<Item = String> {
    let mut is_code = false;
    let mut found = Vec::new();
    for line in text.lines() {
        is_code ^= line.starts_with("```");
        let prose: String = line.split('`').step_by(2).collect::<Vec<_>>().join("·");
        let targets = [("](", ')'), ("<img src=\"", '"')]
            .into_iter()
            .flat_map(|(begin, end)| prose.split(begin).skip(1).filter_map(move |rest| rest.split_once(end)));
        found.extend(targets.filter(|_| !is_code).map(|(target, _)| target.to_owned()));
    }
    found.into_iter()
}

/// What headings are called in links.
fn anchors(text: &str) -> HashSet<String> {
    let headings = text
        .lines()
        .filter_map(|line| line.trim_start_matches('#').strip_prefix(' ').filter(|_| line.starts_with('#')));
    headings
        .map(|heading| {
            let kept = heading.to_lowercase().replace(' ', "-");
            kept.chars().filter(|c| c.is_alphanumeric() || "-_".contains(*c)).collect()
        })
        .collect()
}
