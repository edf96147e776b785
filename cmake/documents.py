#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Installs the documents for `cmake --install` with links and paths adjusted to the installation:

    cmake/documents.py PREFIX SHARE DOC PYTHON      the last three relative to PREFIX, or absolute; respects DESTDIR

Prints the installed files without DESTDIR, separated by semicolons (a list of CMake).
Links point to installed files, or become plain text if the file is not installed; build/bin/grouser becomes grouser,
and a path such as runs/scenes/quickstart.toml that of the installed file.
"""
import os
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
#: Installed below DOC under the same name.
DOCUMENTS = ("README.md", "CHANGELOG.md", "ARCHITECTURE.md", "docs")
#: Installed by install.cmake below SHARE: {path in the sources: path below SHARE}.
SHARED = {name: name for name in ("assets/meshes", "assets/heightmaps", "assets/vehicles", "assets/soils", "runs/scenes",
                                  "runs/mechanisms", "runs/plots", "runs/slurm.sh", "python/examples")} | {
    "tests/install/example": "example"}
LINK = re.compile(r"(?<!!)\[([^\[\]]*)\]\(([^)\s#]+)(#[^)\s]*)?\)")
#: The program in commands, except references to its path in a checkout.
PROGRAM = re.compile(r"build/bin/grouser(?!\w|`\s+of\s+the\s+checkout)")
#: A path in text or code, but not in the text of a link.
PATH = re.compile(r"(?<![\w./\[-])(?:assets|runs|python|tests)/[\w./*-]*\w")


def below(path, top):
    """The rest of a path below a folder or file; None if it is not below it."""
    return path[len(top):] if path == top or path.startswith(top + "/") else None


def place(path, share, doc):
    """Installed path of a source file; None if it is not installed."""
    if any(below(path, top) is not None for top in DOCUMENTS):
        return f"{doc}/{path}"
    return next((f"{share}/{there}{below(path, top)}" for top, there in SHARED.items() if below(path, top) is not None), None)


def fitted(text, document, prefix, share, doc, python):
    """Installed text of a document, given by its path in the sources."""
    share, doc, python = (os.path.join(prefix, path) for path in (share, doc, python))
    folder = os.path.dirname(document)

    def link(match):
        words, target, heading = match.groups("")
        path = os.path.normpath(os.path.join(folder, target))
        if not (ROOT / path).exists():  # a URL, or code that resembles a link
            return match[0]
        there = place(path, share, doc)
        return f"[{words}]({os.path.relpath(there, os.path.join(doc, folder))}{heading})" if there else words

    def named(match):
        there = place(match[0], share, doc)
        return there or match[0]

    text = PATH.sub(named, LINK.sub(link, text)).replace("PYTHONPATH=python ", f"PYTHONPATH={python} ")
    return PROGRAM.sub("grouser", text)


def install(prefix, share, doc, python):
    stage, made = os.environ.get("DESTDIR", ""), []
    for document in [path for top in DOCUMENTS for path in (ROOT / top, *(ROOT / top).rglob("*.md")) if path.suffix == ".md"]:
        name = str(document.relative_to(ROOT))
        made.append(os.path.join(prefix, doc, name))
        file = Path(stage + made[-1])
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(fitted(document.read_text(encoding="utf-8"), name, prefix, share, doc, python), encoding="utf-8")
        file.chmod(0o644)
    return made


if __name__ == "__main__":
    os.umask(0o022)  # readable for all users
    print(";".join(install(*sys.argv[1:])), end="")
