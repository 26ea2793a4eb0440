"""Describes the package for colcon, which does not read pyproject.toml, and for pip."""

from setuptools import setup

NAME = "sun2xp_ros"

setup(
    name=NAME,
    version="0.1.0",
    description="The Stanford/JPL hand of the library sun2xp as a ROS 2 node",
    license="MIT OR Apache-2.0",
    packages=[NAME],
    python_requires=">=3.9",
    # The packages of ROS 2 come with ROS 2, or as wheels (docs/ros.md).
    install_requires=["numpy>=1.21", "sun2xp"],
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{NAME}"]),
        (f"share/{NAME}", ["package.xml"]),
        (f"share/{NAME}/config", ["config/hand.yaml"]),
    ],
    entry_points={"console_scripts": [f"hand = {NAME}.node:main"]},
)
