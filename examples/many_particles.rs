//! Many particles in a rotating frame: Milton (8.52), (8.53).
//!
//! Four ions that repel each other are held in a trap that is longer in one direction and stirred: it turns with Ω.
//! In the frame of the trap L = Σ [m/2 v² + m v·(Ω×r) + m/2 (Ω×r)² − U(r)] − Σ V(r_a − r_b), nothing depends on the
//! time, and the energy function E = E₀ − Σ L_a·Ω (8.53) is conserved. Neither term is by itself: the trap stirs.

mod picture;

use lagrange_core::prelude::*;
use picture::{BLUE, GREY, Panel, Points, RED, Result};
use plotters::prelude::*;

/// The repulsion of two ions, k/|s|.
#[derive(Clone, Copy)]
struct Coulomb {
    k: f64,
}

impl Function<3, 1> for Coulomb {
    fn eval<S: Scalar>(&self, [x, y, z]: [S; 3]) -> [S; 1] {
        [S::constant(self.k) / (x * x + y * y + z * z).sqrt()]
    }
}

/// In the frame of the trap. Ion a is at q[3a], q[3a+1], q[3a+2]; `stiffness` is that of the trap's axes.
#[derive(Lagrangian)]
#[coordinates(q: [12])]
#[define(r[a in 0..4] = [q[3*a], q[3*a + 1], q[3*a + 2]])]
#[define(v[a in 0..4] = der(r[a]))]
#[define(W = [0, 0, rate])]
#[define(U(s) = 1/2*(stiffness[0]*s[0]^2 + stiffness[1]*s[1]^2 + stiffness[2]*s[2]^2))]
#[function(V(s: [3]) = repulsion)]
#[define(interaction = sum(a in 0..3, sum(b in a+1..4, V(r[a] - r[b]))))]
#[define(seen(a) = dot(v[a], v[a])/2 + dot(v[a], cross(W, r[a])) + dot(cross(W, r[a]), cross(W, r[a]))/2)]
#[lagrangian(sum(a in 0..4, m[a]*seen(a) - U(r[a])) - interaction)]
#[define(v_0[a in 0..4] = v[a] + cross(W, r[a]))]
#[observable(inertial_energy = sum(a in 0..4, m[a]/2*dot(v_0[a], v_0[a]) + U(r[a])) + interaction)]
#[observable(stirring = sum(a in 0..4, dot(cross(r[a], m[a]*v_0[a]), W)))]
struct StirredIons {
    m: [f64; 4],
    rate: f64,
    stiffness: [f64; 3],
    repulsion: Coulomb,
}

/// The same ions in the frame at rest, where the trap turns.
#[derive(Lagrangian)]
#[coordinates(q: [12])]
#[define(r[a in 0..4] = [q[3*a], q[3*a + 1], q[3*a + 2]])]
#[define(along(s) = s[0]*cos(rate*t) + s[1]*sin(rate*t))]
#[define(across(s) = s[1]*cos(rate*t) - s[0]*sin(rate*t))]
#[define(U(s) = 1/2*(stiffness[0]*along(s)^2 + stiffness[1]*across(s)^2 + stiffness[2]*s[2]^2))]
#[function(V(s: [3]) = repulsion)]
#[define(interaction = sum(a in 0..3, sum(b in a+1..4, V(r[a] - r[b]))))]
#[lagrangian(sum(a in 0..4, m[a]/2*dot(der(r[a]), der(r[a])) - U(r[a])) - interaction)]
struct IonsAtRest {
    m: [f64; 4],
    rate: f64,
    stiffness: [f64; 3],
    repulsion: Coulomb,
}

type Vectors = nalgebra::SVector<f64, 12>;
type Path<'a> = Trajectory<&'a StirredIons>;
type PathAtRest<'a> = Trajectory<&'a IonsAtRest>;

fn main() -> Result<()> {
    let (m, rate, stiffness) = ([1.0, 1.0, 1.0, 2.0], 0.3, [1.0, 1.6, 3.0]);
    let repulsion = Coulomb { k: 1.0 };
    let ions = StirredIons { m, rate, stiffness, repulsion };
    let inertial = IonsAtRest { m, rate, stiffness, repulsion };
    let start = State::new(
        [1.4, 0.1, 0.0, -0.2, 0.7, 0.1, -1.5, -0.1, 0.0, 0.1, -0.8, -0.1],
        [0.0, 0.2, 0.1, -0.1, 0.0, 0.0, 0.0, -0.1, 0.0, 0.1, 0.0, 0.1],
    );
    let method = Dop853::with_tolerance(1e-13);
    let path = ions.integrate(start, 50.0, method)?;
    let other = inertial.integrate(at_rest(&start, rate), 50.0, method)?;

    println!("{}", StirredIons::equations());
    println!("m = {m:?}, Ω = {rate}, stiffness of the trap {stiffness:?}, repulsion 1/|s|\n");
    table(&ions, &path);
    println!("\n{}, after {} steps\n", path.ending(), path.statistics().accepted);
    checks(&ions, &inertial, &path, &other)?;
    let file = picture::path("many_particles")?;
    draw(&ions, &path, &other, &file)?;
    println!("\npicture: {}", file.display());
    Ok(())
}

/// The state in the frame at rest, whose axes are the trap's at t = 0: r₀ and v₀ = v + Ω×r, turned by Ω t.
fn at_rest(s: &State<f64, 12>, rate: f64) -> State<f64, 12> {
    let mut v_0 = s.v;
    for x in (0..12).step_by(3) {
        v_0[x] -= rate * s.q[x + 1];
        v_0[x + 1] += rate * s.q[x];
    }
    State { t: s.t, q: turned(s.q, rate * s.t), v: turned(v_0, rate * s.t) }
}

