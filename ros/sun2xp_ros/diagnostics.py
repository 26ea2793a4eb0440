"""The diagnostics of a finger (REP 107)."""

from __future__ import annotations

from typing import List, Optional, Tuple

import sun2xp
from diagnostic_msgs.msg import DiagnosticStatus, KeyValue

#: Stages in which a finger does what planners send, or will soon do so.
_NORMAL = ("opening", "calibrating", "running")


class FingerDiagnostics:
    """Describes one finger, and the replies and periods that were lost since the previous description."""

    def __init__(self, hand: sun2xp.Hand, finger: int, name: str) -> None:
        self._hand = hand
        self._finger = finger
        self._name = name
        self._hardware = f"{hand.configuration(finger)['port']} finger {finger}"
        self._lost = 0

    def fault(self) -> int:
        """The number of the fault that has stopped the finger, or 0."""
        stopped = self._hand.fault(self._finger).stopped
        return 0 if stopped is None else stopped.number

    def status(self) -> DiagnosticStatus:
        """Returns the status of the finger."""
        hand, finger = self._hand, self._finger
        status, fault = hand.status(finger), hand.fault(finger)
        losses = status.losses
        lost = losses.lost_replies + losses.skipped_periods
        newly, self._lost = lost - self._lost, lost
        level, message = _summary(status.stage, fault, newly)
        values = [
            ("stage", status.stage),
            ("fault", _described(fault.stopped)),
            ("remedy", fault.stopped.remedy if fault.stopped else ""),
            ("warning", _described(fault.warning)),
            ("warnings since open", fault.warnings),
            ("rate, Hz", status.rate),
            ("measured rate, Hz", f"{status.measured_rate:.1f}"),
            ("wake-up, 99.9 %, us", f"{status.wake_up.p999:.0f}"),
            ("real time", status.realtime),
            ("memory locked", status.memory_locked),
            ("cycles", losses.cycles),
            ("overruns", losses.overruns),
            ("skipped periods", losses.skipped_periods),
            ("lost replies", losses.lost_replies),
            ("late replies", losses.late_replies),
            ("damaged replies", losses.damaged_replies),
            ("applied part of the desired joint torque", f"{status.torque_scale:.3f}"),
            ("applied part of Kx", f"{status.stiffness_scale:.3f}"),
            *self._tensions(),
        ]
        return DiagnosticStatus(
            level=level,
            name=f"sun2xp: {self._name}",
            message=message,
            hardware_id=self._hardware,
            values=[KeyValue(key=key, value=str(value)) for key, value in values],
        )

    def _tensions(self) -> List[Tuple[str, str]]:
        try:
            tensions = self._hand.tip(self._finger).tensions
        except sun2xp.Fault:
            # Nothing measures a finger that has stopped.
            return []
        return [(f"tension {tendon}, N", f"{tension:.2f}") for tendon, tension in enumerate(tensions, 1)]


def _summary(stage: str, fault: sun2xp.FingerFault, newly_lost: int) -> Tuple[bytes, str]:
    if fault.stopped is not None:
        return DiagnosticStatus.ERROR, fault.stopped.text
    if fault.warning is not None:
        return DiagnosticStatus.WARN, fault.warning.text
    if newly_lost > 0:
        return DiagnosticStatus.WARN, f"{newly_lost} periods or replies lost since the previous diagnostics"
    return (DiagnosticStatus.OK if stage in _NORMAL else DiagnosticStatus.WARN), stage


def _described(fault: Optional[sun2xp.FaultDescription]) -> str:
    return f"{fault.number}: {fault.name}, {fault.part}" if fault else ""
