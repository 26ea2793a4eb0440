"""The command `sun2xp`."""

from __future__ import annotations

import os
import signal
import sys

from . import _sun2xp


def main() -> int:
    """Runs the tool with the arguments of the process."""
    # Python's own handler would only note SIGINT, and raise KeyboardInterrupt after the tool has ended.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    # `sun2xp serve` searches for the program sun2xp-serve in the folder of the installed script `sun2xp`, which is
    # argv[0], and not in the folder of the interpreter.
    return _sun2xp.run_tool(["sun2xp", *sys.argv[1:]], os.path.abspath(sys.argv[0]))


if __name__ == "__main__":
    sys.exit(main())
