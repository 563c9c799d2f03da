"""Operations of the accelerations: + − × ÷ √ count 1, sines and cosines apart."""

import os
import re
import subprocess

from peers import place
from report import Section
from workshop import HERE, PLAIN, SHOP, Missing, generate, progress

PLANAR, CHAIN = (2, 3, 5, 8, 10, 20), (5, 10, 20, 50)
COUNT = re.compile(r'#\[doc = "(\d+) operations? \([^"]*\), (\d+) elementary functions?')


def emitted(*features):
    """The counts that stand in the documentation of the emitted `accelerations_unchecked`, by the name of the struct."""
    # The expansion is printed when the crate is compiled, so it must be compiled anew.
    (HERE / "ours" / "src" / "lib.rs").touch()
    printed = subprocess.run(
        ["cargo", "check", "--lib", "--features", ",".join(features)],
        cwd=HERE / "ours",
        capture_output=True,
        text=True,
        env=os.environ | {"LAGRANGE_PRINT": "all", "CARGO_TARGET_DIR": str(SHOP / "ours-printed")},
    ).stderr
    parts = re.split(r"// the expansion of derive\(Lagrangian\) on (\w+)", printed)
    if len(parts) == 1:
        raise Missing("no expansion was printed")
    return {name: counted(text) for name, text in zip(parts[1::2], parts[2::2])}


def counted(expansion):
    """As the documentation says it; where the solution is left to loops, that is without the solution."""
    before, _, body = expansion.partition("fn accelerations_unchecked(")
    found = COUNT.findall(before)
    if not found:
        raise Missing("the emitted `accelerations_unchecked` does not say what they take")
    count = " / ".join(found[-1])
    is_loops = "generated::eliminate(" in body.split("\n        }\n")[0]
    return count + " + loops" if is_loops else count


def tool(script, *arguments):
    try:
        count = generate(script, *arguments)
        return f"{count['operations']} / {count['functions']}"
    except Missing as reason:
        progress(f"  missing: {reason}")
        return "–"


def casadi(system, n, how):
    return tool("with_casadi.py", system, n, how, place(f"count_{system}_{n}.c", PLAIN))


def wrenfold(n):
    return tool("with_wrenfold.py", n, "unrolled", place(f"count_{n}.rs", PLAIN))


def heyoka(n):
    return tool("with_heyoka.py", n, 1, place(f"count_{n}.o", PLAIN), place(f"count_{n}.c", PLAIN))


def sympy(n):
    return tool("with_sympy.py", n, "unrolled", place(f"count_{n}.c", PLAIN)) if n <= 3 else "–"


def rows(options):
    section = Section("Operations (+ − × ÷ √) / sines and cosines")
    section.text(
        "As each tool counts what it generates, the solution of the equations included. Ours also computes how well "
        "the system could be solved (`Solution::pivot`); where that is not used the compiler drops those operations."
    )
    progress("operation counts")
    counts = emitted()
    section.table(
        "planar pendulum",
        ["", *(f"n = {n}" for n in PLANAR)],
        [
            ["ours", *(counts[f"Planar{n}"] for n in PLANAR)],
            ["CasADi, LDLᵀ", *(casadi("planar", n, "ldl") for n in PLANAR)],
            ["wrenfold, unrolled LDLᵀ", *map(wrenfold, PLANAR)],
            ["heyoka", *map(heyoka, PLANAR)],
            ["SymPy, symbolic LU", *map(sympy, PLANAR)],
        ],
    )
    section.table(
        "plane chain of rods in Cartesian coordinates",
        ["", *(f"n = {n}" for n in CHAIN)],
        [
            ["ours", *(counts[f"Chain{n}"] for n in CHAIN)],
            ["CasADi, Schur + LDLᵀ", *(casadi("chain", n, "schur") for n in CHAIN)],
            ["CasADi, LDLᵀ of the whole", *(casadi("chain", n, "kkt") for n in CHAIN)],
        ],
    )
    return section
