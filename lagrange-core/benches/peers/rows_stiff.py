"""Stiff and constrained motions by implicit methods: errors, steps, evaluations and times at equal error."""

import array
import json
import re
from dataclasses import dataclass

from contest import Contestant, in_rotation
from report import Bar, Section
from timing import Ratio, Timing
from workshop import HERE, NATIVE, PYTHON, SHOP, Missing, build_ours, progress, run

PROBLEMS = {
    "squeezer": "Andrews' squeezer, t = 0.03",
    "car_axis": "car axis, t = 3",
    "honey": "pendulum in honey, c = 10⁶, t = 10⁵",
}
ERRORS = (1e-6, 1e-9)
TOLERANCES = [10.0**-k for k in range(4, 14)]
ROUNDS, QUICK_ROUNDS = 21, 3
# A run of so many microseconds is timed once.
LONG = 1e6
OURS = {f"ours, Radau, {stages} stages": stages for stages in (3, 5, 7)}
SCIPY = "SciPy, Radau"


@dataclass
class Known:
    """A problem with its start, and the state that is known at its end."""

    name: str
    time: float
    start: list
    end: list

    @classmethod
    def of(cls, name):
        known = cls(name, **json.loads(run(build_ours("stiff", NATIVE) / "ours", name, "about")))
        known.file().write_bytes(array.array("d", known.start).tobytes())
        return known

    def file(self):
        return SHOP / f"start-{self.name}"

    def error(self, state):
        """The largest error of the coordinates over their largest magnitude; the same of the velocities."""
        n = len(self.end) // 2
        halves = [slice(0, n), slice(n, 2 * n)]
        return max(
            max(abs(x - y) for x, y in zip(state[half], self.end[half], strict=True)) / max(map(abs, self.end[half]))
            for half in halves
        )

    def contestant(self, name, kind, command, tolerance):
        return Contestant(name, kind, self.name, *command(self, tolerance))


def ours(stages):
    program = build_ours("stiff", NATIVE) / "ours"
    return lambda known, tolerance: [program, known.name, stages, tolerance]


def diffsol():
    program = build_ours("stiff", NATIVE, "diffsol") / "diffsol"
    return lambda known, tolerance: [program, known.name, tolerance]


def by_library(*program):
    """A peer that loads our equations from the shared library."""
    library = build_ours("stiff", NATIVE) / "libstiff.so"
    return lambda known, tolerance: [*program, library, known.name, tolerance, known.time, known.file()]


def ida():
    folder = next((SHOP / "venv").glob("lib/python*/site-packages/scikit_sundae.libs"), None)
    if folder is None:
        raise Missing("the libraries of scikit-sundae are not where they were")
    names = ("core", "ida", "nvecserial", "sunmatrixdense", "sunlinsoldense")
    libraries = [next(folder.glob(f"libsundials_{name}-*")) for name in names]
    link = (f"-Wl,-rpath,{folder}", "-Wl,--allow-shlib-undefined", "-ldl")
    program = SHOP / "ida"
    run("gcc", *NATIVE.gcc, "-w", HERE / "generators" / "ida.c", *libraries, *link, "-o", program)
    return by_library(program)


PEERS = {
    SCIPY: lambda: by_library(PYTHON, HERE / "generators" / "scipy_radau.py"),
    "SUNDIALS, IDA": ida,
    "diffsol, BDF": diffsol,
}


def scan(known, name, kind, command):
    """One run at each tolerance, with its error, until the least of the errors is reached."""
    tried = []
    for tolerance in TOLERANCES:
        one = known.contestant(name, kind, command, tolerance)
        try:
            in_rotation([one], 1)
        except Missing:
            continue
        tried.append((tolerance, known.error(one.finish()), one))
        if tried[-1][1] <= min(ERRORS):
            break
    return tried


def contest(known, commands, tried, error, rounds):
    """Timings with tolerances and counts at the loosest tolerance that is as exact, and the names of those without one."""
    judged, again = {}, {}
    for name, (kind, command) in commands.items():
        found = next((run for run in tried[name] if run[1] <= error), None)
        if found:
            tolerance, reached, one = found
            judged[name] = (tolerance, Timing(one.implementation, reached, one.times), one.answer)
            if one.times[0] < LONG:
                again[name] = known.contestant(name, kind, command, tolerance)
    in_rotation(list(again.values()), rounds)
    for name, one in again.items():
        one.finish()
        judged[name][1].times.extend(one.times)
    return judged, [name for name in commands if name not in judged]


def judge(section, where, judged):
    """No more steps than SciPy's method of the same order, and less time than any."""
    own = min((judged[name][1] for name in OURS if name in judged), key=lambda timing: timing.least)
    for name, (_, timing, answer) in judged.items():
        if name == SCIPY:
            steps = judged["ours, Radau, 3 stages"][2]["steps"]
            section.bars.append(Bar(f"{where}, steps of ours with 3 stages", steps, answer["steps"]))
        if name not in OURS:
            ratio = Ratio.of(timing, own)
            what = f"{where}, time of {name} over {own.name}"
            section.bars.append(Bar(what, ratio.least, 1, f" ({ratio.median:.3g})", at_least=True))


def rows(options):
    section = Section("Stiff and constrained motions by implicit methods")
    lock = (HERE / "stiff" / "Cargo.lock").read_text()
    section.text(
        "One thread, native. Ours takes the equations with their constraints. The others integrate ẏ = f(t, y) of coordinates and "
        "velocities with the constraints eliminated, f and its exact Jacobian being our emitted functions; IDA has ẏ − f(t, y) = 0 "
        "and dense matrices. Each is at the loosest of the tolerances 10⁻⁴, 10⁻⁵, … at which its last state is as exact: errors are "
        "relative to the largest coordinate, and the largest velocity. Rejected steps include those whose iteration fails. "
        "SciPy's method is written in Python; runs of more than a second are timed once. diffsol is "
        + re.search(r'name = "diffsol"\nversion = "(.*)"', lock)[1]
        + "."
    )
    commands = {name: ("ours", ours(stages)) for name, stages in OURS.items()}
    for name, make in PEERS.items():
        try:
            commands[name] = ("tool", make())
        except Missing as reason:
            section.missing.append((name, str(reason)))
    for problem, title in PROBLEMS.items():
        known = Known.of(problem)
        progress(f"stiff, {title}")
        tried = {name: scan(known, name, *command) for name, command in commands.items()}
        for error in ERRORS:
            rounds = QUICK_ROUNDS if options.quick else ROUNDS
            judged, missing = contest(known, commands, tried, error, rounds)
            lines = [
                [name, f"{tolerance:.0e}", f"{timing.error:.1e}", answer["steps"], answer["rejected"]]
                + [answer["evaluations"], f"{timing.least / 1e3:.3g}"]
                for name, (tolerance, timing, answer) in judged.items()
            ]
            lines += [[name, *["–"] * 6] for name in missing]
            head = ["", "tolerance", "error", "steps", "rejected", "evaluations", "ms"]
            section.table(f"{title}, to an error of {error:g}", head, lines)
            judge(section, f"{title}, {error:g}", judged)
    return section
