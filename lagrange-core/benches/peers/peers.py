"""Each implementation as a shared library with the signature of the harness."""

from dataclasses import dataclass
from pathlib import Path

from workshop import HERE, PLAIN, SHOP, Missing, build_ours, generate, progress, run


@dataclass
class Implementation:
    """A function in a shared library."""

    name: str
    kind: str  # "ours", "tool" or "hand"
    library: Path | None
    function: str = "accelerations"


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
    return Implementation(label, "ours", build_ours("ours", flags) / "libours.so", name)


def ours_called(name, flags, *features):
    """The emitted function not inlined: what a larger program gets."""
    built = build_ours("ours", flags, "call", *features)
    return Implementation("ours, not inlined", "ours", built / "libours.so", name)


def quantity(name, flags):
    label = "ours, checked" if "checked" in name else "ours"
    return Implementation(label, "ours", build_ours("ours", flags, "robots") / "libours.so", name)


def by_hand(source, function, label, flags, **defines):
    name = "_".join(["hand", source, *map(str, defines.values())])
    library = compile_c(
        [HERE / "hand" / f"{source}.c"],
        place(name + ".so", flags),
        flags,
        *(f"-D{key}={value}" for key, value in defines.items()),
    )
    return Implementation(label, "hand", library, function)


CASADI = {"ldl": "CasADi, LDLᵀ", "schur": "CasADi, Schur + LDLᵀ", "kkt": "CasADi, LDLᵀ of the whole"}
CASADI_ROBOTS = {"CasADi, articulated bodies": (), "fast-math: CasADi, articulated bodies": ("-ffast-math",)}
CASADI_LOOPS = {
    ("lagrangian", "degree"): "CasADi, LDLᵀ",
    ("lagrangian", "loops"): "CasADi, LDLᵀ loop by loop",
    ("newton", "degree"): "CasADi, bodies by hand, LDLᵀ",
    ("newton", "loops"): "CasADi, bodies by hand, LDLᵀ loop by loop",
}
PINOCCHIO = {
    "local": "Pinocchio, articulated bodies, local",
    "world": "Pinocchio, articulated bodies, world",
    "composite": "Pinocchio, composite bodies + Cholesky",
}
PINOCCHIO_QUANTITIES = {
    "inverse": "Pinocchio, rnea",
    "mass_local": "Pinocchio, crba, local",
    "mass_world": "Pinocchio, crba, world",
    "jacobian_frame": "Pinocchio, computeFrameJacobian",
    "jacobian_joints": "Pinocchio, computeJointJacobians",
    "derivatives": "Pinocchio, computeABADerivatives",
}
CASADI_QUANTITIES = {
    "inverse": "CasADi, Newton and Euler from link to link",
    "mass": "CasADi, composite bodies",
    "derivatives": "CasADi, Jacobian of inverse dynamics, LDLᵀ",
}
# Bytes of C in one function beyond which gcc takes more than ten minutes with -O3; half a minute with -O1.
LONGEST = 4_000_000
# What other tools read and write in these is declared in the harness.
HARNESS = f"-I{HERE / 'harness'}"
# Pinocchio's lists of joints and of arguments are longer than Boost's are by default.
BOOST = (
    "-DBOOST_MPL_LIMIT_LIST_SIZE=30",
    "-DBOOST_MPL_CFG_NO_PREPROCESSED_HEADERS",
    "-DBOOST_FUSION_INVOKE_MAX_ARITY=10",
)
WRENFOLD = {"unrolled": "wrenfold, unrolled LDLᵀ", "loops": "wrenfold, M and h"}
SYMPY = {"unrolled": "SymPy, symbolic LU", "loops": "SymPy, M and h"}


def casadi(system, n, how, flags):
    source = place(f"casadi_{system}_{how}_{n}.c", flags)
    generate("with_casadi.py", system, n, how, source)
    library = compile_c([source], source.with_suffix(".so"), flags)
    return Implementation(CASADI[how], "tool", library)


def casadi_robots(system, n, label, flags, *options):
    source = place(f"casadi_{system}_{n}.c", flags)
    generate("with_casadi_robots.py", system, n, source)
    library = place("".join([source.stem, *options]) + ".so", flags)
    return Implementation(label, "tool", compile_c([source], library, flags, HARNESS, *options))


