"""Each implementation as a shared library with the signature of the harness."""

from dataclasses import dataclass
from pathlib import Path

from workshop import HERE, PLAIN, SHOP, Missing, build_ours, generate, progress, run


@dataclass
class Implementation:
    """A function in a shared library, and what it takes where its generator tells."""

    name: str
    kind: str  # "ours", "tool" or "hand"
    library: Path
    function: str = "accelerations"
    operations: int | None = None
    functions: int | None = None


def compile_c(sources, output, flags, *extra):
    output.parent.mkdir(parents=True, exist_ok=True)
    run("gcc", *flags.gcc, "-w", "-fPIC", "-shared", *extra, *sources, "-o", output, "-lm")
    return output


def place(name, flags):
    """The path of a built file, without its ending."""
    folder = SHOP / f"built-{flags.name}"
    folder.mkdir(parents=True, exist_ok=True)
    return folder / name


def ours(name, flags, label="ours"):
    library = build_ours("ours", flags) / "libours.so"
    return Implementation(label, "ours", library, name)


def by_hand(source, function, label, flags, **defines):
    name = "_".join(["hand", source, *map(str, defines.values())])
    library = compile_c([HERE / "hand" / f"{source}.c"], place(name + ".so", flags), flags,
                        *(f"-D{key}={value}" for key, value in defines.items()))
    return Implementation(label, "hand", library, function)


CASADI = {"ldl": "CasADi, LDLᵀ", "schur": "CasADi, Schur + LDLᵀ", "kkt": "CasADi, LDLᵀ of the whole"}


def casadi(system, n, how, flags):
    source = place(f"casadi_{system}_{how}_{n}.c", flags)
    count = generate("with_casadi.py", system, n, how, source)
    library = compile_c([source], source.with_suffix(".so"), flags)
    return Implementation(CASADI[how], "tool", library, operations=count["operations"], functions=count["functions"])


def wrenfold(n, how, flags):
    source = place(f"wrenfold_{how}_{n}.rs", flags)
    count = generate("with_wrenfold.py", n, how, source)
    library = source.with_suffix(".so")
    run("rustc", "--edition", "2021", "--crate-type", "cdylib", "-C", "opt-level=3", "-C", "panic=abort",
        *flags.rustc, source, "-o", library, cwd=HERE)
    if how == "loops":
        return Implementation("wrenfold, M and h", "tool", library)
    return Implementation("wrenfold, unrolled LDLᵀ", "tool", library,
                          operations=count["operations"], functions=count["functions"])


def heyoka(system, n, flags):
    if flags is PLAIN:
        raise Missing("heyoka compiles for the CPU it runs on, whatever the flags")
    source = place(f"heyoka_{system}_{n}.c", flags)
    code = source.with_suffix(".o")
    count = generate("with_heyoka.py", system, n, code, source)
    found = list((SHOP / "venv").glob("lib/python*/site-packages/heyoka.libs/libheyoka-*"))
    if not found:
        raise Missing("the library of heyoka's package, with its vector functions, is not where it was")
    library = compile_c([source, code, found[0]], source.with_suffix(".so"), flags, f"-Wl,-rpath,{found[0].parent}")
    return Implementation("heyoka, cfunc", "tool", library,
                          operations=count["operations"], functions=count["functions"])


def sympy(n, how, flags, seconds):
    source = place(f"sympy_{how}_{n}.c", flags)
    # The derivation takes long, and is the same for all flags.
    written = place(source.name, PLAIN)
    stamp = written.with_suffix(".json")
    if not stamp.exists():
        count = generate("with_sympy.py", n, how, written, seconds=seconds)
        stamp.write_text(repr(count))
    library = compile_c([written], source.with_suffix(".so"), flags)
    label = "SymPy, symbolic LU" if how == "unrolled" else "SymPy, M and h"
    return Implementation(label, "tool", library)


def gather(makers):
    """Those that can be had, and the reasons why others cannot."""
    had, missing = [], []
    for label, make in makers:
        try:
            progress(f"  building {label}")
            had.append(make())
        except Missing as reason:
            progress(f"  missing {label}: {reason}")
            missing.append((label, str(reason)))
    return had, missing
