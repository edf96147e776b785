# SPDX-License-Identifier: BSD-3-Clause
"""Grains and parts over time, from frames.h5."""
from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import AbstractContextManager
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import overload

import h5py
import numpy

from .errors import FileError
from .fields import Field, field_of
from .files import fields_of, long_text, open_file, read, require, still_open, text_of
from .series import Brief, Series, counted, nearest

#: Units of grain quantities in frames.
UNITS = {"id": "-", "position": "m", "radius": "m", "speed": "m/s", "velocity": "m/s", "contact_force": "N",
         "fixed": "-"}


@dataclass(frozen=True, eq=False, repr=False)
class Mesh(Brief):
    """Triangle mesh of the parts or of the ground."""

    vertices: numpy.ndarray  #: [v, 3] in the world [m]
    triangles: numpy.ndarray  #: [t, 3] indices of the vertices
    part: numpy.ndarray | None  #: [t] index in Frames.parts; None for the ground


class Frame:
    """One frame. Data are read on access; `frame.position` etc. have one row per grain, in the order of `frame.id`."""

    def __init__(self, frames: Frames, place: int):
        self._frames, self._name = frames, frames._names[place]
        self.time: float = float(frames.time[place])  #: [s]
        self.step: int = int(frames.step[place])

    def __repr__(self) -> str:
        return f"<grouser.Frame t = {self.time:.6g} s, step {self.step}>"

    @property
    def _group(self) -> h5py.Group:
        opened = self._frames._file
        with self._frames._whole():
            return opened[self._name]

    def _read(self, name: str) -> numpy.ndarray | None:
        """A dataset of this frame; None if the frame lacks it."""
        group = self._group
        with self._frames._whole():
            return read(group[name], self._frames.path) if name in group else None

    def _required(self, name: str) -> numpy.ndarray:
        """A dataset that each frame of this kind has. FileError if it is missing."""
        values = self._read(name)
        require(values is not None, self._frames.path, f"/{self._name}/{name}")
        assert values is not None
        return values

    def __len__(self) -> int:
        """Number of grains."""
        group = self._group
        with self._frames._whole():
            return len(group["grains/id"]) if "grains" in group else 0

    def grains(self, name: str) -> numpy.ndarray:
        """A quantity of all grains, [n] or [n, 3]. name: a key of `grouser.UNITS`. KeyError if not in the frame."""
        path, group = self._frames.path, self._group
        with self._frames._whole():
            names = list(group["grains"]) if "grains" in group else []
        if not names:
            raise KeyError(f"{path}: this frame has no grains")
        if name not in names:
            raise KeyError(f"{path}: no grain quantity {name!r}; available: {', '.join(names)}")
        values = self._required(f"grains/{name}")
        place = f"/{self._name}/grains/{name}"
        require(len(values) == len(self), path, place)
        if name == "radius":
            require(bool(numpy.all((values > 0) & (values <= 1e7))), path, place)
        return values

    @property
    def id(self) -> numpy.ndarray:
        """[n] id of each grain, constant during the run."""
        return self.grains("id")

    @property
    def position(self) -> numpy.ndarray:
        """[n, 3] [m]"""
        return self.grains("position")

    @property
    def radius(self) -> numpy.ndarray:
        """[n] [m]"""
        return self.grains("radius")

    @property
    def velocity(self) -> numpy.ndarray:
        """[n, 3] [m/s]"""
        return self.grains("velocity")

    @property
    def contact_force(self) -> numpy.ndarray:
        """[n, 3] resultant contact force on each grain [N]; NaN in the first frame. KeyError if not in the frame."""
        return self.grains("contact_force")

    @property
    def has_fields(self) -> bool:
        """True if this frame has soil fields."""
        return "fields" in self._group

    def field(self, name: str) -> Field:
        """A soil field in this frame, with one row; see Frames.fields()."""
        group = self._group
        return field_of([group.get("fields")], numpy.array([self.time]), name, self._frames.path)

    def soil(self, name: str) -> numpy.ndarray:
        """Deformable soil in this frame: "position" [v, 3] [m] and "triangles" [t, 3]; at the vertices "sinkage" [m],
        "pressure", "max_pressure", "shear" [v] and "shear_vector" [v, 3] [Pa]. KeyError for a scene without it."""
        values = self._read(f"soil/{name}")
        if values is None:
            raise KeyError(f"{self._frames.path}: this frame has no {name!r} of deformable soil")
        if name == "triangles":
            self._frames._check(values, len(self._required("soil/position")), f"/{self._name}/soil/triangles")
        return values

    @property
    def poses(self) -> numpy.ndarray:
        """[parts, 7] position [m] and orientation (quaternion, scalar first) of the reference frame of each part in the
        world, in the order of Frames.parts."""
        poses = self._read("parts/pose")
        return numpy.empty((0, 7)) if poses is None else poses

    def pose(self, part: str) -> tuple[numpy.ndarray, numpy.ndarray]:
        """Position [3] [m] and rotation [3, 3] of a part: world = position + rotation @ p for a point p in the part's
        reference frame."""
        row = self.poses[self._frames.place_of(part)]
        return row[:3], rotation(row[3:])

    @property
    def parts(self) -> Mesh:
        """Triangle meshes of the parts."""
        vertices = self._read("parts/position")
        with self._frames._whole():
            if vertices is None:
                raise KeyError("parts/position")
            return Mesh(vertices, *self._frames._triangles(len(vertices)))


