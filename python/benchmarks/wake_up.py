"""Measures the wake-up of the servos with three planners: one burns Python (computes without a pause), one sleeps, and
one sleeps while another process burns Python. One run measures the three in turns. Prints the table of docs/python.md.

    python wake_up.py [--rounds 10] [--seconds 10]
    taskset --cpu-list 0 python wake_up.py --servo-core 1

With the second command the servos run on core 1 and everything else on core 0. The planner that burns Python does so in
as many threads as it has cores, and another of its threads reads and sends poses 1000 times a second. The other process
burns Python in as many threads. It has no hand, so its interpreter lock cannot affect the servos: only its use of the
cores can. Each percentile is the median over all fingers and rounds, and the longest time is the maximum. Run the
benchmark on a quiet machine with real-time scheduling.
"""

import argparse
import os
import statistics
import subprocess
import sys
import threading
import time
from typing import Optional

import sun2xp

# The names of the planners in the table.
SLEEPS, OTHER, PLANNER = "sleeps", "sleeps, and another process burns Python", "burns Python"


def burn(stop: threading.Event) -> None:
    """Computes without a pause."""
    number = 1
    while not stop.is_set():
        for _ in range(1000):
            number = number * 48271 % 2147483647


def burners(stop: threading.Event) -> list:
    """Returns as many burning threads as this process has cores."""
    return [threading.Thread(target=burn, args=(stop,)) for _ in os.sched_getaffinity(0)]


def configuration(servo_core: Optional[int]) -> str:
    """Returns the text of the configuration that binds the servos to a core, or an empty text for None."""
    return "" if servo_core is None else "".join(f"[finger.{finger}]\ncore = {servo_core}\n" for finger in (1, 2, 3))


def plan(hand: sun2xp.Hand, stop: threading.Event, counts: list) -> None:
    """Reads and sends the pose of every finger 1000 times a second."""
    due = time.monotonic()
    while not stop.is_set():
        for finger in (1, 2, 3):
            hand.send_position(finger, hand.position(finger))
        counts.append(1)
        due += 0.001
        time.sleep(max(0.0, due - time.monotonic()))


def measure(hand: sun2xp.Hand, seconds: float, load: str) -> tuple:
    """Returns the distributions of the wake-ups of all fingers, and how often the planner read and sent the poses."""
    stop, counts = threading.Event(), []
    threads = []
    if load == PLANNER:
        threads = burners(stop) + [threading.Thread(target=plan, args=(hand, stop, counts))]
    for thread in threads:
        thread.start()
    other = subprocess.Popen([sys.executable, __file__, "--burn"]) if load == OTHER else None
    time.sleep(0.5)
    for finger in (1, 2, 3):
        hand.reset_timing(finger)
    time.sleep(seconds)
    found = [hand.timing(finger) for finger in (1, 2, 3)]
    stop.set()
    for thread in threads:
        thread.join()
    if other is not None:
        other.kill()
        other.wait()
    return found, len(counts)


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--rounds", type=int, default=10)
    arguments.add_argument("--seconds", type=float, default=10.0)
    arguments.add_argument("--servo-core", type=int, help="core of the servos; by default the kernel chooses")
    arguments.add_argument("--burn", action="store_true", help=argparse.SUPPRESS)
    arguments = arguments.parse_args()
    # With the default of 5 ms, each burning thread keeps the interpreter lock for 5 ms, and the planning thread cannot
    # run 1000 times a second.
    sys.setswitchinterval(0.0001)
    if arguments.burn:
        for thread in burners(threading.Event()):
            thread.start()
        return
    loads = [SLEEPS, OTHER, PLANNER]
    found = {load: [] for load in loads}
    planned = 0
    with sun2xp.simulated(text=configuration(arguments.servo_core)) as hand:
        status = hand.status(1)
        for round in range(arguments.rounds):
            # The order changes, so that a slow change of the machine does not look like a difference of the planners.
            for load in loads[round % 3 :] + loads[: round % 3]:
                distributions, count = measure(hand, arguments.seconds, load)
                found[load].extend(distributions)
                planned += count
    print(f"Real-time scheduling: {status.realtime}. {arguments.rounds} rounds of {arguments.seconds:g} s.\n")
    print("| planner | cycles | median, us | 99 %, us | 99.9 %, us | longest, us |\n|---|---|---|---|---|---|")
    for load in loads:
        rounds = found[load]
        median = [statistics.median(getattr(one, part) for one in rounds) for part in ("median", "p99", "p999")]
        cycles, longest = sum(one.count for one in rounds), max(one.maximum for one in rounds)
        print(f"| {load} | {cycles} | {median[0]:.1f} | {median[1]:.1f} | {median[2]:.1f} | {longest:.1f} |")
    late = {load: statistics.median(one.p999 for one in found[load]) for load in loads}
    rate = planned / arguments.rounds / (arguments.seconds + 0.5)
    print(
        f"\nThe 99.9 % value with the planner that burns Python is {late[PLANNER] / late[SLEEPS]:.2f} times the value "
        f"with the planner that sleeps, and {late[PLANNER] / late[OTHER]:.2f} times the value with another process "
        f"that burns Python."
    )
    print(f"The planner that burns Python sent {rate:.0f} times a second.")


if __name__ == "__main__":
    main()
