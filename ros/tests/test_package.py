"""Tests the dependencies in package.xml, which colcon and rosdep read."""

import pathlib
import re
import sys
from xml.etree import ElementTree

ROS = pathlib.Path(__file__).parents[1]

#: Imported modules that package.xml does not list under these names: sun2xp has no rosdep key, and the rosdep key of
#: numpy is python3-numpy.
OTHERS = {"sun2xp", "numpy"}


def test_the_package_depends_on_every_module_that_it_imports():
    needed = {entry.text for entry in ElementTree.parse(ROS / "package.xml").findall("exec_depend")}
    imported = set()
    for source in (ROS / "sun2xp_ros").glob("*.py"):
        imported.update(re.findall(r"^(?:from|import) (\w+)", source.read_text(), re.MULTILINE))
    assert {"rclpy", *OTHERS} <= imported
    assert imported - sys.stdlib_module_names - OTHERS <= needed
