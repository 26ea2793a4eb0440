"""Measures a finger as a spring: pushes the tip of a simulated finger with a rising force along each axis, and plots
how far the tip gives way, together with the straight lines that follow from the stiffness that was sent.

    python spring.py spring.png
"""

import sys
import time

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plot
import numpy

import sun2xp

STIFFNESS = numpy.diag([3.0, 2.0, 1.5])  # N/cm
FORCES = numpy.linspace(0, 1.5, 6)  # N
AXES = "xyz"
PAUSE = 0.5  # s, for the finger to come to rest


def deflections(hand: sun2xp.Hand, axis: int) -> numpy.ndarray:
    """The deflections of the tip along an axis under each of the forces, cm: shape (n,)."""
    places = []
    for force in FORCES:
        hand.push(1, force * numpy.eye(3)[axis])
        time.sleep(PAUSE)
        places.append(hand.tip(1).position[axis])
    hand.push(1, [0, 0, 0])
    return numpy.array(places) - places[0]


def main(picture: str) -> None:
    with sun2xp.simulated() as hand:
        hand.send_position(1, [0.0, 0.6, 0.9])
        hand.send_stiffness(1, STIFFNESS)
        hand.wait(1, "settled", timeout=30)
        measured = [deflections(hand, axis) for axis in range(3)]

    figure, axes = plot.subplots(figsize=(6, 4), constrained_layout=True)
    for axis, name in enumerate(AXES):
        color = f"C{axis}"
        sent = STIFFNESS[axis, axis]
        axes.plot(FORCES / sent, FORCES, color=color, linewidth=1)
        label = f"{name}: {sent:g} N/cm sent, {numpy.polyfit(measured[axis], FORCES, 1)[0]:.2f} N/cm measured"
        axes.plot(measured[axis], FORCES, "o", color=color, label=label)
    axes.set_xlabel("deflection of the tip, cm")
    axes.set_ylabel("force on the tip, N")
    axes.set_title("A fingertip is the spring that was sent")
    axes.legend()
    axes.grid(alpha=0.3)
    figure.savefig(picture, dpi=120)
    for axis, name in enumerate(AXES):
        found = numpy.polyfit(measured[axis], FORCES, 1)[0]
        print(f"{name}: {STIFFNESS[axis, axis]:g} N/cm sent, {found:.2f} N/cm measured")


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else "spring.png")
