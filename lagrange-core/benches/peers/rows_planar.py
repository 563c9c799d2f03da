"""The planar pendulum of n links in angles: time per acceleration."""

import peers
from report import Section, bar, comparison, fastest
from timing import measure
from workshop import NATIVE, PLAIN, progress

SIZES = (2, 3, 5, 8, 10, 20)
WORST_ERROR = 1e-12


def makers(n, flags, options):
    yield "ours", lambda: peers.ours(f"planar_{n}", flags)
    yield "ours, not inlined", lambda: peers.ours_called(f"planar_{n}", flags)
    yield "CasADi", lambda: peers.casadi("planar", n, "ldl", flags)
    yield "wrenfold, unrolled", lambda: peers.wrenfold(n, "unrolled", flags)
    yield "wrenfold, M and h", lambda: peers.wrenfold(n, "loops", flags)
    yield "heyoka", lambda: peers.heyoka(n, flags)
    if n <= 10 or options.slow:
        yield "SymPy", lambda: peers.sympy(n, "loops", flags, seconds=600)
    if n <= 3:
        yield "SymPy, symbolic LU", lambda: peers.sympy(n, "unrolled", flags, seconds=600)
    yield "by hand, dense", lambda: peers.by_hand("planar", "dense", "by hand, dense LDLᵀ", flags, N=n)
    yield "by hand, O(n)", lambda: peers.by_hand("planar", "linear", "by hand, O(n)", flags, N=n)
    if n == 2:
        yield "by hand, closed", lambda: peers.by_hand("planar", "closed", "by hand, closed form", flags, N=n)


def bars(section, n, flags, timings):
    where = f"n = {n}, {flags.name}"
    bar(section, f"{where}, against the fastest tool", timings, fastest(timings, ["tool"]), 1.05)
    if n == 2:
        bar(section, f"{where}, against the fastest by hand", timings, fastest(timings, ["hand"]), 1.1)
    if n == 20:
        linear = fastest(timings, ["hand"], ["by hand, O(n)"])
        bar(section, f"{where}, against O(n)", timings, linear, 1.2)


def rows(options):
    section = Section("Planar pendulum of n links in angles: nanoseconds per acceleration")
    section.text("A cell: least time of a sample · ours divided by it, by minima (by medians).")
    for flags in (NATIVE, PLAIN):
        columns, chained = {}, {}
        for n in SIZES:
            progress(f"planar n = {n}, {flags.name}")
            implementations, missing = peers.gather(makers(n, flags, options))
            right, wrong = measure("planar", n, implementations, options.effort, WORST_ERROR)
            columns[f"n = {n}"] = right
            chained[f"n = {n}"], _ = measure("planar", n, implementations, options.effort, WORST_ERROR, "chained")
            section.missing += missing + wrong
            bars(section, n, flags, right)
        comparison(section, f"{flags.name}: independent evaluations", columns)
        comparison(section, f"{flags.name}: each input from the result before", chained)
    return section
