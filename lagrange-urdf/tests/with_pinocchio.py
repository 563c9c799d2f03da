#!/usr/bin/env python3
"""Compares imported robots with Pinocchio: mass matrix, inverse dynamics, accelerations and their derivatives in the tangent of
the state, at 200 random states each.

    pip install pin example-robot-data
    python3 lagrange-urdf/tests/with_pinocchio.py [NAME …]

Robots are those of example-robot-data. Each is imported, compiled and asked for its numbers; Pinocchio reads the same file.
The largest difference counts relative to the largest entry. Without Pinocchio nothing is compared, and that is said."""

import os
import re
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree
from pathlib import Path

try:
    import numpy
    import pinocchio
except ImportError as error:
    print(f"NOTE: {error}: imported robots are not compared with Pinocchio", file=sys.stderr)
    sys.exit(0)

TOLERANCE = 1e-11
STATES = 200
ROOT = Path(__file__).resolve().parents[2]
FIXED, FLOATING = [], ["--floating"]

# Name, file, options.
ROBOTS = [
    ("double_pendulum", "double_pendulum_description/urdf/double_pendulum.urdf", FIXED),
    ("two_dofs", "asr_twodof_description/urdf/TwoDofs.urdf", FIXED),
    ("ur5", "ur_description/urdf/ur5_robot.urdf", FIXED),
    ("ur10_numbers", "ur_description/urdf/ur10_robot.urdf", ["--numbers"]),
    ("panda", "panda_description/urdf/panda.urdf", FIXED),
    ("kinova", "kinova_description/robots/kinova.urdf", FIXED),
    ("xarm7", "xarm_description/urdf/xarm7.urdf", FIXED),
    ("z1", "z1_description/urdf/z1.urdf", FIXED),
    ("so101", "so_arm_description/urdf/so101.urdf", FIXED),
    ("allegro_hand", "allegro_hand_description/urdf/allegro_right_hand.urdf", FIXED),
    ("talos_arm", "talos_data/robots/talos_left_arm.urdf", FIXED),
    ("tiago", "tiago_description/robots/tiago_no_hand.urdf", FIXED),
    ("tiago_dual_numbers", "tiago_description/robots/tiago_dual.urdf", ["--numbers"]),
    ("baxter", "baxter_description/urdf/baxter.urdf", FIXED),
    ("solo12", "solo_description/robots/solo12.urdf", FLOATING),
    ("anymal", "anymal_c_simple_description/urdf/anymal.urdf", FLOATING),
    ("go2", "go2_description/urdf/go2.urdf", FLOATING),
    ("hyq", "hyq_description/robots/hyq_no_sensors.urdf", FLOATING),
    ("talos_numbers", "talos_data/robots/talos_reduced.urdf", FLOATING + ["--numbers"]),
    ("g1_numbers", "g1_description/urdf/g1_29dof_rev_1_0.urdf", FLOATING + ["--numbers"]),
]

MANIFEST = """
[package]
name = "robots"
version = "0.0.0"
edition = "2024"

[dependencies]
lagrange-core = {{ path = "{root}/lagrange-core" }}

[workspace]

[profile.dev]
debug = false

[profile.dev.package.lagrange-derive]
opt-level = 2
"""

