#!/usr/bin/env python3
"""Writes packaging/third-party-licences.txt: the licences of all crates that the library, the tool and the Python
package contain. Writes packaging/third-party-licences-remote.txt: those of the other crates that the server and the
library of remote hands contain.

Run it after a change of Cargo.lock. tool/tests/third_party.rs checks that the files list exactly these crates.
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


LOCAL = ("sun2xp", "sun2xp-tool", "sun2xp-python")
REMOTE = ("sun2xp-serve", "sun2xp-remote-library")
REMOTE_FILE = "third-party-licences-remote.txt"


def contained(metadata, owners):
    """Returns the crates that are linked into these packages, and procedural macros with their dependencies."""
    # The metadata has the crates that any package of the workspace needs, including those for build scripts and tests.
    # The tree has only the normal dependencies of these packages with their enabled features.
    command = ["cargo", "tree", "--locked", "--edges", "normal", "--prefix", "none", "--format", "{p}"]
    command += [argument for owner in owners for argument in ("--package", owner)] + ["--target", TARGET]
    lines = subprocess.check_output(command, cwd=ROOT, text=True).splitlines()
    # The packages of the workspace are not third-party. A crate that the workspace replaces by its own copy is
    # third-party.
    linked = {tuple(line.split()[:2]) for line in lines if line and not line.startswith("sun2xp")}
    found = [package for package in metadata["packages"] if (package["name"], "v" + package["version"]) in linked]
    return sorted(found, key=lambda package: (package["name"], package["version"]))


def files(package):
    """Returns the files with licences in the sources of a crate."""
    folder = pathlib.Path(package["manifest_path"]).parent
    found = sorted(file for file in folder.iterdir() if file.is_file() and file.name.upper().startswith(NAMES))
    # If a user may choose from several licences, the list has only the MIT licence, because its text is the shortest.
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


def write(file, title, crates, embedded):
    """Writes a list of crates with the texts of their licences."""
    licences = {}
    lines = [title, ""]
    for package in crates:
        name = f"{package['name']} {package['version']}"
        lines.append(f"{name}: {package['license'] or 'see the text'}")
        # Some crates offer the Apache licence without its text.
        apache = [ROOT / "LICENSE-APACHE"] if file == REMOTE_FILE and "Apache-2.0" in (package["license"] or "") else []
        for source in files(package) or apache:
            notices, rest = split(source.read_text(errors="replace"))
            licences.setdefault(rest, []).append((name, notices))
    for text, users in sorted(licences.items(), key=lambda item: item[1]):
        lines += ["", "-" * 100]
        for name, notices in users:
            lines.append("; ".join([name, *dict.fromkeys(notices)]))
        lines += ["-" * 100, "", text]
    for name, source in embedded.items():
        lines += ["", "-" * 100, name, "-" * 100, "", (ROOT / source).read_text().strip()]
    (ROOT / "packaging" / file).write_text("\n".join(lines) + "\n")


def main():
    command = ["cargo", "metadata", "--format-version", "1", "--locked", "--filter-platform", TARGET]
    metadata = json.loads(subprocess.check_output(command, cwd=ROOT))
    local = contained(metadata, LOCAL)
    title = "The library, the tool and the Python package contain these crates:"
    write("third-party-licences.txt", title, local, EMBEDDED)
    remote = [package for package in contained(metadata, REMOTE) if package not in local]
    title = "The server and the library of remote hands contain these crates, besides those of "
    title += "third-party-licences.txt:"
    write(REMOTE_FILE, title, remote, {})


if __name__ == "__main__":
    main()
