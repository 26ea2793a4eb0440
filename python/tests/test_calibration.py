"""Calibrations, and their results in the configuration file."""

import numpy
import pytest

import sun2xp


def test_zeros_are_found_and_stored(tmp_path):
    file = tmp_path / "hand.toml"
    file.write_text("[finger]\nport = 'simulated'\n")
    steps = []
    with sun2xp.open(file) as hand:
        zeros = hand.zero(1, lambda part, step: steps.append((part, step)))
        assert zeros.gauge.shape == (4,) and zeros.joint_error.shape == (3,)
        assert abs(zeros.joint_error).max() < 0.05
        assert hand.configuration(1)["encoder"]["zero"] == list(zeros.encoder)
        assert hand.status(1).stage == "running"
        # `zero` has stored the zeros in the file, so nothing is left to store.
        assert not hand.store_calibration(1)
        with pytest.raises(sun2xp.Refused):
            hand.zero(4)
    assert len(steps) > 10 and all(0 <= part <= 1 for part, _ in steps)
    assert {"reading the gauges with slack tendons"} <= {step for _, step in steps}
    assert "zero" in file.read_text() and numpy.isfinite(zeros.gauge).all()


def test_an_interrupted_calibration_stops_the_finger(hand):
    def interrupt(part, step):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        hand.zero(2, interrupt, store=False)
    # The servo carries out the stop at the beginning of its next cycle. The fixture `limit` ends a test that hangs.
    while hand.status(2).stage != "faulted":
        pass
    hand.recover(2)
    assert hand.status(2).stage == "running"