/// Four vectors, turned about z.
fn turned(mut vectors: Vectors, angle: f64) -> Vectors {
    let (sine, cosine) = angle.sin_cos();
    for x in (0..12).step_by(3) {
        let [along, across] = [vectors[x], vectors[x + 1]];
        (vectors[x], vectors[x + 1]) = (cosine * along - sine * across, sine * along + cosine * across);
    }
    vectors
}

fn table(ions: &StirredIons, path: &Path<'_>) {
    println!(
        "{:>5} {:>9} {:>9} {:>13} {:>13} {:>17}",
        "t", "x of 1", "y of 1", "E₀", "Σ L_a·Ω", "E = p·q̇ − L"
    );
    for sample in path.samples(11) {
        let s = sample.state();
        println!(
            "{:5.1} {:9.5} {:9.5} {:13.8} {:13.8} {:17.12}",
            s.t,
            s.q[0],
            s.q[1],
            ions.inertial_energy(s),
            ions.stirring(s),
            ions.energy(s)
        );
    }
}

fn checks(ions: &StirredIons, inertial: &IonsAtRest, path: &Path<'_>, other: &PathAtRest<'_>) -> Result<()> {
    let energy = ions.energy(path.start().state());
    let mut worst = [0.0_f64; 4];
    for sample in path.samples(2001) {
        let s = sample.state();
        // The momenta, turned to the axes at rest, beside those of the ions there.
        let there = at_rest(s, ions.rate);
        let momentum = turned(ions.momentum(s), ions.rate * s.t);
        let momenta = (momentum - inertial.momentum(&there)).amax();
        let deviations = [
            ions.energy(s) - (ions.inertial_energy(s) - ions.stirring(s)),
            momenta,
            ions.energy(s) - energy,
            (there.q - other.at(s.t)?.state().q).amax(),
        ];
        worst = std::array::from_fn(|i| worst[i].max(deviations[i].abs()));
    }
    let laws = [
        "E = E₀ − Σ L_a·Ω (8.53)",
        "p = m (v + Ω×r), the momentum at rest (8.52)",
        "E is conserved",
        "the motion is that in the frame at rest",
    ];
    println!("largest deviation from the exact law");
    for (law, worst) in laws.into_iter().zip(worst) {
        println!("  {law:<46} {worst:8.1e}");
    }
    Ok(())
}

fn draw(ions: &StirredIons, path: &Path<'_>, other: &PathAtRest<'_>, file: &std::path::Path) -> Result<()> {
    let root = picture::sheet(file, (1100, 950))?;
    let panels = root.split_evenly((2, 2));
    let seen = |state: fn(&State<f64, 12>, f64) -> State<f64, 12>| -> Vec<State<f64, 12>> {
        path.samples(2000).map(|s| state(s.state(), ions.rate)).collect()
    };
    draw_paths("In the frame of the trap: the ions change places", &seen(|s, _| *s), &panels[0])?;
    draw_paths("The same in the frame at rest", &seen(at_rest), &panels[1])?;
    draw_energies(ions, path, &panels[2])?;
    draw_drift(ions, path, other, &panels[3])?;
    root.present()?;
    Ok(())
}

const BROWN: RGBColor = RGBColor(150, 110, 40);

fn draw_paths(title: &str, states: &[State<f64, 12>], area: &picture::Area) -> Result<()> {
    let mut chart = Panel::new(title, ["x", "y"]).equal_axes();
    for (ion, color) in [BLUE, RED, GREY, BROWN].into_iter().enumerate() {
        let place = |s: &State<f64, 12>| (s.q[3 * ion], s.q[3 * ion + 1]);
        chart.line(states.iter().map(place), color.stroke_width(1));
        let end = states.last().map(place).into_iter().collect();
        let name =
            if ion == 3 { "heavy ion at the end".to_owned() } else { format!("ion {} at the end", ion + 1) };
        chart.dots(&name, color, &end);
    }
    chart.draw(area)
}

fn draw_energies(ions: &StirredIons, path: &Path<'_>, area: &picture::Area) -> Result<()> {
    let against_time = |value: fn(&StirredIons, &State<f64, 12>) -> f64| -> Points {
        let start = value(ions, path.start().state());
        path.samples(800).map(|s| (s.time(), value(ions, s.state()) - start)).collect()
    };
    let [at_rest, stirring] = [StirredIons::inertial_energy, StirredIons::stirring].map(against_time);
    let energy = against_time(StirredIons::energy);
    let mut chart = Panel::new("E = E₀ − Σ L_a·Ω, Milton (8.53)", ["t", "change since the start"]);
    chart.curve("E₀, in the frame at rest", BLUE, &at_rest);
    chart.dots("Σ L_a·Ω", RED, &stirring.into_iter().step_by(20).collect());
    chart.curve("E, in the frame of the trap", GREY, &energy);
    chart.draw(area)
}

fn draw_drift(
    ions: &StirredIons,
    path: &Path<'_>,
    other: &PathAtRest<'_>,
    area: &picture::Area,
) -> Result<()> {
    let start = ions.energy(path.start().state());
    let (mut drift, mut apart) = (Points::new(), Points::new());
    for sample in path.samples(400) {
        let s = sample.state();
        drift.push((s.t, (ions.energy(s) - start) * 1e12));
        apart.push((s.t, (at_rest(s, ions.rate).q - other.at(s.t)?.state().q).amax() * 1e12));
    }
    let mut chart = Panel::new("What integration leaves", ["t", "deviation × 10¹²"]);
    chart.curve("E less its start", BLUE, &drift);
    chart.curve("both motions, largest distance", RED, &apart);
    chart.draw(area)
}
