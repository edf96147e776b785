# SPDX-License-Identifier: BSD-3-Clause
"""Grains at rest: a settled bed from the cache, or the checkpoint of a run."""
from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

import h5py
import numpy

from .errors import FileError
from .files import fields_of, open_file
from .series import Brief, Quantity

_TOP_BITS, _LOW_BITS = 10, 32  # bits of a 42-bit coordinate: base/position.hpp


def metres_of(words: numpy.ndarray, unit: float) -> numpy.ndarray:
    """Positions [n, 3] [m] from integer positions [n, 4]: low 32 bits of x, y and z, then three times 10 high bits.
    `unit` [m]."""
    low, high = words[:, :3].astype(numpy.int64), words[:, 3].astype(numpy.int64)
    top = numpy.stack([high >> (_TOP_BITS * axis) for axis in range(3)], axis=1) & (1 << _TOP_BITS) - 1
    top -= (top >> (_TOP_BITS - 1)) << _TOP_BITS  # the highest bit is the sign
    return ((top << _LOW_BITS) + low) * unit


@dataclass(frozen=True, eq=False, repr=False)
class Bed(Brief):
    """Grains of a bed, sorted by id, including fixed grains (rough floor)."""

    file: Path
    position: numpy.ndarray  #: [n, 3] [m]
    velocity: numpy.ndarray  #: [n, 3] [m/s]
    spin: numpy.ndarray  #: [n, 3] [rad/s]
    radius: numpy.ndarray  #: [n] [m]
    material: numpy.ndarray  #: [n] index among the scene's grain materials
    fixed: numpy.ndarray  #: [n] True for grains that never move
    contacts: numpy.ndarray  #: [n] number of grains in contact
    time_step: float  #: [s]
    settled: dict[str, Quantity]  #: end of settling: time [s], steps, agitation (kinetic energy ratio), heights [m]
    structure: dict[str, Quantity]  #: porosity, coordination...; {} if not measured
    scene: str  #: TOML of the run, or the recipe of a cached bed
    commit: str

    def __len__(self) -> int:
        return len(self.position)

    def volume(self) -> float:
        """Total volume of the grains [m3]."""
        return float(numpy.sum(self.radius**3) * 4 / 3 * numpy.pi)


#: Units of the bed quantities in checkpoints.
_UNITS = {"time": "s", "highest": "m", "lowest": "m", "mean_height": "m", "mean_diameter": "m", "settled_height": "m",
          "thickness": "m", "depth": "m", "distance": "mean diameters"}


def _quantities(group: h5py.Group | None) -> dict[str, Quantity]:
    found: dict[str, Quantity] = {}
    for name, dataset in (group or {}).items():
        value = dataset[:, 0]
        found[name] = Quantity(value[0] if len(value) == 1 else value, _UNITS.get(name, "-"), "", name)
    return found


def open_bed(path: str | os.PathLike) -> Bed:
    """Opens a settled bed of the cache (bed-*.h5; a run prints its name in the line "bed"), a checkpoint.h5, or the
    checkpoint in a run's folder. FileError for other files, or if the file does not contain the unit of positions."""
    path = Path(path)
    path = path / "checkpoint.h5" if path.is_dir() else path
    try:
        file = open_file(path)
    except OSError as error:
        raise FileError(f"{path}: cannot be read as a checkpoint or cached bed: {error}") from error
    with file, fields_of(path, "a checkpoint or cached bed"):
        if "grains" not in file or "settled" not in file:
            raise FileError(f"{path}: contains no grains")
        grains = file["grains"]
        if "unit" not in grains.attrs:
            raise FileError(f"{path}: no unit of positions: an old version wrote the file; run it again")

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
    """Files of cached settled beds, most recently used first, in `folder`; default: the program's cache (GROUSER_CACHE,
    else XDG_CACHE_HOME/grouser, else ~/.cache/grouser)."""
    if folder is None:
        named = os.environ.get("GROUSER_CACHE")
        if named == "":
            return []
        folder = named or Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "grouser"
    return sorted(Path(folder).glob("bed-*.h5"), key=lambda file: -file.stat().st_mtime)
