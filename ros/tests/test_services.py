"""Tests services of the node with the real rclpy, and what the diagnostics report when a service is called."""

from conftest import JOINTS, PREFIX, near, refused, trajectory


def of_finger(message, finger):
    found = {status.name: status for status in message.status}
    return found[f"sun2xp: {PREFIX}finger{finger}"]


def in_stage(finger, stage):
    def condition(message):
        values = {value.key: value.value for value in of_finger(message, finger).values}
        return values["stage"] == stage

    return condition


def test_a_fault_is_in_diagnostics_and_recover_ends_it(planner):
    message = planner.wait("/diagnostics")
    # A busy machine loses periods, of which the diagnostics warn.
    assert [status for status in message.status if status.level > b"\x01"] == []
    assert {"tension 4, N", "lost replies", "remedy"} <= {value.key for value in message.status[0].values}
    assert message.status[0].hardware_id == "simulated finger 1"

    response = planner.call("finger2/stop")
    assert response.success and "finger 2 is stopped" in response.message
    status = of_finger(planner.wait("/diagnostics", in_stage(2, "faulted")), 2)
    values = {value.key: value.value for value in status.values}
    assert status.level == b"\x02" and "stop of the finger" in status.message
    assert values["fault"].startswith("50: ") and "recover it" in values["remedy"]
    assert list(planner.wait("joint_states").name) == JOINTS[:3] + JOINTS[6:]
    planner.trajectories.publish(trajectory(2, (1.0, [0.0, 0.5, 0.9])))
    planner.wait("/rosout", refused("finger 2 is faulted"))

    response = planner.call("recover")
    assert response.success, response
    assert response.message == "finger 1 has no fault; finger 2 has recovered; finger 3 has no fault"
    assert planner.wait("/diagnostics", in_stage(2, "running")).status[1].level < b"\x02"
    assert list(planner.wait("joint_states").name) == JOINTS


def test_a_zeroing_does_not_delay_the_node_and_stop_ends_it(planner):
    zeroing = planner.begin("finger3/zero")
    planner.wait("/diagnostics", in_stage(3, "calibrating"))
    planner.trajectories.publish(trajectory(3, (1.0, [0.0, 0.5, 0.9])))
    planner.wait("/rosout", refused("trajectory refused", "finger 3"))
    planner.trajectories.publish(trajectory(2, (1.0, [0.1, 0.6, 1.0])))
    planner.wait("joint_states", near(2, [0.1, 0.6, 1.0]))
    assert not zeroing.done() and planner.call("stop").success
    response = planner.finish(zeroing, "finger3/zero")
    assert not response.success and "finger 3" in response.message
    assert planner.call("recover").success
    planner.wait("/diagnostics", in_stage(3, "running"))
