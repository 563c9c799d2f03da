"""Bodies in space that joints close to loops: time per acceleration, and operations."""

import peers
from report import Section, bar, comparison, fastest
from rows_counts import emitted, tool
from timing import measure
from workshop import NATIVE, PLAIN, progress

# Heading, system in the harness, the struct of ours.
SYSTEMS = (("spatial four-bar", "four_bar", "FourBar"), ("Stewart platform", "stewart", "Stewart"))
WORST_ERROR = 1e-10


def makers(system):
    yield "ours, not inlined", lambda: peers.ours_called(f"{system}_0", NATIVE, "robots")
    for (form, order), label in peers.CASADI_LOOPS.items():
        yield label, lambda form=form, order=order: peers.casadi_loops(system, form, order, NATIVE)


def operations(section):
    counts = emitted("robots")
    count = lambda system, *how: tool("with_casadi_loops.py", system, *how, peers.place(f"count_{system}.c", PLAIN))
    section.table(
        "operations (+ − × ÷ √) / sines and cosines",
        ["", *(heading for heading, *_ in SYSTEMS)],
        [["ours", *(counts[ours] for *_, ours in SYSTEMS)]]
        + [[label, *(count(system, *how) for _, system, _ in SYSTEMS)] for how, label in peers.CASADI_LOOPS.items()],
    )


def rows(options):
    section = Section("Bodies in space, closed to loops: nanoseconds per acceleration")
    section.text(
        "Crank, coupler and rocker, with 5 coordinates and 3 constraints; a plate on six legs that can be screwed out, "
        "with 25 coordinates and 19 constraints. All that a body has is an input. CasADi solves the mass matrix and the "
        "constraints together by its sparse LDLᵀ, in an order of its own, where that meets no pivot of zero, or loop by "
        "loop; from the Lagrangian, or with the accelerations of the bodies written by hand. A cell: least time of a "
        "sample · ours divided by it, by minima (by medians)."
    )
    columns = {}
    for heading, system, _ in SYSTEMS:
        progress(f"{heading}, {NATIVE.name}")
        implementations, missing = peers.gather(makers(system))
        columns[heading], wrong = measure(system, 0, implementations, options.effort, WORST_ERROR)
        section.missing += missing + [(f"{name}, {heading}", reason) for name, reason in wrong]
        bar(section, f"{heading}, against", columns[heading], fastest(columns[heading], ["tool"]), 1.0)
    comparison(section, NATIVE.name, columns)
    operations(section)
    return section
