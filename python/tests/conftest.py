"""Fixtures that several tests use, and the longest time of a test."""

import signal

import pytest
from remote_scripted import Scripted

import sun2xp

#: Longest time of a test, s.
LONGEST = 120


@pytest.fixture(autouse=True)
def limit():
    """Ends a test that hangs."""

    def end(*_):
        raise TimeoutError(f"the test takes more than {LONGEST} s")

    signal.signal(signal.SIGALRM, end)
    signal.alarm(LONGEST)
    yield
    signal.alarm(0)


@pytest.fixture
def hand():
    """A simulated hand, which is closed after the test."""
    with sun2xp.simulated() as opened:
        yield opened


@pytest.fixture(scope="module")
def shared():
    """A simulated hand for tests that only read, or that leave the fingers as they find them."""
    with sun2xp.simulated() as opened:
        yield opened


@pytest.fixture
def server():
    """A scripted server of a remote hand. The server does what the test says, without a network."""
    return Scripted()


@pytest.fixture
def remote(server):
    """The remote hand of the fixture `server`."""
    return server.hand
