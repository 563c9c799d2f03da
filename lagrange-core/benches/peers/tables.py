#!/usr/bin/env python3
"""Writes RESULTS.md, and the tables of README and book, from results.json and methods.txt; with --check only says whether they agree.

python3 lagrange-core/benches/peers/tables.py [--check]
"""

import sys

import pages
import results
from workshop import HERE, ROOT

BEGIN = "<!-- written by lagrange-core/benches/peers/tables.py: begin -->\n"
END = "<!-- written by lagrange-core/benches/peers/tables.py: end -->\n"


def documents():
    """Each file, and what must stand in it."""
    about, sections = results.load()
    yield HERE / "RESULTS.md", results.markdown(about, sections)
    methods = pages.of_methods((HERE / "methods.txt").read_text())
    for name, text in (
        ("README.md", pages.of_readme(about, sections)),
        ("book/src/costs.md", pages.of_costs(about, sections)),
        ("book/src/methods.md", methods),
    ):
        yield ROOT / name, between_marks(ROOT / name, text)


def between_marks(path, text):
    """What is in this file, with this text between the marks."""
    before, _, rest = path.read_text().partition(BEGIN)
    _, mark, after = rest.partition(END)
    if not mark:
        sys.exit(f"{path} has not both marks: {BEGIN}{END}")
    return before + BEGIN + "\n" + text + "\n" + END + after


def write():
    for path, text in documents():
        path.write_text(text)


def check():
    """Fails where a table is not what was measured."""
    if wrong := [str(path.relative_to(ROOT)) for path, text in documents() if path.read_text() != text]:
        sys.exit(f"{' and '.join(wrong)}: not what was measured; run {HERE.relative_to(ROOT)}/tables.py")


if __name__ == "__main__":
    check() if "--check" in sys.argv[1:] else write()
