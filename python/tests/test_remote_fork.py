"""A child of `os.fork` leaves the remote hands of its parent alone."""

import socket
import subprocess
import sys

from remote_double import Double

#: A program that forks while one of its threads holds the lock of the Sender. In any program, the thread that sends the
#: Targets may hold this lock during a fork.
PROGRAM = """
import os, signal, sys, threading, time
import sun2xp, sun2xp.remote

hand = sun2xp.remote.open("hand", sys.argv[1])
held, ends = threading.Event(), threading.Event()

def hold():
    with hand._network.sender.lock:
        held.set()
        ends.wait()

threading.Thread(target=hold).start()
held.wait()
events = hand.events()
child = os.fork()
if child == 0:
    calls = [hand.status, hand.wait, hand.acquire, hand.release, hand._network.hands]
    calls += [hand.cycles, events.take, events.wait, lambda: next(iter(events))]
    for call in [*calls, lambda: hand.position(1), lambda: hand.send_position(1, [0.0, 0.6, 0.9])]:
        try:
            call()
        except sun2xp.Error as error:
            assert error.number == sun2xp.ErrorNumber.FORKED, error
        else:
            sys.exit(3)
    assert hand.closed and not hand.owned
    hand.close()
    sys.exit(0)
ends.set()
ended, status, limit = 0, None, time.monotonic() + 20
while not ended and time.monotonic() < limit:
    ended, status = os.waitpid(child, os.WNOHANG)
    time.sleep(0.01)
if not ended:
    os.kill(child, signal.SIGKILL)
hand.wait(1, "applied", timeout=20)
print("the child has ended with", status if ended else "a kill")
hand.close()
"""


def test_a_forked_child_is_refused_and_ends():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        endpoint = f"tcp/127.0.0.1:{probe.getsockname()[1]}"
    with Double(endpoint):
        run = subprocess.run([sys.executable, "-c", PROGRAM, endpoint], capture_output=True, text=True, timeout=100)
    assert run.stdout == "the child has ended with 0\n" and run.returncode == 0, run
