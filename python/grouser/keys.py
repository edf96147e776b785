# SPDX-License-Identifier: BSD-3-Clause
"""Checks the keys of scenes against the tables of `grouser fields`."""
from __future__ import annotations

import difflib
import os
import re
import subprocess
from functools import cache
from typing import Any

from .program import find_program
from .toml import key_text

_HEADING = re.compile(r"### `\[+(.+?)\]+`$")
_KEY = re.compile(r"\| `([A-Za-z0-9_]+)` \|")
_ANY = ("NAME", "a|b", "SECTION")  # placeholders for a name in the program's tables


@cache
def _sections(vehicle: bool = False) -> dict[tuple[str, ...], list[str]]:
    """{("driver", "table"): its keys}; {} if the program cannot be run."""
    try:
        words: list[str | os.PathLike] = [find_program(), "fields", *(["--vehicle"] if vehicle else [])]
        text = subprocess.run(words, capture_output=True, text=True, check=True).stdout
    except (OSError, subprocess.CalledProcessError):
        return {}
    sections: dict[tuple[str, ...], list[str]] = {}
    here: list[str] = []
    for line in text.split("\n"):
        if title := _HEADING.match(line):
            path = tuple(word.strip('"') for word in title[1].split("."))
            here = sections.setdefault(path, [])
        elif key := _KEY.match(line):
            here.append(key[1])
    return sections


def _fits(pattern: tuple[str, ...], path: list[str]) -> bool:
    return len(pattern) == len(path) and all(a == b or a in _ANY for a, b in zip(pattern, path))


def _dotted(path: list[str]) -> str:
    return ".".join(key_text(word) for word in path)


def check(path: list[str], value: Any) -> None:
    """Raises KeyError, which names the nearest key, for an unknown key of a scene. Accepts every key if the program
    cannot be run, and every key in lists of a vehicle file."""
    sections = _sections()
    if not sections or path == ["version"]:
        return
    if len(path) == 1 and isinstance(value, (dict, list, tuple)):
        if not any(pattern[0] == path[0] for pattern in sections):
            _refuse(path, [pattern[0] for pattern in sections], "section")
    if isinstance(value, dict):
        for key, inner in value.items():
            check([*path, key], inner)
    elif isinstance(value, (list, tuple)) and all(isinstance(one, dict) for one in value) and (value or len(path) == 1):
        for one in value:
            check(path, one)
    elif path[0] == "spec":
        if len(path) == 3 and (known := _sections(vehicle=True)):
            _check_leaf(path, {("spec", *name): keys for name, keys in known.items()})
    else:
        _check_leaf(path, sections)


def _check_leaf(path: list[str], sections: dict[tuple[str, ...], list[str]]) -> None:
    *section, key = path
    here = [k for pattern, known in sections.items() if _fits(pattern, section) for k in known]
    if key in here:
        return
    if near := difflib.get_close_matches(key, here, 1, 0.6):
        _refuse(path, [_dotted([*section, near[0]])])
    if any(_fits(pattern, path) for pattern in sections):
        raise KeyError(f"{_dotted(path)} is a section; set one of its keys, or set it to a dict")

    def named(pattern: tuple[str, ...]) -> list[str]:
        """The pattern with its placeholders replaced by the names of the path."""
        return [b if a in _ANY else a for a, b in zip(pattern, section)] if len(pattern) == len(section) else [*pattern]

    # Suggest the only key of this name in another section, else a key of this section, else any key.
    whole = [_dotted([*named(pattern), k]) for pattern, known in sections.items() for k in known]
    same = [word for word in whole if word.rpartition(".")[2] == key]
    own = [_dotted([*section, k]) for k in here]
    _refuse(path, same if len(same) == 1 else own or same or whole)


def _refuse(path: list[str], valid: list[str], what: str = "key") -> None:
    word = _dotted(path)
    near = valid if len(valid) == 1 else difflib.get_close_matches(word, valid, 1, 0.0)
    raise KeyError(f"{word}: unknown {what}; did you mean {near[0]}?" if near else f"{word}: unknown {what}")
