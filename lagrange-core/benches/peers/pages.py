"""What the README and the book say about speed, from what was measured."""

import re

TOOLS = ("CasADi", "wrenfold", "heyoka", "SymPy", "Pinocchio")
ROBOTS = ("arm of 6 joints", "quadruped", "arm of 20 joints", "humanoid")

# What the README shows of the tables in the book.
README_ROWS = (
    "accelerations, 5 planar links in angles",
    "accelerations, 20 planar links in angles",
    "accelerations and multipliers, 20 rods in the plane",
    "accelerations, arm of 6 joints",
    "accelerations, humanoid",
    "accelerations of 8 double pendulums, AVX2 lanes",
)
README_MOTIONS = ("spherical pendulum, by hand", "10 planar links")

README = """\
Beside the tools that people use, built, checked and timed by `python3 lagrange-core/benches/peers/run.py`;
[the book has more](book/src/costs.md#beside-other-tools). {about}

{fastest}

What one writes by hand is C for this one system.
Single motions by Taylor's method to round-off, and the error at the end; heyoka has the pendulum simplified by hand, and derives the links
from the Lagrangian:

{taylor}
"""

COSTS = """\
Against the tools that people use, in one run of `python3 lagrange-core/benches/peers/run.py`, which builds, checks and
times all of them in turn (`README.md` in its folder says how, `RESULTS.md` there has everything, plain flags too). {about}

{fastest}

What one writes by hand is C for this one system. CasADi, wrenfold, heyoka and SymPy are used as serves each best. Against
dual numbers, which take the same derivatives at run time (num-dual {num_dual}, `HyperDual`, nalgebra's Cholesky):

{duals}

{taylor}
{stiff}{spheres}{grips}
2,000 double pendulums from rest to t = 10. By Taylor's method errors are smaller than `Dop853`'s at the same tolerance. Where
there is AVX-512, ours has eight lanes.

{ensemble}

Compile times beyond an empty crate, all functions in use; functions of more than 4,000 operations are compiled in parts side by side, what they compute over and over in loops:

{growth}
"""


NANOSECONDS = ["nanoseconds", "ours", "the fastest tool", "by hand, O(n)"]
MOTIONS = ["µs for the whole motion, error at its end", "`Taylor`", "error", "heyoka", "error", "`Dop853`", "error"]

TAYLOR = """\
Single motions by Taylor's method to round-off. heyoka is given the first two simplified by hand, without the multiplier that
ours computes, and derives the others from the Lagrangian. `Dop853` is at 10⁻¹³:

{table}
"""

STIFF = """\
Stiff and constrained motions by implicit methods, `Radau` with 3, 5 and 7 stages. The others integrate the accelerations and their exact
Jacobian, which are our emitted functions:

{table}
"""

SPHERES = """\

A hundred spheres that are thrown on a floor with friction, by time stepping. Whatever happens on the way, each ends up rolling with
5/7 of its velocity, in m/s; depth is that of a sphere in the floor, in m. Ours is for few bodies exactly, rapier3d for many, plausibly:

{table}
"""


GRIPS = """\

A cube that friction holds for a minute, below its limit, pressed against a wall by a pad or on a slope. MuJoCo's contacts give way by design;
*stiff* has its settings against slip:

{table}
"""


def of_readme(about, sections):
    fast = table(NANOSECONDS, [row for row in fastest(sections) if row[0] in README_ROWS])
    motions = [row[:5] for row in taylor(sections) if row[0] in README_MOTIONS]
    return README.format(about=where(about), fastest=fast, taylor=table(MOTIONS[:5], motions))


def of_costs(about, sections):
    """The page of the book."""
    return COSTS.format(
        about=where(about),
        num_dual=about["num-dual"],
        fastest=table(NANOSECONDS, fastest(sections)),
        duals=duals(sections["duals"]),
        ensemble=ensemble(sections["ensemble"]),
        taylor=TAYLOR.format(table=table(MOTIONS, taylor(sections))) if "taylor" in sections else "",
        growth=growth(sections["growth"]),
        stiff=STIFF.format(table=stiff(sections["stiff"])) if "stiff" in sections else "",
        spheres=SPHERES.format(table=spheres(sections["spheres"])) if "spheres" in sections else "",
        grips=GRIPS.format(table=grips(sections["grips"])) if "grips" in sections else "",
    )


def of_methods(printed):
    """What an error costs, from what the example `methods` printed."""
    rows = [re.split(r" {2,}", line.strip()) for line in printed.splitlines()]
    rows = [row for row in rows if len(row) == 11]
    names = ("Taylor", "Dop853", "Dopri5")
    heads = [f"{error}: {names[0]}" for error in ("10⁻⁶", "10⁻⁹", "10⁻¹²")]
    head = [cell for first in heads for cell in (first, *names[1:])]
    return table(["time in µs, to an error of", *head, "least error of Taylor"], rows)


def where(about):
    rustc, gcc = (re.search(r"\d+\.\d+\.\d+(?= \(|$)", about[name])[0] for name in ("rustc", "gcc"))
    spelled = {tool.lower(): tool for tool in TOOLS} | {"pin": "Pinocchio"}
    tools = ", ".join(f"{spelled[name]} {version}" for name, version in about["packages"].items() if name in spelled)
    return (
        f"{about['date']}, {about['cpu']}, {about['cores']} cores, {about['system']},\n"
        f"native flags; rustc {rustc}, gcc {gcc}; {tools}.\nLeast of {about['effort'].split()[0]} samples.{alone(about)}"
    )


