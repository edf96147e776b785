# SPDX-License-Identifier: BSD-3-Clause
"""The results of a run."""
from __future__ import annotations

import os
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import h5py
import numpy

from .bed import Bed, open_bed
from .errors import FileError
from .fields import Field
from .files import CHECKSUM, fields_of, long_text, open_file, read, read_json, require, still_open, text_of
from .frames import Frames
from .series import Brief, Quantity, Series, counted

SIDES = ("left", "right")


@dataclass(frozen=True, eq=False, repr=False)
class Surface(Brief):
    """Surface of the bed on a grid of nodes: undisturbed (before the vehicle touches the bed) and final. Ruts are where
    `surface.final_height - surface.height` is negative."""

    x: numpy.ndarray  #: [columns] x of the nodes [m]
    y: numpy.ndarray  #: [rows] y of the nodes [m]
    height: numpy.ndarray  #: [rows, columns] undisturbed height at (x[column], y[row]) [m]
    interpolation: str  #: between nodes: "bilinear", "Catmull-Rom" or "monotone"
    final_height: numpy.ndarray | None = None  #: [rows, columns] height at the end of the run [m]; None if not recorded
    #: (unfinished run, output.final_surface = false)


def quantity_of(dataset: h5py.Dataset, name: str, file: Path) -> Quantity:
    """A dataset with its unit and definition; a single number has the shape ()."""
    value = read(dataset, file)
    if value.shape == (1,):
        value = value[0]
    return Quantity(value, text_of(dataset.attrs.get("unit", "")), text_of(dataset.attrs.get("help", "")), name)


