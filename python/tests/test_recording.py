"""Recordings and black boxes that are read as arrays, and the tool `sun2xp` that the wheel installs."""

import os
import pathlib
import shutil
import subprocess
import sys
import time

import numpy
import pytest

import sun2xp

TOOL = pathlib.Path(sys.executable).with_name("sun2xp")


def tool(*arguments, **options):
    """Runs the tool of the installed package."""
    return subprocess.run([TOOL, *arguments], capture_output=True, text=True, timeout=100, **options)


def test_the_tool_is_installed():
    assert tool("--version").stdout == f"sun2xp {sun2xp.__version__}\n"
    wrong = tool("lunch")
    assert wrong.returncode == 2 and "lunch" in wrong.stderr
    failed = tool("replay", "/dev/null")
    assert failed.returncode == 1 and failed.stderr.startswith("sun2xp: ")


def test_the_tool_starts_the_server_beside_it(tmp_path):
    command, server = tmp_path / "sun2xp", tmp_path / "sun2xp-serve"
    shutil.copy(TOOL, command)
    missing = subprocess.run([command, "serve", "--router"], capture_output=True, text=True, timeout=100)
    assert missing.returncode == 1 and f"{server} is missing" in missing.stderr
    server.write_text('#!/bin/sh\necho "served $*"\n')
    server.chmod(0o755)
    found = subprocess.run([command, "serve", "--router"], capture_output=True, text=True, timeout=100)
    assert (found.returncode, found.stdout) == (0, "served --router\n"), found


def test_control_c_ends_the_tool(tmp_path):
    arguments = [TOOL, "board", "--link", "unused"]
    process = subprocess.Popen(arguments, stdin=subprocess.PIPE, stdout=subprocess.PIPE, cwd=tmp_path)
    # The tool must run before it gets the signal, because a tool that has failed has the exit status 1 too.
    assert process.stdout.readline().startswith(b"/dev/pts/") and process.poll() is None
    process.send_signal(2)
    try:
        assert process.wait(20) in (0, 1, -2)
    finally:
        process.kill()
        process.communicate()


def test_a_black_box_has_the_last_cycles(hand):
    # The finger arrives at its set point before it is stopped. Its black box ends at the stop.
    hand.send_position(1, [0.1, 0.6, 0.9])
    hand.wait(1, timeout=30)
    events = hand.events()
    hand.stop(1)
    fault = events.wait(20)
    box = hand.black_box(1)
    cycles = box.cycles[1]
    assert list(box.cycles) == [1] and box.complete and len(cycles) > 100
    assert (numpy.diff(cycles["cycle"]) == 1).all() and (numpy.diff(cycles["time"]) > 0).all()
    assert cycles["joints"].shape == (len(cycles), 3) and cycles["kx"].shape == (len(cycles), 3, 3)
    assert fault.cycle in cycles["cycle"]
    running = cycles[cycles["stage"] == "running"]
    assert abs(running["joints"][-1] - [0.1, 0.6, 0.9]).max() < 0.04
    assert box.description["configuration"]["hand"]["rate"] == 1000
    assert "finger 1" in repr(box)


def test_a_black_box_without_cycles_has_empty_arrays(hand):
    hand.stop(1)
    box = hand.black_box(1)
    box.cycles = {1: box.cycles[1][:0]}
    assert box.seconds(1).shape == (0,)


def test_a_recording_becomes_a_table(tmp_path):
    file = tmp_path / "hand.mcap"
    name = f"python-{os.getpid()}"
    with sun2xp.simulated(text=f"[telemetry]\nname = '{name}'\n") as hand:
        recorder = subprocess.Popen([TOOL, "record", "--hand", name, "--output", file, "--seconds", "3"], cwd=tmp_path)
        while not (file.exists() and file.stat().st_size > 10_000):
            time.sleep(0.05)
        hand.send_position(2, [0.2, 0.6, 0.9])
        hand.wait(2, timeout=30)
        hand.stop(3)
        assert recorder.wait(60) == 0
    recording = sun2xp.read_recording(file)
    assert sorted(recording.cycles) == [1, 2, 3] and recording.complete
    moved = recording.cycles[2]["joints"]
    assert abs(moved[-1] - [0.2, 0.6, 0.9]).max() < 0.05 and abs(moved[0] - moved[-1]).max() > 0.1
    assert {"event", "fault"} <= {mark.kind for mark in recording.marks}
    stopped = recording.cycles[3]
    assert stopped["stage"][-1] == "faulted" and stopped["fault"][-1] > 0
    for finger in (1, 2, 3):
        part = sun2xp.read_recording(file, fingers=[finger])
        # The seconds of a finger do not depend on the fingers that are read.
        assert list(part.cycles) == [finger] and (part.seconds(finger) == recording.seconds(finger)).all()
    table = recording.to_pandas(2)
    assert len(table) == len(moved) and table.index.name == "seconds"
    assert numpy.array_equal(table["joints_2"], moved[:, 2], equal_nan=True)
    assert {"kx_0_1", "stage", "tensions_3"} <= set(table.columns)


def test_a_minute_takes_as_much_memory_as_the_description_says(hand):
    minute = 60_000 * hand.black_box(1).cycles[1].dtype.itemsize
    assert f"takes {minute * 1e-6:.0f} MB" in sun2xp.read_recording.__doc__


def test_what_is_no_recording_is_refused(tmp_path):
    file = tmp_path / "hand.mcap"
    file.write_text("no recording")
    with pytest.raises(sun2xp.Error, match="not a recording"):
        sun2xp.read_recording(file)
    with pytest.raises(sun2xp.Error, match="cannot read"):
        sun2xp.read_recording(os.fspath(tmp_path / "missing"))
