"""Checks the set points of a planner, as far as the client can, and converts them to the form of the protocol."""

from __future__ import annotations

from typing import Any, Dict, List, Sequence

import numpy
import numpy.typing

from .._errors import ErrorNumber, Refused
from .._types import Array, SetPoint
from ._messages import JOINTS, MOST_POSES, NO_PLACE, PATH, TIP, Part
from ._types import FingerStatus

#: Relative rounding of `float32`. A joint angle may exceed a limit by this fraction of the larger magnitude of the
#: joint's two limits. Kx may exceed its bound by eight times this fraction of the bound.
_ROUNDING = float(numpy.finfo(numpy.float32).eps)

#: The asymmetry of Kx that counts as rounding, relative to its largest entry. The hand has the same tolerance.
_ASYMMETRY = 1e-3


def group(set_points: Sequence[SetPoint], fingers: Dict[int, FingerStatus]) -> List[Part]:
    """Returns the parts of a group. Their command numbers are not set.

    Raises:
        Refused: no set point, a set point that changes nothing, a wrong shape, a number that is not finite, a joint
            angle outside its limits, an asymmetric Kx, a Kx above the finger's bound, both a position and a tip for one
            finger, or two set points for one finger.
    """
    numbers = [set_point.finger for set_point in set_points]
    if not numbers:
        raise _refused("the group has no set point: give one for each finger that gets a new set point")
    for finger in numbers:
        if numbers.count(finger) > 1:
            raise _refused(f"the group has {numbers.count(finger)} set points for finger {finger}: give only one")
    return [_part(set_point, fingers[set_point.finger]) for set_point in set_points]


def _part(set_point: SetPoint, status: FingerStatus) -> Part:
    part = Part(set_point.finger, 0)
    if set_point.position is not None and set_point.tip is not None:
        raise _refused(f"the set point of finger {set_point.finger} has a position and a tip: leave one of them out")
    if set_point.position is not None:
        part.place = JOINTS
        part.values = tuple(_joints("position", set_point.finger, set_point.position, (3,), status))
    elif set_point.tip is not None:
        part.place, part.values = TIP, tuple(_array("tip", set_point.tip, (3,)))
    if set_point.stiffness is not None:
        part.stiffness = tuple(_symmetric(set_point.finger, set_point.stiffness, status))
    if set_point.damping is not None:
        part.damping = float(_array("damping", set_point.damping, ()))
    if part.place == NO_PLACE and part.stiffness is None and part.damping is None:
        raise _refused(f"the set point of finger {set_point.finger} is empty: set position, tip, stiffness or damping")
    return part


def path(
    finger: int, times: numpy.typing.ArrayLike, joints: numpy.typing.ArrayLike, status: FingerStatus
) -> Part:
    """Returns the Part that sends a path. Its command number is not set.

    Raises:
        Refused: a wrong shape or number of poses, a time of 0 or less, times that do not rise, or joint angles outside
            their limits.
    """
    instants = _array("times", times, (None,))
    count = len(instants)
    if not 1 <= count <= MOST_POSES:
        raise _refused(f"the path has {count} poses: send 1 to {MOST_POSES} poses, and further ones as another path")
    if instants[0] <= 0 or (numpy.diff(instants) <= 0).any():
        text = f"the times of the path are {instants.tolist()} s"
        raise _refused(f"{text}: send times above 0, each later than the time before it")
    poses = _joints("joints", finger, joints, (count, 3), status)
    return Part(finger, 0, PATH, poses=[(instant, *pose) for instant, pose in zip(instants, poses)])


def _joints(name: str, finger: int, angles: Any, shape: tuple, status: FingerStatus) -> Array:
    array = _array(name, angles, shape)
    low, high = status.joints
    rounding = _ROUNDING * numpy.maximum(abs(low), abs(high))
    if (array < low - rounding).any() or (array > high + rounding).any():
        limits = f"{low.round(4).tolist()} to {high.round(4).tolist()} rad"
        text = f"{array.tolist()} rad is outside the limits of finger {finger}, {limits}"
        raise _refused(f"{text}: send angles within the limits", ErrorNumber.LIMIT)
    return array


def _symmetric(finger: int, kx: Any, status: FingerStatus) -> List[float]:
    array = _array("Kx", kx, (3, 3))
    if not numpy.allclose(array, array.T, rtol=0, atol=_ASYMMETRY * abs(array).max()):
        raise _refused(f"Kx of finger {finger} is {array.tolist()}, not symmetric: send a symmetric Kx")
    largest = numpy.linalg.eigvalsh((array + array.T) / 2)[-1]
    if largest > status.stiffness * (1 + 8 * _ROUNDING):
        bound = f"the bound is {status.stiffness:.3g} N/cm"
        text = f"the largest eigenvalue of Kx of finger {finger} is {largest:.3g} N/cm, but {bound}"
        raise _refused(f"{text}: send a softer Kx", ErrorNumber.LIMIT)
    return array.ravel().tolist()


def _array(name: str, value: Any, shape: tuple) -> Array:
    try:
        array = numpy.asarray(value, dtype=numpy.float64)
    except (TypeError, ValueError) as error:
        raise _refused(f"{name} is no array of numbers ({error}): pass numbers") from error
    if len(array.shape) != len(shape) or any(want not in (None, have) for want, have in zip(shape, array.shape)):
        wanted = str(shape).replace("None", "n")
        raise _refused(f"{name} has the shape {array.shape}: pass an array with the shape {wanted}")
    if not numpy.isfinite(array).all():
        raise _refused(f"{name} is {array.tolist()}: pass finite numbers")
    return array


def _refused(text: str, number: int = ErrorNumber.ARGUMENT) -> Refused:
    return Refused(text, number=number)