def casadi_quantity(system, n, function, flags):
    source = place(f"casadi_{system}_{function}_{n}.c", flags)
    generate("with_casadi_quantities.py", system, n, function, source)
    is_long = source.with_name(f"generated_{source.name}").stat().st_size > LONGEST
    options = ("-O1",) if is_long else ()
    library = compile_c([source], source.with_suffix(".so"), flags, HARNESS, *options)
    return Implementation(CASADI_QUANTITIES[function], "tool", library)


def casadi_loops(system, form, order, flags):
    source = place(f"casadi_{system}_{form}_{order}.c", flags)
    generate("with_casadi_loops.py", system, form, order, source)
    return Implementation(CASADI_LOOPS[form, order], "tool", compile_c([source], source.with_suffix(".so"), flags))


def pinocchio(how, flags):
    return Implementation(PINOCCHIO[how], "tool", pinocchio_library("with_pinocchio", flags), how)


def pinocchio_quantity(function, flags):
    library = pinocchio_library("with_pinocchio_quantities", flags)
    return Implementation(PINOCCHIO_QUANTITIES[function], "tool", library, function)


def pinocchio_library(name, flags):
    """Its templates take minutes to compile, so it is done once."""
    generators = HERE / "generators"
    source, library = generators / f"{name}.cpp", place(f"{name}.so", flags)
    sources = [source, generators / "pinocchio_model.h", *(HERE / "harness" / one for one in ("systems.h", "robots.h"))]
    if not library.exists() or library.stat().st_mtime < max(one.stat().st_mtime for one in sources):
        packages = next((SHOP / "venv").glob("lib/python*/site-packages"))
        eigen = packages / "casadi" / "include" / "eigen3"
        run(
            *("g++", "-std=c++17", *flags.gcc, "-DNDEBUG", "-w", "-fPIC", "-shared", *BOOST, HARNESS),
            *(f"-I{packages / 'cmeel.prefix' / 'include'}", f"-I{eigen}", source, "-o", library),
            seconds=1200,
        )
    return library


def wrenfold(n, how, flags):
    source = place(f"wrenfold_{how}_{n}.rs", flags)
    generate("with_wrenfold.py", n, how, source)
    library = source.with_suffix(".so")
    options = ["--edition=2021", "--crate-type=cdylib", "-Copt-level=3", "-Cpanic=abort"]
    run("rustc", *options, *flags.rustc, source, "-o", library, cwd=HERE)
    return Implementation(WRENFOLD[how], "tool", library)


def heyoka(n, flags, batch=1):
    if flags is PLAIN:
        raise Missing("under plain flags, since it compiles for the CPU it runs on whatever the flags")
    source = place(f"heyoka_{n}_{batch}.c", flags)
    code = source.with_suffix(".o")
    generate("with_heyoka.py", n, batch, code, source)
    found = list((SHOP / "venv").glob("lib/python*/site-packages/heyoka.libs/libheyoka-*"))
    if not found:
        raise Missing("the library of heyoka's package, with its vector functions, is not where it was")
    library = compile_c([source, code, found[0]], source.with_suffix(".so"), flags, f"-Wl,-rpath,{found[0].parent}")
    return Implementation("heyoka, cfunc" if batch == 1 else f"heyoka, batches of {batch}", "tool", library)


def sympy(n, how, flags, seconds):
    source = place(f"sympy_{how}_{n}.c", flags)
    # The derivation takes long, and is the same for all flags and in all runs.
    written, script = place(source.name, PLAIN), HERE / "generators" / "with_sympy.py"
    if not written.exists() or written.stat().st_mtime < script.stat().st_mtime:
        generate(script.name, n, how, written, seconds=seconds)
    library = compile_c([written], source.with_suffix(".so"), flags)
    return Implementation(SYMPY[how], "tool", library)


def gather(makers):
    """Those that can be had, ours first, and the reasons why others cannot. Without ours there is no comparison."""
    had, missing = [], []
    for label, make in makers:
        try:
            progress(f"  building {label}")
            had.append(make())
        except Missing as reason:
            if label.startswith("ours"):
                raise
            progress(f"  missing {label}: {reason}")
            missing.append((label, str(reason)))
    return had, missing
