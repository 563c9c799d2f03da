"""Compile times of a plain user project with one derived system, as the system grows.

The macro runs unoptimised, as in anyone's project. rustc's own report of its passes (`-Ztime-passes`) separates it
from the rest; what an empty crate takes is subtracted.
"""

import json
import os
import re
import shutil
import subprocess
from dataclasses import dataclass

from report import Bar, Section
from workshop import ROOT, SHOP, progress

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

# How the system is used: a program that uses every emitted function, one that integrates, one that does nothing with
# the system, and a library that exports it.
MAIN = """fn main() {{
    let system = std::hint::black_box(System {{ m: [1.0; {n}], l: [1.0; {n}], g: 9.81 }});
    let state = std::hint::black_box(State::at_rest({start}));
    {statement}
}}
"""
EVERY = """let solution = system.accelerations(&state);
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

# Seconds for the macro, rustc in release and in dev, of the systems that have bars.
BARS = {("pendulum", 10): (0.3, 0.7, 1), ("pendulum", 20): (1, 2, 2), ("chain", 50): (1.5, 3, 3)}
PROFILES = ("release", "dev")
LIMIT_S = 120


@dataclass(frozen=True)
class Cost:
    """Seconds of the macros and of the rest of rustc, and its largest memory in MB."""

    macros: float
    rest: float
    memory: float


class Refused(Exception):
    """The compiler did not compile it, and what it said."""


def source(system, n, use):
    attributes, _ = SYSTEMS[system]
    angles = f"[0.3; {n}]"
    hanging = f"std::array::from_fn::<f64, {2 * n}, _>(|k| if k < {n} {{ 0.0 }} else {{ {n - 1}.0 - k as f64 }})"
    filled = {"n": n, "start": angles if system == "pendulum" else hanging}
    text = STRUCT.format(attributes=attributes.format(**filled), **filled)
    if USES[use]:
        text += MAIN.format(statement=USES[use], **filled)
    return "use lagrange_core::prelude::*;\n" + text


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


def compile_once(folder, text, use, profile):
    target = ["--lib"] if use == "library" else ["--bin", "system"]
    (folder / "src" / ("library.rs" if use == "library" else "main.rs")).write_text(text)
    # The unstable flag is allowed for this crate alone, so that no dependency sees another compiler.
    environment = os.environ | {"RUSTC_BOOTSTRAP": "system", "CARGO_TARGET_DIR": str(SHOP / "growth-target")}
    command = ["cargo", "rustc", "--quiet", "--profile", profile, *target, "--", "-Ztime-passes", "-Ztime-passes-format=json"]
    try:
        done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, timeout=LIMIT_S)
    except subprocess.TimeoutExpired:
        raise Refused(f"not done in {LIMIT_S} s") from None
    if done.returncode:
        raise Refused(complaint(done.stderr))
    passes = [json.loads(line) for line in re.findall(r"^time: (\{.*\})$", done.stdout + done.stderr, re.M)]
    seconds = {one["pass"]: one["time"] for one in passes}
    memory = max(one["rss_end"] or 0 for one in passes)
    return Cost(seconds["macro_expand_crate"], seconds["total"] - seconds["macro_expand_crate"], memory / 1e6)


def complaint(said):
    """The first error; a crash is called one."""
    for crash in ("overflowed its stack", "SIGSEGV", "SIGKILL", "SIGABRT", "panicked", "internal compiler error"):
        if crash in said:
            return f"CRASH: {crash}"
    errors = re.findall(r"^error.*", said, re.M)
    return errors[0] if errors else said.strip().splitlines()[-1]


def least(folder, text, use, profile, repeats):
    """The least of several compilations; one is enough where it takes long."""
    costs = []
    while len(costs) < repeats and (not costs or costs[0].rest < 10):
        costs.append(compile_once(folder, f"// {len(costs)}\n{text}", use, profile))
    return Cost(*(min(values) for values in zip(*((one.macros, one.rest, one.memory) for one in costs))))


def beyond_empty(folder, system, n, use, profile, repeats, empty):
    cost = least(folder, source(system, n, use), use, profile, repeats)
    base = empty[use, profile]
    return Cost(cost.macros - base.macros, cost.rest - base.rest, cost.memory)


def bars(section, system, n, use, costs):
    macro_limit, *limits = BARS[system, n]
    if use == "every function":
        section.bars.append(Bar(f"{system} n = {n}: macro, s", min(cost.macros for cost in costs.values()), macro_limit))
    for profile, limit in zip(PROFILES, limits) if use in ("every function", "integrates") else ():
        section.bars.append(Bar(f"{system} n = {n}, {use}, {profile}: rustc, s", costs[profile].rest, limit))


def grow(section, folder, system, empty, options):
    """A line of the table for each size, until the macro refuses."""
    sizes = [n for n in SYSTEMS[system][1] if not options.quick or (system, n) in BARS]
    for n in sizes:
        cells = [f"{system} n = {n}"]
        for use in USES:
            options.progress(f"growth: {system} n = {n}, {use}")
            try:
                costs = {profile: beyond_empty(folder, system, n, use, profile, options.repeats, empty) for profile in PROFILES}
            except Refused as reason:
                section.text(f"{system} n = {n}, {use}: {reason}")
                return
            if use == "every function":
                cells += [f"{min(cost.macros for cost in costs.values()):.2f}", f"{costs['release'].memory:.0f}"]
            cells += [f"{costs[profile].rest:.2f}" for profile in PROFILES]
            if (system, n) in BARS:
                bars(section, system, n, use, costs)
        yield cells


def rows(options):
    section = Section("Growth of compile times, in seconds beyond an empty crate")
    section.text("Programs that use every emitted function, that integrate (which compiles the integrator too), that make a "
                 "system only; a library that exports it. The macro is not optimised, as in any project; memory is rustc's "
                 "largest in MB, with every function in release.")
    options.repeats = 1 if options.quick else 3
    folder = project()
    for profile in PROFILES:
        progress(f"growth: building the dependencies, {profile}")
        subprocess.run(["cargo", "build", "--quiet", "--profile", profile], cwd=folder, check=True, capture_output=True,
                       env=os.environ | {"CARGO_TARGET_DIR": str(SHOP / "growth-target"), "RUSTC_BOOTSTRAP": "system"})
    empty = {(use, profile): least(folder, "" if use == "library" else "fn main() {}\n", use, profile, 3) for use in USES for profile in PROFILES}
    head = ["", "macro", "memory", *(f"{use}, {profile}" for use in USES for profile in PROFILES)]
    lines = [cells for system in SYSTEMS for cells in grow(section, folder, system, empty, options)]
    section.table("seconds", head, lines)
    return section
