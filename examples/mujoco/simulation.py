"""Simulates the fingers of a hand in MuJoCo, in step with a servo in another process (mujoco_hand.c).

    sun2xp model --mjcf --output hand.xml
    python simulation.py hand.xml /dev/shm/hand [picture.png]

Both processes map the second file. The servo writes torques and requests steps of one period. This program advances
the simulation by one period for each request, and writes encoder counts and tensions. When mujoco_hand ends, this
program draws the picture, if a file for it was named, and ends.
"""

import mmap
import os
import struct
import sys
import time
import xml.etree.ElementTree as ElementTree
import zlib

import mujoco
import numpy

# Values that the model does not contain. They are the defaults of docs/sun2xp.toml.
MOTOR_RADIUS = 0.000475  # m, finger.geometry.motor_radius
STIFFNESS = 30000.0  # N/m, finger.simulation.tendon_stiffness
SHAFT_FRICTION = 0.05  # finger.simulation.shaft_friction
COUNTS = 2000 / (2 * numpy.pi)  # encoder counts per rad

PERIOD = 0.001  # s, 1 / hand.rate
STEP = 0.0001  # s, as in the built-in simulation

# The memory that both processes share: numbers of 8 bytes. mujoco_hand.c has the same layout.
READY, REQUESTED, DONE, ENDED, TIME, FIRST_FINGER = range(6)
TORQUES, TENSIONS, ENCODERS, JOINTS, SIZE = 0, 4, 8, 12, 15

# Friction that holds, instead of MuJoCo's default that creeps under a constant load.
STIFF_FRICTION = {"solreffriction": "0.0004 1", "solimpfriction": "0.999 0.9999 0.001"}


def with_elastic_tendons(text):
    """Returns the model with elastic tendons that only pull, its initial joint angles, rad, and its pretensions, N.
    In the model of `sun2xp model` the tendons are rigid, and the rotors add their inertia and friction to the tendons.
    Here a rotor for each tendon winds the tendon in. The rotor is a body that slides by the wound length, m.
    """
    root = ElementTree.fromstring(text)
    root.find("option").set("timestep", str(STEP))
    pretension = [float(pull) for pull in root.find("keyframe/key").get("ctrl").split()]
    for joint in root.iter("joint"):
        if "frictionloss" in joint.attrib:
            joint.attrib.update(STIFF_FRICTION)
    for tendon, home in zip(root.find("tendon"), pretension, strict=True):
        name = tendon.get("name")
        rotor = ElementTree.SubElement(root.find("worldbody"), "body", name=f"{name}_rotor", pos="0 0 -0.1")
        ElementTree.SubElement(rotor, "inertial", pos="0 0 0", mass="1e-6", diaginertia="1e-9 1e-9 1e-9")
        moved = {key: tendon.attrib.pop(key) for key in ("armature", "damping", "frictionloss")}
        wound = {"name": f"{name}_wound", "type": "slide", "axis": "1 0 0", **moved, **STIFF_FRICTION}
        ElementTree.SubElement(rotor, "joint", wound)
        for joint in tendon:
            joint.set("coef", str(-float(joint.get("coef"))))
        ElementTree.SubElement(tendon, "joint", joint=wound["name"], coef="1")
        # If the tendon is longer than the second number of springlength, the tension is the stiffness times the excess
        # length. Otherwise the tension is zero.
        tendon.attrib.update(stiffness=str(STIFFNESS), springlength=f"-10 {-home / STIFFNESS}")
    root.remove(root.find("actuator"))
    pose = root.find("keyframe/key").get("qpos")
    root.remove(root.find("keyframe"))
    return ElementTree.tostring(root, encoding="unicode"), [float(angle) for angle in pose.split()], pretension


