# SPDX-License-Identifier: BSD-3-Clause
"""A soil as it was measured in virtual tests."""
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
    """A constant of the soil, as measured and as published."""

    measured: Estimate
    published: tuple[tuple[float, str], ...]  #: (value, source), in the unit of what was measured
    span: tuple[float, float] | None  #: that the published values leave room for
    verdict: str  #: "inside", "outside"...; "-" where not measured
    inconclusive: str = ""  #: why the measured value is not to be used; empty where it is sound


@dataclass(frozen=True, eq=False, repr=False)
class PlateCurve(Brief):
    """One plate pushed into one bed, lifted, and pushed again."""

    plate: str  #: "small" or "large"
    breadth: float  #: [m]
    seed: int
    phase: numpy.ndarray  #: [points] 0 down, 3 held there, 1 up, 2 down again
    sinkage: numpy.ndarray  #: [points] [m]
    pressure: numpy.ndarray  #: [points] [Pa]


@dataclass(frozen=True, eq=False, repr=False)
class ShearCurve(Brief):
    """One layer sheared under one load."""

    load: float  #: [Pa]
    seed: int
    displacement: numpy.ndarray  #: [points] [m]
    shear_stress: numpy.ndarray  #: [points] [Pa]
    normal_stress: numpy.ndarray  #: [points] [Pa]


class SoilTest:
    """The folder of `grouser soil`: `test["phi"]` is a Constant, of n, k_phi, k_c, c, phi, K."""

    def __init__(self, folder: str | os.PathLike):
        self.folder: Path = Path(folder)
        file = self.folder / "soil.json"
        self.json: dict = read_json(file, "a soil's test")  #: all of soil.json
        if "constants" not in self.json:
            raise FileError(f"{file}: is no file of a soil's test")
        with fields_of(file, "a soil's test"):
            self.name: str = self.json["soil"]
            self.grain_radius: float = self.json["grain_radius_m"]  #: [m]
            self.coarse: bool = self.json["care"] == "coarse"  #: measured with --quick
            #: Names of tests that ended unsoundly and were done again with shorter steps.
            self.shorter_steps: list[str] = list(self.json.get("tests_with_shorter_steps", []))
            self.constants: dict[str, Constant] = {
                name: Constant(Estimate(number(one["value"]), number(one["half_width"]), one["unit"], name),
                               tuple((number(p.get("value")), p["source"]) for p in one["published"]),
                               tuple(one["span"]) if one.get("span") else None, one.get("verdict", "-"),
                               one.get("inconclusive") or "")
                for name, one in self.json["constants"].items()}

    def __repr__(self) -> str:
        return f"<grouser.SoilTest {self.folder}: {', '.join(map(str, (c.measured for c in self.constants.values())))}>"

    def __getitem__(self, name: str) -> Constant:
        """KeyError names the constants that there are."""
        if name not in self.constants:
            raise KeyError(f"{self.folder}: there is no constant {name!r}; there are {', '.join(self.constants)}")
        return self.constants[name]

    def plates(self) -> list[PlateCurve]:
        """Pressure over sinkage, a curve a bed. FileError where there are none."""
        groups = _grouped(read_csv(self.folder / "plates.csv"), ("plate", "breadth [m]", "seed"))
        return [PlateCurve(plate, float(breadth), int(seed), _column(rows, "phase").astype(int),
                           _column(rows, "sinkage [m]"), _column(rows, "pressure [Pa]"))
                for (plate, breadth, seed), rows in groups.items()]

    def shear(self) -> list[ShearCurve]:
        """Stress over displacement, a curve a sample. FileError where there are none."""
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
    """Opens the folder of `grouser soil`. FileError where it has no soil.json."""
    return SoilTest(folder)
