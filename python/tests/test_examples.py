"""Runs the examples, the benchmarks, and the snippets in Python from the documentation."""

import os
import pathlib
import re
import subprocess
import sys

import pytest

import sun2xp

PYTHON = pathlib.Path(__file__).parent.parent
ROOT = PYTHON.parent

#: The pages that are searched for snippets in Python. The snippets of docs/ros.md need ROS, and ros/tests runs them.
#: The snippets of docs/remote.md need a server, and test_remote_serve.py runs them.
PAGES = [ROOT / "README.md", PYTHON / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
SNIPPETS = [
    pytest.param(snippet, id=f"{page.relative_to(ROOT)}-{number}")
    for page in PAGES
    for number, snippet in enumerate(re.findall(r"```python\n(.*?)```", page.read_text(), re.DOTALL))
    if page.name not in ("ros.md", "remote.md")
]


def run(*arguments, folder):
    result = subprocess.run([sys.executable, *arguments], cwd=folder, capture_output=True, text=True, timeout=110)
    assert result.returncode == 0, result.stderr
    return result.stdout


def test_the_spring_is_measured_and_plotted(tmp_path):
    said = run(PYTHON / "examples/spring.py", "spring.png", folder=tmp_path)
    found = re.findall(r"([\d.]+) N/cm sent, ([\d.]+) N/cm measured", said)
    assert len(found) == 3
    for sent, measured in found:
        assert abs(float(measured) / float(sent) - 1) < 0.1, said
    assert (tmp_path / "spring.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("example", "header", "first"), [("five_calls.py", "Sun2Xp.h", "joints "), ("c_interface.py", "sun2xp.h", "tip ")]
)
def test_cffi_reads_the_headers(example, header, first, tmp_path):
    # tests/installed sets this variable to the path of the library. In a checkout without a build there is no library.
    library = os.environ.get("SUN2XP_LIBRARY")
    if library is None:
        pytest.skip("SUN2XP_LIBRARY does not name the shared library")
    said = run(PYTHON / "examples" / example, PYTHON.parent / "include" / header, library, folder=tmp_path)
    assert said.startswith(first) and "there is no finger 7" in said


def test_the_benchmarks_print_their_tables(tmp_path):
    calls = run(PYTHON / "benchmarks/calls.py", "--rounds", "1", "--calls", "10", folder=tmp_path)
    assert calls.count("|\n") == 10
    wake_up = run(PYTHON / "benchmarks/wake_up.py", "--rounds", "1", "--seconds", "0.5", folder=tmp_path)
    assert "| burns Python |" in wake_up


def test_the_snippets_are_found():
    pages = {snippet.id.rsplit("-", 1)[0] for snippet in SNIPPETS}
    assert {"README.md", "python/README.md", "docs/python.md", "docs/black-box.md"} <= pages


@pytest.mark.parametrize("snippet", SNIPPETS)
def test_a_snippet_of_a_page_runs(snippet, tmp_path):
    # The snippet of docs/black-box.md reads a black-box file, so the test writes one.
    if "finger-1.jsonl" in snippet:
        with sun2xp.simulated() as hand:
            hand.write_black_box(1, tmp_path / "finger-1.jsonl")
        snippet += "assert len(tensions) > 10 and len(tensions[0]) == 4\n"
    run("-c", snippet, folder=tmp_path)
