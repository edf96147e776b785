#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Puts the documents where `cmake --install` wants them, so that they fit what is installed there:

    cmake/documents.py PREFIX SHARE DOC PYTHON      the last three from the prefix on, or whole; DESTDIR goes before

A link leads to where a file is installed, and is plain text where it is not; build/bin/grouser becomes grouser, and
a path such as runs/scenes/quickstart.toml that of the installed file.
"""
import os
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
#: What is put below DOC by its own name.
DOCUMENTS = ("README.md", "CHANGELOG.md", "ARCHITECTURE.md", "docs")
#: What install.cmake puts below SHARE, and where there. Documents name it by its place in the sources.
SHARED = {name: name for name in ("assets/meshes", "assets/heightmaps", "assets/vehicles", "assets/soils", "runs/scenes",
                                  "runs/mechanisms", "runs/plots", "runs/slurm.sh", "python/examples")} | {
    "tests/install/example": "example"}
LINK = re.compile(r"(?<!!)\[([^\[\]]*)\]\(([^)\s#]+)(#[^)\s]*)?\)")
#: The program in commands, but not where the place in a checkout is spoken of.
PROGRAM = re.compile(r"build/bin/grouser(?!\w|`\s+of\s+the\s+checkout)")
#: A path in text or code; that of a link's text stays as it is.
PATH = re.compile(r"(?<![\w./\[-])(?:assets|runs|python|tests)/[\w./*-]*\w")


def below(path, top):
    """The rest of a path below a folder or file; None where it is not below it."""
    return path[len(top):] if path == top or path.startswith(top + "/") else None


def place(path, share, doc):
    """Where a file of the sources, by its path there, is installed; None where it is not."""
    if any(below(path, top) is not None for top in DOCUMENTS):
        return f"{doc}/{path}"
    return next((f"{share}/{there}{below(path, top)}" for top, there in SHARED.items() if below(path, top) is not None), None)


def fitted(text, document, prefix, share, doc, python):
    """The text of a document, by its path in the sources, as it is installed."""
    share, doc, python = (os.path.join(prefix, path) for path in (share, doc, python))
    folder = os.path.dirname(document)

    def link(match):
        words, target, heading = match.groups("")
        path = os.path.normpath(os.path.join(folder, target))
        if not (ROOT / path).exists():  # code that looks like a link, or an address
            return match[0]
        there = place(path, share, doc)
        return f"[{words}]({os.path.relpath(there, os.path.join(doc, folder))}{heading})" if there else words

    def named(match):
        there = place(match[0], share, doc)
        return there or match[0]

    text = PATH.sub(named, LINK.sub(link, text)).replace("PYTHONPATH=python ", f"PYTHONPATH={python} ")
    return PROGRAM.sub("grouser", text)


def install(prefix, share, doc, python):
    stage = Path(os.environ.get("DESTDIR", "") + os.path.join(prefix, doc))
    for document in [path for top in DOCUMENTS for path in (ROOT / top, *(ROOT / top).rglob("*.md")) if path.suffix == ".md"]:
        name = str(document.relative_to(ROOT))
        file = stage / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(fitted(document.read_text(encoding="utf-8"), name, prefix, share, doc, python), encoding="utf-8")


if __name__ == "__main__":
    install(*sys.argv[1:])
