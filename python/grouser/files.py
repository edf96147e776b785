# SPDX-License-Identifier: BSD-3-Clause
"""JSON and CSV of results: FileError, with the file's name, where one is missing or broken."""
from __future__ import annotations

import csv
import json
from pathlib import Path

from .errors import FileError


def read_json(file: Path, what: str) -> dict:
    """FileError where the file is missing, broken, or holds something else than a table."""
    try:
        found = json.loads(file.read_text(encoding="utf-8"))
    except OSError as error:
        raise FileError(f"{file}: cannot be read as {what}: {error.strerror}") from error
    except ValueError as error:
        raise FileError(f"{file}: cannot be read as {what}: {error}") from error
    if not isinstance(found, dict):
        raise FileError(f"{file}: cannot be read as {what}: it holds no table")
    return found


def read_csv(file: Path) -> list[dict[str, str]]:
    """The rows of a CSV file by the names of their columns. FileError where it cannot be read."""
    try:
        with open(file, newline="", encoding="utf-8") as text:
            return list(csv.DictReader(text))
    except OSError as error:
        raise FileError(f"{file}: cannot be read: {error.strerror}") from error
    except (ValueError, csv.Error) as error:
        raise FileError(f"{file}: cannot be read as a table: {error}") from error