class Hand:
    """The simulated hand. Arrays of the tendons have 12 entries: tendons 1 to 4 of each finger, finger by finger."""

    def __init__(self, text):
        text, pose, pretension = with_elastic_tendons(text)
        self.model = mujoco.MjModel.from_xml_string(text)
        self.data = mujoco.MjData(self.model)
        names = [(finger, tendon) for finger in (1, 2, 3) for tendon in (1, 2, 3, 4)]
        wound = [self.model.joint(f"finger{finger}_tendon{tendon}_wound") for finger, tendon in names]
        self.rotors = numpy.array([joint.dofadr[0] for joint in wound])
        self.places = numpy.array([joint.qposadr[0] for joint in wound])
        joints = [self.model.joint(f"finger{finger}_joint{joint}") for finger in (1, 2, 3) for joint in range(3)]
        self.joints = numpy.array([joint.qposadr[0] for joint in joints])
        self.rest = -numpy.array(pretension) / STIFFNESS
        self.dry = self.model.dof_frictionloss[self.rotors].copy()
        self.data.qpos[self.joints] = pose[:9]
        mujoco.mj_forward(self.model, self.data)
        # Sets the rotors so that each tendon has its pretension in this pose.
        self.data.qpos[self.places] = -self.data.ten_length
        mujoco.mj_forward(self.model, self.data)

    def tensions(self):
        """Tensions, N."""
        return STIFFNESS * numpy.maximum(0.0, self.data.ten_length - self.rest)

    def counts(self):
        """Encoder counts."""
        return numpy.floor(self.data.qpos[self.places] / MOTOR_RADIUS * COUNTS)

    def advance(self, torques):
        """Advances by one period with these torques of the motors, N cm."""
        self.data.qfrc_applied[self.rotors] = 0.01 * torques / MOTOR_RADIUS
        for _ in range(round(PERIOD / STEP)):
            self.model.dof_frictionloss[self.rotors] = self.dry + SHAFT_FRICTION * self.tensions()
            mujoco.mj_step(self.model, self.data)
        # After mj_step, the lengths of the tendons are those before the last step. This call computes the present ones.
        mujoco.mj_fwdPosition(self.model, self.data)


class Memory:
    """The memory that both processes share."""

    def __init__(self, path):
        numbers = FIRST_FINGER + 3 * SIZE
        with open(path, "w+b") as file:
            os.ftruncate(file.fileno(), 8 * numbers)
            mapped = mmap.mmap(file.fileno(), 8 * numbers)
        self.counters = numpy.frombuffer(mapped, dtype=numpy.uint64)
        self.values = numpy.frombuffer(mapped, dtype=numpy.float64)
        self.fingers = self.values[FIRST_FINGER:].reshape(3, SIZE)

    def torques(self):
        return self.fingers[:, TORQUES:TENSIONS].ravel()

    def show(self, hand):
        self.fingers[:, TENSIONS:ENCODERS] = hand.tensions().reshape(3, 4)
        self.fingers[:, ENCODERS:JOINTS] = hand.counts().reshape(3, 4)
        self.fingers[:, JOINTS:SIZE] = hand.data.qpos[hand.joints].reshape(3, 3)
        self.values[TIME] = hand.data.time


def draw(hand, path):
    """Draws the hand as a picture in the format PNG. Without a screen, set MUJOCO_GL=egl."""
    with mujoco.Renderer(hand.model, 720, 960) as renderer:
        renderer.update_scene(hand.data, camera="view")
        pixels = renderer.render()
    height, width, _ = pixels.shape
    rows = b"".join(b"\0" + row.tobytes() for row in pixels)

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)))
        file.write(chunk(b"IEND", b""))


def main(model, path, picture=None):
    with open(model, encoding="utf-8") as file:
        hand = Hand(file.read())
    memory = Memory(path)
    memory.show(hand)
    memory.counters[READY] = 1
    parent = os.getppid()
    while memory.counters[ENDED] == 0 and os.getppid() == parent:
        if memory.counters[REQUESTED] == memory.counters[DONE]:
            time.sleep(0.00005)
            continue
        hand.advance(memory.torques())
        memory.show(hand)
        # The samples are complete before the servo sees that the step is done.
        memory.counters[DONE] += 1
    if picture:
        draw(hand, picture)


if __name__ == "__main__":
    main(*sys.argv[1:])
