//! How orbits, monodromy matrices and families are printed.

use lagrange_core::prelude::*;

use lagrange_systems::{DrivenSpring, HenonHeiles};

use crate::systems::{DRIVEN, PENDULUM};

/// Pairs, moduli, and no digits that are round-off.
#[test]
fn printed_orbit() {
    let guess = State::new([0.0, 0.0], [0.0, 0.45]);
    let search = HenonHeiles.periodic_orbit(&guess).period_near(6.6).energy(0.1);
    let orbit = search.find().unwrap();
    let text = orbit.to_string();
    let lines: Vec<_> = text.lines().collect();
    let [title, start, around, pair, trivial] = lines[..] else { panic!("{text}") };
    assert!(title.starts_with("periodic orbit of HenonHeiles: period 7.1"), "{text}");
    // The motion along the axis has x = ẋ = 0 but for round-off.
    assert!(start.starts_with("start: t = 0.0: q = (0.0, ") && start.contains("q̇ = (0.0, 0.4"), "{text}");
    assert!(around.contains(": symplectic, by an error of "), "{text}");
    assert!(pair.starts_with("multipliers ") && pair.ends_with(" i, |λ| = 1") && pair.len() < 90, "{text}");
    assert_eq!(trivial, "multipliers 1 and 1 of the shift along the orbit and of its energy");
    assert!(text.ends_with(&orbit.monodromy.to_string()));
}

#[test]
fn printed_monodromies() {
    let around = |k, c| {
        let method = Dop853::with_tolerance(1e-13);
        DrivenSpring { k, c, a: 0.0, ..DRIVEN }
            .monodromy(&State::at_rest([0.0]), 1.0, method)
            .unwrap()
            .to_string()
    };
    // e and 1/e, a decaying turn, and two real ones.
    let text = around(-1.0, 0.0);
    assert!(text.starts_with("monodromy over 1: symplectic, by an error of "), "{text}");
    assert!(text.ends_with("\nmultipliers 2.7182818285 and 0.36787944117, |λ| = 2.7182818285\n"), "{text}");
    let text = around(1.0, 0.2);
    assert!(text.starts_with("monodromy over 1: not symplectic, by an error of "), "{text}");
    assert!(text.contains("\nmultipliers 0.49") && text.ends_with(" i, |λ| = 0.90483741804\n"), "{text}");
    assert_eq!(around(-1.0, 0.2).matches("\nmultiplier ").count(), 2);
}

/// A table says what its columns are, and which orbits it leaves out.
#[test]
fn printed_family() {
    let search = PENDULUM.periodic_orbit(&State::at_rest([0.5])).period_near(6.3).mirrored(&["theta_dot"]);
    let family = search.family(&search.find().unwrap()).orbits(12).follow().unwrap();
    let text = family.to_string();
    let mut lines = text.lines();
    assert_eq!(
        lines.next(),
        Some(
            "12 periodic orbits of Pendulum: every tenth, the last, and all bifurcations; `csv` has all orbits"
        )
    );
    assert!(
        lines.next().is_some_and(|line| line.starts_with("|λ|: largest modulus of the multipliers")),
        "{text}"
    );
    assert!(text.contains("\n     0 ") && text.contains("\n    10 ") && text.contains("\n    11 "), "{text}");
}