# Reads a state, accelerations and efforts a line; writes mass matrix, inverse dynamics without efforts, accelerations with, and the
# derivatives of these in local coordinates.
ANSWERS = """
use lagrange_core::nalgebra::{Const, DMatrix, SVector};
use lagrange_core::prelude::*;

pub fn answer<L, const N: usize, const M: usize>(mut robot: L, linear: impl Fn(&L, &State<f64, N>) -> DMatrix<f64>)
where
    L: Simulate + Linearized + Lagrangian<Scalar = f64, N = Const<N>, M = Const<M>>,
{
    let efforts: Vec<usize> = (0..L::PARAMETERS.len()).filter(|k| L::PARAMETERS[*k].starts_with("tau_")).collect();
    println!("{}", L::COORDINATES.join(" "));
    println!("{}", efforts.iter().map(|k| &L::PARAMETERS[*k][4..]).collect::<Vec<_>>().join(" "));
    for line in std::io::stdin().lines() {
        let line = line.unwrap();
        let numbers: Vec<f64> = line.split(' ').map(|number| number.parse().unwrap()).collect();
        let part = |k: usize| -> [f64; N] { std::array::from_fn(|i| numbers[k * N + i]) };
        let state = State::new(part(0), part(1));
        efforts.iter().for_each(|k| assert!(robot.set_parameter(*k, 0.0)));
        let forces = robot.inverse_dynamics(&state, &part(2).into(), &SVector::zeros());
        for (k, effort) in efforts.iter().zip(&numbers[3 * N..]) {
            robot.set_parameter(*k, *effort);
        }
        let accelerations = robot.solve(&state).unwrap().accelerations;
        let matrix = robot.mass_matrix(&state);
        let linear = linear(&robot, &state);
        let below = linear.rows(linear.nrows() / 2, linear.nrows() / 2);
        let all = matrix.iter().chain(forces.iter()).chain(accelerations.iter()).chain(below.iter());
        println!("{}", all.map(|number| format!("{number:e}")).collect::<Vec<_>>().join(" "));
    }
}
"""

MAIN = """
#![recursion_limit = "512"]
use lagrange_core::prelude::*;
mod robot {{ include!("{text}"); }}
fn main() {{ robots::answer(robot::{name}::default(), |robot, state| {linear}); }}
"""

# In local coordinates there are no other constraints than those of quaternions.
LINEAR = "robot.linearize_locally(state, &[]).unwrap().a"
NO_LINEAR = "{ let _ = (robot, state); lagrange_core::nalgebra::DMatrix::zeros(0, 0) }"


def folder():
    """Where the descriptions of example-robot-data are."""
    for path in sys.path:
        for found in Path(path).glob("**/share/example-robot-data/robots"):
            return found
    print("NOTE: example-robot-data is not installed: imported robots are not compared with Pinocchio", file=sys.stderr)
    sys.exit(0)


def crate(place, robots):
    """Writes a crate with a program for each robot that can be imported. Returns these."""
    (place / "src/bin").mkdir(parents=True)
    (place / "Cargo.toml").write_text(MANIFEST.format(root=ROOT))
    (place / "src/lib.rs").write_text(ANSWERS)
    imported = []
    for name, file, options in robots:
        command = ["cargo", "run", "--quiet", "--locked", "-p", "lagrange-urdf", "--", *options, file]
        result = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
        if result.returncode:
            print(f"{name}: not imported\n{result.stderr}")
            continue
        text = place / f"{name}.rs"
        text.write_text(result.stdout)
        struct = re.search(r"pub struct (\w+)", result.stdout)[1]
        (place / f"src/bin/{name}.rs").write_text(
            MAIN.format(text=text, name=struct, linear=NO_LINEAR if "#[constraint" in result.stdout else LINEAR)
        )
        imported.append((name, file, options))
    return imported


