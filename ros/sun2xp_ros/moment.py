"""Times of the library on the clock of ROS."""

from __future__ import annotations

import time
from typing import Any

from rclpy.duration import Duration
from rclpy.time import Time


class Moment:
    """The same moment on the clock of ROS and on CLOCK_MONOTONIC, which stamps the measurements of the library."""

    def __init__(self, clock: Any) -> None:
        self.on_ros: Time = clock.now()
        #: The moment on CLOCK_MONOTONIC, ns.
        self.monotonic: int = time.monotonic_ns()

    def time_of(self, measured: int) -> Time:
        """Returns the time of a measurement on the clock of ROS. `measured` is its time on CLOCK_MONOTONIC, ns. If the
        clock of ROS began after the measurement, as a simulated clock can, returns the beginning of the clock of ROS,
        because no time is negative."""
        since = max(measured - self.monotonic, -self.on_ros.nanoseconds)
        return self.on_ros + Duration(nanoseconds=since)
