"""Computes the times of the firmware from the instructions that it executes, and prints them as a table.

    timing.py stm32f405.elf stm32f405.bin

Fails if the upper bound of the time from a Command to its Reply is longer than the protocol allows, if the computed
time on an otherwise idle line leaves less than the required margin, or if a pass of the main loop takes longer than
the protocol core (firmware/core) permits."""

import sys

from board import Board, command, configure
from registers import GPIOB, BSRR, MEGAHERTZ, TIM2, TIM3, TIM4, TIM5

# Longest permitted time from a Command to its Reply, us (docs/board-protocol.md).
ALLOWED = 100
# Least ratio of the allowed time to the computed time.
MARGIN = 3
# Longest pass of the main loop, us (firmware/README.md).
LOOP = 1000
BAUD = 2_000_000
BYTE = MEGAHERTZ * 10_000_000 // BAUD

# Torques and torque constants for which the divisions take different times.
VALUES = [
    ((1000, -1000, 500, 0), (23400,) * 4),
    ((23750, -23750, 23750, -23750), (1,) * 4),
    ((23750, -23750, 23750, -23750), (0xFFFFFFFF,) * 4),
    ((-32768, 32767, -32768, 32767), (65537, 3, 23400, 0)),
]


class Bench:
    """A running board. With `cached`, the flash has its cache. Without `cached`, the times are upper bounds (see
    Board)."""

    def __init__(self, cached, constants=(23400,) * 4):
        self.board = Board(sys.argv[1], open(sys.argv[2], "rb").read(), cached)
        self.registers = self.board.registers
        self.registers.byte_cycles = BYTE
        self.board.run_for(200)
        assert self.board.ask(configure(constants=constants, watchdog_ms=1000), BAUD)[0] == 0xA1

    def reply_time(self, torques, wait, followers=0):
        """Sends a Command after `wait` cycles. Returns the cycles from the arrival of its last byte to the first byte
        of its Reply, and the instructions between these two. `followers` more Commands follow without a gap."""
        board, wire = self.board, command(torques)
        arrived = board.send(wire * (1 + followers), BAUD, int(wait)) - followers * len(wire) * BYTE
        self.registers.sent.clear()
        board.run(lambda: self.registers.now >= arrived)
        before = board.instructions
        board.run(lambda: bool(self.registers.sent))
        taken, instructions = self.registers.sent[0][0] - arrived, board.instructions - before
        end = arrived + (300 + 150 * followers) * MEGAHERTZ
        board.run(lambda: self.registers.now >= end)
        answers = sum(byte == 0 for _, byte in self.registers.sent)
        assert answers == 1 + followers, (answers, followers)
        assert self.registers.overruns == 0
        return taken, instructions


def at_any_phase(cached, followers):
    """The longest time that is found over 24 phases of the main loop and all torques and constants of VALUES."""
    longest = (0, 0)
    for torques, constants in VALUES:
        bench = Bench(cached, constants)
        for phase in range(24):
            longest = max(longest, bench.reply_time(torques, phase * 37, followers))
    return longest


def during_a_sample(cached, followers):
    """The longest time if the Command arrives while the main loop takes a sample of its own."""
    longest = (0, 0)
    torques, constants = VALUES[2]
    for phase in range(0, 30, 2):
        bench = Bench(cached, constants)
        bench.reply_time(torques, 0)
        writes = bench.registers.writes
        conversions = lambda: [at for at, address, value in writes if address == GPIOB + BSRR and value == 2]
        last = conversions()[-1]
        bench.board.run(lambda: bench.registers.now >= last + 9800 * MEGAHERTZ)
        # The sample of the main loop is due 10 ms after the last one. A Command of 17 bytes takes 85 us.
        due = last + 10000 * MEGAHERTZ
        wait = due + (phase - 4) * MEGAHERTZ - 17 * BYTE - bench.registers.now
        longest = max(longest, bench.reply_time(torques, wait, followers))
    return longest


def one_handler(cached):
    """The interrupt of one byte, at its longest."""
    bench = Bench(cached)
    bench.board.longest_handler = 0
    bench.reply_time(*[VALUES[0][0], 0], followers=3)
    return bench.board.longest_handler, 0


def sampling_skew(cached):
    """The time from the edge that samples the gauges to the read of the last encoder."""
    bench = Bench(cached)
    reads, read = [], bench.registers.read

    def noted(address):
        if address in (TIM2 + 0x24, TIM3 + 0x24, TIM4 + 0x24, TIM5 + 0x24):
            reads.append(bench.registers.now)
        return read(address)

    bench.registers.read = noted
    bench.registers.writes.clear()
    bench.reply_time(VALUES[0][0], 0)
    edge = next(at for at, address, value in bench.registers.writes if address == GPIOB + BSRR and value == 2)
    return reads[3] - edge, 0


def longest_loop(cached):
    """The longest time between two feeds of the watchdog, during a burst of 15 Commands at the full rate."""
    bench = Bench(cached)
    bench.registers.longest_unfed = 0
    bench.reply_time(VALUES[1][0], 0, followers=14)
    return bench.registers.longest_unfed, 0


# Each pair contains the longest permitted computed time and the largest permitted upper bound, us.
QUICK, IN_TIME, NO_LIMIT = (ALLOWED / MARGIN, ALLOWED), (ALLOWED, ALLOWED), (float("inf"), float("inf"))

ROWS = [
    ("Command to Reply, typical", lambda cached: Bench(cached).reply_time(VALUES[0][0], 100), QUICK),
    (
        "Command to Reply, the longest time found for different torques, torque constants and phases of the main loop",
        lambda cached: at_any_phase(cached, 0),
        QUICK,
    ),
    ("the same while more Commands arrive at 2 Mbaud", lambda cached: at_any_phase(cached, 2), IN_TIME),
    (
        "the same for one set of torques, while the main loop takes a sample and one more Command arrives",
        lambda cached: during_a_sample(cached, 1),
        IN_TIME,
    ),
    ("interrupt of one byte at 2 Mbaud (a byte takes 5 us)", one_handler, NO_LIMIT),
    ("from the sample of the gauges to the last encoder", sampling_skew, NO_LIMIT),
    (
        "between two feeds of the watchdog, in a burst of 15 Commands at 2 Mbaud",
        longest_loop,
        (LOOP, float("inf")),
    ),
]


def main():
    print("| what | instructions | cycles | us | cycles, upper bound | us |")
    print("|---|---|---|---|---|---|")
    late = []
    for what, measure, limits in ROWS:
        (cached, count), (bound, _) = measure(True), measure(False)
        times = (cached / MEGAHERTZ, bound / MEGAHERTZ)
        row = f"| {what} | {count or ''} | {cached} | {times[0]:.1f} | {bound} | {times[1]:.1f} |"
        print(row, flush=True)
        if any(time > limit for time, limit in zip(times, limits)):
            late.append(f"{what} (permitted: {limits[0]:.1f} us, for the upper bound {limits[1]:.1f} us)")
    if late:
        sys.exit(f"too long: {', '.join(late)}")


if __name__ == "__main__":
    main()