class Run:
    """The results in the folder of a run. Data are read on access. The folder of an unfinished run can be opened too;
    open it again to read newer rows.

    `run["vehicle.left.slip"]` is a Series; `run.names()` lists all series; `run.constants` contains the constants.
    """

    def __init__(self, path: str | os.PathLike):
        path = Path(path)
        self.folder: Path = path.parent if path.name == "results.h5" else path
        self.file: Path = self.folder / "results.h5"
        if not self.file.is_file():
            raise FileError(f"{self.folder}: no results.h5; specify the folder of a run")
        try:
            self._opened = open_file(self.file)
        except OSError as error:
            raise FileError(f"{self.file}: damaged or not an HDF5 file: {error}; run again or restore a copy") from error
        try:
            with fields_of(self.file, "the results of a run"):
                if "series/time" not in self._opened or "series/step" not in self._opened:
                    raise FileError(f"{self.file}: no series; not the results.h5 of a run")
                # The number of rows differs between quantities only if the program was killed while it wrote a row.
                self._rows = min(len(group["value"]) for group in self._groups.values()) if self._groups else 0
            steps = self.step
            require(bool(numpy.all(steps[1:] > steps[:-1])), self.file, "/series/step")
        except FileError:
            self._opened.close()
            raise

    def close(self) -> None:
        """Closes results.h5 and frames.h5."""
        frames: Frames | None = self.__dict__.get("frames")  # only if it was opened
        if self._opened and frames is not None:
            frames.close()
        self._opened.close()

    @property
    def _open(self) -> h5py.File:
        return still_open(self._opened, self.file)

    def __enter__(self) -> Run:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<grouser.Run {self.folder}: {self.status}, {counted(self._rows, 'row')} of {len(self._groups)} series>"

    @cached_property
    def _groups(self) -> dict[str, h5py.Group]:
        """{name with dots: group of step, time and value}"""
        groups: dict[str, h5py.Group] = {}

        def visit(path: str, item: h5py.Dataset | h5py.Group) -> None:
            if isinstance(item, h5py.Group) and "value" in item and "time" in item:
                groups[path.replace("/", ".")] = item

        self._open.visititems(visit)
        return groups

    def names(self, beginning: str = "") -> list[str]:
        """Names of all series, or of the series with a prefix: `run.names("vehicle.left.")`."""
        return [name for name in self._groups if name.startswith(beginning)]

    def __contains__(self, name: str) -> bool:
        return name.replace("/", ".") in self._groups

    def __iter__(self) -> Iterator[str]:
        return iter(self._groups)

    def __getitem__(self, name: str) -> Series:
        """A series by its name, with dots or slashes. KeyError if the run does not contain the series."""
        group = self._groups.get(name.replace("/", "."))
        if group is None:
            raise KeyError(f"{self.folder}: no series {name!r}; names() lists all {len(self._groups)}")
        time, step, rows = self.time, self.step, self._rows
        with fields_of(self.file, "the results of a run"):
            value = group["value"]
            return Series(read(value, self.file, slice(rows)), text_of(value.attrs["unit"]), text_of(value.attrs["help"]),
                          name.replace("/", "."), time, step,
                          tuple(text_of(label) for label in value.attrs.get("labels", ())))

    @property
    def time(self) -> numpy.ndarray:
        """[rows] [s]"""
        return self._rows_of("series/time")

    @property
    def step(self) -> numpy.ndarray:
        """[rows] step number [-]"""
        return self._rows_of("series/step")

    def _rows_of(self, name: str) -> numpy.ndarray:
        opened = self._open
        with fields_of(self.file, "the results of a run"):
            return read(opened[name], self.file, slice(self._rows))

    def by_shoe(self, name: str) -> dict[str, Series]:
        """{"left": ..., "right": ...}, each [rows, shoes], for a quantity with one value per shoe: "sinkage",
        "tension", "pad_height", "ground_pressure", "on_ground". KeyError for a run without a vehicle."""
        return {side: self[f"vehicle.{side}.{name}"] for side in SIDES}

    def sinkage(self) -> dict[str, Series]:
        """Sinkage of the shoes {"left": ..., "right": ...}, each [rows, shoes] [m]; NaN for shoes without ground
        contact. KeyError for a run without a vehicle."""
        return self.by_shoe("sinkage")

    @cached_property
    def constants(self) -> dict[str, Quantity]:
        """{name: Quantity} for all constants: "vehicle.mass", "terrain.bed.porosity"; including curves such as
        "terrain.bed.depth" [n]."""
        constants: dict[str, Quantity] = {}

        def visit(path: str, item: h5py.Dataset | h5py.Group) -> None:
            name = path.replace("/", ".")
            if isinstance(item, h5py.Dataset) and not path.startswith("series/") and \
                    name.rpartition(".")[0] not in self._groups:
                constants[name] = quantity_of(item, name, self.file)

        opened = self._open
        with fields_of(self.file, "the results of a run"):
            opened.visititems(visit)
        return constants

    @property
    def surface(self) -> Surface | None:
        """The undisturbed and the final surface; None for a run without a vehicle on a bed."""
        opened = self._open
        with fields_of(self.file, "the results of a run"):
            if "terrain/surface" not in opened:
                return None
            group = opened["terrain/surface"]
            x, y, height = (read(group[name], self.file) for name in ("x", "y", "height"))
            final = read(group["final_height"], self.file) if "final_height" in group else None
            require(all(h is None or h.shape == (len(y), len(x)) for h in (height, final)), self.file, group.name)
            return Surface(x, y, height, text_of(group["height"].attrs["interpolation"]), final)

    @cached_property
    def scene(self) -> dict:
        """The resolved scene: all keys with their values, as a dict (the contents of scene.toml)."""
        opened = self._open
        with fields_of(self.file, "the results of a run"):
            text = str(long_text(opened, "scene"))
            try:
                return tomllib.loads(text)
            except tomllib.TOMLDecodeError as error:
                raise FileError(f"{self.file}: the scene in it cannot be read: {error}") from error

    @cached_property
    def manifest(self) -> dict:
        """manifest.json: status, program, machine, times, figures, files; {} if missing."""
        file = self.folder / "manifest.json"
        return read_json(file, "the manifest of a run") if file.is_file() else {}

    @property
    def status(self) -> str:
        """"finished", "incomplete" (the vehicle never drove, or its tracks advanced by fewer than two sprocket teeth),
        "failed", "stopped" or "running"; "unknown" without a manifest."""
        return self.manifest.get("status", "unknown")

    @property
    def facts(self) -> dict[str, str | list[str]]:
        """Attributes of results.h5: version, commit, machine, state_hash, names of parts..."""
        opened = self._open
        with fields_of(self.file, "the results of a run"):
            values = {name: long_text(opened, name) for name in opened.attrs
                      if name != "scene" and not name.endswith(CHECKSUM)}
            return {name: value if isinstance(value, str) else [text_of(v) for v in value]
                    for name, value in values.items()}

    @cached_property
    def frames(self) -> Frames | None:
        """Grains and parts over time; None if the run wrote no frames."""
        self._open  # raises if the run is closed
        file = self.folder / "frames.h5"
        return Frames(file) if file.is_file() else None

    def fields(self, name: str) -> Field:
        """A soil field over time: see Frames.fields()."""
        if self.frames is None:
            raise KeyError(f"{self.folder}: no frames.h5, which contains the soil fields")
        return self.frames.fields(name)

    def bed(self) -> Bed:
        """The grains in the run's checkpoint. FileError if the run has no checkpoint."""
        return open_bed(self.folder)


def open_run(path: str | os.PathLike) -> Run:
    """Opens the results of a run: path of its folder or of results.h5. FileError if there are no results."""
    return Run(path)
