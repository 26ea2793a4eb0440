"""Hands at the port of a board that another process simulates."""

import math
import signal
import subprocess
import sys

import pytest

import sun2xp

#: Runs the tool `sun2xp` with the arguments that follow.
TOOL = "import sys; from sun2xp import _sun2xp; sys.exit(_sun2xp.run_tool(['sun2xp', *sys.argv[1:]]))"

#: Rate of the servo, Hz. A busy machine can keep it.
RATE = 500

#: Time after which the board stops the finger by itself, ms.
WATCHDOG = 1000


class Board:
    """A simulated board of finger 2."""

    def __init__(self, *orders):
        arguments = ["board", "--finger", "2", "--patient", str(RATE)]
        for order in orders:
            arguments += ["--order", order]
        self.process = subprocess.Popen(
            [sys.executable, "-c", TOOL, *arguments], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )
        self.port = self.process.stdout.readline().strip()
        #: The configuration of a hand at this board. When the hand is opened, it tests its wiring.
        self.configuration = (
            f"[hand]\nrate = {RATE}\nfingers = [2]\nself_test = true\nwatchdog_ms = {WATCHDOG}\n"
            f"[finger.2]\nport = '{self.port}'\n"
        )

    def order(self, text):
        """Gives an order, and returns the words of the answer."""
        self.process.stdin.write(text + "\n")
        self.process.stdin.flush()
        return self.process.stdout.readline().split()

    def state(self, name, count):
        """Returns the numbers that follow this name in the state of the finger."""
        words = self.order("state 2")
        place = words.index(name) + 1
        return [float(word) for word in words[place : place + count]]

    def close(self):
        self.process.kill()
        self.process.communicate()


@pytest.fixture
def board(request):
    one = Board(*getattr(request, "param", []))
    yield one
    one.close()


@pytest.mark.parametrize("board", [["reverse-encoder 2 4"]], indirect=True)
def test_wrong_wiring_is_a_fault_with_finger_and_number(board):
    with pytest.raises(sun2xp.Fault, match="encoder 4 counts backwards") as wrong:
        sun2xp.open(text=board.configuration)
    assert wrong.value.finger == 2 and f"finger 2 (fault {wrong.value.fault}): " in str(wrong.value)


def test_a_program_that_ends_while_a_hand_opens_stops_its_board(board):
    program = f"""
import signal, sun2xp
signal.signal(signal.SIGINT, signal.default_int_handler)
sun2xp.open(text={board.configuration!r})
"""
    opening = subprocess.Popen([sys.executable, "-c", program], stderr=subprocess.PIPE, text=True)
    while not any(board.state("torques", 4)):
        assert opening.poll() is None, opening.communicate()
    opening.send_signal(signal.SIGINT)
    _, said = opening.communicate(timeout=60)
    assert "KeyboardInterrupt" in said, said
    _, command, end = board.state("times", 3)
    # A board that its watchdog stops does not enter the end state so soon after the last Command.
    assert not math.isnan(end) and end - command < WATCHDOG / 2
