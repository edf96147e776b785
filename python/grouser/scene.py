# SPDX-License-Identifier: BSD-3-Clause
"""Scenes: read, build, change, run."""
from __future__ import annotations

import copy
import os
import re
import shlex
import tempfile
import tomllib
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

from .check import Check
from . import keys
from .errors import FileError, briefly
from .files import read_text
from .program import Job, Progress, call
from .run import Run
from .soil import SoilTest
from .sweep import Sweep
from .toml import document_text, key_text, value_text

_NEXT = re.compile(r"((?:resume|start again) with: )")  # before a command in a message of the program
_MARK = "# Written by the Python package grouser, which may write it anew."

Tell = Callable[[Progress], None] | None


def _path_of(key: str) -> list[str]:
    """["contact", "clay|loam", "friction"] from 'contact."clay|loam".friction'. KeyError if it is not a key."""
    path: list[str] = []
    try:
        table: Any = tomllib.loads(f"{key} = 0")
        while isinstance(table, dict):
            (name, table), = table.items()
            path.append(name)
    except ValueError:
        raise KeyError(f"{key!r} is not a key: expected words separated by dots; quote words with characters other "
                       "than letters, digits, _ and -") from None
    return path


class Scene:
    """A scene as a TOML document: `scene["run.duration"] = 0.5`. docs/keys.md lists all keys. Setting an unknown key
    raises KeyError; the program checks the values when the scene is run, planned or checked.

    document: nested dicts, as read by tomllib; default: an empty scene of version 1. folder: base of relative paths in
    the scene. name: name of the scene in messages. KeyError for unknown keys.
    """

    def __init__(self, document: Mapping[str, Any] | None = None, folder: str | os.PathLike = ".", name: str = "scene"):
        self.document: dict[str, Any] = copy.deepcopy(dict(document)) if document else {"version": 1}
        self.folder: Path = Path(folder).resolve()
        self.name = name
        self._called = "scene" if name == "scene" else f"scene {name}"  # in messages
        for key, value in (document or {}).items():
            keys.check([key], value)

    def __repr__(self) -> str:
        return f"<grouser.Scene {self._called}: {', '.join(self.document)}>"

    @classmethod
    def read(cls, file: str | os.PathLike) -> Scene:
        """Reads a scene file without its comments. FileError if the file cannot be read or is not TOML."""
        file = Path(file)
        try:
            document = tomllib.loads(read_text(file, "utf-8-sig"))
        except OSError as error:
            raise FileError(f"{file}: cannot be read: {error.strerror}") from error
        except UnicodeDecodeError as error:
            raise FileError(f"{file}: not UTF-8 text; save it as UTF-8") from error
        except ValueError as error:
            raise FileError(f"{file}: {error}") from error
        scene = cls(None, file.parent, file.stem)
        scene.document, scene._called = document, str(file)
        return scene

    def copy(self) -> Scene:
        other = Scene(None, self.folder, self.name)
        other.document, other._called = copy.deepcopy(self.document), self._called
        return other

    def __getitem__(self, key: str) -> Any:
        """The value of "section.key", or a whole section. KeyError if the scene does not set this key; defaults are in
        `Run.scene`."""
        table: Any = self.document
        for word in _path_of(key):
            if not isinstance(table, dict) or word not in table:
                raise KeyError(key)
            table = table[word]
        return table

    @briefly
    def __setitem__(self, key: str, value: Any) -> None:
        """Sets the value of "section.key"; a dict sets a whole section. KeyError for an unknown key, or if a part of
        the path is not a section. For lists ([[grains]], [[plane]]...), use `add()` and `scene["grains"][0]`."""
        *sections, last = path = _path_of(key)
        table: Any = self.document
        for k, word in enumerate(sections):  # report a wrong section before a wrong key
            table = _section(table.get(word, {}), sections[:k + 1], key)
        keys.check(path, value)
        table = self.document
        for word in sections:
            table = table.setdefault(word, {})
        table[last] = copy.deepcopy(value)

    def __delitem__(self, key: str) -> None:
        """Removes a key or a section. KeyError if the scene does not contain it."""
        *sections, last = _path_of(key)
        table = self.document
        for k, word in enumerate(sections):
            if word not in table:
                raise KeyError(key)
            table = _section(table[word], sections[:k + 1], key)
        if last not in table:
            raise KeyError(key)
        del table[last]

    def __contains__(self, key: str) -> bool:
        try:
            self[key]
        except KeyError:
            return False
        return True

    @briefly
    def add(self, section: str, **values: Any) -> Scene:
        """Appends a section to a list: `scene.add("plane", material="glass")`. Returns the scene. KeyError for an
        unknown key."""
        keys.check([section], values)
        self.document.setdefault(section, []).append(copy.deepcopy(values))
        return self

    def text(self) -> str:
        """The scene as TOML."""
        return document_text(self.document)

    def write(self, file: str | os.PathLike) -> Path:
        """Writes a scene file; creates missing folders. Returns its path."""
        file = Path(file)
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(self.text(), encoding="utf-8")
        return file

    # These methods write the scene to OUT.toml, next to the results folder OUT. Messages contain the name of the scene.

    @briefly
    def start(self, out: str | os.PathLike, *, force: bool = False, resume: bool | str | os.PathLike = False,
              until: str = "", device: str = "", threads: int | None = None, hash: bool = False, cache: bool = True,
              progress: Tell = None, environment: dict[str, str] | None = None) -> Job:
        """Starts `grouser run` and returns at once; `Run(out)` opens the results so far.

        out: folder of the results. force: overwrite this folder. resume: True continues from its checkpoint; a path
        branches from the checkpoint of another run. until: "rest" ends the run before the vehicle drives. device:
        "auto", "cpu" or "cuda"; threads: number of CPU threads, 0: all; defaults: as in the scene. hash: print the hash
        of the final state. cache: reuse settled beds and mesh spheres. progress: callback(Progress), called from
        another thread. environment: additional environment variables.
        """
        words = [flag for flag, given in (("--force", force), ("--hash", hash), ("--no-cache", not cache)) if given]
        words += _with_file("--resume", resume) + (["--until", until] if until else [])
        return self._started("run", out, words + _options(device, threads), progress, environment)

    @briefly
    def run(self, out: str | os.PathLike, **options: Any) -> Run:
        """Runs the scene to the end and opens the results. Options: see `start()`; exceptions: see `Job.wait()`."""
        self.start(out, **options).wait()
        return Run(out)

    @briefly
    def plan(self, *, probe: bool = False) -> str:
        """Returns the output of `grouser plan`: active features, size, time step; with `probe` also the estimated run
        time. InputError for an invalid scene. Leaves no files."""
        with tempfile.TemporaryDirectory() as folder:
            file = self.write(Path(folder) / f"{self.name}.toml")
            words: list[str | os.PathLike] = ["plan", file, *([] if probe else ["--no-probe"])]
            return self._worded(Job(words, self.folder, worded=lambda text: self._worded(text, file)).wait(), file)

    def _worded(self, text: str, file: Path) -> str:
        """A message of the program, with the name of the scene instead of the scene file and line. The command that
        resumes a stopped program keeps the scene file, and starts in the folder in which the program ran."""
        words, *command = _NEXT.split(text, maxsplit=1)
        words = re.sub(re.escape(str(file)) + r"(:\d+)*", lambda _: self._called, words)
        return words + f"cd {shlex.quote(str(self.folder))} && ".join(command)

    @briefly
    def sweep(self, out: str | os.PathLike, values: Mapping[str, Iterable[Any]] | None = None, *, seeds: int = 0,
              cases: Mapping[str, Mapping[str, Any]] | None = None, jobs: int = 1, force: bool = False,
              from_checkpoint: bool | str | os.PathLike = False, device: str = "", threads: int | None = None,
              progress: Tell = None, environment: dict[str, str] | None = None) -> Sweep:
        """Runs `grouser sweep` over all combinations of values and cases; continues an interrupted sweep.

        values: {key: values}, e.g. {"driver.sprocket_speed": [0.5, 1, 2]}; a string or number is a single value. cases:
        {name: {key: value}}, keys that change together. seeds: run.seed from 1 to `seeds` for each combination. jobs:
        number of parallel runs. from_checkpoint: checkpoint from which all runs branch; True: they branch from a common
        run that ends when the vehicle is at rest. SimulationError names the failed runs; `Sweep(out)` opens the others.
        """
        words = ["--jobs", str(jobs)]
        for key, several in (values or {}).items():
            words += ["--set", f"{key}=" + ",".join(map(_word, _several(several)))]
        for name, keys in (cases or {}).items():
            words += ["--case", name + (": " if keys else "") + ", ".join(f"{k}={_word(v)}" for k, v in keys.items())]
        words += ["--seeds", str(seeds)] if seeds else []
        words += (["--force"] if force else []) + _with_file("--from-checkpoint", from_checkpoint)
        words += _options(device, threads)
        self._started("sweep", out, words, progress, environment).wait()
        return Sweep(out)

    @briefly
    def check(self, out: str | os.PathLike, *, axes: Iterable[str] = (), seeds: int = 8, budget: str = "",
              jobs: int = 1, draws: int = 0, force: bool = False, device: str = "", threads: int | None = None, progress: Tell = None,
              environment: dict[str, str] | None = None) -> Check:
        """Runs `grouser check`, which computes error bars for all figures; continues an interrupted check.

        axes: axes to vary (["step", "grain_size"], or a single string); empty: all. seeds: number of seeds per case.
        budget: limit of the computing time ("90s", "20min", "1.5h"); empty: unlimited. draws: number of samples of the
        constants of deformable soil.
        """
        words = ["--jobs", str(jobs), "--seeds", str(seeds)] + (["--draws", str(draws)] if draws else [])
        axes = axes if isinstance(axes, str) else ",".join(axes)
        words += (["--axes", axes] if axes else []) + (["--budget", budget] if budget else [])
        words += (["--force"] if force else []) + _options(device, threads)
        self._started("check", out, words, progress, environment).wait()
        return Check(out)

    def _started(self, command: str, out: str | os.PathLike, words: list[str], progress: Tell,
                 environment: dict[str, str] | None) -> Job:
        """Writes the scene file and starts the command. If the program rejects the call, a folder of existing results
        keeps its previous scene file."""
        out = Path(out).resolve()
        file = out.parent / f"{out.name}.toml"
        before = _own_text(file)
        there = before is not None or out.exists()
        text = f"{_MARK}\n{self.text()}"
        file.parent.mkdir(parents=True, exist_ok=True)
        _put(file, text)

        def put_back() -> None:
            if before is not None:
                _put(file, before)
            elif there:
                file.unlink(missing_ok=True)

        try:
            return Job([command, file, "--out", out, *words], self.folder, progress, environment, put_back,
                       lambda text: self._worded(text, file))
        except BaseException:
            put_back()
            raise


