"""Messages of the library in the log `sun2xp` of the module logging."""

from __future__ import annotations

import atexit
import logging
import sys
import threading
from typing import Optional

from . import _sun2xp

#: Receives the messages of the library, such as warnings about missing permissions for real time. Without a handler,
#: `logging` prints warnings on standard error.
logger = logging.getLogger("sun2xp")

_starting = threading.Lock()
_thread: Optional[threading.Thread] = None


def start() -> None:
    """Begins to log, if this process does not do so yet."""
    global _thread
    with _starting:
        if _thread is None:
            _thread = threading.Thread(target=_pass_on, name="sun2xp log", daemon=True)
            _sun2xp.take_messages()
            _thread.start()
            # atexit calls the newest function first, so the hands are closed after `_end`. Messages then go to standard
            # error again.
            atexit.register(_end)


def flush() -> None:
    """Waits until the messages of the calls so far are in the log."""
    if threading.current_thread() is not _thread:
        _sun2xp.flush_messages()


def _pass_on() -> None:
    while (message := _sun2xp.next_message()) is not None:
        level, text = message
        try:
            logger.log(level, "%s", text)
        except Exception as error:
            # `logging` reports the errors of handlers itself, but not those of filters.
            sys.stderr.write(f"sun2xp: {text} (not logged: {error})\n")


def _end() -> None:
    _sun2xp.end_messages()
    if _thread is not None:
        _thread.join(1.0)
