"""The parallel stiffness controller of the Stanford/JPL hand.

Lengths are in cm, forces in N, torques in N cm, angles in rad, stiffnesses in N/cm, times in s, unless a description
says otherwise. Fingers are numbered 1 to 3, joints 0 to 2, tendons 1 to 4.

    import sun2xp

    with sun2xp.simulated() as hand:
        hand.send_position(1, [0.1, 0.5, 0.9])
        print(hand.position(1))
"""

from . import then, when
from ._errors import Closed, ConfigurationError, Error, ErrorNumber, Fault, Refused, TimedOut
from ._events import Events
from ._hand import Hand, open, simulated
from ._recording import Recording, read_recording
from ._sun2xp import stop_all
from ._sun2xp import version as __version__
from ._types import (
    Distribution,
    Event,
    EventKind,
    FaultDescription,
    FingerFault,
    Identified,
    JointState,
    JointTorques,
    Limits,
    Losses,
    Mark,
    ObjectState,
    PalmPose,
    SetPoint,
    Signs,
    Status,
    Tip,
    TouchReading,
    Zeros,
)

__all__ = [
    "Closed",
    "ConfigurationError",
    "Distribution",
    "Error",
    "ErrorNumber",
    "Event",
    "EventKind",
    "Events",
    "Fault",
    "FaultDescription",
    "FingerFault",
    "Hand",
    "Identified",
    "JointState",
    "JointTorques",
    "Limits",
    "Losses",
    "Mark",
    "ObjectState",
    "PalmPose",
    "Recording",
    "Refused",
    "SetPoint",
    "Signs",
    "Status",
    "TimedOut",
    "Tip",
    "TouchReading",
    "Zeros",
    "__version__",
    "open",
    "read_recording",
    "simulated",
    "stop_all",
    "then",
    "when",
]
