"""2,000 double pendulums from rest to T = 10: microseconds a trajectory, on one thread."""

import array
import random
from statistics import median, quantiles

from contest import Contestant, in_rotation
from report import Bar, Section, bar, comparison
from timing import Timing
from workshop import HERE, NATIVE, PYTHON, SHOP, build_ours, lanes, progress

PENDULUMS, TOLERANCES = 2000, (1e-9, 1e-12, 1e-15)
ROUNDS, QUICK_ROUNDS = 21, 3


def ours(method, way, tolerance):
    name = f"ours, {method} " + ("on lanes" if way == "lanes" else "one by one")
    command = [build_ours("ours", NATIVE) / "ensemble", method.lower(), way, tolerance, SHOP / "starts"]
    return Contestant(name, "ours", f"{tolerance:g}", *command)


def heyoka(batch, tolerance):
    name = f"heyoka, batch of {batch}" if batch > 1 else "heyoka, scalar"
    command = [PYTHON, HERE / "generators" / "heyoka_ensemble.py", batch, tolerance, SHOP / "starts"]
    return Contestant(name, "tool", f"{tolerance:g}", *command)


def exact_ends():
    """The last states to all digits."""
    command = [PYTHON, HERE / "generators" / "heyoka_ensemble.py", "exact", 0.0, SHOP / "starts"]
    reference = Contestant("heyoka", "tool", "exact", *command)
    reference.run()
    return reference.finish()


def starts():
    """Random angles, always the same."""
    generator = random.Random(7)
    angles = array.array("d", (generator.uniform(-2, 2) for _ in range(2 * PENDULUMS)))
    (SHOP / "starts").write_bytes(angles.tobytes())


def errors(states, reference):
    """The largest error of a pendulum's state, for all pendulums."""
    differences = [abs(one - other) for one, other in zip(states, reference, strict=True)]
    return [max(differences[k : k + 4]) for k in range(0, len(differences), 4)]


def contest(contestants, exact, rounds):
    """The timings, runs in rotation, each with the errors of all pendulums."""
    in_rotation(contestants, rounds)
    judged = [errors(one.finish(), exact) for one in contestants]
    return [(timing(one, error), error) for one, error in zip(contestants, judged)]


def timing(contestant, error):
    """In microseconds a trajectory."""
    return Timing(contestant.implementation, median(error), [time / PENDULUMS for time in contestant.times])


def bars(section, tolerance, timings):
    """Against the batch as wide as our lanes."""
    same = next(timing for timing in timings if timing.name == f"heyoka, batch of {lanes(NATIVE)}")
    bar(section, f"time at {tolerance:g}", timings, same, 1.0)
    section.bars.append(Bar(f"median error at {tolerance:g}: {same.name}", timings[0].error / same.error, 1.0))


def rows(options):
    section = Section(f"{PENDULUMS} double pendulums from rest to T = 10: microseconds a trajectory")
    section.text(
        "One thread, native. Ours is derived from the Lagrangian of Landau and Lifshitz (*Mechanics*, § 5), heyoka is given accelerations "
        "simplified by hand. One tolerance means other errors with other methods. Large swings are chaotic, so "
        "errors of the last states are given by quantiles, against heyoka in extended precision. Times are of the wall "
        "clock. A cell: least time · that of ours, Taylor on lanes divided by it, by minima (by medians)."
    )
    starts()
    exact, columns, quality = exact_ends(), {}, {}
    for tolerance in TOLERANCES:
        progress(f"ensemble at {tolerance:g}")
        contestants = [
            ours(method, way, tolerance) for method in ("Taylor", "Dop853") for way in ("lanes", "one-by-one")
        ]
        contestants += [heyoka(batch, tolerance) for batch in (1, 4, 8)]
        judged = contest(contestants, exact, QUICK_ROUNDS if options.quick else ROUNDS)
        columns[f"{tolerance:g}"] = [timing for timing, _ in judged]
        for timing, error in judged:
            quality.setdefault(timing.name, []).append(f"{median(error):.0e} / {quantiles(error, n=10)[8]:.0e}")
        bars(section, tolerance, columns[f"{tolerance:g}"])
    comparison(section, "at a tolerance of", columns)
    section.table(
        "error of the last state: half of them less / nine in ten less",
        ["", *columns],
        [[name, *cells] for name, cells in quality.items()],
    )
    return section