class Robot:
    """A robot of Pinocchio in the coordinates of ours."""

    def __init__(self, file, floating, coordinates):
        root = [pinocchio.JointModelFreeFlyer()] if floating else []
        self.model = pinocchio.buildModelFromUrdf(str(file), *root, mimic=True)
        self.data = self.model.createData()
        self.model.gravity.linear = numpy.array([0.0, 0.0, -9.81])
        self.damping = self.model.damping + self.mimicked_damping(file)
        self.mimics = any(joint.shortname().startswith("JointModelMimic") for joint in self.model.joints)
        self.floating = floating
        self.count = len(coordinates)
        place = {name: k for k, name in enumerate(coordinates)}
        # Index in our coordinates, in those of Pinocchio, in its velocities, whether it has cosine and sine.
        self.joints = []
        for name, joint in zip(self.model.names, self.model.joints):
            if name in ("universe", "root_joint") or joint.nv == 0:
                continue
            ours = re.sub("[^A-Za-z0-9]+", "_", name)
            self.joints.append((place.pop(ours), joint.idx_q, joint.idx_v, joint.nq == 2))
        assert all(name.startswith(("place", "turn")) for name in place), place

    def mimicked_damping(self, file):
        """Damping of joints that mimic, along the joints that they follow: Pinocchio leaves it out."""
        damping = numpy.zeros(self.model.nv)
        for joint in xml.etree.ElementTree.parse(file).iter("joint"):
            mimic, dynamics = joint.find("mimic"), joint.find("dynamics")
            if mimic is not None and dynamics is not None and joint.get("type") != "fixed":
                driver = self.model.joints[self.model.getJointId(mimic.get("joint"))]
                factor = float(mimic.get("multiplier", 1))
                damping[driver.idx_v] += factor**2 * float(dynamics.get("damping", 0))
        return damping

    def state(self, q, v):
        """Coordinates and velocities for Pinocchio, and the matrix T that takes our rates to its velocities."""
        there, rates = numpy.zeros(self.model.nq), numpy.zeros((self.model.nv, self.count))
        if self.floating:
            w, x, y, z = q[3:7]
            turn = pinocchio.Quaternion(w, x, y, z).toRotationMatrix()
            there[:3], there[3:7] = q[:3], [x, y, z, w]
            rates[:3, :3] = turn.T
            rates[3:6, 3:7] = 2 * numpy.array([[-x, w, z, -y], [-y, -z, w, x], [-z, y, -x, w]])
        for ours, index, velocity, is_pair in self.joints:
            there[index : index + 1 + is_pair] = [numpy.cos(q[ours]), numpy.sin(q[ours])] if is_pair else [q[ours]]
            rates[velocity, ours] = 1
        return there, rates @ v, rates

    def accelerations(self, rates, v, a):
        """Those for Pinocchio: T a + Ṫ q̇, of which the second is that of the origin's velocity along turning axes."""
        there = rates @ a
        if self.floating:
            speeds = rates @ v
            there[:3] -= numpy.cross(speeds[3:6], speeds[:3])
        return there

    def forces(self, q, v, a):
        """Generalized forces along our coordinates, with damping."""
        there, speeds, rates = self.state(q, v)
        forces = pinocchio.rnea(self.model, self.data, there, speeds, self.accelerations(rates, v, a))
        return rates.T @ (forces + self.damping * speeds)

    def mass_matrix(self, q):
        there, _, rates = self.state(q, numpy.zeros(self.count))
        upper = numpy.triu(pinocchio.crba(self.model, self.data, there))
        return rates.T @ (upper + numpy.triu(upper, 1).T) @ rates

    def free(self, q, v, efforts):
        """Accelerations for Pinocchio of these efforts along our coordinates."""
        there, speeds, rates = self.state(q, v)
        efforts = rates @ efforts - self.damping * speeds
        if self.mimics:
            # The articulated-body algorithm of Pinocchio has no joints that mimic.
            upper = numpy.triu(pinocchio.crba(self.model, self.data, there))
            bias = pinocchio.rnea(self.model, self.data, there, speeds, numpy.zeros(self.model.nv))
            return numpy.linalg.solve(upper + numpy.triu(upper, 1).T, efforts - bias)
        return pinocchio.aba(self.model, self.data, there, speeds, efforts)


    def derivatives(self, q, v, efforts):
        """Derivatives of the accelerations by the tangent of the place and by the velocities, with damping: −M⁻¹ times those of the
        inverse dynamics. Pinocchio's own function for them, `computeABADerivatives`, is off by up to 2e-10 for Tiago and G1, by
        differences with 60 digits."""
        there, speeds, rates = self.state(q, v)
        upper = numpy.triu(pinocchio.crba(self.model, self.data, there))
        accelerations = pinocchio.aba(self.model, self.data, there, speeds, rates @ efforts - self.damping * speeds)
        by_q, by_v, _ = pinocchio.computeRNEADerivatives(self.model, self.data, there, speeds, accelerations)
        forces = numpy.hstack([by_q, by_v + numpy.diag(self.damping)])
        return -numpy.linalg.solve(upper + numpy.triu(upper, 1).T, forces)

    def converted(self, q, v, a, below):
        """Ours, in local coordinates, in the tangent of Pinocchio: there places and velocities of the base are along its axes."""
        _, speeds, rates = self.state(q, v)
        n = len(below)
        order, columns = numpy.zeros(n, dtype=int), numpy.arange(n)
        if self.floating:
            order[:6] = columns[:6]
        for ours, _, velocity, _ in self.joints:
            order[velocity] = ours - self.floating
        below = below[order][:, numpy.concatenate([order, n + order])]
        if not self.floating:
            return below
        turn, along, omega = rates[:3, :3].T, speeds[:3], speeds[3:6]
        # Their changes of (place, rotation, …) and of (velocity, ω, …) in ours.
        changes = numpy.eye(2 * n)
        changes[:3, :3] = changes[n : n + 3, n : n + 3] = turn
        changes[n : n + 3, 3:6] = -turn @ skew(along)
        below = below @ changes
        below[:3] = turn.T @ below[:3]
        below[:3, 3:6] += skew(turn.T @ a[:3])
        below[:3, n : n + 3] -= skew(omega)
        below[:3, n + 3 : n + 6] += skew(along)
        return below


