"""The wake-up of the servos with a planner that burns Python, against a planner that sleeps, in turns in one run.
Prints the table of docs/python.md.

    python wake_up.py [--rounds 10] [--seconds 10]

The planner burns in as many threads as there are cores, and another thread reads and sends 1000 times a second. The
99.9 % of the wake-ups are those of all fingers and rounds. Run it on a quiet machine with real-time scheduling.
"""

import argparse
import os
import statistics
import sys
import threading
import time

import sun2xp


def burn(stop: threading.Event) -> None:
    """Computes without a pause."""
    number = 1
    while not stop.is_set():
        for _ in range(1000):
            number = number * 48271 % 2147483647


def plan(hand: sun2xp.Hand, stop: threading.Event, counts: list) -> None:
    """Reads and sends the pose of every finger 1000 times a second."""
    due = time.monotonic()
    while not stop.is_set():
        for finger in (1, 2, 3):
            hand.send_position(finger, hand.position(finger))
        counts.append(1)
        due += 0.001
        time.sleep(max(0.0, due - time.monotonic()))


def measure(hand: sun2xp.Hand, seconds: float, burning: bool) -> tuple:
    """Returns the distributions of the wake-ups of all fingers, and the number of calls."""
    stop, counts = threading.Event(), []
    threads = []
    if burning:
        threads = [threading.Thread(target=burn, args=(stop,)) for _ in range(os.cpu_count() or 1)]
        threads.append(threading.Thread(target=plan, args=(hand, stop, counts)))
    for thread in threads:
        thread.start()
    time.sleep(0.5)
    for finger in (1, 2, 3):
        hand.reset_timing(finger)
    time.sleep(seconds)
    found = [hand.timing(finger) for finger in (1, 2, 3)]
    stop.set()
    for thread in threads:
        thread.join()
    return found, len(counts)


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--rounds", type=int, default=10)
    arguments.add_argument("--seconds", type=float, default=10.0)
    arguments = arguments.parse_args()
    names = {False: "sleeps", True: "burns Python"}
    # With the default of 5 ms, each burning thread keeps the interpreter lock for 5 ms, and the planning thread cannot
    # run 1000 times a second.
    sys.setswitchinterval(0.0001)
    found = {False: [], True: []}
    planned = 0
    with sun2xp.simulated() as hand:
        status = hand.status(1)
        for round in range(arguments.rounds):
            # The order changes, so that a slow change of the machine does not look like an effect.
            for burning in (round % 2 == 0, round % 2 == 1):
                distributions, count = measure(hand, arguments.seconds, burning)
                found[burning].extend(distributions)
                planned += count
    print(f"Real-time scheduling: {status.realtime}. {arguments.rounds} rounds of {arguments.seconds:g} s.\n")
    print("| planner | cycles | median, us | 99 %, us | 99.9 %, us | longest, us |\n|---|---|---|---|---|---|")
    for burning, name in names.items():
        rounds = found[burning]
        median = [statistics.median(getattr(one, part) for one in rounds) for part in ("median", "p99", "p999")]
        cycles, longest = sum(one.count for one in rounds), max(one.maximum for one in rounds)
        print(f"| {name} | {cycles} | {median[0]:.1f} | {median[1]:.1f} | {median[2]:.1f} | {longest:.1f} |")
    burning, sleeping = (statistics.median(one.p999 for one in found[name]) for name in (True, False))
    ratio = burning / sleeping
    rate = planned / arguments.rounds / (arguments.seconds + 0.5)
    print(f"\nThe 99.9 % with the burning planner are {ratio:.2f} times those without.")
    print(f"It sent {rate:.0f} times a second.")


if __name__ == "__main__":
    main()
