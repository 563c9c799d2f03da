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

from growth_project import SYSTEMS, USES, humanoid, project, source
from report import Bar, Section
from workshop import SHOP, progress, run

# Seconds for the macro, rustc in release and in dev, of the systems that have bars; of the humanoid all in release.
BARS = {("pendulum", 10): (0.3, 0.7, 1), ("pendulum", 20): (1, 2, 2), ("chain", 50): (1.5, 3, 3)}
HUMANOID_BAR = 35
PROFILES = ("release", "dev")
REPEATS, LIMIT_S = 3, 60
TARGET = SHOP / "growth-target"
HEAD = ["", "macro", "memory", *(f"{use}, {profile}" for use in USES for profile in PROFILES)]


@dataclass(frozen=True)
class Cost:
    """Seconds of the macros and of the rest of rustc, and its largest memory in MB."""

    macros: float
    rest: float
    memory: float


class Refused(Exception):
    """The compiler did not compile it, and what it said."""


def compile_once(folder, text, use, profile):
    target = ["--lib"] if use == "library" else ["--bin", "system"]
    (folder / "src" / ("library.rs" if use == "library" else "main.rs")).write_text(text)
    # Nothing is left from the time before.
    shutil.rmtree(TARGET / "debug" / "incremental", ignore_errors=True)
    # The unstable flag is allowed for this crate alone, so that no dependency sees another compiler.
    environment = os.environ | {"RUSTC_BOOTSTRAP": "system", "CARGO_TARGET_DIR": str(TARGET)}
    passes = ["-Ztime-passes", "-Ztime-passes-format=json"]
    # `timeout` ends cargo together with the rustc that it started.
    command = ["timeout", str(LIMIT_S), "cargo", "rustc", "--quiet", "--profile", profile, *target, "--", *passes]
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True)
    if done.returncode == 124:
        raise Refused(f"not done in {LIMIT_S} s")
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
            return f"a CRASH of the compiler: {crash}"
    errors = re.findall(r"^error.*", said, re.M)
    return errors[0] if errors else said.strip().splitlines()[-1]


def least(folder, text, use, profile, repeats):
    """The least of several compilations."""
    costs = [compile_once(folder, f"// {turn}\n{text}", use, profile) for turn in range(repeats)]
    return Cost(*(min(values) for values in zip(*((one.macros, one.rest, one.memory) for one in costs))))


def beyond_empty(folder, system, n, use, profile, repeats, empty):
    cost = least(folder, source(system, n, use), use, profile, repeats)
    base = empty[use, profile]
    return Cost(cost.macros - base.macros, cost.rest - base.rest, cost.memory)


def bars(section, system, n, use, costs):
    macro_limit, *limits = BARS[system, n]
    if use not in ("every function", "integrates"):
        return
    if use == "every function":
        section.bars.append(
            Bar(f"{system} n = {n}: macro, s", min(cost.macros for cost in costs.values()), macro_limit)
        )
    for profile, limit in zip(PROFILES, limits, strict=True):
        section.bars.append(Bar(f"{system} n = {n}, {use}, {profile}: rustc, s", costs[profile].rest, limit))


def grow(section, folder, system, empty, options):
    """A line of the table for each size, until the macro refuses."""
    sizes = [n for n in SYSTEMS[system][1] if not options.quick or (system, n) in BARS]
    for n in sizes:
        cells = [f"{system} n = {n}"]
        for use in USES:
            progress(f"growth: {system} n = {n}, {use}")
            repeats = REPEATS if (system, n) in BARS and not options.quick else 1
            try:
                costs = {
                    profile: beyond_empty(folder, system, n, use, profile, repeats, empty) for profile in PROFILES
                }
            except Refused as reason:
                section.text(f"{system} n = {n}, {use}: {reason}")
                yield cells + ["–"] * (len(HEAD) - len(cells))
                return
            if use == "every function":
                cells += [f"{min(cost.macros for cost in costs.values()):.2f}", f"{costs['release'].memory:.0f}"]
            cells += [f"{costs[profile].rest:.2f}" for profile in PROFILES]
            if (system, n) in BARS:
                bars(section, system, n, use, costs)
        yield cells


def grow_humanoid(section, folder, options):
    """The macro and rustc together, in release."""
    progress("growth: humanoid")
    what = "humanoid of 30 joints, every function, release: macro and rustc, s"
    try:
        cost = least(folder, humanoid(), "every function", "release", 1 if options.quick else REPEATS)
        section.bars.append(Bar(what, cost.macros + cost.rest, HUMANOID_BAR))
    except Refused as reason:
        section.bars.append(Bar(f"{what}: {reason}", LIMIT_S, HUMANOID_BAR))


def rows(options):
    section = Section("Growth of compile times, in seconds beyond an empty crate")
    section.text(
        "Programs that use every emitted function, that integrate (which compiles the integrator too), that make a "
        "system only; a library that exports it. The macro is not optimised, as in any project; memory is rustc's "
        "largest in MB, with every function in release."
    )
    folder = project()
    for profile in PROFILES:
        progress(f"growth: building the dependencies, {profile}")
        environment = os.environ | {"CARGO_TARGET_DIR": str(TARGET), "RUSTC_BOOTSTRAP": "system"}
        run("cargo", "build", "--quiet", "--profile", profile, cwd=folder, env=environment)
    empty = {
        (use, profile): least(folder, "" if use == "library" else "fn main() {}\n", use, profile, REPEATS)
        for use in USES
        for profile in PROFILES
    }
    lines = [cells for system in SYSTEMS for cells in grow(section, folder, system, empty, options)]
    section.table("seconds", HEAD, lines)
    grow_humanoid(section, folder, options)
    return section
