# SPDX-License-Identifier: BSD-3-Clause
"""Grains at rest: a settled bed that the program has kept, or the checkpoint of a run."""
from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

import h5py
import numpy

from .errors import FileError
from .files import fields_of
from .series import Brief, Quantity

_TOP_BITS, _LOW_BITS = 10, 32  # of a coordinate of 42: base/position.hpp


def metres_of(words: numpy.ndarray, unit: float) -> numpy.ndarray:
    """[n, 3] [m] of integer positions [n, 4]: the low 32 bits of x, y and z, then three times 10 high bits; `unit`
    [m]."""
    low, high = words[:, :3].astype(numpy.int64), words[:, 3].astype(numpy.int64)
    top = numpy.stack([high >> (_TOP_BITS * axis) for axis in range(3)], axis=1) & (1 << _TOP_BITS) - 1
    top -= (top >> (_TOP_BITS - 1)) << _TOP_BITS  # the highest bit is the sign
    return ((top << _LOW_BITS) + low) * unit


@dataclass(frozen=True, eq=False, repr=False)
class Bed(Brief):
    """Grains by id. Fixed grains, those of a rough floor, are among them."""

    file: Path
    position: numpy.ndarray  #: [n, 3] [m]
    velocity: numpy.ndarray  #: [n, 3] [m/s]
    spin: numpy.ndarray  #: [n, 3] [rad/s]
    radius: numpy.ndarray  #: [n] [m]
    material: numpy.ndarray  #: [n] place among the scene's materials of grains; 0 where there is one
    fixed: numpy.ndarray  #: [n] True for grains that never move
    contacts: numpy.ndarray  #: [n] other grains that each touches
    time_step: float  #: [s]
    settled: dict[str, Quantity]  #: how it came to rest: time [s], steps, agitation, friction, highest, mean_height [m]
    structure: dict[str, Quantity]  #: what it is made of (porosity, coordination...); {} where that was not measured
    scene: str  #: TOML of a run; of a kept bed what it was made of
    commit: str

    def __len__(self) -> int:
        return len(self.position)

    def volume(self) -> float:
        """Of all grains together [m3]."""
        return float(numpy.sum(self.radius**3) * 4 / 3 * numpy.pi)


#: Units of what a checkpoint says of a bed.
_UNITS = {"time": "s", "highest": "m", "lowest": "m", "mean_height": "m", "mean_diameter": "m", "settled_height": "m",
          "thickness": "m", "depth": "m", "distance": "mean diameters"}


def _quantities(group: h5py.Group | None) -> dict[str, Quantity]:
    found: dict[str, Quantity] = {}
    for name in group or ():
        value = group[name][:, 0]
        found[name] = Quantity(value[0] if len(value) == 1 else value, _UNITS.get(name, "-"), "", name)
    return found


def open_bed(path: str | os.PathLike) -> Bed:
    """Opens a settled bed that was kept (bed-*.h5 in the cache, which a run names in its line "bed"), a checkpoint.h5,
    or that of a run's folder. FileError where it is none, or is of a program that did not tell the length of a unit."""
    path = Path(path)
    path = path / "checkpoint.h5" if path.is_dir() else path
    try:
        file = h5py.File(path, "r", locking=False)
    except OSError as error:
        raise FileError(f"{path}: cannot be read as a checkpoint or a kept bed: {error}") from error
    with file, fields_of(path, "a checkpoint or a kept bed"):
        if "grains" not in file or "settled" not in file:
            raise FileError(f"{path}: holds no grains")
        grains = file["grains"]
        if "unit" not in grains.attrs:
            raise FileError(f"{path}: does not say what its positions count in: it is of before; make it anew")

        def column(name: str, missing: float) -> numpy.ndarray:
            values = grains[name][:, 0]
            return values if len(values) else numpy.full(n, missing)

        n = len(grains["position"])
        return Bed(path, metres_of(grains["position"][:], float(grains.attrs["unit"])), grains["velocity"][:],
                   grains["spin"][:], column("radius", float(grains.attrs["radius"])),
                   column("material", 0).astype(int), column("fixed", 0) != 0, grains["contacts"][:, 0],
                   float(file["time_step"][0, 0]), _quantities(file["settled"]), _quantities(file.get("bed")),
                   str(file.attrs["scene"]), str(file.attrs["commit"]))


def kept_beds(folder: str | os.PathLike | None = None) -> list[Path]:
    """Files of the settled beds that are kept, those used last first: in `folder`, else where the program keeps them
    (GROUSER_CACHE, else XDG_CACHE_HOME/grouser, else ~/.cache/grouser)."""
    if folder is None:
        named = os.environ.get("GROUSER_CACHE")
        if named == "":
            return []
        folder = named or Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "grouser"
    return sorted(Path(folder).glob("bed-*.h5"), key=lambda file: -file.stat().st_mtime)
