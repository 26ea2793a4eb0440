#!/usr/bin/env python3
"""Writes packaging/third-party-licences.txt: the licences of all crates that the library, the tool and the Python package
contain.

Run it after a change of Cargo.lock. tool/tests/third_party.rs compares the list of crates.
"""

import json
import pathlib
import re
import subprocess
import textwrap

ROOT = pathlib.Path(__file__).resolve().parent.parent
TARGET = "x86_64-unknown-linux-gnu"
NAMES = ("LICEN", "COPYING", "NOTICE", "COPYRIGHT", "UNLICENSE")

# What the tool embeds besides crates.
EMBEDDED = {
    "three.js, in the web page of the tool": "tool/page/vendor/three.LICENSE",
    "uPlot, in the web page of the tool": "tool/page/vendor/uplot.LICENSE",
    "DejaVu Sans, in the plots of the tool": "tool/font/LICENSE.txt",
}


def contained(metadata):
    """Returns the crates that are linked, without crates that only run during the build."""
    # The metadata has the crates of all features; the tree has those of the enabled ones.
    command = ["cargo", "tree", "--locked", "--edges", "normal", "--prefix", "none", "--format", "{p}"]
    command += ["--package", "sun2xp", "--package", "sun2xp-tool", "--package", "sun2xp-python", "--target", TARGET]
    lines = subprocess.check_output(command, cwd=ROOT, text=True).splitlines()
    linked = {tuple(line.split()[:2]) for line in lines if line and "(/" not in line}
    found = [package for package in metadata["packages"] if (package["name"], "v" + package["version"]) in linked]
    return sorted(found, key=lambda package: (package["name"], package["version"]))


def files(package):
    """Returns the files with licences in the sources of a crate."""
    folder = pathlib.Path(package["manifest_path"]).parent
    found = sorted(file for file in folder.iterdir() if file.is_file() and file.name.upper().startswith(NAMES))
    # Of several licences that a user may choose from, this is the shortest.
    mit = [file for file in found if "MIT" in file.name.upper()]
    return mit if mit and "MIT" in (package["license"] or "") and "AND" not in package["license"] else found


def split(text):
    """Returns the copyright notices and the rest of a text, without differences in line breaks."""
    notices, rest = [], []
    for paragraph in re.split(r"\n\s*\n", text.strip()):
        lines = [line.strip() for line in paragraph.splitlines()]
        while lines and re.match(r"(copyright|\(c\))\b.*\d", lines[0], re.IGNORECASE):
            notices.append(lines.pop(0))
        if lines:
            rest.append(textwrap.fill(" ".join(lines), 100))
    return notices, "\n\n".join(rest)


def main():
    command = ["cargo", "metadata", "--format-version", "1", "--locked", "--filter-platform", TARGET]
    crates = contained(json.loads(subprocess.check_output(command, cwd=ROOT)))
    licences = {}
    lines = ["The library, the tool and the Python package contain these crates:", ""]
    for package in crates:
        name = f"{package['name']} {package['version']}"
        lines.append(f"{name}: {package['license'] or 'see the text'}")
        for file in files(package):
            notices, rest = split(file.read_text(errors="replace"))
            licences.setdefault(rest, []).append((name, notices))
    for text, users in sorted(licences.items(), key=lambda item: item[1]):
        lines += ["", "-" * 100]
        for name, notices in users:
            lines.append("; ".join([name, *dict.fromkeys(notices)]))
        lines += ["-" * 100, "", text]
    for name, file in EMBEDDED.items():
        lines += ["", "-" * 100, name, "-" * 100, "", (ROOT / file).read_text().strip()]
    (ROOT / "packaging/third-party-licences.txt").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
