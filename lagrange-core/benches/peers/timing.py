"""Alternating measurements: one process takes samples of all implementations of a system in rotation."""

import json
import shutil
from dataclasses import dataclass
from statistics import median

from peers import Implementation
from workshop import HERE, SHOP, Missing, run


@dataclass(frozen=True)
class Effort:
    """How many samples of each copy, and how long each at least."""

    samples: int
    milliseconds: int

    def __str__(self):
        return f"{COPIES * self.samples} samples in rotation, each at least {self.milliseconds} ms"


# Where code lies in memory can cost tens of percent, so every library is loaded from as many copies.
COPIES = 3
FULL, QUICK = Effort(7, 20), Effort(2, 3)


@dataclass
class Timing:
    """What was measured of one implementation: an error, and a time a sample."""

    implementation: Implementation
    error: float
    times: list

    @property
    def name(self):
        return self.implementation.name

    @property
    def least(self):
        return min(self.times)

    @property
    def median(self):
        return median(self.times)


@dataclass(frozen=True)
class Ratio:
    """How much longer one takes than another: by minima, and by medians."""

    least: float
    median: float

    @classmethod
    def of(cls, one, other):
        return cls(one.least / other.least, one.median / other.median)

    def __str__(self):
        return f"{share(self.least)} ({share(self.median)})"


def share(value):
    """Two digits after the point, more where there would be none left."""
    return f"{value:.2f}" if value >= 0.1 else f"{value:.2g}"


def harness():
    """The C program that measures."""
    program, sources = SHOP / "harness", sorted((HERE / "harness").glob("*.c"))
    run("gcc", "-O2", "-Wall", *sources, "-o", program, "-ldl", "-lm")
    return program


def copies(implementations):
    """What to load, the copies of all one after another."""
    for copy in range(COPIES):
        folder = SHOP / f"copy-{copy}"
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir()
        for index, one in enumerate(implementations):
            yield f"{shutil.copy(one.library, folder / str(index))}:{one.function}"


def merged(implementation, lines):
    """One timing of the samples of all copies."""
    measured = [json.loads(line) for line in lines]
    return Timing(
        implementation, max(one["error"] for one in measured), [time for one in measured for time in one["times"]]
    )


def measure(system, n, implementations, effort, worst_error, dependence="independent"):
    """The timings of those whose results are right, and the names of those whose are not."""
    targets = copies(implementations)
    lines = run(harness(), system, n, effort.samples, effort.milliseconds, dependence, *targets).splitlines()
    timings = [merged(one, lines[index :: len(implementations)]) for index, one in enumerate(implementations)]
    right = [timing for timing in timings if timing.error <= worst_error]
    wrong = [(timing.name, f"its error is {timing.error:.0e}") for timing in timings if timing not in right]
    if any(timing.implementation.kind == "ours" for timing in timings if timing not in right):
        raise Missing(f"ours is wrong in {system} {n}: {wrong}")
    return right, wrong
