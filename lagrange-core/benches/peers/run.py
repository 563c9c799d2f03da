#!/usr/bin/env python3
"""Runs ours and the tools that people use now in one go and prints the tables.

python3 lagrange-core/benches/peers/run.py [ROW...] [--quick] [--slow] [--update] [--output FILE]
"""

import argparse
import time
from pathlib import Path

import results
import rows_chain
import rows_counts
import rows_duals
import rows_ensemble
import rows_grips
import rows_growth
import rows_lanes
import rows_loops
import rows_planar
import rows_quantities
import rows_robots
import rows_spheres
import rows_stiff
import rows_taylor
import tables
import workshop
from report import Bar, Section
from timing import FULL, QUICK
from workshop import SHOP, Missing, progress, set_up_python

ROWS = {
    "planar": rows_planar.rows,
    "counts": rows_counts.rows,
    "chain": rows_chain.chains,
    "spherical": rows_chain.spherical,
    "robots": rows_robots.rows,
    "loops": rows_loops.rows,
    "quantities": rows_quantities.rows,
    "lanes": rows_lanes.rows,
    "taylor": rows_taylor.rows,
    "stiff": rows_stiff.rows,
    "spheres": rows_spheres.rows,
    "grips": rows_grips.rows,
    "ensemble": rows_ensemble.rows,
    "duals": rows_duals.rows,
    "growth": rows_growth.rows,
}


def options():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("rows", nargs="*", metavar="ROW", help=f"of {', '.join(ROWS)}; default all")
    parser.add_argument("--quick", action="store_true", help="few short samples: to see that it works")
    parser.add_argument("--slow", action="store_true", help="also SymPy at n = 20, which derives for minutes")
    parser.add_argument(
        "--update", action="store_true", help="puts the rows in the place of those of the last full run, and says so there"
    )
    parser.add_argument(
        "--output", type=Path, help="where the tables go; default results.json, RESULTS.md and README.md after a full run"
    )
    chosen = parser.parse_args()
    if unknown := set(chosen.rows) - set(ROWS):
        parser.error(f"there is no row {', '.join(sorted(unknown))}; there are {', '.join(ROWS)}")
    chosen.effort = QUICK if chosen.quick else FULL
    return chosen


def section(name, chosen):
    """A row's tables, or why there are none; then no bar of it is reached."""
    try:
        return ROWS[name](chosen)
    except Missing as reason:
        progress(f"missing {name}: {reason}")
        return Section(name, bars=[Bar(f"{name}, measured", 0, 1, at_least=True)], missing=[(name, str(reason))])


def main():
    chosen, start = options(), time.monotonic()
    SHOP.mkdir(parents=True, exist_ok=True)
    set_up_python()
    about = workshop.about() | {"alone": {}, "effort": str(chosen.effort)}
    sections = {name: section(name, chosen) for name in chosen.rows or ROWS}
    about["minutes"] = (time.monotonic() - start) / 60
    text = results.markdown(about, sections)
    print(text)
    if chosen.output:
        chosen.output.write_text(text)
    elif not chosen.quick and (chosen.update or not chosen.rows):
        results.save(*(results.updated(about, sections, ROWS) if chosen.rows else (about, sections)))
        tables.write()


if __name__ == "__main__":
    main()
