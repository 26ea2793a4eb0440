"""Measures the time of calls from Python, and of `Hand::position` in Rust. The measurements alternate in one run.
Prints a table. docs/python.md has its medians.

    python calls.py [--rounds 20] [--calls 20000]
"""

import argparse
import statistics
import timeit

import numpy

import sun2xp


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--rounds", type=int, default=20)
    arguments.add_argument("--calls", type=int, default=20000)
    arguments = arguments.parse_args()
    with sun2xp.simulated() as hand:
        joints = hand.position(1)
        listed = joints.tolist()
        stiffness = numpy.diag([3.0, 3.0, 3.0])
        calls = {
            "`Hand::position` in Rust": None,
            "`hand.position(1)`": lambda: hand.position(1),
            "`numpy.empty(3)`": lambda: numpy.empty(3),
            "`hand.send_position(1, array)`": lambda: hand.send_position(1, joints),
            "`hand.send_position(1, list)`": lambda: hand.send_position(1, listed),
            "`hand.send_stiffness(1, array)`": lambda: hand.send_stiffness(1, stiffness),
            "`hand.tip(1)`": lambda: hand.tip(1),
            "`hand.status(1)`": lambda: hand.status(1),
        }
        times = {name: [] for name in calls}
        for _ in range(arguments.rounds):
            for name, call in calls.items():
                if call is None:
                    seconds = hand._time_position(1, arguments.calls)
                else:
                    seconds = timeit.timeit(call, number=arguments.calls)
                times[name].append(seconds / arguments.calls * 1e9)
    print("| call | median, ns | fastest round, ns |\n|---|---|---|")
    for name, found in times.items():
        print(f"| {name} | {statistics.median(found):.0f} | {min(found):.0f} |")
    both = zip(times["`hand.position(1)`"], times["`Hand::position` in Rust"])
    more = statistics.median(one - other for one, other in both)
    print(f"\n`hand.position(1)` takes {more:.0f} ns more than `Hand::position` in Rust.")


if __name__ == "__main__":
    main()
