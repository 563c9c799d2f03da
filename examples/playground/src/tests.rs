//! The page's functions, without a page.

use crate::Reading;

const PENDULUM: &str = "#[coordinates(x, y)]
#[lagrangian(m/2 * (x_dot^2 + y_dot^2) - m*g*y)]
#[constraint(rod: x^2 + y^2 = l^2)]
#[observable(height = l + y)]
struct Pendulum { m: f64, g: f64, l: f64 }";

/// A start beside the rod is projected, and the energy stays.
#[test]
fn a_text_moves() {
    let reading = Reading::new(PENDULUM.to_owned());
    assert_eq!(reading.parameters(), ["m", "g", "l"]);
    for (method, loss) in [("Dop853", 1e-8), ("Dopri5", 1e-5), ("RungeKutta4", 1e-8)] {
        let run =
            reading.run(&[1.0, 10.0, 1.0], &[0.6, -0.7], &[0.0, 0.0], method, 10.0, 101).expect("it moves");
        assert_eq!((run.times.len(), run.states.len(), run.message.as_str()), (101, 404, ""));
        for state in run.states.chunks(4) {
            assert!((state[0].hypot(state[1]) - 1.0).abs() < 1e-9, "{state:?}");
        }
        let lost = run.energies.iter().map(|energy| (energy - run.energies[0]).abs()).fold(0.0, f64::max);
        assert!(lost < loss, "{method} loses {lost:e}");
        assert!((run.observables[0] - 1.0 - run.states[1]).abs() < 1e-15);
    }
}

#[test]
fn errors_are_at_their_tokens() {
    let text = PENDULUM.replace("m*g*y)", "m*g*ỹ·z)").replace("ỹ·z", "θ*z");
    let faults = Reading::new(text.clone()).faults();
    let characters: Vec<u16> = text.encode_utf16().collect();
    let marked: Vec<String> = faults
        .iter()
        .map(|fault| String::from_utf16_lossy(&characters[fault.start..fault.start + fault.length]))
        .collect();
    assert_eq!(marked, ["θ", "z"]);
    assert!(faults[1].message.contains("nothing is called `z`"), "{faults:?}");
}

#[test]
fn a_motion_that_fails_says_why() {
    let fall = "#[coordinates(r)] #[lagrangian(r_dot^2/2 + 1/r)] struct Fall;";
    let run = Reading::new(fall.to_owned()).run(&[], &[1.0], &[0.0], "Dop853", 3.0, 10).expect("it starts");
    assert!(!run.message.is_empty());
    assert!(run.times[9] < 1.2);
}

#[test]
fn the_program_has_the_values() {
    let reading = Reading::new(
        "#[coordinates(x)] #[lagrangian(m[1]*x_dot^2/2 - k*x^2)] struct Spring { m: [f64; 2], k: f64 }"
            .to_owned(),
    );
    let program = reading.program(&[2.0, 0.5], &[1.0], &[0.0], "RungeKutta4", 10.0);
    assert!(program.contains("let system = Spring { m: [0.0, 2.0], k: 0.5 };"), "{program}");
    assert!(program.contains("system.integrate(start, 10.0, RungeKutta4::with_step(0.002))?"), "{program}");
}
