"""Cartesian coordinates with constraints: accelerations and all multipliers."""

import peers
from report import Bar, Section, bar, comparison, fastest
from timing import measure
from workshop import NATIVE, PLAIN, progress

SIZES = (5, 10, 20, 50)
WORST_ERROR = 1e-9
OWN_ERROR = 1e-14


def makers(system, n, dimension, flags):
    yield "ours", lambda: peers.ours(f"{system}_{n}", flags)
    yield "ours, not inlined", lambda: peers.ours_called(f"{system}_{n}", flags)
    yield "CasADi, Schur", lambda: peers.casadi(system, n, "schur", flags)
    yield "CasADi, whole", lambda: peers.casadi(system, n, "kkt", flags)
    yield ("by hand", lambda: peers.by_hand("chain", "thomas", "by hand, Schur + Thomas", flags, N=n, DIM=dimension))


def measured(section, system, n, dimension, flags, options):
    progress(f"{system} n = {n}, {flags.name}")
    implementations, missing = peers.gather(makers(system, n, dimension, flags))
    right, wrong = measure(system, n, implementations, options.effort, WORST_ERROR)
    section.missing += missing + wrong
    return right


def residual(section, where, timings):
    section.bars.append(
        Bar(f"{where}, residual of both equations / largest acceleration", timings[0].error, OWN_ERROR)
    )


def chains(options):
    section = Section("Plane chain of n rods in Cartesian coordinates: nanoseconds per accelerations and multipliers")
    section.text("A cell: least time of a sample · ours divided by it, by minima (by medians).")
    for flags in (NATIVE, PLAIN):
        columns = {}
        for n in SIZES:
            timings = columns[f"n = {n}"] = measured(section, "chain", n, 2, flags, options)
            where = f"n = {n}, {flags.name}"
            bar(section, f"{where}, against", timings, fastest(timings, ["tool"], [peers.CASADI["schur"]]), 1.0)
            bar(section, f"{where}, against", timings, fastest(timings, ["hand"]), 1.2)
            residual(section, where, timings)
        comparison(section, f"{flags.name}", columns)
    return section


def spherical(options):
    section = Section("Spherical pendulum in Cartesian coordinates: nanoseconds per accelerations and multiplier")
    columns = {}
    for flags in (NATIVE, PLAIN):
        timings = columns[flags.name] = measured(section, "spherical", 1, 3, flags, options)
        bar(section, f"{flags.name}, against", timings, fastest(timings, ["hand"]), 1.2)
        residual(section, flags.name, timings)
    comparison(section, "least time of a sample · ours divided by it, by minima (by medians)", columns)
    return section
