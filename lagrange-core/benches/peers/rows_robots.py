"""Bodies in space that hang together by joints: time per acceleration, and operations."""

import peers
from report import Section, bar, comparison, fastest
from rows_counts import emitted, tool
from timing import measure
from workshop import NATIVE, PLAIN, progress

# Heading, system and number in the harness, the system that others take, the struct of ours; how much longer than
# CasADi and than Pinocchio's articulated-body algorithm ours may take.
SYSTEMS = (
    ("arm of 6 joints", "arm", 6, "arm", "Arm6", 1.0, 0.4),
    ("arm by Denavit and Hartenberg", "denavit", 6, "denavit", "Denavit6", 1.0, 0.4),
    ("quadruped", "quadruped", 0, "quadruped", "Quadruped", 1.05, 0.4),
    ("quadruped in angles", "quadruped_angles", 0, "quadruped", "QuadrupedAngles", 1.05, 0.4),
    ("arm of 20 joints", "arm", 20, "arm", "Arm20", None, 0.5),
    ("humanoid", "humanoid", 0, "humanoid", "Humanoid", None, 0.5),
)
WORST_ERROR = 1e-10


def makers(system, n, other):
    yield "ours, not inlined", lambda: peers.ours_called(f"{system}_{n}", NATIVE, "robots")
    for label, options in peers.CASADI_ROBOTS.items():
        yield label, lambda label=label, options=options: peers.casadi_robots(other, n, label, NATIVE, *options)
    for function, label in peers.PINOCCHIO.items():
        yield label, lambda function=function: peers.pinocchio(function, NATIVE)


def bars(section, heading, timings, casadi_limit, pinocchio_limit):
    plain, articulated = list(peers.CASADI_ROBOTS)[:1], [peers.PINOCCHIO[how] for how in ("local", "world")]
    if casadi_limit:
        bar(section, f"{heading}, against", timings, fastest(timings, ["tool"], plain), casadi_limit)
    bar(section, f"{heading}, against", timings, fastest(timings, ["tool"], articulated), pinocchio_limit)


def operations(section):
    counts = emitted("robots")
    section.table(
        "operations (+ − × ÷ √) / sines and cosines",
        ["", *(heading for heading, *_ in SYSTEMS)],
        [
            ["ours", *(counts[ours] for *_, ours, _, _ in SYSTEMS)],
            [
                "CasADi",
                *(
                    tool("with_casadi_robots.py", other, n, peers.place(f"count_{system}_{n}.c", PLAIN))
                    for _, system, n, other, *_ in SYSTEMS
                ),
            ],
        ],
    )


def rows(options):
    section = Section("Bodies in space: nanoseconds per acceleration")
    section.text(
        "Six and twenty joints in a row, placed arbitrarily or by Denavit and Hartenberg's rules; a body on four legs "
        "of three joints, free in space by a quaternion or by three angles; a humanoid of thirty joints, free by a "
        "quaternion. Placements, masses, centres, inertias and torques are inputs. Ours gives accelerations of the "
        "coordinates, those of the quaternion and its multiplier included, the others those along the axes of the "
        "base. A cell: least time of a sample · ours divided by it, by minima (by medians)."
    )
    columns = {}
    for heading, system, n, other, _, *limits in SYSTEMS:
        progress(f"{heading}, {NATIVE.name}")
        implementations, missing = peers.gather(makers(system, n, other))
        columns[heading], wrong = measure(system, n, implementations, options.effort, WORST_ERROR)
        section.missing += missing + wrong
        bars(section, heading, columns[heading], *limits)
    comparison(section, NATIVE.name, columns)
    operations(section)
    return section
