"""The connection to a server or to a router, over which several hands can be used."""

from __future__ import annotations

import atexit
import ctypes
import json
import os
import re
import threading
import weakref
from typing import TYPE_CHECKING, Any, Callable, Dict, List, Optional

from .._errors import Closed, ConfigurationError, ErrorNumber
from . import _messages
from ._certificate import common_name
from ._errors import NoAnswer, forked
from ._owner import Sender
from ._types import Status, Tls, status

if TYPE_CHECKING:
    from ._hand import RemoteHand

#: Where `sun2xp serve` listens by default.
LOOPBACK = "tcp/127.0.0.1:7447"

#: Longest time in which a server answers, s.
ANSWER_TIME = 2.0

#: Number of attempts if a get (a query of Zenoh) reaches nobody, and the pause between two attempts, s.
ATTEMPTS = 3
PAUSE = 0.2

#: A get that reaches nobody ends within this time, s. If a get ends later without a reply, the connection was lost, and
#: the server may have carried out the request.
NOBODY = 0.5

#: Pauses between the attempts to connect, ms: the first pause, the longest, and the factor by which they grow. They
#: are the same for the first connection and after a loss of the connection.
_RETRY = {"period_init_ms": 100, "period_max_ms": 500, "period_increase_factor": 2}

_HAND = re.compile(r"[a-z0-9-]{1,32}\Z")

_open_networks: "weakref.WeakSet[Network]" = weakref.WeakSet()


def _zenoh() -> Any:
    try:
        import zenoh
    except ImportError as error:
        raise ImportError("sun2xp.remote needs the package eclipse-zenoh: pip install 'sun2xp[remote]'") from error
    return zenoh


def checked_hand(name: str) -> str:
    """Returns the name of a hand.

    Raises:
        ConfigurationError: no hand can have this name.
    """
    if not _HAND.match(name):
        text = f"no hand can have the name {name!r}: use 1 to 32 characters a to z, 0 to 9 and -"
        raise ConfigurationError(text, number=ErrorNumber.CONFIGURATION)
    return name


def checked_client(name: Optional[str], tls: Optional[Tls]) -> str:
    """Returns the name of this client. With TLS, its default is the common name of the certificate.

    Raises:
        ConfigurationError: no client can have this name.
    """
    if name is None:
        name = "planner" if tls is None else common_name(tls.certificate)
    if not _messages.CLIENT.match(name):
        text = f"no client can have the name {name!r}: use 1 to 64 characters A to Z, a to z, 0 to 9, ., _ and -"
        raise ConfigurationError(text, number=ErrorNumber.CONFIGURATION)
    return name


def check_files(tls: Tls) -> None:
    """Checks that the files of TLS can be read, because Zenoh reports only that a connection was refused.

    Raises:
        ConfigurationError: a file cannot be read.
    """
    for path in (tls.authority, tls.certificate, tls.key):
        try:
            with open(path, "rb"):
                pass
        except OSError as error:
            remedy = "name the files of this client in the argument `tls`"
            if isinstance(error, PermissionError):
                remedy = "this user needs permission to read the file and to enter its folder"
            text = f"{os.fspath(path)} cannot be read ({error.strerror}): {remedy}"
            raise ConfigurationError(text, number=ErrorNumber.CONFIGURATION) from error


def configuration(endpoint: str, tls: Optional[Tls]) -> Dict[str, Any]:
    """Returns the configuration of Zenoh for a client that knows one endpoint, and searches for no other."""
    settings: Dict[str, Any] = {
        "mode": "client",
        "connect": {"endpoints": [endpoint], "timeout_ms": 3000, "retry": _RETRY},
        "scouting": {"multicast": {"enabled": False}, "gossip": {"enabled": False}},
        "transport": {"unicast": {"open_timeout": 2000}},
    }
    if tls is not None:
        files = {
            "root_ca_certificate": str(tls.authority),
            "connect_certificate": str(tls.certificate),
            "connect_private_key": str(tls.key),
            "enable_mtls": True,
            "verify_name_on_connect": True,
        }
        settings["transport"]["link"] = {"protocols": ["tls"], "tls": files}
    return settings


