# SPDX-License-Identifier: BSD-3-Clause
"""The results of virtual soil tests."""
from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

import numpy

from .errors import FileError
from .files import fields_of, read_csv, read_json
from .series import Brief, Estimate, number


@dataclass(frozen=True, eq=False)
class Constant:
    """Measured and published values of a soil constant."""

    measured: Estimate
    published: tuple[tuple[float, str], ...]  #: (value, source), in the unit of the measured value
    span: tuple[float, float] | None  #: range of the published values
    verdict: str  #: "inside", "outside"...; "-" if not measured
    inconclusive: str = ""  #: reason why the measured value is inconclusive, else empty


@dataclass(frozen=True, eq=False, repr=False)
class PlateCurve(Brief):
    """Pressure over sinkage of one plate on one bed during loading, holding, unloading and reloading."""

    plate: str  #: "small" or "large"
    breadth: float  #: [m]
    seed: int
    phase: numpy.ndarray  #: [points] 0 loading, 3 holding, 1 unloading, 2 reloading
    sinkage: numpy.ndarray  #: [points] [m]
    pressure: numpy.ndarray  #: [points] [Pa]


@dataclass(frozen=True, eq=False, repr=False)
class ShearCurve(Brief):
    """Shear test of one sample under one normal load."""

    load: float  #: [Pa]
    seed: int
    displacement: numpy.ndarray  #: [points] [m]
    shear_stress: numpy.ndarray  #: [points] [Pa]
    normal_stress: numpy.ndarray  #: [points] [Pa]


class SoilTest:
    """The folder of `grouser soil`: `test["phi"]` is a Constant. The constants are n, k_phi, k_c, c, phi, K."""

    def __init__(self, folder: str | os.PathLike):
        self.folder: Path = Path(folder)
        file = self.folder / "soil.json"
        self.json: dict = read_json(file, "a soil test")  #: contents of soil.json
        if "constants" not in self.json:
            raise FileError(f"{file}: not the soil.json of a soil test")
        with fields_of(file, "a soil test"):
            self.name: str = self.json["soil"]
            self.grain_radius: float = self.json["grain_radius_m"]  #: [m]
            self.coarse: bool = self.json["care"] == "coarse"  #: True for tests with --quick
            #: Names of tests that were repeated with shorter time steps because their first result was invalid.
            self.shorter_steps: list[str] = list(self.json.get("tests_with_shorter_steps", []))
            self.constants: dict[str, Constant] = {
                name: Constant(Estimate(number(one["value"]), number(one["half_width"]), one["unit"], name),
                               tuple((number(p.get("value")), p["source"]) for p in one["published"]),
                               (one["span"][0], one["span"][1]) if one.get("span") else None, one.get("verdict", "-"),
                               one.get("inconclusive") or "")
                for name, one in self.json["constants"].items()}

    def __repr__(self) -> str:
        return f"<grouser.SoilTest {self.folder}: {', '.join(map(str, (c.measured for c in self.constants.values())))}>"

    def __getitem__(self, name: str) -> Constant:
        """Returns a constant by name. KeyError lists the constants."""
        if name not in self.constants:
            raise KeyError(f"{self.folder}: no constant {name!r}; constants are {', '.join(self.constants)}")
        return self.constants[name]

    def plates(self) -> list[PlateCurve]:
        """Curves of pressure over sinkage, one per plate and bed. FileError if plates.csv is missing."""
        groups = _grouped(read_csv(self.folder / "plates.csv"), ("plate", "breadth [m]", "seed"))
        return [PlateCurve(plate, float(breadth), int(seed), _column(rows, "phase").astype(int),
                           _column(rows, "sinkage [m]"), _column(rows, "pressure [Pa]"))
                for (plate, breadth, seed), rows in groups.items()]

    def shear(self) -> list[ShearCurve]:
        """Curves of stress over displacement, one per load and sample. FileError if shear.csv is missing."""
        groups = _grouped(read_csv(self.folder / "shear.csv"), ("load [Pa]", "seed"))
        return [ShearCurve(float(load), int(seed), _column(rows, "displacement [m]"),
                           _column(rows, "shear stress [Pa]"), _column(rows, "normal stress [Pa]"))
                for (load, seed), rows in groups.items()]


def _grouped(rows: list[dict[str, str]], keys: tuple[str, ...]) -> dict[tuple[str, ...], list[dict[str, str]]]:
    groups: dict[tuple[str, ...], list[dict[str, str]]] = {}
    for row in rows:
        groups.setdefault(tuple(row[key] for key in keys), []).append(row)
    return groups


def _column(rows: list[dict[str, str]], name: str) -> numpy.ndarray:
    return numpy.array([float(row[name]) for row in rows])


def open_soil(folder: str | os.PathLike) -> SoilTest:
    """Opens the folder of `grouser soil`. FileError if it has no soil.json."""
    return SoilTest(folder)
