"""A cube that friction holds for a minute, by time stepping: how far it creeps."""

import json

from report import Bar, Section
from workshop import HERE, NATIVE, PYTHON, build_ours, progress, run

SECONDS = 60
STEPS = (1 / 500, 1 / 60)
SETTINGS = ("default", "stiff")
SCENES = {"grip": "pressed against a wall", "slope": "on a slope of 25°"}


def creeps(ours):
    """Each scene and step with what holds the cube, and what became of it."""
    script = HERE / "grips" / "with_mujoco.py"
    for scene in SCENES:
        for step in STEPS:
            yield scene, step, "ours, MoreauJean", json.loads(run(ours, scene, step, SECONDS))
            for settings in SETTINGS:
                found = json.loads(run(PYTHON, script, scene, step, SECONDS, settings))
                yield scene, step, f"MuJoCo, {settings}", found


def version():
    return run(PYTHON, "-c", "import mujoco; print(mujoco.__version__)").strip()


def rows(options):
    section = Section("A cube that friction holds, by time stepping")
    section.text(
        f"A cube of 1 kg and 0.1 m, {SECONDS} s, friction of coefficient 0.5; a pad presses it against a wall with 20 N, where 9.81 N "
        "are needed, or it stands on a slope of 25°, where 26.6° are the limit. MuJoCo "
        f"{version()} as it comes, and with elliptic cones, `impratio` 10 and 50 iterations against slip (*stiff*); its first "
        "second, in which bodies sink into one another, is not counted. Its contacts are soft by design, for robots that learn."
    )
    progress("grips")
    ours = build_ours("grips", NATIVE) / "ours"
    lines, worst = [], 0
    for scene, step, name, found in creeps(ours):
        what = f"{SCENES[scene]}, {1 / step:.0f} steps a second"
        lines.append([what, name, f"{found['creep']:.1e}", f"{found['speed']:.1e}", f"{1e6 * found['step']:.3g}"])
        worst = max(worst, found["creep"] if name.startswith("ours") else 0)
    section.table("how far it creeps", ["", "by", "creep, m", "speed at the end, m/s", "µs a step"], lines)
    section.bars.append(Bar("creep of ours, m", worst, 1e-12))
    return section
