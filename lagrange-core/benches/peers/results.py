"""What was measured: `results.json`, from which all tables are written."""

import json
import sys
from dataclasses import asdict

from report import Bar, Section, Table
from workshop import HERE

FILE = HERE / "results.json"


def save(about, sections):
    """`about` says where, when and with what; `sections` maps a row's name to what was measured."""
    measured = {"about": about, "sections": {name: asdict(section) for name, section in sections.items()}}
    FILE.write_text(json.dumps(measured, ensure_ascii=False, indent=1) + "\n")


def load():
    measured = json.loads(FILE.read_text())
    return measured["about"], {name: section(**fields) for name, fields in measured["sections"].items()}


def updated(about, sections, order):
    """What the last full run measured, but for these rows, which were measured by themselves."""
    before, all_sections = load()
    packages = before["packages"] | about["packages"]
    others = [fact for fact in ("rustc", "gcc") if about[fact] != before[fact]]
    others += [name for name, version in before["packages"].items() if packages[name] != version]
    if others:
        sys.exit(f"the last full run had another {', '.join(others)}: run all rows")
    cpu = "" if about["cpu"] == before["cpu"] else f", on {about['cpu']}"
    alone = before["alone"] | dict.fromkeys(sections, f"{about['commit']}, {about['date']}{cpu}")
    all_sections |= sections
    return before | {"alone": alone, "packages": packages}, {name: all_sections[name] for name in order if name in all_sections}


def section(title, parts, bars, missing):
    parts = [part if isinstance(part, str) else Table(**part) for part in parts]
    return Section(title, parts, [Bar(**bar) for bar in bars], missing)


def markdown(about, sections):
    """All tables, as RESULTS.md has them."""
    bars = [bar for section in sections.values() for bar in section.bars]
    packages = ", ".join(f"{name} {version}" for name, version in about["packages"].items())
    facts = [
        f"Date: {about['date']}, commit {about['commit']}",
        f"CPU: {about['cpu']}, {about['cores']} cores, {about['system']}",
        f"Load average at the start: {about['load']:.2f}",
        f"Compilers: {about['rustc']}; {about['gcc']}",
        f"Python {about['python']}: {packages}; num-dual {about['num-dual']}",
        *(f"The row {row} was measured by itself, at commit {where}" for row, where in about["alone"].items()),
        about["effort"],
    ]
    passed = f"{sum(bar.passes for bar in bars)} of {len(bars)} bars pass; the run took {about['minutes']:.1f} minutes."
    head = ["# Comparison with other tools", "\n".join(f"- {fact}" for fact in facts), passed]
    return "\n\n".join(head + [section.markdown() for section in sections.values()]) + "\n"
