"""Passes the messages of the library to the logger `sun2xp` of the module `logging`."""

from __future__ import annotations

import atexit
import logging
import sys
import threading
from typing import Optional

from . import _sun2xp

#: The logger of the library's refusals (level INFO) and warnings (level WARNING), such as missing permissions for real
#: time. Without a handler, `logging` writes the warnings to standard error.
logger = logging.getLogger("sun2xp")

_starting = threading.Lock()
_thread: Optional[threading.Thread] = None


def start() -> None:
    """Starts the thread that logs the messages, if it was not started before."""
    global _thread
    with _starting:
        if _thread is None:
            _thread = threading.Thread(target=_pass_on, name="sun2xp log", daemon=True)
            _sun2xp.take_messages()
            _thread.start()
            # `atexit` calls the newest function first, so `_end` runs before the function that closes the hands. The
            # messages of that function go to standard error.
            atexit.register(_end)


def flush() -> None:
    """Waits until all messages so far are logged, but at most for one second."""
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
