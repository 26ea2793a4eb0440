"""Opening, closing, threads, processes and errors."""

import errno
import gc
import os
import pickle
import signal
import subprocess
import sys
import threading
import time

import pytest

import sun2xp
from sun2xp import _sun2xp


def run(program, *arguments):
    """Runs a program with the interpreter of the test, and returns its result."""
    return subprocess.run([sys.executable, "-c", program, *arguments], capture_output=True, text=True, timeout=120)


def test_several_hands_are_independent():
    with sun2xp.simulated() as one, sun2xp.open(text="[hand]\nrate = 500\n[finger]\nport = 'simulated'") as other:
        one.send_position(1, [0.2, 0.6, 0.9])
        one.wait(1, timeout=30)
        assert abs(other.position(1) - one.position(1)).max() > 0.05
        assert (one.status(1).rate, other.status(1).rate) == (1000, 500)
        other.close()
        assert other.closed and not one.closed and repr(other) == "<sun2xp.Hand: closed>"
        assert repr(one) == "<sun2xp.Hand: running, running, running>"
        one.position(1)


def test_a_configuration_is_refused_with_its_line(tmp_path):
    file = tmp_path / "hand.toml"
    file.write_text("[hand]\nrate = 1\n")
    with pytest.raises(sun2xp.ConfigurationError, match=r"hand.toml:2: hand.rate"):
        sun2xp.open(file)
    with pytest.raises(sun2xp.ConfigurationError, match="configuration text:1: "):
        sun2xp.open(text="hands = 3")
    with pytest.raises(sun2xp.ConfigurationError, match="hand.rate"):
        sun2xp.simulated(rate=7)
    with pytest.raises(sun2xp.ConfigurationError, match="broken"):
        sun2xp.simulated("broken")
    with pytest.raises(sun2xp.Error):
        sun2xp.open(tmp_path / "missing.toml")
    with pytest.raises(TypeError):
        sun2xp.open(file, text="")
    file.write_text("[finger]\nport = 'simulated'\n")
    sun2xp.open(str(file)).close()


def test_a_hand_on_another_machine_is_not_replaced_by_a_simulated_one(tmp_path):
    text = "[remote]\nendpoint = 'tcp/cell:7447'\nhand = 'left'\nclient = 'planner'\n"
    (tmp_path / "hand.toml").write_text(text)
    for opening in (lambda: sun2xp.open(tmp_path / "hand.toml"), lambda: sun2xp.open(text=text)):
        with pytest.raises(sun2xp.ConfigurationError, match=r"table \[remote\].*sun2xp.remote.open"):
            opening()


def test_a_simulated_hand_ignores_rate_boards_and_names_of_its_text():
    board = "thread = 1\nbaud = 2000000\nboard = '00 01 02 03 04 05 06 07 08 09 0a 0b'"
    text = f"[hand]\nrate = 7\n[finger]\n{board}\n[finger.simulation]\nhand = 'worn'\nstart_degrees = [2, 30, 40]\n"
    with sun2xp.simulated("cheap", text=text) as hand:
        simulation = hand.configuration(1)["simulation"]
        assert (simulation["hand"], simulation["start_degrees"]) == ("cheap", [2, 30, 40])
        assert hand.status(1).rate == 1000
        # Only a simulated finger can be pushed.
        hand.push(1, [0, 0, 0])


def test_a_faulted_finger_recovers(hand):
    hand.stop(2)
    with pytest.raises(sun2xp.Fault) as fault:
        while True:
            hand.position(2)
    assert fault.value.finger == 2 and fault.value.fault == hand.fault(2).stopped.number
    assert fault.value.remedy and fault.value.remedy in str(fault.value)
    assert fault.value.number == sun2xp.ErrorNumber.FAULTED and fault.value.errno == errno.EIO
    assert hand.status(2).stage == "faulted" and hand.status(1).stage == "running"
    hand.recover(2)
    assert hand.status(2).stage == "running"
    hand.recover(1)
    sun2xp.stop_all()
    while hand.status(3).stage != "faulted":
        pass


def test_waiting_leaves_the_interpreter_to_others(hand):
    """A thread counts while another one waits: a wait with the interpreter lock would stop the count."""
    counts, done = [], threading.Event()

    def count():
        while not done.is_set():
            counts.append(time.monotonic())

    hand.send_position(1, [0.2, 0.6, 0.9])
    counter = threading.Thread(target=count)
    counter.start()
    waits = [
        lambda: hand.wait(1, timeout=30),
        lambda: hand.events().wait(0.3),
        lambda: sun2xp.simulated().close(),
    ]
    for wait in waits:
        before = len(counts)
        wait()
        assert len(counts) - before > 10
    done.set()
    counter.join()