def rotation(quaternion: numpy.ndarray) -> numpy.ndarray:
    """Rotation matrices [..., 3, 3], part to world frame, from quaternions [..., 4], scalar first."""
    w, x, y, z = numpy.moveaxis(numpy.asarray(quaternion, dtype=float), -1, 0)
    rows = [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]
    return numpy.moveaxis(numpy.array(rows), (0, 1), (-2, -1))


#: Groups of frames.h5 that are not frames.
_BESIDE = {"ground", "parts", "vertices"}


class Frames:
    """All frames of a run: `len(frames)`, `frames[0]`, `frames[2:5]`, `for frame in frames`."""

    def __init__(self, path: str | os.PathLike):
        path = Path(path)
        path = path / "frames.h5" if path.is_dir() else path
        try:
            self._opened = open_file(path)
        except OSError as error:
            raise FileError(f"{path}: cannot be read as the frames of a run: {error}") from error
        self.path: Path = path
        with self._whole():
            self._names = sorted(name for name in self._opened if name.isdigit())
            beside = set(self._opened) - _BESIDE
        if not self._names and beside:
            self._opened.close()
            raise FileError(f"{path}: no frames; not the frames.h5 of a run")
        with self._whole():
            attributes = [self._opened[name].attrs for name in self._names]
            self.time = numpy.array([one["time"] for one in attributes])  #: [frames] [s]
            self.step = numpy.array([one["step"] for one in attributes], dtype=int)  #: [frames]

    def __repr__(self) -> str:
        return f"<grouser.Frames {self.path}: {counted(len(self), 'frame')}>"

    def close(self) -> None:
        self._opened.close()

    @property
    def _file(self) -> h5py.File:
        return still_open(self._opened, self.path)

    def _whole(self) -> AbstractContextManager[None]:
        """Context that reads from the file: FileError if it is damaged."""
        return fields_of(self.path, "the frames of a run")

    def _check(self, triangles: numpy.ndarray, vertices: int, place: str) -> None:
        require(triangles.ndim == 2 and triangles.shape[1] == 3 and bool(numpy.all(triangles < vertices)), self.path,
                place)

    def _triangles(self, vertices: int) -> tuple[numpy.ndarray, numpy.ndarray]:
        """Triangles of the parts, and the part of each triangle."""
        triangles, part = (read(self._file["parts"][name], self.path) for name in ("triangles", "part"))
        self._check(triangles, vertices, "/parts/triangles")
        require(part.shape == triangles.shape[:1] and bool(numpy.all(part < len(self.parts))), self.path, "/parts/part")
        return triangles, part

    def __len__(self) -> int:
        return len(self._names)

    @overload
    def __getitem__(self, index: int) -> Frame: ...

    @overload
    def __getitem__(self, index: slice) -> list[Frame]: ...

    def __getitem__(self, index: int | slice) -> Frame | list[Frame]:
        """A frame, or for a slice a list of frames. IndexError if out of range."""
        if isinstance(index, slice):
            return [self[i] for i in range(*index.indices(len(self)))]
        if not -len(self) <= index < len(self):
            raise IndexError(f"{self.path}: has {counted(len(self), 'frame')}, 0 to {len(self) - 1}; no frame "
                             f"{index}")
        return Frame(self, index)

    def __iter__(self) -> Iterator[Frame]:
        return (self[i] for i in range(len(self)))

    def at(self, time: float) -> Frame:
        """The frame nearest to `time` [s]. ValueError if there is no frame, or if `time` is more than one interval
        before the first or after the last."""
        return self[nearest(self.time, time, "frames", str(self.path))]

    @cached_property
    def parts(self) -> list[str]:
        """Names of the rigid parts: "chassis", "left shoe 12"."""
        opened = self._file
        with self._whole():
            return [text_of(name) for name in long_text(opened["parts/part"], "names")] if "parts/part" in opened else []

    def place_of(self, part: str) -> int:
        """Index of a part in `parts`. KeyError, with examples of names, for an unknown part."""
        if part not in self.parts:
            raise KeyError(f"no part {part!r}; parts are {', '.join(self.parts[:6])}...")
        return self.parts.index(part)

    def part(self, name: str) -> Series:
        """Motion of a part: [frames, 7] position [m] and orientation (quaternion, scalar first); see Frame.poses."""
        place = self.place_of(name)
        opened = self._file
        with self._whole():
            poses = numpy.array([read(opened[frame]["parts/pose"], self.path)[place] for frame in self._names])
        return Series(poses, "m, -", "position and orientation of a part", name, self.time, self.step,
                      ("x", "y", "z", "qw", "qx", "qy", "qz"))

    def grain(self, id: int, name: str = "position") -> Series:
        """A quantity of one grain over time: [frames] or [frames, 3]; NaN in frames without the grain. KeyError if no
        frame contains the grain."""
        rows: list[numpy.ndarray | None] = []
        for frame in self:
            at = numpy.flatnonzero(frame.id == id) if len(frame) else numpy.empty(0, int)
            rows.append(frame.grains(name)[at[0]] if len(at) else None)
        there = next((row for row in rows if row is not None), None)
        if there is None:
            raise KeyError(f"{self.path}: no frame contains grain {id}")
        values = numpy.array([numpy.full_like(there, numpy.nan, dtype=float) if row is None else row for row in rows])
        return Series(values, UNITS.get(name, ""), "", f"grain {id} {name}", self.time, self.step,
                      ("x", "y", "z") if values.ndim == 2 else ())

    def fields(self, name: str) -> Field:
        """A soil field over time: "stress", "strain_rate", "velocity", "porosity", "coordination" or
        "mechanical_coordination": [frames, z, y, x], for vectors [..., 3], for tensors [..., 3, 3]. KeyError for an
        unknown field or a scene without output.fields_cell; ValueError if the grids of the frames differ."""
        return field_of([self._file[frame].get("fields") for frame in self._names], self.time, name, self.path)

    @property
    def ground(self) -> Mesh | None:
        """Triangle mesh of rigid ground; None for a scene without rigid ground."""
        opened = self._file
        with self._whole():
            if "ground" not in opened:
                return None
            vertices, triangles = (read(opened["ground"][name], self.path) for name in ("position", "triangles"))
            self._check(triangles, len(vertices), "/ground/triangles")
            return Mesh(vertices, triangles, None)


def open_frames(path: str | os.PathLike) -> Frames:
    """Opens frames.h5: path of the file or of a run's folder. FileError if the file cannot be read."""
    return Frames(path)
