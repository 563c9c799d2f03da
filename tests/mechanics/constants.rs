//! Constants of nature stand in expressions as they are, whatever their size.

use lagrange_core::prelude::*;

#[derive(Lagrangian)]
#[coordinates(x)]
#[define(h = 6.62607015e-34)]
#[define(k_b = 1.380649e-23)]
#[lagrangian(m/2 * x_dot^2 - h^2/(8*m*x^2) - k_b*6.02214076e23*t*x - (1 + 1e-50)*x)]
#[observable(planck = h)]
#[observable(squared = h^2)]
#[observable(avogadro = 6.02214076e23)]
#[observable(least = 2.3e-308)]
#[observable(greatest = -1.7e308)]
#[observable(power = 7^100)]
#[observable(difference = 1e-60*x - (1e-60 + 1e-61)*x)]
struct Particle<T> {
    m: T,
}

/// x'' m = h^2/(4 m x^3) - R t - 1
#[test]
fn the_equations_have_them() {
    let (m, x, t) = (2e-60, 3e-3, 0.25);
    let particle = Particle { m };
    let state = State::at_rest([x]).at_time(t);
    let h = 6.62607015e-34_f64;
    let expected = (h * h / (4.0 * m * x * x * x) - 8.31446261815324 * t - 1.0) / m;
    let found = particle.solve(&state).unwrap().accelerations[0];
    // A rounding for each of a dozen operations, and the terms are of one size.
    assert!((found / expected - 1.0).abs() < 40.0 * f64::EPSILON, "{found:e} {expected:e}");
}

/// The nearest numbers to the decimals, as Rust reads them.
#[test]
fn literals_are_rounded_once() {
    let (particle, state) = (Particle { m: 1.0_f64 }, State::at_rest([1.0]));
    for (found, expected) in [
        (particle.planck(&state), 6.62607015e-34_f64),
        (particle.squared(&state), 4.3904805632721022e-67),
        (particle.avogadro(&state), 6.02214076e23),
        (particle.least(&state), 2.3e-308),
        (particle.greatest(&state), -1.7e308),
    ] {
        assert_eq!(found.to_bits(), expected.to_bits(), "{found:e} {expected:e}");
    }
    // 100 roundings at most.
    assert!((particle.power(&state) / 7.0_f64.powi(100) - 1.0).abs() < 1e-13);
    assert!((particle.difference(&state) / -1e-61 - 1.0).abs() < 4.0 * f64::EPSILON);
}

#[test]
fn in_single_precision_they_are_rounded_to_it() {
    let (particle, state) = (Particle { m: 1.0_f32 }, State::at_rest([1.0_f32]));
    assert_eq!(particle.planck(&state), 6.62607015e-34_f64 as f32);
    assert_eq!(particle.squared(&state), 0.0);
}

#[test]
fn they_are_read_with_their_power_of_ten() {
    let text = Particle::<f64>::equations().text();
    assert!(text.contains("h = 6.62607015×10⁻³⁴"), "{text}");
    assert!(text.contains("6.02214076×10²³"), "{text}");
    let (_, equations) = text.split_once("Equations of motion").unwrap();
    assert!(equations.contains("10⁻⁵⁰"), "{text}");
    let latex = Particle::<f64>::equations().latex();
    assert!(latex.contains(r"h &= 6.62607015 \times 10^{-34}"), "{latex}");
}
