"""What else is asked of bodies in space than their accelerations, against Pinocchio and CasADi."""

import peers
from report import Section, bar, comparison, fastest
from timing import measure
from workshop import NATIVE, progress

# Heading, system and number in the harness.
SYSTEMS = (("arm of 6 joints", "arm", 6), ("quadruped", "quadruped", 0), ("humanoid", "humanoid", 0))
# Heading, function of ours, others of ours, functions of Pinocchio and of CasADi.
QUANTITIES = (
    ("inverse dynamics", "inverse", (), ("inverse",), ("inverse",)),
    ("mass matrix", "mass", (), ("mass_local", "mass_world"), ("mass",)),
    ("derivatives", "derivatives", ("derivatives_checked",), ("derivatives",), ("derivatives",)),
)
JACOBIAN = ("Jacobian of a point", "jacobian", (), ("jacobian_frame", "jacobian_joints"), ())
WORST_ERROR = 1e-12
# How much longer ours may take than Pinocchio, and than CasADi.
PINOCCHIO_LIMIT = 0.5
CASADI_LIMITS = {"arm": 1.0, "quadruped": 1.05, "humanoid": 1.05}


def makers(system, n, quantity, others, of_pinocchio, of_casadi):
    for function in (quantity, *others):
        name = f"{system}_{function}_{n}"
        yield f"ours, {name}", lambda name=name: peers.quantity(name, NATIVE)
    for function in of_pinocchio:
        label = peers.PINOCCHIO_QUANTITIES[function]
        yield label, lambda function=function: peers.pinocchio_quantity(function, NATIVE)
    for function in of_casadi:
        label = peers.CASADI_QUANTITIES[function]
        yield label, lambda function=function: peers.casadi_quantity(system, n, function, NATIVE)


def bars(section, heading, system, timings):
    for labels, limit in ((peers.PINOCCHIO_QUANTITIES, PINOCCHIO_LIMIT), (peers.CASADI_QUANTITIES, CASADI_LIMITS[system])):
        if other := fastest(timings, ["tool"], labels.values()):
            bar(section, f"{heading}, against", timings, other, limit)


def rows(options):
    section = Section("Bodies in space: nanoseconds per quantity")
    section.text(
        "The arm, the quadruped and the humanoid of the accelerations above. Inverse dynamics are the forces at the joints "
        "that accelerations take; the Jacobian is that of the velocity of a point of the last link (Pinocchio gives the "
        "angular one with it), which ours has as that of a constraint; the derivatives are those of all accelerations by "
        "coordinates, their rates and the forces at the joints, ours by `residual_slopes` and `factor`, and by the checked "
        "`state_jacobian`. Where the base is free, ours gives all that by the coordinates, a quaternion's four too, the "
        "others by six velocities along the axes of the base. All are right to 10⁻¹² of the largest number in a matrix. "
        "A cell: least time of a sample · ours divided by it, by minima (by medians)."
    )
    for title, system, n in SYSTEMS:
        columns = {}
        for heading, quantity, *functions in (*QUANTITIES, *([JACOBIAN] if system == "arm" else [])):
            progress(f"{title}: {heading}, {NATIVE.name}")
            implementations, missing = peers.gather(makers(system, n, quantity, *functions))
            columns[heading], wrong = measure(f"{system}_{quantity}", n, implementations, options.effort, WORST_ERROR)
            section.missing += [(f"{title}: {name}", why) for name, why in missing + wrong]
            bars(section, f"{title}: {heading}", system, columns[heading])
        comparison(section, f"{NATIVE.name}: {title}", columns)
    return section
