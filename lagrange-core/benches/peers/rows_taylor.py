"""Single motions by Taylor's method to round-off: times, steps and errors."""

import array

from contest import Contestant, in_rotation
from report import Bar, Section, comparison, fastest
from timing import Ratio, Timing
from workshop import HERE, NATIVE, PLAIN, PYTHON, SHOP, build_ours, progress

# Where each starts, how long it moves, what heyoka is given, and how many times faster ours is to be.
SYSTEMS = {
    "double pendulum, by hand": ("double", "double", [2.0, 1.0, 0.0, 0.0], 10.0, 1),
    "spherical pendulum, by hand": ("spherical", "spherical", [0.6, 0.0, -0.8, 0.0, 1.0, 0.0], 50.0, 1),
    "2 planar links": ("planar-2", "planar-2", [1.0] * 2 + [0.0] * 2, 10.0, 2),
    "5 planar links": ("planar-5", "planar-5", [1.0] * 5 + [0.0] * 5, 4.0, 4),
    "10 planar links": ("planar-10", "planar-10", [1.0] * 10 + [0.0] * 10, 2.0, 20),
    "20 planar links": ("planar-20", "planar-20", [1.0] * 20 + [0.0] * 20, 1.0, 30),
}
OURS = (("Taylor", NATIVE, "taylor"), ("Taylor, plain", PLAIN, "taylor"), ("Dop853", NATIVE, "dop853"))
ROUNDS, QUICK_ROUNDS = 41, 3
# Of links from their Lagrangian heyoka compiles no more than so many unrolled in a minute.
UNROLLED = ("double", "spherical", "planar-2")


def contestants(name):
    """Ours first; the last is exact."""
    system, peer, start, end, _ = SYSTEMS[name]
    (SHOP / f"start-{system}").write_bytes(array.array("d", start).tobytes())
    arguments = [end, SHOP / f"start-{system}"]
    had = [
        Contestant(f"ours, {label}", "ours", system, build_ours("ours", flags) / "taylor", system, way, *arguments)
        for label, flags, way in OURS
    ]
    script = HERE / "generators" / "heyoka_taylor.py"
    for mode in (*(("unrolled",) if peer in UNROLLED else ()), "compact", "exact"):
        had.append(Contestant(f"heyoka, {mode}", "tool", peer, PYTHON, script, peer, mode, *arguments))
    return had


def contest(name, rounds):
    """The timings, and how many steps each took."""
    *had, exact = contestants(name)
    in_rotation([exact], 1)
    in_rotation(had, rounds)
    reference = exact.finish()
    judged = []
    for one in had:
        error = max(abs(x - y) for x, y in zip(one.finish(), reference, strict=True))
        judged.append((Timing(one.implementation, error, one.times), one.answer["steps"]))
    return judged


def judge(section, name, timings):
    """At least so many times faster, and no less exact."""
    peer = fastest(timings, ["tool"])
    ratio = Ratio.of(peer, timings[0])
    times = SYSTEMS[name][-1]
    what = f"{name}, {peer.name} over ours"
    section.bars.append(Bar(what, ratio.least, times, f" ({ratio.median:.3g})", at_least=True))
    section.bars.append(Bar(f"{name}, error", timings[0].error, peer.error, at_least=False))


def rows(options):
    section = Section("Single motions by Taylor's method, to round-off: microseconds for the whole")
    section.text(
        "One thread, native but for plain. Ours is derived from the Lagrangian (of the double pendulum that of Landau and Lifshitz, *Mechanics*, § 5), "
        "with the multiplier of the spherical pendulum; heyoka is given "
        "the first two simplified by hand, without multiplier, and derives the others by `heyoka.lagrangian`, with masses and "
        "lengths that are all 1. Errors are those of the last states, against heyoka in long double. Dop853 is at a tolerance of "
        "1e-13. A cell: least time · ours divided by it, by minima (by medians)."
    )
    columns, cells = {}, {}
    for name in SYSTEMS:
        progress(f"taylor, {name}")
        judged = contest(name, QUICK_ROUNDS if options.quick else ROUNDS)
        columns[name] = [timing for timing, _ in judged]
        for timing, steps in judged:
            cells.setdefault(timing.name, {})[name] = f"{steps} × {timing.least / steps:.2f} µs / {timing.error:.0e}"
        judge(section, name, columns[name])
    comparison(section, "least times", columns)
    section.table(
        "steps × time a step / error of the last state",
        ["", *columns],
        [[name, *(row.get(column, "–") for column in columns)] for name, row in cells.items()],
    )
    return section
