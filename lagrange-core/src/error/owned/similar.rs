//! Names similar to one that is not known, for messages.

use alloc::{format, string::String, vec::Vec};

/// Number of names listed in a message that counts the others; a single other one is listed too.
const LISTED: usize = 3;

/// Lists names for a message: up to four; of more, the three most similar to `name`, and the number of the others.
pub(crate) fn listed(name: &str, known: &[String]) -> String {
    let quoted = |names: &[&String]| {
        let names: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
        names.join(", ")
    };
    let mut names: Vec<&String> = known.iter().collect();
    if names.len() <= LISTED + 1 {
        return quoted(&names);
    }
    names.sort_by_key(|known| apart(name, known));
    format!("{} and {} more", quoted(&names[..LISTED]), names.len() - LISTED)
}

/// Returns the most similar name, if it is similar enough.
pub(crate) fn nearest<'a>(name: &str, known: &'a [String]) -> Option<&'a String> {
    let allowed = match name.chars().count() {
        0 | 1 => return None,
        2..=4 => 1,
        5..=8 => 2,
        _ => 3,
    };
    known.iter().filter(|known| apart(name, known) <= allowed).min_by_key(|known| apart(name, known))
}

/// Distance of two names. Differences of case alone count as zero.
fn apart(name: &str, known: &str) -> usize {
    if known.eq_ignore_ascii_case(name) { 0 } else { distance(name, known) }
}

/// Damerau–Levenshtein distance (Damerau 1964): number of letters changed, deleted, inserted or swapped with
/// the next.
fn distance(from: &str, to: &str) -> usize {
    let (from, to): (Vec<char>, Vec<char>) = (from.chars().collect(), to.chars().collect());
    let mut rows: Vec<Vec<usize>> = (0..=from.len()).map(|i| (i..=i + to.len()).collect()).collect();
    for i in 1..=from.len() {
        for j in 1..=to.len() {
            let changed = rows[i - 1][j - 1] + usize::from(from[i - 1] != to[j - 1]);
            let least = changed.min(rows[i - 1][j] + 1).min(rows[i][j - 1] + 1);
            let swaps = i > 1 && j > 1 && from[i - 2] == to[j - 1] && from[i - 1] == to[j - 2];
            rows[i][j] = if swaps { least.min(rows[i - 2][j - 2] + 1) } else { least };
        }
    }
    rows[from.len()][to.len()]
}

#[cfg(test)]
mod tests {
    use super::distance;

    #[test]
    fn names_are_as_far_apart_as_slips_of_the_pen() {
        for (from, to, slips) in [
            ("", "", 0),
            ("", "abc", 3),
            ("abc", "", 3),
            ("theta", "tetha", 2),
            ("theta", "theta_dot", 4),
            ("kitten", "sitting", 3),
            ("ψ", "φ", 1),
            ("ab", "ba", 1),
        ] {
            assert_eq!(distance(from, to), slips, "{from} {to}");
        }
    }
}
