"""The hand, and the functions that open it."""

from __future__ import annotations

import json
import os
from typing import Any, AsyncIterator, Callable, Dict, Iterable, Optional, Union

from . import _log, _sun2xp
from ._errors import Error
from ._events import Events
from ._recording import Recording, black_box
from ._types import Event, Identified, Signs, Zeros

#: Called during a calibration with its completed part, 0 to 1, and its current activity.
Progress = Callable[[float, str], None]


class Hand(_sun2xp.Hand):
    """An open hand of up to three fingers, whose numbers are in `fingers`. The servo threads run without Python.

    `sun2xp.open()` and `sun2xp.simulated()` open a hand. A process can open several hands. All methods may be called
    from several threads. Methods that wait release the interpreter lock. Ctrl-C ends `wait`, `recover`, calibrations
    and the waits for events, but not `close`. Leaving a `with` block closes the hand.

    All methods except `close` raise Closed if the hand is closed, Refused if there is no such finger or if an argument
    is wrong, and Fault if the method needs a running finger and the finger is faulted. They raise TypeError if an
    argument has a wrong type. But if the argument should be an array, they raise Refused. `adjust` raises
    ConfigurationError if the keys are wrong.
    """

    def events(self) -> Events:
        """Returns a queue that gets the hand's events from now on. `for event in hand.events()` waits for each event,
        and `async for` does so in asyncio."""
        events = Events(self)
        events.clear()
        return events

    async def events_async(self) -> AsyncIterator[Event]:
        """Yields the hand's events in asyncio, from the first step of the generator until the hand is closed."""
        async for event in self.events():
            yield event

    def wait(
        self,
        fingers: Union[int, Iterable[int], None] = None,
        condition: str = "arrived",
        timeout: Optional[float] = None,
    ) -> None:
        """Waits until the condition holds for each of these fingers. The condition refers to the set point that was
        sent to the finger last.

        Args:
            fingers: a finger, or several. The default is all fingers of the hand.
            condition: "arrived": since the set point was sent, there was a cycle in which every joint was at the set
                point. "settled": since the set point was sent, the joints have come to rest. Both conditions still hold
                if the finger was pushed away afterwards.
            timeout: time limit, s. Without it, the wait has no limit.

        Raises:
            TimedOut: the time limit has expired.
            Fault: a finger is faulted.
        """
        if fingers is None:
            fingers = self.fingers
        # An integer of numpy is not an int, so anything that is not iterable counts as one finger.
        self._wait(list(fingers) if isinstance(fingers, Iterable) else [fingers], condition, timeout)

    def configuration(self, finger: int) -> Dict[str, Any]:
        """The finger's configuration in force, with calibrations and adjustments: the keys of `[finger]`."""
        return json.loads(self._configuration(finger))

    def black_box(self, finger: int) -> Recording:
        """The last two seconds of a finger; of a faulted finger, the last two seconds before the fault."""
        return black_box(self, finger)

    def zero(self, finger: int, progress: Optional[Progress] = None, *, store: bool = True) -> Zeros:
        """Zeros gauges and encoders of a finger. With the zeroing method "stops", its joints move between
        their stops.

        If `progress` or the handler of a signal raises an exception, as the handler of Ctrl-C does, the finger stops.
        It is then faulted, and `recover` makes it a spring with the previous calibration.

        Args:
            progress: called with the completed part, 0 to 1, and the current activity.
            store: whether to store the zeros in the configuration file with which the hand was opened.

        Raises:
            ConfigurationError: the zeros could not be stored. They are in force until the hand is closed, and
                `store_calibration` can store them later. This error is also raised if the configuration does not permit
                zeroing (nothing has changed), or cannot be used with the new zeros (the finger is limp and has its
                previous zeros).
            Error: the calibration failed, and the previous one is in force. If the finger faulted after its zeros had
                been found, the new zeros are in force.
        """
        return self._calibrated(finger, "zero", progress, store)

    def identify(self, finger: int, progress: Optional[Progress] = None, *, store: bool = True) -> Identified:
        """Measures gauge gains, friction, tendon stiffness and rotor inertia of a finger, which must have been zeroed.
        Its joints move between their stops, and the finger presses against its lower stops. Arguments and errors are
        those of `zero`."""
        return self._calibrated(finger, "identify", progress, store)

    def find_signs(self, finger: int, progress: Optional[Progress] = None, *, store: bool = True) -> Signs:
        """Finds the signs of motors, encoders and gauges of a finger. Afterwards the finger is limp: its motors are
        off. Arguments and errors are those of `zero`.

        The hand was opened under tension, for which the right signs must be known. So this method can only check known
        signs. The command `sun2xp calibrate` finds unknown signs.
        """
        return self._calibrated(finger, "signs", progress, store)

    def _calibrated(self, finger: int, task: str, progress: Optional[Progress], store: bool) -> Any:
        found = self._calibrate(finger, task, progress)
        if store:
            self.store_calibration(finger)
        return found


def open(path: Union[str, os.PathLike[str], None] = None, *, text: Optional[str] = None) -> Hand:
    """Opens a hand, and returns when every finger holds its pose at its initial stiffness.

    Args:
        path: the configuration file. Without path and text, the library takes the file that SUN2XP_CONFIG names, or
            sun2xp.toml in the working directory or in the configuration folders. If there is no file, the hand is
            simulated.
        text: the text of a configuration, instead of a file.

    Raises:
        ConfigurationError: the configuration cannot be read or used. The error names file, line and reason.
        Fault: a finger has faulted. Then every motor is in its end state.
        Error: a port or a board does not work.
    """
    if text is None:
        return _opened(_sun2xp.open_file, path)
    if path is not None:
        raise TypeError("open() takes a path or a text, not both")
    return _opened(_sun2xp.open_text, text)


def simulated(name: str = "nominal", *, rate: float = 1000.0, text: str = "") -> Hand:
    """Opens a simulated hand, which needs no hardware.

    Args:
        name: "nominal": the tendons, motors and gauges are as the controller assumes. "worn", "sheathed" or "cheap":
            they differ from what the controller assumes (docs/real-tendons.md).
        rate: rate of the servos, Hz, 500 to 5000.
        text: further keys of the configuration. The keys `simulation.hand`, `hand.rate`, `port` and `board` and the
            table `[remote]` are ignored.

    Raises:
        ConfigurationError: no hand has this name, the rate is out of range, or the text is wrong.
    """
    return _opened(_sun2xp.open_simulated, name, rate, text)


def _opened(function: Callable[..., _sun2xp.Opened], *arguments: Any) -> Hand:
    _log.start()
    try:
        hand = Hand(function(*arguments))
    except Error:
        # The messages of the failed opening are in the log before the error is raised. KeyboardInterrupt is no `Error`,
        # so Ctrl-C does not wait for the log.
        _log.flush()
        raise
    _log.flush()
    return hand
