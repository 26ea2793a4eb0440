"""`python3 -m sun2xp.remote [ENDPOINT]` prints the hands that can be reached without TLS."""

from __future__ import annotations

import sys

from .._errors import Error
from . import discover
from ._network import LOOPBACK


def main() -> int:
    """Prints one line for each hand. Returns the exit status."""
    endpoint = sys.argv[1] if len(sys.argv) > 1 else LOOPBACK
    try:
        hands = discover(endpoint)
    except Error as error:
        print(error, file=sys.stderr)
        return 1
    if not hands:
        remedy = f"start `sun2xp serve` on the machine of the hand (with serve.connect if {endpoint} is a router)"
        print(f"no hand answers at {endpoint}: {remedy}", file=sys.stderr)
        return 1
    for name, status in sorted(hands.items()):
        stages = ", ".join(f"finger {finger} {one.stage}" for finger, one in status.fingers.items())
        print(f"{name}: {stages}; owner: {status.owner or 'none'}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