def _with_file(option: str, given: bool | str | os.PathLike) -> list[str]:
    """Arguments of an option with an optional file."""
    if not given:
        return []
    return [option] if given is True else [option, str(Path(given).resolve())]


def _own_text(file: Path) -> str | None:
    """Text of a scene file written by this package; None if the file does not exist. FileError for other files."""
    try:
        text = file.read_text(encoding="utf-8")
    except FileNotFoundError:
        return None
    except (OSError, UnicodeDecodeError):
        text = ""
    if not text.startswith(_MARK):
        raise FileError(f"{file} exists and was not written by this package: choose another `out`, or move the "
                        "file")
    return text


def _put(file: Path, text: str) -> None:
    """Writes a file atomically: writes a temporary file, then renames it."""
    new = file.with_name(f".{file.name}.{os.getpid()}")
    try:
        new.write_text(text, encoding="utf-8")
        new.replace(file)
    finally:
        new.unlink(missing_ok=True)


@briefly
def measure_soil(soil: str | os.PathLike, out: str | os.PathLike, options: Iterable[str] = (), *, progress: Tell = None,
                 environment: dict[str, str] | None = None) -> SoilTest:
    """Runs `grouser soil`, which measures the constants of a soil given by name or by a .toml file. options: further
    arguments, such as ["--quick", "--jobs", "2"]. SimulationError if a test is invalid; `SoilTest(out)` opens the
    others."""
    call(["soil", soil, "--out", out, *options], None, progress, environment)
    return SoilTest(out)


def _section(table: Any, path: list[str], key: str) -> dict[str, Any]:
    if isinstance(table, dict):
        return table
    name = ".".join(map(key_text, path))
    raise KeyError(f"{key}: {name} is not a section" +
                   (f"; change a list by scene[{name!r}][0][...]" if isinstance(table, list) else f", but {table!r}"))


def _several(values: Any) -> Iterable[Any]:
    """Values as an iterable; a string is a single value, not a sequence."""
    return values if isinstance(values, Iterable) and not isinstance(values, (str, bytes)) else [values]


def _word(value: Any) -> str:
    """A value as a word of the command line; strings with commas are quoted."""
    if isinstance(value, str):
        return value_text(value) if "," in value else value
    return value_text(value)


def _options(device: str, threads: int | None) -> list[str]:
    return (["--device", device] if device else []) + ([] if threads is None else ["--threads", str(threads)])
