"""Loads a model into MuJoCo. The standard input has poses and rates of the nine joints, in rad and rad/s, as JSON.
Prints as JSON, for each pose, the positions of the three fingertips (m), the inertia matrix (kg m^2), and the torques
of gravity and motion (N m). Also prints the stops, the actuators and the gravity of the model."""

import json
import sys
from xml.etree import ElementTree

import mujoco
import numpy

# MuJoCo also accepts files that are not well-formed XML, so this parser checks the file first.
ElementTree.parse(sys.argv[1])
model = mujoco.MjModel.from_xml_path(sys.argv[1])
data = mujoco.MjData(model)
joints = [model.joint(f"finger{finger}_joint{joint}") for finger in (1, 2, 3) for joint in (0, 1, 2)]
places = [int(joint.qposadr[0]) for joint in joints]
speeds = [int(joint.dofadr[0]) for joint in joints]


def tip(name):
    if mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_SITE, name) >= 0:
        return data.site(name).xpos
    return data.body(name).xpos


def inertia():
    columns = []
    for speed in speeds:
        unit, column = numpy.zeros(model.nv), numpy.zeros(model.nv)
        unit[speed] = 1.0
        mujoco.mj_mulM(model, data, column, unit)
        columns.append(column[speeds].tolist())
    return columns


answers = []
for pose, rates in json.load(sys.stdin):
    data.qpos[places] = pose
    data.qvel[speeds] = rates
    mujoco.mj_forward(model, data)
    tips = [tip(f"finger{finger}_tip").tolist() for finger in (1, 2, 3)]
    answers.append({"tips": tips, "inertia": inertia(), "bias": data.qfrc_bias[speeds].tolist()})
stops = [joint.range.tolist() for joint in joints]
actuators = [model.actuator(actuator).name for actuator in range(model.nu)]
gravity = model.opt.gravity.tolist()
json.dump({"answers": answers, "stops": stops, "actuators": actuators, "gravity": gravity}, sys.stdout)
