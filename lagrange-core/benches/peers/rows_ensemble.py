"""2,000 double pendulums from rest to T = 10: microseconds a trajectory, on one thread."""

import array
import random
from statistics import median, quantiles

from contest import Contestant, in_rotation
from report import Section, comparison
from timing import Timing
from workshop import HERE, NATIVE, PYTHON, SHOP, build_ours, progress

PENDULUMS, TOLERANCES, REFERENCE_TOLERANCE = 2000, (1e-6, 1e-9, 1e-12), 1e-15
ROUNDS, QUICK_ROUNDS = 21, 3


def ours(way, tolerance):
    name = "ours, on lanes" if way == "lanes" else "ours, one by one"
    command = [build_ours("ours", NATIVE) / "ensemble", way, tolerance, SHOP / "starts"]
    return Contestant(name, "ours", f"{tolerance:g}", *command)


def heyoka(batch, tolerance):
    name = f"heyoka, batch of {batch}" if batch > 1 else "heyoka, scalar"
    command = [PYTHON, HERE / "generators" / "heyoka_ensemble.py", batch, tolerance, SHOP / "starts"]
    return Contestant(name, "tool", f"{tolerance:g}", *command)


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


def rows(options):
    section = Section(f"{PENDULUMS} double pendulums from rest to T = 10: microseconds a trajectory")
    section.text(
        "One thread, native. One tolerance means other errors with other methods. Large swings are chaotic, so "
        f"errors of the last states are given by quantiles, against heyoka at {REFERENCE_TOLERANCE:g}. Times are of "
        "the wall clock. A cell: least time · ours divided by it, by minima (by medians)."
    )
    starts()
    reference = heyoka(1, REFERENCE_TOLERANCE)
    reference.run()
    exact = reference.finish()
    columns, quality = {}, {}
    for tolerance in TOLERANCES:
        progress(f"ensemble at {tolerance:g}")
        contestants = [ours(way, tolerance) for way in ("lanes", "one-by-one")]
        contestants += [heyoka(batch, tolerance) for batch in (1, 4, 8)]
        judged = contest(contestants, exact, QUICK_ROUNDS if options.quick else ROUNDS)
        columns[f"{tolerance:g}"] = [timing for timing, _ in judged]
        for timing, error in judged:
            quality.setdefault(timing.name, []).append(f"{median(error):.0e} / {quantiles(error, n=10)[8]:.0e}")
    comparison(section, "at a tolerance of", columns)
    section.table(
        "error of the last state: half of them less / nine in ten less",
        ["", *columns],
        [[name, *cells] for name, cells in quality.items()],
    )
    return section
