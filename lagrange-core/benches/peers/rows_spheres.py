"""A hundred spheres on a floor by time stepping: what an accuracy costs."""

import re

from contest import Contestant, in_rotation
from report import Bar, Section
from timing import Ratio, Timing
from workshop import HERE, NATIVE, build_ours, progress

SECONDS = 10
RATES = (60, 240)
ITERATIONS = (4, 20)
ROUNDS, QUICK_ROUNDS = 11, 3


def contestants():
    """Each with its steps a second, which is what steps of one length are compared at."""
    ours = build_ours("spheres", NATIVE) / "ours"
    rapier = build_ours("spheres", NATIVE, "rapier") / "rapier"
    for rate in RATES:
        yield rate, Contestant("ours, MoreauJean", "ours", str(rate), ours, rate)
        for count in ITERATIONS:
            yield rate, Contestant(f"rapier3d, {count} iterations", "tool", f"{rate}-{count}", rapier, rate, count)


def rows(options):
    section = Section("A hundred spheres thrown on a floor, by time stepping")
    version = re.search(r'name = "rapier3d-f64"\nversion = "(.*)"', (HERE / "spheres" / "Cargo.lock").read_text())[1]
    section.text(
        f"One thread, native, 64-bit numbers, {SECONDS} s; rapier3d {version}, its settings but for the iterations as they come. The "
        "spheres bounce, slide, and end up rolling with 5/7 of their velocity, whatever happened on the way: the error is the "
        "largest difference from that. Depth is how far a sphere is in the floor at the end of a step, slip the velocity of a "
        "lowest point at the end of the motion. Ours solves all contacts to a residual of 10⁻¹⁰, with matrices of all 600 "
        "coordinates and 300 multipliers, and is meant for few bodies exactly; rapier is meant for many, plausibly."
    )
    progress("spheres")
    all_of_them = list(contestants())
    in_rotation([one for _, one in all_of_them], QUICK_ROUNDS if options.quick else ROUNDS)
    lines, judged = [], {}
    for rate, one in all_of_them:
        one.finish()
        timing = Timing(one.implementation, one.answer["error"], one.times)
        judged[rate, timing.name] = timing
        figures = [f"{one.answer[what]:.1e}" for what in ("error", "depth", "slip")]
        lines.append([f"{timing.name}, {rate} steps a second", f"{timing.least / SECONDS / rate:.3g}", *figures])
    section.table("µs a step, and what they reach", ["", "µs a step", "error", "depth", "slip"], lines)
    for (rate, name), timing in judged.items():
        if timing.implementation.kind == "tool":
            own = judged[rate, "ours, MoreauJean"]
            ratio = Ratio.of(own, timing)
            where = f"{rate} steps a second, error of ours over that of {name}"
            section.bars.append(Bar(where, own.error / timing.error, 1, f" in {ratio.least:.3g} times the time"))
    return section
