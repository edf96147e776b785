# SPDX-License-Identifier: BSD-3-Clause
"""Writes TOML documents (Python's tomllib can only read them)."""
from __future__ import annotations

import math
import re

import numpy

_BARE = re.compile(r"[A-Za-z0-9_-]+")
_ESCAPES = {'"': '\\"', "\\": "\\\\", "\b": "\\b", "\t": "\\t", "\n": "\\n", "\f": "\\f", "\r": "\\r"}


def key_text(key: str) -> str:
    """A TOML key, quoted if necessary."""
    return key if _BARE.fullmatch(key) else _string(key)


def _string(text: str) -> str:
    return '"' + "".join(_ESCAPES.get(c, c if " " <= c != "\x7f" else f"\\u{ord(c):04x}") for c in text) + '"'


def value_text(value: object) -> str:
    """A value as TOML. Numbers keep full precision. TypeError for types that TOML does not support."""
    if isinstance(value, (numpy.ndarray, numpy.generic)):
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        return repr(value) if math.isfinite(value) else str(value)
    if isinstance(value, str) or hasattr(value, "__fspath__"):
        return _string(value if isinstance(value, str) else str(value))
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(map(value_text, value)) + "]"
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key_text(k)} = {value_text(v)}" for k, v in value.items()) + "}"
    raise TypeError(f"{value!r} is not a number, string, boolean, list or dict")


def _is_list_of_tables(value: object) -> bool:
    return isinstance(value, (list, tuple)) and bool(value) and all(isinstance(v, dict) for v in value)


def document_text(document: dict) -> str:
    """A document as TOML, with its tables as sections: `tomllib.loads(document_text(d)) == d`."""
    lines: list[str] = []
    _write(document, "", lines)
    return "\n".join(lines).strip() + "\n"


def _write(table: dict, path: str, lines: list[str]) -> None:
    inner = {k: v for k, v in table.items() if isinstance(v, dict) or _is_list_of_tables(v)}
    lines += [f"{key_text(k)} = {value_text(v)}" for k, v in table.items() if k not in inner]
    for key, value in inner.items():
        name = f"{path}.{key_text(key)}" if path else key_text(key)
        if isinstance(value, dict):
            # A table that contains only tables needs no header: [material.soil] without [material].
            if not value or any(not isinstance(v, dict) for v in value.values()):
                lines += ["", f"[{name}]"]
            _write(value, name, lines)
        else:
            for one in value:
                lines += ["", f"[[{name}]]"]
                _write(one, name, lines)