def test_a_hand_that_got_no_object_is_closed_without_the_interpreter_lock():
    opened = _sun2xp.open_simulated("nominal", 1000.0, "")
    counts, done = [], threading.Event()

    def count():
        while not done.is_set():
            counts.append(time.monotonic())

    counter = threading.Thread(target=count)
    counter.start()
    begin = time.monotonic()
    del opened
    quarter = (time.monotonic() - begin) / 4
    done.set()
    counter.join()
    # The fingers need 0.2 s for their end states. After that, this thread may wait for the lock before it goes on.
    assert quarter > 0.02 and any(quarter < at - begin < 3 * quarter for at in counts)


def test_a_hand_is_closed_while_another_thread_waits(hand):
    # A finger that is pushed away does not arrive.
    hand.push(1, [0, 0, -5])
    hand.send_position(1, [0.2, 0.6, 0.9])
    refused = []

    def wait():
        try:
            hand.wait(1)
        except sun2xp.Error as error:
            refused.append(error)

    waiter = threading.Thread(target=wait)
    waiter.start()
    time.sleep(0.5)
    hand.close()
    waiter.join(timeout=30)
    assert not waiter.is_alive() and [type(error) for error in refused] == [sun2xp.Closed]


@pytest.mark.parametrize("wait", ["hand.wait(1)", "list(hand.events())", "sun2xp.open(text=slow)"])
def test_control_c_ends_a_wait(wait):
    program = f"""
import os, signal, sun2xp, threading, time
# A program that a shell starts in the background ignores the signal.
signal.signal(signal.SIGINT, signal.default_int_handler)
silent = os.ttyname(os.openpty()[1])
slow = "[hand]\\nopen_timeout_ms = 60000\\n[finger]\\nport = 'simulated'\\n[finger.1]\\nport = '" + silent + "'"
hand = sun2xp.simulated()
hand.push(1, [0, 0, -5])
hand.send_position(1, [0, 0.6, 0.9])
threading.Timer(0.2, os.kill, (os.getpid(), signal.SIGINT)).start()
began = time.monotonic()
try:
    {wait}
except KeyboardInterrupt:
    print("interrupted", time.monotonic() - began < 5)
"""
    result = run(program)
    assert result.stdout == "interrupted True\n" and result.returncode == 0, result


def test_a_forked_child_is_refused_and_leaves_the_hand_alone(hand):
    child = os.fork()
    if child == 0:
        try:
            hand.position(1)
            os._exit(1)
        except sun2xp.Error as error:
            hand.close()
            del hand
            gc.collect()
            os._exit(0 if "forked" in error.text else 2)
    assert os.waitpid(child, 0)[1] == 0
    assert hand.status(1).stage == "running"
    hand.position(1)


def test_an_exception_keeps_its_attributes_on_the_way_from_another_process(hand):
    hand.push(1, [0, 0, -5])
    hand.send_position(1, [0.2, 0.6, 0.9])
    with pytest.raises(sun2xp.TimedOut) as late:
        hand.wait(1, timeout=0)
    fault = sun2xp.Fault("stopped: recover it", number=9, errno=errno.ENODEV, finger=2, fault=50)
    for error in (late.value, fault):
        copy = pickle.loads(pickle.dumps(error))
        assert type(copy) is type(error) and str(copy) == str(error) and copy.errno == error.errno
        assert vars(copy) == vars(error)
    assert late.value.errno == errno.ETIMEDOUT


def test_an_open_hand_is_closed_at_the_end_of_the_program():
    program = """
import sun2xp, atexit
atexit.register(lambda: print(hand.status(1).stage))
hand = sun2xp.simulated()
"""
    result = run(program)
    assert (result.stdout, result.returncode) == ("running\n", 0), result


def test_a_hand_that_nobody_holds_is_closed():
    hand = sun2xp.simulated()
    events = hand.events()
    del hand
    gc.collect()
    assert events.closed
    assert list(events) is not None and events.wait() is None


def test_signals_stay_with_python(hand):
    received = []
    before = signal.signal(signal.SIGUSR1, lambda *_: received.append(1))
    signal.raise_signal(signal.SIGUSR1)
    signal.signal(signal.SIGUSR1, before)
    assert received == [1]
