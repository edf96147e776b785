# SPDX-License-Identifier: BSD-3-Clause
"""Fields of the soil on a grid, from frames.h5."""
from __future__ import annotations

from dataclasses import dataclass

import numpy

from .series import Quantity

#: Fields that frames hold where the scene has output.fields_cell: name, (unit, shape of a cell's value, what it is).
FIELDS = {"stress": ("Pa", (3, 3), "mean stress of a cell (Love-Weber), negative in compression"),
          "strain_rate": ("1/s", (3, 3), "symmetric gradient of the velocity; NaN where grains are too few"),
          "velocity": ("m/s", (3,), "mean of the grains, weighted with mass; NaN without grains"),
          "porosity": ("-", (), "pores over volume"),
          "coordination": ("-", (), "contacts of a grain, mean; NaN without grains"),
          "mechanical_coordination": ("-", (), "contacts of a grain that has two or more, mean")}
#: Where xx, xy, xz, yy, yz, zz stand in a tensor.
_PLACES = numpy.array([[0, 1, 2], [1, 3, 4], [2, 4, 5]])


@dataclass(frozen=True, eq=False, repr=False)
class Field(Quantity):
    """A field of the soil over time: `value` has the shape [frames, z, y, x], of vectors [..., 3], of tensors
    [..., 3, 3]. The cell [k, j, i] has its centre at (x[i], y[j], z[k])."""

    time: numpy.ndarray = None  #: [frames] [s]
    x: numpy.ndarray = None  #: [nx] centres of the cells [m]
    y: numpy.ndarray = None  #: [ny] the same along y
    z: numpy.ndarray = None  #: [nz] the same along z
    origin: numpy.ndarray = None  #: [3] lower corner of the box of cells [m]
    spacing: numpy.ndarray = None  #: [3] edges of a cell [m]

    @property
    def cell_volume(self) -> float:
        """[m3]"""
        return float(numpy.prod(self.spacing))


def field_of(groups: list, time: numpy.ndarray, name: str, where: object) -> Field:
    """`groups`: fields of each frame, None where it has none. KeyError where there is no such field in any; ValueError
    where frames have different grids."""
    if name not in FIELDS:
        raise KeyError(f"there is no field {name!r}; fields are {', '.join(FIELDS)}")
    kept = [place for place, group in enumerate(groups) if group is not None]
    if not kept:
        raise KeyError(f"{where}: has no fields of the soil; set output.fields_cell in the scene")
    first = groups[kept[0]]
    origin, spacing = first["origin"][:], first["spacing"][:]
    for place in kept:
        group = groups[place]
        if (group["porosity"].shape != first["porosity"].shape or not numpy.array_equal(group["origin"][:], origin)
                or not numpy.array_equal(group["spacing"][:], spacing)):
            raise ValueError(f"{where}: frames {kept[0]} and {place} have different grids of fields; read them one by one: "
                             "run.frames[n].field(name)")
    unit, shape, about = FIELDS[name]
    value = numpy.stack([groups[place][name][:] for place in kept])
    if shape == (3, 3):
        value = value[..., _PLACES]
    x, y, z = (origin[a] + spacing[a] * (numpy.arange(first["porosity"].shape[2 - a]) + 0.5) for a in range(3))
    return Field(value, unit, about, name, time[kept], x, y, z, origin, spacing)
