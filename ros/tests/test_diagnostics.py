"""The levels of the diagnostics of a finger, without a hand and without nodes."""

import dataclasses
import types

import sun2xp
from diagnostic_msgs.msg import DiagnosticStatus
from sun2xp_ros.diagnostics import FingerDiagnostics

FAULT = sun2xp.FaultDescription(12, "broken tendon", "tendon 3", 0.0, "broken tendon: replace it", "replace it")
TIMES = sun2xp.Distribution(10, 1.0, 2.0, 3.0, 4.0, 5.0)
LOSSES = sun2xp.Losses(10, 0, 0, 0, 0, 0, 0, 0)
STATUS = sun2xp.Status("running", True, True, True, 1000.0, 999.9, TIMES, LOSSES, 1.0, 1.0, 0.0)


class Hand:
    """A hand in a given state."""

    def __init__(self, status=STATUS, stopped=None, warning=None):
        self.state, self.faults = status, sun2xp.FingerFault(stopped, warning, int(warning is not None))

    def configuration(self, finger):
        return {"port": "/dev/ttyUSB0"}

    def status(self, finger):
        return self.state

    def fault(self, finger):
        return self.faults

    def tip(self, finger):
        if self.faults.stopped:
            raise sun2xp.Fault("stopped")
        return types.SimpleNamespace(tensions=[1.0, 2.0, 3.0, 4.0])


def described(**state):
    status = FingerDiagnostics(Hand(**state), 2, "finger2").status()
    return status, {value.key: value.value for value in status.values}


def test_a_running_finger_is_ok():
    status, values = described()
    assert (status.level, status.message) == (DiagnosticStatus.OK, "running")
    assert status.hardware_id == "/dev/ttyUSB0 finger 2"
    assert values["tension 3, N"] == "3.00" and values["fault"] == values["remedy"] == ""


def test_a_fault_is_an_error_with_its_remedy():
    status, values = described(stopped=FAULT, status=dataclasses.replace(STATUS, stage="faulted"))
    assert (status.level, status.message) == (DiagnosticStatus.ERROR, FAULT.text)
    assert (values["fault"], values["remedy"]) == ("12: broken tendon, tendon 3", "replace it")
    assert "tension 3, N" not in values


def test_a_warning_and_a_limp_finger_are_warnings():
    status, values = described(warning=FAULT)
    assert (status.level, values["warning"]) == (DiagnosticStatus.WARN, "12: broken tendon, tendon 3")
    status, _ = described(status=dataclasses.replace(STATUS, stage="limp"))
    assert (status.level, status.message) == (DiagnosticStatus.WARN, "limp")


def test_losses_warn_once():
    hand = Hand(dataclasses.replace(STATUS, losses=dataclasses.replace(LOSSES, lost_replies=3, skipped_periods=1)))
    diagnostics = FingerDiagnostics(hand, 1, "finger1")
    first = diagnostics.status()
    assert first.level == DiagnosticStatus.WARN and first.message.startswith("4 periods or replies lost")
    assert diagnostics.status().level == DiagnosticStatus.OK
