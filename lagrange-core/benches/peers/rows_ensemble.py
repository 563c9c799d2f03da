"""2,000 double pendulums from rest to T = 10: microseconds a trajectory, on one thread."""

import array
import json
import random
import subprocess
from statistics import median, quantiles

from peers import Implementation
from report import Section, comparison
from timing import Timing
from workshop import HERE, NATIVE, PYTHON, SHOP, Missing, build_ours, progress

PENDULUMS, TOLERANCES, REFERENCE_TOLERANCE = 2000, (1e-6, 1e-9, 1e-12), 1e-15
ROUNDS, QUICK_ROUNDS = 21, 3


class Contestant:
    """A process that integrates the ensemble whenever it is asked to."""

    def __init__(self, name, kind, tolerance, *command):
        self.implementation = Implementation(name, kind, None)
        self.ends, self.times = SHOP / f"ends-{name}-{tolerance:g}".replace(" ", "-"), []
        self.process = subprocess.Popen(
            [*map(str, command), str(tolerance), str(SHOP / "starts"), str(self.ends)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )

    def run(self):
        """One run, its time in microseconds a trajectory."""
        try:
            self.process.stdin.write("\n")
            self.process.stdin.flush()
            self.times.append(1e6 * json.loads(self.process.stdout.readline())["seconds"] / PENDULUMS)
        except (BrokenPipeError, json.JSONDecodeError):
            said = self.process.communicate()[1].strip().splitlines() or ["it ends without a word"]
            raise Missing(f"{self.implementation.name}: {said[-1]}") from None

    def finish(self):
        """The last states, four numbers a pendulum."""
        self.process.communicate()
        states = array.array("d")
        states.frombytes(self.ends.read_bytes())
        return states


def ours(way, tolerance):
    name = "ours, on lanes" if way == "lanes" else "ours, one by one"
    return Contestant(name, "ours", tolerance, build_ours("ours", NATIVE) / "ensemble", way)


def heyoka(batch, tolerance):
    name = f"heyoka, batch of {batch}" if batch > 1 else "heyoka, scalar"
    return Contestant(name, "tool", tolerance, PYTHON, HERE / "generators" / "heyoka_ensemble.py", batch)


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
    for _ in range(rounds):
        for one in contestants:
            one.run()
    judged = [errors(one.finish(), exact) for one in contestants]
    return [(Timing(one.implementation, median(error), one.times), error) for one, error in zip(contestants, judged)]


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
