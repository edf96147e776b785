# SPDX-License-Identifier: BSD-3-Clause
"""Soil fields on a grid, from frames.h5."""
from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy

from .files import fields_of, read
from .series import Quantity, no_values

#: Fields in frames of scenes with output.fields_cell: name, (unit, shape of a cell's value, definition).
FIELDS = {"stress": ("Pa", (3, 3), "mean stress in a cell (Love-Weber), negative in compression"),
          "strain_rate": ("1/s", (3, 3), "symmetric part of the velocity gradient; NaN with too few grains"),
          "velocity": ("m/s", (3,), "mass-weighted mean velocity of the grains; NaN without grains"),
          "porosity": ("-", (), "pore volume / total volume"),
          "coordination": ("-", (), "mean number of contacts per grain; NaN without grains"),
          "mechanical_coordination": ("-", (), "mean number of contacts of grains with two or more contacts")}
#: Index of the stored component (xx, xy, xz, yy, yz, zz) for each element of a tensor.
_PLACES = numpy.array([[0, 1, 2], [1, 3, 4], [2, 4, 5]])


@dataclass(frozen=True, eq=False, repr=False)
class Field(Quantity):
    """A soil field over time: `value` has the shape [frames, z, y, x], for vectors [..., 3], for tensors [..., 3, 3].
    The centre of cell [k, j, i] is (x[i], y[j], z[k])."""

    time: numpy.ndarray = field(default_factory=no_values)  #: [frames] [s]
    x: numpy.ndarray = field(default_factory=no_values)  #: [nx] centres of the cells along x [m]
    y: numpy.ndarray = field(default_factory=no_values)  #: [ny] centres of the cells along y [m]
    z: numpy.ndarray = field(default_factory=no_values)  #: [nz] centres of the cells along z [m]
    origin: numpy.ndarray = field(default_factory=no_values)  #: [3] lower corner of the grid [m]
    spacing: numpy.ndarray = field(default_factory=no_values)  #: [3] edge lengths of a cell [m]

    @property
    def cell_volume(self) -> float:
        """Volume of a cell [m3]."""
        return float(numpy.prod(self.spacing))


def field_of(groups: list, time: numpy.ndarray, name: str, where: Path) -> Field:
    """Reads a field. `groups`: fields of each frame, None for a frame without fields. KeyError if no frame has the
    field; ValueError if the grids of the frames differ."""
    if name not in FIELDS:
        raise KeyError(f"no field {name!r}; fields are {', '.join(FIELDS)}")
    kept = [place for place, group in enumerate(groups) if group is not None]
    if not kept:
        raise KeyError(f"{where}: no soil fields; set output.fields_cell in the scene")
    with fields_of(where, "the frames of a run"):
        grids = [(read(groups[place]["origin"], where), read(groups[place]["spacing"], where),
                  groups[place]["porosity"].shape) for place in kept]
        values = [read(groups[place][name], where) for place in kept]
    origin, spacing, cells = grids[0]
    for place, (low, edges, shape) in zip(kept, grids, strict=True):
        if shape != cells or not numpy.array_equal(low, origin) or not numpy.array_equal(edges, spacing):
            raise ValueError(f"{where}: frames {kept[0]} and {place} have different grids; read single frames: "
                             "run.frames[n].field(name)")
    unit, shape, about = FIELDS[name]
    value = numpy.stack(values)
    if shape == (3, 3):
        value = value[..., _PLACES]
    x, y, z = (origin[a] + spacing[a] * (numpy.arange(cells[2 - a]) + 0.5) for a in range(3))
    return Field(value, unit, about, name, time[kept], x, y, z, origin, spacing)