def skew(x):
    return numpy.array([[0, -x[2], x[1]], [x[2], 0, -x[0]], [-x[1], x[0], 0]])


def random_state(random, robot):
    q, v, a = random.uniform(-3, 3, (3, robot.count))
    if robot.floating:
        turn = q[3:7] / numpy.linalg.norm(q[3:7])
        q[3:7] = turn
        v[3:7] -= turn * (turn @ v[3:7])
        a[3:7] -= turn * (turn @ a[3:7] + v[3:7] @ v[3:7])
    return q, v, a


def difference(found, expected):
    return numpy.abs(found - expected).max() / numpy.abs(expected).max()


def compare(program, file, floating):
    """Largest differences of mass matrix, inverse dynamics, accelerations and their derivatives; number of our coordinates."""
    pipe = dict(stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    with subprocess.Popen([program], **pipe) as process:
        coordinates, driven = (process.stdout.readline().split() for _ in range(2))
        robot, random = Robot(file, floating, coordinates), numpy.random.default_rng(1)
        n, worst = robot.count, numpy.zeros(4)
        for _ in range(STATES):
            q, v, a = random_state(random, robot)
            efforts = numpy.zeros(n)
            efforts[[coordinates.index(name) for name in driven]] = random.uniform(-9, 9, len(driven))
            line = [*q, *v, *a, *(efforts[coordinates.index(name)] for name in driven)]
            print(*line, file=process.stdin, flush=True)
            numbers = numpy.array(process.stdout.readline().split(), dtype=float)
            matrix, forces, accelerations, below = numpy.split(numbers, [n * n, n * n + n, n * n + 2 * n])
            _, _, rates = robot.state(q, v)
            worst = numpy.maximum(worst, [
                difference(matrix.reshape(n, n), robot.mass_matrix(q)),
                difference(forces, robot.forces(q, v, a)),
                difference(robot.accelerations(rates, v, accelerations), robot.free(q, v, efforts)),
                0,
            ])
            # Pinocchio has no derivatives of joints that mimic.
            if len(below) and not robot.mimics:
                below = below.reshape(-1, robot.model.nv).T
                found = robot.converted(q, v, accelerations, below)
                worst[3] = max(worst[3], difference(found, robot.derivatives(q, v, efforts)))
        process.stdin.close()
    return worst, n


def main():
    robots, wanted = folder(), sys.argv[1:]
    chosen = [(name, robots / file, options) for name, file, options in ROBOTS if not wanted or name in wanted]
    with tempfile.TemporaryDirectory() as place:
        place = Path(place)
        agree, target = 0, Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")).resolve() / "robots"
        print(f"{'robot':<20}{'coordinates':>12}{'compiled':>10}{'M':>10}{'inverse':>10}{'q̈':>10}{'∂q̈':>10}")
        for name, file, options in crate(place, chosen):
            start = time.monotonic()
            command = ["cargo", "build", "--quiet", "--bin", name, "--target-dir", target]
            if subprocess.run(command, cwd=place).returncode:
                continue
            seconds = time.monotonic() - start
            worst, count = compare(target / "debug" / name, file, "--floating" in options)
            agree += worst.max() < TOLERANCE
            row = "".join(f"{x:>10.1e}" if x else f"{'–':>10}" for x in worst)
            print(f"{name:<20}{count:>12}{seconds:>8.1f} s{row}", flush=True)
    print(f"{agree} of {len(chosen)} robots agree to {TOLERANCE}")
    return 0 if agree == len(chosen) else 1


if __name__ == "__main__":
    sys.exit(main())
