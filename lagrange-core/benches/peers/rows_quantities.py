"""What else is asked of an arm than its accelerations, against Pinocchio."""

import peers
from report import Section, bar, comparison, fastest
from timing import measure
from workshop import NATIVE, progress

# Heading, system in the harness and function of ours, others of ours, functions of Pinocchio.
QUANTITIES = (
    ("inverse dynamics", "arm_inverse", (), ("inverse",)),
    ("mass matrix", "arm_mass", (), ("mass_local", "mass_world")),
    ("Jacobian of a point", "arm_jacobian", (), ("jacobian_frame", "jacobian_joints")),
    ("state derivatives", "arm_derivatives", ("arm_derivatives_checked",), ("derivatives",)),
)
JOINTS = 6
WORST_ERROR = 1e-12


def makers(system, others, functions):
    for function in (system, *others):
        yield f"ours, {function}", lambda function=function: peers.quantity(f"{function}_{JOINTS}", NATIVE)
    for function in functions:
        label = peers.PINOCCHIO_QUANTITIES[function]
        yield label, lambda function=function: peers.pinocchio_quantity(function, NATIVE)


def rows(options):
    section = Section("An arm of six joints: nanoseconds per quantity")
    section.text(
        "Placed arbitrarily, with the parameters of the accelerations above. Inverse dynamics are the forces at the joints "
        "that accelerations take; the Jacobian is that of the velocity of a point of the last link (Pinocchio gives the "
        "angular one with it), which ours has as that of a constraint; the derivatives are those of all accelerations by "
        "angles, their rates and the forces at the joints, ours by `residual_slopes` and `factor`, and by the checked "
        "`state_jacobian`. All are right to 10⁻¹² of the largest number in a matrix. A cell: least time of a sample · ours "
        "divided by it, by minima (by medians)."
    )
    columns = {}
    for heading, system, others, functions in QUANTITIES:
        progress(f"{heading}, {NATIVE.name}")
        implementations, missing = peers.gather(makers(system, others, functions))
        columns[heading], wrong = measure(system, JOINTS, implementations, options.effort, WORST_ERROR)
        section.missing += missing + wrong
        bar(section, f"{heading}, against", columns[heading], fastest(columns[heading], ["tool"]), 1.0)
    comparison(section, NATIVE.name, columns)
    return section
