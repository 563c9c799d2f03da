"""Eight double pendulums on SIMD lanes."""

import peers
from report import Bar, Section, bar, comparison, fastest
from timing import Ratio, measure
from workshop import AVX2, NATIVE, lanes, progress

WORST_ERROR = 1e-12
AS_WIDE = {4: "heyoka, batches of 4", 8: "heyoka, batches of 8"}


def makers(flags):
    yield "ours, on lanes", lambda: peers.ours("lanes_wide", flags, "ours, on lanes")
    yield "ours, scalar", lambda: peers.ours("lanes_scalar", flags, "ours, one after another")
    yield "heyoka", lambda: peers.heyoka(2, flags, batch=4)
    if flags is NATIVE:
        yield "heyoka, batches of 8", lambda: peers.heyoka(2, flags, batch=8)


def rows(options):
    section = Section("Eight double pendulums on SIMD lanes: nanoseconds for all eight")
    section.text(
        "In batches of four, the width of AVX2, heyoka uses SLEEF's AVX2 functions; the instructions around them it "
        "chooses for the CPU it runs on. Eight is the width of AVX-512, which ours has where it is compiled for it."
    )
    columns = {}
    for flags in (AVX2, NATIVE):
        progress(f"lanes, {flags.name}")
        implementations, missing = peers.gather(makers(flags))
        timings, wrong = measure("lanes", 2, implementations, options.effort, WORST_ERROR)
        section.missing += missing + wrong
        columns[flags.name] = timings
        gain = Ratio.of(next(one for one in timings if one.name == "ours, one after another"), timings[0])
        section.bars.append(
            Bar(f"{flags.name}, throughput against scalar", gain.least, 2.5, f" ({gain.median:.3g})", at_least=True)
        )
        bar(section, f"{flags.name}, against", timings, fastest(timings, ["tool"], [AS_WIDE[lanes(flags)]]), 1.0)
    comparison(section, "least time of a sample · ours on lanes divided by it, by minima (by medians)", columns)
    return section
