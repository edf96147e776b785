# SPDX-License-Identifier: BSD-3-Clause
"""Reads JSON and CSV files of results; FileError names the file, and the position of damage."""
from __future__ import annotations

import csv
import json
import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import h5py

from .errors import FileError

_REMEDY = "run it again or restore the file from a copy"


def read_json(file: Path, what: str) -> dict:
    """Reads a JSON dictionary. FileError if the file is missing, damaged (with line and column) or not a dictionary."""
    try:
        found = json.loads(file.read_text(encoding="utf-8"))
    except OSError as error:
        raise FileError(f"{file}: cannot be read as {what}: {error.strerror}") from error
    except json.JSONDecodeError as error:
        raise FileError(_damaged(f"{file}:{error.lineno}:{error.colno}", what, "invalid JSON")) from error
    except UnicodeDecodeError as error:
        before = error.object[:error.start]
        line, column = before.count(b"\n") + 1, error.start - before.rfind(b"\n")
        raise FileError(_damaged(f"{file}:{line}:{column}", what, "not UTF-8 text")) from error
    if not isinstance(found, dict):
        raise FileError(_damaged(f"{file}:1:1", what, "not a JSON dictionary"))
    return found


def _damaged(place: str, what: str, fault: str) -> str:
    return f"{place}: cannot be read as {what}: {fault}; the file is damaged: {_REMEDY}"


@contextmanager
def fields_of(file: Path, what: str) -> Iterator[None]:
    """Context in which data from `file` are evaluated: FileError if a field is missing or has the wrong type."""
    try:
        yield
    except FileError:
        raise
    except KeyError as error:  # h5py: the message is a sentence with the name in quotes
        name = (re.findall("'([^']+)'", str(error)) or [error])[-1]
        raise FileError(f"{file}: cannot be read as {what}: {name!r} is missing; damaged or from another version: "
                        f"{_REMEDY}") from error
    except (TypeError, ValueError, AttributeError, IndexError, OSError) as error:
        raise FileError(f"{file}: cannot be read as {what}: a field has the wrong type; damaged or from another "
                        f"version: {_REMEDY}") from error


def still_open(file: h5py.File, path: Path) -> h5py.File:
    """Returns the file; ValueError if it has been closed."""
    if not file:
        raise ValueError(f"{path}: the file is closed; open it again")
    return file


def read_csv(file: Path) -> list[dict[str, str]]:
    """Reads the rows of a CSV file as dictionaries by column name. FileError if the file cannot be read."""
    try:
        with open(file, newline="", encoding="utf-8") as text:
            return list(csv.DictReader(text))
    except OSError as error:
        raise FileError(f"{file}: cannot be read: {error.strerror}") from error
    except (ValueError, csv.Error) as error:
        raise FileError(f"{file}: cannot be read as a table: not valid text; the file is damaged: "
                        f"{_REMEDY}") from error
