# SPDX-License-Identifier: BSD-3-Clause
"""JSON and CSV of results: FileError, with the file's name and place, where one is missing or broken."""
from __future__ import annotations

import csv
import json
import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import h5py

from .errors import FileError

_REMEDY = "make it again, or take it from a copy"


def read_json(file: Path, what: str) -> dict:
    """FileError with line and column where the file is missing, broken, or holds something else than a table."""
    try:
        found = json.loads(file.read_text(encoding="utf-8"))
    except OSError as error:
        raise FileError(f"{file}: cannot be read as {what}: {error.strerror}") from error
    except json.JSONDecodeError as error:
        raise FileError(_damaged(f"{file}:{error.lineno}:{error.colno}", what, "is no JSON from here on")) from error
    except UnicodeDecodeError as error:
        before = error.object[:error.start]
        line, column = before.count(b"\n") + 1, error.start - before.rfind(b"\n")
        raise FileError(_damaged(f"{file}:{line}:{column}", what, "is no text from here on")) from error
    if not isinstance(found, dict):
        raise FileError(_damaged(f"{file}:1:1", what, "holds no table"))
    return found


def _damaged(place: str, what: str, fault: str) -> str:
    return f"{place}: cannot be read as {what}: it {fault}; the file is damaged: {_REMEDY}"


@contextmanager
def fields_of(file: Path, what: str) -> Iterator[None]:
    """While a table that was read from `file` is taken apart: FileError where a field is missing or of another kind."""
    try:
        yield
    except FileError:
        raise
    except KeyError as error:  # h5py's is a sentence with the name in it
        name = (re.findall("'([^']+)'", str(error)) or [error])[-1]
        raise FileError(f"{file}: cannot be read as {what}: it has no {name!r}; it is damaged, or of another version: "
                        f"{_REMEDY}") from error
    except (TypeError, ValueError, AttributeError, IndexError, OSError) as error:
        raise FileError(f"{file}: cannot be read as {what}: a field in it is of another kind; it is damaged, or of "
                        f"another version: {_REMEDY}") from error


def still_open(file: h5py.File, path: Path) -> h5py.File:
    """ValueError where it has been closed."""
    if not file:
        raise ValueError(f"{path}: is closed; open it again")
    return file


def read_csv(file: Path) -> list[dict[str, str]]:
    """The rows of a CSV file by the names of their columns. FileError where it cannot be read."""
    try:
        with open(file, newline="", encoding="utf-8") as text:
            return list(csv.DictReader(text))
    except OSError as error:
        raise FileError(f"{file}: cannot be read: {error.strerror}") from error
    except (ValueError, csv.Error) as error:
        raise FileError(f"{file}: cannot be read as a table, for it holds what is no text; it is damaged: "
                        f"{_REMEDY}") from error