class Network:
    """A connection to a server or to a router, from `sun2xp.remote.connect`.

    Several hands can be used over one connection. One thread repeats the targets of all these hands. The targets
    that it sends at the same time have the same time stamp. Leaving a `with` block closes the hands and the connection.

    Args:
        endpoint: where the server or the router listens, such as "tls/cell:7447".
        client: name of this client. With TLS it is the common name of the certificate, and need not be given.
        tls: the files of mutual TLS. A server that listens on more than loopback needs them.

    Raises:
        ConfigurationError: no client can have this name, or a certificate cannot be read.
        NoAnswer: nobody listens at the endpoint, or the certificates do not fit.
    """

    def __init__(self, endpoint: str = LOOPBACK, *, client: Optional[str] = None, tls: Optional[Tls] = None) -> None:
        self.endpoint = endpoint
        if tls is not None:
            check_files(tls)
        self.client = checked_client(client, tls)
        #: Whether this process is a child of the one that has connected.
        self.forked = False
        self._zenoh = _zenoh()
        try:
            text = json.dumps(configuration(endpoint, tls))
            self.session = self._zenoh.open(self._zenoh.Config.from_json5(text))
        except self._zenoh.ZError as error:
            # The text ends with a place in the source of Zenoh, which does not help the user.
            reason = str(error).split(" at /")[0].rstrip("!. ")
            remedy = "check the endpoint and the certificates, and whether sun2xp serve runs"
            raise NoAnswer(f"no connection to {endpoint} ({reason}): {remedy}", number=ErrorNumber.TIMED_OUT) from error
        self.sender = Sender()
        self._hands: List[Any] = []
        self._lock = threading.Lock()
        _open_networks.add(self)

    def __enter__(self) -> "Network":
        return self

    def __exit__(self, *exception: object) -> None:
        self.close()

    def hands(self, timeout: float = ANSWER_TIME) -> Dict[str, Status]:
        """Returns the status of every hand that can be reached, by the name of the hand.

        Args:
            timeout: time for the answers, s.
        """
        found = {}
        for key, payload in self.get("sun2xp/*/status", None, timeout):
            message = _messages.read_status(payload)
            if message is not None:
                found[key.split("/")[1]] = status(message)
        return found

    def get(self, key: str, payload: Optional[bytes], timeout: float) -> List[tuple]:
        """Returns the keys and payloads of all answers to a get. The get ends when all servers that it has reached have
        answered, or after `timeout` s. Ctrl-C ends it."""
        if self.forked:
            raise forked()
        if self.session.is_closed():
            raise Closed("the connection is closed: connect again", number=ErrorNumber.NO_HAND)
        answers: List[tuple] = []
        ended = threading.Event()

        def take(reply: Any) -> None:
            if reply.ok is not None:
                answers.append((str(reply.ok.key_expr), bytes(reply.ok.payload)))

        handler = self._zenoh.handlers.Callback(take, drop=ended.set)
        self.session.get(key, handler, payload=payload, timeout=timeout)
        # The time limit of Zenoh ends the get. This wait has a limit too, in case the session is closed meanwhile.
        ended.wait(timeout + 1)
        return list(answers)

    def subscriber(self, key: str, take: Callable[[bytes], None]) -> Any:
        """Calls a function with every payload under a key, in a thread of Zenoh."""
        return self.session.declare_subscriber(key, lambda sample: take(bytes(sample.payload)))

    def put(self, key: str, payload: bytes) -> None:
        """Sends a Target. If the line is full, the Target is dropped: the next Target repeats it.

        The Target is not sent by a declared publisher, which would send nothing before Zenoh knows of a subscriber.
        """
        self.session.put(
            key,
            payload,
            congestion_control=self._zenoh.CongestionControl.DROP,
            priority=self._zenoh.Priority.REAL_TIME,
            express=True,
        )

    def open(
        self,
        hand: str = "hand",
        *,
        read_only: bool = False,
        take_over: bool = False,
        recover: bool = True,
        stale: float = 0.1,
    ) -> "RemoteHand":
        """Opens a hand over this connection. Arguments and errors are those of `sun2xp.remote.open`."""
        from ._hand import RemoteHand

        opened = RemoteHand(self, checked_hand(hand), stale=stale)
        with self._lock:
            self._hands.append(opened)
        try:
            if not read_only:
                opened.acquire(take_over=take_over, recover=recover)
        except BaseException:
            # Not only an Error but also Ctrl-C can end the acquire.
            opened.close()
            raise
        return opened

    def forget(self, hand: Any) -> None:
        """Removes a hand from the list of the hands that `close` closes."""
        with self._lock:
            self._hands = [other for other in self._hands if other is not hand]

    def close(self) -> None:
        """Closes the hands, and then the connection. The fingers of the hands that this client owns go to their end
        states. A child of `os.fork` leaves the connection of its parent alone."""
        if self.forked:
            return
        for hand in list(self._hands):
            hand.close()
        self.sender.close()
        if not self.session.is_closed():
            self.session.close()
        _open_networks.discard(self)

    def _leave(self) -> None:
        """Gives the connection up in a child of `os.fork`. The child has no thread of Zenoh, and a lock that another
        thread had at the fork stays locked."""
        self.forked = True
        # The destructors of Zenoh would wait for its threads, so nothing of this connection is ever freed.
        ctypes.pythonapi.Py_IncRef(ctypes.py_object(self))
        self.sender.leave()
        for hand in self._hands:
            hand._receiver.leave()


def _leave_all() -> None:
    for network in list(_open_networks):
        network._leave()
    _open_networks.clear()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_leave_all)


@atexit.register
def _close_all() -> None:
    for network in list(_open_networks):
        network.close()
