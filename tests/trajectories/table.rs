//! Trajectories as comma-separated values.

use lagrange_core::prelude::*;

/// A bead on a rod of length l, in polar coordinates: what is asked for twice stands there once.
#[derive(Lagrangian)]
#[coordinates(r, phi)]
#[lagrangian(m/2 * (r_dot^2 + r^2 * phi_dot^2))]
#[constraint(rod: r = l)]
#[observable(tension = -lambda(rod))]
#[conserved(moment = m * r^2 * phi_dot)]
struct Bead {
    m: f64,
    l: f64,
}

/// Names, and the numbers of each line.
fn read(table: &str) -> (Vec<&str>, Vec<Vec<f64>>) {
    let mut lines = table.lines();
    let names = lines.next().expect("a header").split(',').collect();
    let cells = |line: &str| line.split(',').map(|cell| cell.parse().expect("a number")).collect();
    (names, lines.map(cells).collect())
}

#[test]
fn energy_and_conserved_quantities_stand_in_the_table_on_request() {
    let bead = Bead { m: 2.0, l: 0.5 };
    let path = bead.integrate(State::new([0.5, 0.0], [0.0, 3.0]), 4.0, Dop853::default()).unwrap();
    let plain = "t,r,phi,r_dot,phi_dot,lambda(rod),force(r),force(phi),tension,moment";
    for (table, more) in [
        (path.csv(9), ""),
        (path.csv(9).energy(), ",energy"),
        (path.csv(9).conserved(), ",p_phi,energy"),
        (path.csv(9).conserved().energy(), ",energy,p_phi"),
    ] {
        let text = table.to_string();
        let (names, rows) = read(&text);
        assert_eq!(names.join(","), format!("{plain}{more}"));
        assert_eq!(rows.len(), 9);
        for row in rows {
            let phi = 3.0 * row[0];
            for (name, cell) in names.iter().zip(row) {
                let exact = match *name {
                    "t" => continue,
                    "r" => 0.5,
                    "phi" => phi,
                    "phi_dot" => 3.0,
                    // m r φ̇² towards the pivot.
                    "lambda(rod)" | "force(r)" => -9.0,
                    "tension" => 9.0,
                    "moment" | "p_phi" => 1.5,
                    "energy" => 2.25,
                    _ => 0.0,
                };
                assert!((cell - exact).abs() < 1e-9, "{name} is {cell}, not {exact}");
            }
        }
    }
}
