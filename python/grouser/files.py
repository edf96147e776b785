# SPDX-License-Identifier: BSD-3-Clause
"""Reads JSON, CSV and HDF5 files of results; FileError names the file, and the position of damage."""
from __future__ import annotations

import csv
import io
import json
import os
import re
import stat
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import h5py
import numpy

from .errors import FileError

_REMEDY = "run it again or restore the file from a copy"


_KINDS = ((stat.S_ISDIR, "a folder"), (stat.S_ISFIFO, "a FIFO"), (stat.S_ISSOCK, "a socket"),
          (stat.S_ISCHR, "a device"), (stat.S_ISBLK, "a device"))


def check_input(file: Path) -> None:
    """FileError if the path, after its links, is not a regular file: reading a FIFO, a device or a file of the kernel
    may never end. OSError for a missing file."""
    found = os.stat(file)
    kind = next((name for holds, name in _KINDS if holds(found.st_mode)), "")
    if not kind and any(os.path.exists(place) and os.stat(place).st_dev == found.st_dev for place in ("/proc", "/sys")):
        kind = "a file of the kernel"
    if kind:
        raise FileError(f"{file} is {kind} (a regular file is required)")


def read_text(file: Path, encoding: str = "utf-8") -> str:
    """The text of a regular file. FileError as from check_input(), OSError, UnicodeDecodeError."""
    check_input(file)
    return file.read_text(encoding=encoding)


def leads_out(folder: Path, path: Path) -> bool:
    """Whether a path leads out of a folder, also by its links."""
    try:
        return not path.resolve().is_relative_to(folder.resolve())
    except (OSError, RuntimeError, ValueError):  # a loop of links, or a path that no file can have
        return True


def inside(folder: Path, name: str, file: Path) -> Path:
    """The path `name` in a folder, as `file` lists it. FileError if it leads out of the folder, so that results from
    elsewhere cannot refer to other files of this machine."""
    if leads_out(folder, folder / name):
        raise FileError(f"{file}: the path {name!r} leads out of the folder {folder}; correct it, or copy the files "
                        "into the folder")
    return folder / name


def read_json(file: Path, what: str) -> dict:
    """Reads a JSON dictionary. FileError if the file is missing, damaged (with line and column) or not a dictionary."""
    try:
        found = json.loads(read_text(file))
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
    _check(file, what)
    return found


def _check(file: Path, what: str) -> None:
    """FileError if the checksum in the last line of the file is wrong."""
    text = file.read_bytes()
    last = re.search(rb',\n  "checksum": "([0-9a-f]{8})"\n}\n\Z', text)
    # Older versions write no checksum: the last entry of their manifest is a table, not a text.
    is_altered = not last and file.name == "manifest.json" and text.endswith(b'"\n}\n')
    if is_altered or last and int(last[1], 16) != zlib.crc32(text[:last.start()]):
        raise FileError(_damaged(str(file), what, "wrong checksum"))


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
        if re.search(r"Unable to (synchronously )?open object \((?!object ')", str(error)):  # there, but unreadable
            raise FileError(_damaged(str(file), what, "a part of it is unreadable")) from error
        name = (re.findall("'([^']+)'", str(error)) or [error])[-1]
        raise FileError(f"{file}: cannot be read as {what}: {name!r} is missing; damaged or from another version: "
                        f"{_REMEDY}") from error
    except (OSError, RuntimeError, MemoryError) as error:  # raised by h5py: a wrong checksum
        raise FileError(_damaged(str(file), what, "a part of it is unreadable")) from error
    except (TypeError, ValueError, AttributeError, IndexError) as error:
        raise FileError(f"{file}: cannot be read as {what}: a field has the wrong type; damaged or from another "
                        f"version: {_REMEDY}") from error


def read(dataset: h5py.Dataset, file: Path, rows: object = ()) -> numpy.ndarray:
    """Reads a dataset, or some of its rows. FileError if the data are damaged."""
    compressed = 1032 if dataset.compression else 1  # maximum of zlib
    try:
        if dataset.nbytes <= dataset.id.get_storage_size() * compressed:
            return dataset[rows]
    except (OSError, RuntimeError, MemoryError):
        pass
    raise FileError(f"{file}: dataset {dataset.name} cannot be read: the file is damaged: {_REMEDY}")


class _ClosedAtEnd(io.FileIO):
    """A file that is closed with its last reference, which the HDF5 file holds."""

    def __del__(self) -> None:
        self.close()


def open_file(path: Path) -> h5py.File:
    """Opens an HDF5 file to read its present contents. HDF5 shares the state of a file that this process has open,
    which may be older; a second opening therefore reads through a Python file of its own. OSError as from h5py."""
    check_input(path)
    for one in h5py.h5f.get_obj_ids(h5py.h5f.OBJ_ALL, h5py.h5f.OBJ_FILE):
        name = os.fsdecode(h5py.h5f.get_name(one))
        if os.path.exists(name) and os.path.samefile(name, path):
            return h5py.File(_ClosedAtEnd(path), "r")
    return h5py.File(path, "r", locking=False)


def text_of(value: object) -> str:
    return value.decode() if isinstance(value, bytes) else str(value)


#: End of the name of an attribute with the checksum of a long text, which has no checksum in HDF5.
CHECKSUM = "_crc32"


def long_text(item: h5py.HLObject, name: str) -> str | numpy.ndarray:
    """An attribute with one text or several, which may be long. ValueError if its checksum is wrong, KeyError if it is
    missing."""
    value = item.attrs[name]
    if name + CHECKSUM in item.attrs:
        data = value.tobytes() if isinstance(value, numpy.ndarray) else value
        if zlib.crc32(data) != item.attrs[name + CHECKSUM]:
            raise ValueError(name)
    return value if isinstance(value, numpy.ndarray) else text_of(value)


def require(holds: bool, file: Path, place: str) -> None:
    """FileError if the data at `place` do not fulfil a condition."""
    if not holds:
        raise FileError(f"{file}: {place} is out of range: the file is damaged: {_REMEDY}")


def still_open(file: h5py.File, path: Path) -> h5py.File:
    """Returns the file; ValueError if it has been closed."""
    if not file:
        raise ValueError(f"{path}: the file is closed; open it again")
    return file


def read_csv(file: Path) -> list[dict[str, str]]:
    """Reads the rows of a CSV file as dictionaries by column name. FileError if the file cannot be read."""
    try:
        check_input(file)
        with open(file, newline="", encoding="utf-8") as text:
            return list(csv.DictReader(text))
    except OSError as error:
        raise FileError(f"{file}: cannot be read: {error.strerror}") from error
    except FileError:
        raise
    except (ValueError, csv.Error) as error:
        raise FileError(f"{file}: cannot be read as a table: not valid text; the file is damaged: "
                        f"{_REMEDY}") from error
