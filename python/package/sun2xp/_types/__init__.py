"""The results of calls, and the set point of a group.

Lengths are in cm, forces in N, torques in N cm, angles in rad, stiffnesses in N/cm.

`==` compares two results by identity and not by value, because a comparison of arrays has no single truth value.
"""

from ._calibration import Identified, Signs, Zeros
from ._commands import Limits, SetPoint
from ._events import Event, EventKind, FaultDescription, FingerFault, Mark
from ._service import Distribution, Losses, Status
from ._state import Array, JointState, JointTorques, ObjectState, PalmPose, Tip, TouchReading

__all__ = [
    "Array",
    "Distribution",
    "Event",
    "EventKind",
    "FaultDescription",
    "FingerFault",
    "Identified",
    "JointState",
    "JointTorques",
    "Limits",
    "Losses",
    "Mark",
    "ObjectState",
    "PalmPose",
    "SetPoint",
    "Signs",
    "Status",
    "Tip",
    "TouchReading",
    "Zeros",
]
