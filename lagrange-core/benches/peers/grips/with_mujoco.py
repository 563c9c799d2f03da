"""`with_mujoco.py SCENE STEP SECONDS SETTINGS` holds the cube of the scene still by MuJoCo, and prints what `ours` prints.

SETTINGS are `default`, or `stiff`: elliptic cones, 10 for the ratio of frictional to normal impedance, and 50 iterations against slip.
"""

import json
import sys
import time

import mujoco
import numpy

SCENES = {
    "grip": """
        <geom name="wall" type="box" pos="-0.05 0 0" size="0.05 0.2 0.2" friction="0.5 0 0"/>
        <body name="cube" pos="0.05 0 0">
          <freejoint/>
          <geom type="box" size="0.05 0.05 0.05" mass="1" friction="0.5 0 0"/>
        </body>
        <body name="pad" pos="0.15 0 0">
          <joint name="pad" type="slide" axis="1 0 0"/>
          <geom type="box" size="0.05 0.2 0.2" mass="1" friction="0.5 0 0"/>
        </body>""",
    "slope": """
        <geom name="slope" type="plane" size="5 5 0.1" friction="0.5 0 0"/>
        <body name="cube" pos="0 0 0.05">
          <freejoint/>
          <geom type="box" size="0.05 0.05 0.05" mass="1" friction="0.5 0 0"/>
        </body>""",
}
STIFF = 'cone="elliptic" impratio="10" noslip_iterations="50"'


def main():
    scene, step, seconds, settings = sys.argv[1], float(sys.argv[2]), float(sys.argv[3]), sys.argv[4]
    angle = numpy.radians(25 if scene == "slope" else 0)
    gravity = 9.81 * numpy.array([numpy.sin(angle), 0, -numpy.cos(angle)])
    model = mujoco.MjModel.from_xml_string(
        f"""<mujoco>
          <option timestep="{step}" gravity="{gravity[0]} 0 {gravity[2]}" {STIFF if settings == "stiff" else ""}/>
          <worldbody>{SCENES[scene]}</worldbody>
        </mujoco>"""
    )
    data = mujoco.MjData(model)
    if scene == "grip":
        data.qfrc_applied[model.joint("pad").dofadr[0]] = -20
    cube = model.body("cube").id
    # What bodies sink into one another at first is no creep.
    advance(model, data, 1 / step)
    start, now = data.xpos[cube].copy(), time.perf_counter()
    count = round((seconds - 1) / step)
    advance(model, data, count)
    spent = (time.perf_counter() - now) / count
    creep = numpy.linalg.norm(data.xpos[cube] - start)
    print(json.dumps({"creep": creep, "speed": numpy.linalg.norm(data.qvel[:3]), "step": spent}))


def advance(model, data, count):
    for _ in range(round(count)):
        mujoco.mj_step(model, data)


main()
