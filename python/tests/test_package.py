"""The public interface of the package: types, stubs and documentation."""

import inspect
import operator
import pathlib
import re
import subprocess
import sys

import sun2xp
import sun2xp.remote
from sun2xp import _sun2xp

PACKAGE = pathlib.Path(sun2xp.__file__).parent


def test_everything_public_is_described():
    for name in [*sun2xp.__all__, *(f"remote.{name}" for name in sun2xp.remote.__all__)]:
        value = operator.attrgetter(name)(sun2xp)
        assert name == "__version__" or inspect.getdoc(value), name
        if inspect.isclass(value) and value.__module__.startswith("sun2xp"):
            for member, method in inspect.getmembers(value, callable):
                assert member.startswith("_") or inspect.getdoc(method), f"{name}.{member}"


def test_the_numbers_of_errors_are_those_of_the_c_interface():
    header = pathlib.Path(__file__).parents[2] / "include/sun2xp.h"
    found = re.findall(r"#define SUN2XP_ERROR_(\w+) (\d+)", header.read_text())
    assert [(name, int(number)) for name, number in found] == [(one.name, one.value) for one in sun2xp.ErrorNumber]


def test_the_stubs_have_every_method():
    stub = (PACKAGE / "_sun2xp.pyi").read_text()
    for owner in (_sun2xp.Hand, _sun2xp.Queue, _sun2xp):
        for name in vars(owner):
            if not name.startswith("__"):
                assert f" {name}(" in stub or f"class {name}" in stub or f"{name}:" in stub, name


def test_mypy_accepts_the_package_and_a_program(tmp_path):
    program = tmp_path / "program.py"
    program.write_text(
        "import numpy\n"
        "import sun2xp\n"
        "import sun2xp.remote\n"
        "with sun2xp.simulated() as hand:\n"
        "    hand.send_position(1, numpy.zeros(3))\n"
        "    force: float = hand.tip(1).force[0]\n"
        "    for event in hand.events():\n"
        "        kind: sun2xp.EventKind = event.kind\n"
        "    hand.send_group([sun2xp.SetPoint(1, position=[0.0, 0.6, 0.9])])\n"
        "with sun2xp.remote.open('hand', client='planner') as remote:\n"
        "    angle: float = remote.position(1)[0]\n"
    )

    def check(*arguments):
        command = [sys.executable, "-m", "mypy", "--cache-dir", str(tmp_path / "cache"), *arguments]
        result = subprocess.run(command, capture_output=True, text=True, cwd=tmp_path)
        return result.returncode, result.stdout + result.stderr

    assert check("-p", "sun2xp")[0] == 0, check("-p", "sun2xp")
    assert check("program.py")[0] == 0, check("program.py")
    program.write_text("import sun2xp\nsun2xp.simulated().send_position('one', [0, 0, 0])\n")
    status, said = check("program.py")
    assert status == 1 and "arg-type" in said, said
    for opened in ("sun2xp.simulated()", "sun2xp.remote.open()", "sun2xp.remote.connect().open()"):
        # The target of `with` has the type of the hand.
        program.write_text(f"import sun2xp.remote\nwith {opened} as hand:\n    hand.send_position('one', [0, 0, 0])\n")
        status, said = check("program.py")
        assert status == 1 and "arg-type" in said, said
    program.write_text("import sun2xp.remote\nprint(sun2xp.remote.open().status().owner)\n")
    assert check("program.py")[0] == 0, check("program.py")
