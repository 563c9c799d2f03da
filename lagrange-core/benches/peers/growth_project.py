"""A plain user project with one derived system, of any size."""

import shutil

from workshop import HERE, ROOT, SHOP

PLANAR = """
#[coordinates(theta: [{n}])]
#[define(vx[0] = l[0]*cos(theta[0])*theta_dot[0])]
#[define(vx[i in 1..{n}] = vx[i-1] + l[i]*cos(theta[i])*theta_dot[i])]
#[define(vy[0] = l[0]*sin(theta[0])*theta_dot[0])]
#[define(vy[i in 1..{n}] = vy[i-1] + l[i]*sin(theta[i])*theta_dot[i])]
#[define(y[0] = -l[0]*cos(theta[0]))]
#[define(y[i in 1..{n}] = y[i-1] - l[i]*cos(theta[i]))]
#[lagrangian(sum(i in 0..{n}, m[i]/2*(vx[i]^2 + vy[i]^2) - m[i]*g*y[i]))]
"""
CHAIN = """
#[coordinates(x: [{n}], y: [{n}])]
#[lagrangian(sum(i in 0..{n}, m[i]/2*(x_dot[i]^2 + y_dot[i]^2) - m[i]*g*y[i]))]
#[constraint(rod[0]: (x[0]^2 + y[0]^2 - l[0]^2)/2 = 0)]
#[constraint(rod[i in 1..{n}]: ((x[i]-x[i-1])^2 + (y[i]-y[i-1])^2 - l[i]^2)/2 = 0)]
"""
SYSTEMS = {"pendulum": (PLANAR, (2, 5, 10, 20, 40, 80, 160)), "chain": (CHAIN, (2, 10, 20, 50, 100, 200, 400))}
STRUCT = "#[derive(Lagrangian)]{attributes}pub struct System {{ pub m: [f64; {n}], pub l: [f64; {n}], pub g: f64 }}\n"
MADE = "System {{ m: [1.0; {n}], l: [1.0; {n}], g: 9.81 }}"
MADE_HUMANOID = """Humanoid {
        at: [Vector3::repeat(0.1); 30],
        centre: [Vector3::zeros(); 31],
        inertia: [Matrix3::identity(); 31],
        m: [1.0; 31],
        g: 9.81,
        tau: [0.0; 30],
    }"""

# How the system is used: a program that uses every emitted function, one that integrates, one that does nothing with
# the system, and a library that exports it.
MAIN = """fn main() {{
    let system = std::hint::black_box({made});
    let state = std::hint::black_box(State::at_rest({start}));
    {statement}
}}
"""
EVERY = """let solution = system.accelerations_unchecked(&state);
    std::hint::black_box((system.lagrangian(&state), system.energy(&state), system.momentum(&state)));
    std::hint::black_box((system.momentum_rate(&state), system.mass_matrix(&state), system.forcing(&state)));
    std::hint::black_box((system.constraint_residual(&state), system.constraint_rate(&state)));
    std::hint::black_box((system.constraint_jacobian(&state), system.constraint_bias(&state)));
    std::hint::black_box((system.constraint_force(&state, &solution.multipliers), system.conserved(0, &state)));
    std::hint::black_box((solution.accelerations, solution.multipliers, solution.pivot));"""
USES = {
    "every function": EVERY,
    "integrates": "std::hint::black_box(system.integrate(state, 1.0, Dop853::default()).unwrap().end().state());",
    "unused": "std::hint::black_box((system.g, state));",
    "library": None,
}
MANIFEST = """[package]
name = "system"
version = "0.1.0"
edition = "2024"

[lib]
path = "src/library.rs"

[dependencies]
lagrange-core = {{ path = "{core}" }}

[workspace]
"""


def source(system, n, use):
    attributes, _ = SYSTEMS[system]
    angles = f"[0.3; {n}]"
    hanging = f"std::array::from_fn::<f64, {2 * n}, _>(|k| if k < {n} {{ 0.0 }} else {{ {n - 1}.0 - k as f64 }})"
    filled = {"n": n, "start": angles if system == "pendulum" else hanging}
    text = STRUCT.format(attributes=attributes.format(**filled), **filled)
    if USES[use]:
        text += MAIN.format(made=MADE.format(n=n), start=filled["start"], statement=USES[use])
    return "use lagrange_core::prelude::*;\n" + text


def humanoid():
    """A program that uses every function of a body of 30 joints."""
    upright = "std::array::from_fn::<f64, 37, _>(|k| if k == 3 { 1.0 } else { 0.0 })"
    stated = (HERE / "ours" / "src" / "robots" / "humanoid.rs").read_text()
    return stated + MAIN.format(made=MADE_HUMANOID, start=upright, statement=EVERY)


def project():
    """A folder with the manifest of a project that depends on the crate by its path."""
    folder = SHOP / "growth"
    shutil.rmtree(folder, ignore_errors=True)
    (folder / "src").mkdir(parents=True)
    (folder / "Cargo.toml").write_text(MANIFEST.format(core=ROOT / "lagrange-core"))
    (folder / "src" / "library.rs").write_text("")
    (folder / "src" / "main.rs").write_text("fn main() {}\n")
    shutil.copy(ROOT / "Cargo.lock", folder)
    return folder
