"""The examples, the benchmarks and the snippets of docs/python.md run."""

import os
import pathlib
import re
import subprocess
import sys

import pytest

PYTHON = pathlib.Path(__file__).parent.parent
PAGE = PYTHON.parent / "docs/python.md"


def run(*arguments, folder):
    result = subprocess.run([sys.executable, *arguments], cwd=folder, capture_output=True, text=True, timeout=110)
    assert result.returncode == 0, result.stderr
    return result.stdout


def test_the_spring_is_measured_and_plotted(tmp_path):
    said = run(PYTHON / "examples/spring.py", "spring.png", folder=tmp_path)
    found = re.findall(r"([\d.]+) N/cm of ([\d.]+)", said)
    assert len(found) == 3
    for measured, sent in found:
        assert abs(float(measured) / float(sent) - 1) < 0.1, said
    assert (tmp_path / "spring.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("example", "header", "first"), [("five_calls.py", "Sun2Xp.h", "joints "), ("c_interface.py", "sun2xp.h", "tip ")]
)
def test_cffi_reads_the_headers(example, header, first, tmp_path):
    # tests/installed names the library. Without it, as in a checkout without a build, there is nothing to load.
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


@pytest.mark.parametrize("snippet", re.findall(r"```python\n(.*?)```", PAGE.read_text(), re.DOTALL))
def test_a_snippet_of_the_page_runs(snippet, tmp_path):
    run("-c", snippet, folder=tmp_path)
