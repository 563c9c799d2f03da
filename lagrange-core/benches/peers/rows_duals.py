"""The same derivatives at run time, by dual numbers."""

from peers import Implementation, gather, ours
from report import Section, comparison
from timing import measure
from workshop import NATIVE, PLAIN, build_ours, progress

SIZES = (2, 5, 10)
WORST_ERROR = 1e-12
SECOND = {"entries": "num-dual, HyperDual entry by entry", "hessian": "num-dual, hessian at once"}


def duals(function, label, flags):
    return Implementation(label, "tool", build_ours("dual-numbers", flags) / "libdual_numbers.so", function)


def makers(n, flags):
    yield "ours", lambda: ours(f"planar_{n}", flags)
    for how, label in SECOND.items():
        yield label, lambda how=how, label=label: duals(f"planar_{how}_{n}", label, flags)


def first_order(flags):
    yield "ours", lambda: ours("bodies", flags)
    yield "num-dual", lambda: duals("bodies", "num-dual, gradient and Dual", flags)


def rows(options):
    section = Section("Against num-dual, which takes the same derivatives at run time: nanoseconds")
    section.text(
        "The pendulum's accelerations, solved by nalgebra's Cholesky decomposition; the forces and the energy of "
        "three bodies under gravity. A cell: least time of a sample · ours divided by it, by minima (by medians)."
    )
    for flags in (NATIVE, PLAIN):
        columns = {}
        for system, n, heading, made in [
            *(("planar", n, f"pendulum n = {n}", makers(n, flags)) for n in SIZES),
            ("bodies", 3, "three bodies", first_order(flags)),
        ]:
            progress(f"dual numbers, {heading}, {flags.name}")
            implementations, missing = gather(made)
            columns[heading], wrong = measure(system, n, implementations, options.effort, WORST_ERROR)
            section.missing += missing + wrong
        comparison(section, flags.name, columns)
    return section