def alone(about):
    """Which rows were measured when."""
    rows = ", ".join(f"`{row}` ({where})" for row, where in about["alone"].items())
    return f" Measured by themselves: {rows}." if rows else ""


def table(head, rows):
    """All columns but the first are numbers."""
    lines = ["| " + " | ".join(head) + " |", "|---|" + "---:|" * (len(head) - 1)]
    return "\n".join(lines + ["| " + " | ".join(cells) + " |" for cells in rows])


def time(section, caption, column, name):
    """The time in a cell, without what it is compared with."""
    return section.cell(caption, column, name).split(" · ")[0]


def fastest_tool(section, caption, column):
    times = [(time(section, caption, column, name), name) for name in section.names(caption) if name.startswith(TOOLS)]
    had = [one for one in times if one[0] != "–"]
    if not had:
        return "–"
    least, name = min(had, key=lambda one: float(one[0]))
    return f"{least} ({re.match('|'.join(TOOLS), name)[0]})"


def fastest(sections):
    """Rows of single evaluations."""

    def row(what, section, caption, column, hand):
        ours = time(section, caption, column, next(iter(section.names(caption)), "ours"))
        return [what, ours, fastest_tool(section, caption, column), hand and time(section, caption, column, hand)]

    planar, chain, spherical, lanes = (sections[name] for name in ("planar", "chain", "spherical", "lanes"))
    independent, thomas = "native: independent evaluations", "by hand, Schur + Thomas"
    least = "least time of a sample · ours divided by it, by minima (by medians)"
    return [
        *(
            row(f"accelerations, {n} planar links in angles", planar, independent, f"n = {n}", "by hand, O(n)")
            for n in (2, 5, 10, 20)
        ),
        *(
            row(f"accelerations and multipliers, {n} rods in the plane", chain, "native", f"n = {n}", thomas)
            for n in (5, 20, 50)
        ),
        row("the same, spherical pendulum", spherical, least, "native", thomas),
        *(
            row(f"accelerations, {what}", sections["robots"], "native", what, "")
            for what in ROBOTS
            if "robots" in sections
        ),
        row("accelerations of 8 double pendulums, AVX2 lanes", lanes, least.replace("ours", "ours on lanes"), "avx2", ""),
    ]


def duals(section):
    entries, gradient = "num-dual, HyperDual entry by entry", "num-dual, gradient and Dual"
    rows = [
        (f"accelerations, {n} planar links", f"pendulum n = {n}", entries) for n in (2, 5, 10)
    ] + [("forces and energy of three bodies", "three bodies", gradient)]
    return table(
        ["nanoseconds", "ours", "num-dual"],
        [[what, *(time(section, "native", column, name) for name in ("ours", other))] for what, column, other in rows],
    )


def taylor(sections):
    """Rows of single motions, where they were measured."""
    if "taylor" not in sections:
        return []
    section, times = sections["taylor"], "least times"
    quality = "steps × time a step / error of the last state"

    def cells(column, name):
        return [time(section, times, column, name), section.cell(quality, column, name).split(" / ")[-1]]

    def best(column):
        had = [name for name in section.names(times) if name.startswith("heyoka") and cells(column, name)[0] != "–"]
        return cells(column, min(had, key=lambda name: float(cells(column, name)[0])))

    columns = section.captioned(times).head[1:]
    return [
        [column, *cells(column, "ours, Taylor"), *best(column), *cells(column, "ours, Dop853")] for column in columns
    ]


def stiff(section):
    """Steps and times to an error of 10⁻⁹; a dash where it is not reached."""
    captions = [part.caption for part in section.parts if not isinstance(part, str) and part.caption.endswith("1e-09")]
    names = section.names(captions[0])

    def cells(caption):
        found = ([section.cell(caption, column, name) for column in ("steps", "ms")] for name in names)
        return [steps if steps == "–" else f"{steps} / {ms}" for steps, ms in found]

    rows = [[caption.removesuffix(", to an error of 1e-09"), *cells(caption)] for caption in captions]
    return table(["steps / ms, to an error of 10⁻⁹", *(name.removeprefix("ours, ") for name in names)], rows)


def spheres(section):
    measured = section.captioned("µs a step, and what they reach")
    return table(measured.head, measured.rows)


def grips(section):
    measured = section.captioned("how far it creeps")
    return table(measured.head, measured.rows)


def ensemble(section):
    times, errors = "at a tolerance of", "error of the last state: half of them less / nine in ten less"
    rows = [
        [name, time(section, times, "1e-09", name), section.cell(errors, "1e-09", name).split(" / ")[0]]
        for name in section.names(times)
    ]
    return table(["µs a trajectory, tolerance 10⁻⁹, one thread", "time", "median error"], rows)


def growth(section):
    columns = ["macro", "every function, dev", "every function, release", "integrates, release"]
    systems = [(f"{n} planar links in angles", f"pendulum n = {n}") for n in (10, 20, 40, 80)]
    systems += [(f"{n} rods in Cartesian coordinates", f"chain n = {n}") for n in (50, 200, 400)]
    return table(
        ["seconds", "the macro", "every function, dev", "release", "with integration, release"],
        [[what, *(section.cell("seconds", column, name) for column in columns)] for what, name in systems],
    )
