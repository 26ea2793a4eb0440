"""Hands on other machines, which `sun2xp serve` offers (docs/remote.md).

This module needs the package eclipse-zenoh: pip install 'sun2xp[remote]'. Units, shapes and the names of calls are
those of `sun2xp`.

    import sun2xp.remote

    with sun2xp.remote.open("hand", "tcp/127.0.0.1:7447") as hand:
        hand.send_position(1, [0.1, 0.5, 0.9])
        hand.wait(1)
        print(hand.position(1))
"""

from __future__ import annotations

from typing import Dict, Optional, Sequence

from .._types import SetPoint
from ._errors import NoAnswer, NotOwner, Stale
from ._events import RemoteEvents
from ._hand import RemoteHand
from ._network import LOOPBACK, Network
from ._types import Counts, FingerState, FingerStatus, Status, Tip, Tls

__all__ = [
    "Counts",
    "FingerState",
    "FingerStatus",
    "Network",
    "NoAnswer",
    "NotOwner",
    "RemoteEvents",
    "RemoteHand",
    "Stale",
    "Status",
    "Tip",
    "Tls",
    "connect",
    "discover",
    "open",
    "send_together",
]


def open(
    hand: str = "hand",
    endpoint: str = LOOPBACK,
    *,
    client: Optional[str] = None,
    tls: Optional[Tls] = None,
    read_only: bool = False,
    take_over: bool = False,
    recover: bool = True,
    stale: float = 0.1,
) -> RemoteHand:
    """Opens a hand on another machine, over a connection of its own.

    Args:
        hand: name of the hand.
        endpoint: where its server or a router listens, such as "tls/cell:7447".
        client: name of this client; "planner" if not given. With TLS it is the common name of the certificate.
        tls: the files of mutual TLS. A server that listens on more than loopback needs them.
        read_only: do not acquire the hand. Then its state can be read, and it can be stopped.
        take_over: acquire the hand even if another client commands it.
        recover: recover fingers that have stopped. Fingers stop when their hand is released.
        stale: largest age of the state that `position`, `tip` and `state` return, s.

    Raises:
        ConfigurationError: `hand` or `client` is not a permitted name, or a certificate cannot be read.
        NoAnswer: there is no connection or no such hand, or, with TLS, this client may not use the hand.
        NotOwner: another client commands the hand, or, without TLS, this client may not command it ([serve.clients] of
            the server).
        Fault: a finger has a fault whose cause is still there.
    """
    network = Network(endpoint, client=client, tls=tls)
    try:
        opened = network.open(hand, read_only=read_only, take_over=take_over, recover=recover, stale=stale)
    except BaseException:
        network.close()
        raise
    opened._owns_network = True
    return opened


def connect(endpoint: str = LOOPBACK, *, client: Optional[str] = None, tls: Optional[Tls] = None) -> Network:
    """Connects to a server or to a router, for several hands. Arguments and errors are those of `open`."""
    return Network(endpoint, client=client, tls=tls)


def discover(
    endpoint: str = LOOPBACK, *, client: Optional[str] = None, tls: Optional[Tls] = None, timeout: float = 2.0
) -> Dict[str, Status]:
    """Returns the status of every hand that can be reached over this endpoint, by the name of the hand. Arguments and
    errors are those of `open`; `timeout` is the time for the answers, s."""
    with Network(endpoint, client=client, tls=tls) as network:
        return network.hands(timeout)


def send_together(set_points: Dict[RemoteHand, Sequence[SetPoint]]) -> None:
    """Sends set points to several hands of one connection, with one time stamp. Nothing is sent if the set points of
    one hand are invalid, if the server has refused an earlier set point of one of the fingers and no call has raised
    this refusal yet, or if this client does not own one of the hands.

    Raises:
        ValueError: there is no hand, or the hands do not have the same connection (`connect`).
        NotOwner, Refused: for the same reasons as in `RemoteHand.send_group`.
    """
    networks = {id(hand._network): hand._network for hand in set_points}
    if not networks:
        raise ValueError("the call has no hand: give at least one hand with its set points")
    if len(networks) > 1:
        raise ValueError("the hands need one connection: open them with the same sun2xp.remote.connect()")
    commands = [(hand.owner, hand.parts(points)) for hand, points in set_points.items()]
    next(iter(networks.values())).sender.send(commands)
