# SPDX-License-Identifier: BSD-3-Clause
"""A calibration: search for contact parameters that reproduce given soil constants."""
from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from .errors import FileError
from .files import fields_of, inside, read_json
from .series import Estimate, counted, number
from .soil import SoilTest


@dataclass(frozen=True, eq=False)
class Trial:
    """One trial: parameters of a soil, and the results of its tests."""

    name: str  #: name of the folder: "shear_2", "plate_1"
    kind: str  #: "shear" or "plate"
    parameters: dict[str, float | str | bool]  #: material keys, in the units of docs/keys.md
    measured: dict[str, Estimate]  #: shear: "phi", "c", "K"; plate: "pressure" of the small plate at "sinkage"


@dataclass(frozen=True, eq=False)
class Outcome:
    """A target and the value reached with the final parameters."""

    what: str  #: "phi", "pressure, small plate"
    wanted: float  #: target, in the unit of `reached`
    tolerance: float  #: NaN if the value is not a target
    reached: Estimate  #: mean, with half of the 95 % interval over the tests (NaN for a single test)
    verdict: str  #: "reached", "not reached", "not sought"


class Calibration:
    """The folder of `grouser soil --calibrate`. `for trial in calibration` iterates over the trials."""

    def __init__(self, folder: str | os.PathLike):
        self.folder: Path = Path(folder)
        file = self.folder / "calibration.json"
        self.json: dict = read_json(file, "a calibration")  #: contents of calibration.json
        if "trials" not in self.json or "targets" not in self.json:
            raise FileError(f"{file}: not the calibration.json of a calibration")
        with fields_of(file, "a calibration"):
            self.name: str = self.json["soil"]
            self.grain_radius: float = self.json["grain_radius_m"]  #: [m]
            self.coarse: bool = self.json["care"] == "coarse"  #: True for a search with --quick
            self.status: str = self.json["status"]  #: "searching", "unfinished" (out of time), "finished"
            self.trials: list[Trial] = [
                Trial(one["name"], one["kind"], one["parameters"] or {},
                      {name: _estimate(name, value) for name, value in (one["measured"] or {}).items()})
                for one in self.json["trials"]]
            self.outcomes: list[Outcome] = [
                Outcome(one["what"], number(one["wanted"]), number(one["tolerance"]),
                        _estimate(one["what"], one["reached"]), one["verdict"])
                for one in self.json.get("outcomes", [])]  #: empty until the search has finished

    def __repr__(self) -> str:
        return f"<grouser.Calibration {self.folder}: {counted(len(self), 'trial')}>"

    @property
    def soil_file(self) -> Path | None:
        """The file of the calibrated soil; None before the search has finished."""
        name = self.json.get("soil_file")
        return inside(self.folder, name, self.folder / "calibration.json") if name else None

    def soil(self) -> SoilTest:
        """All tests of the calibrated soil. FileError before the search has finished."""
        if "tests" not in self.json:
            raise FileError(f"{self.folder}: the search is not finished; continue it with --resume")
        return SoilTest(inside(self.folder, self.json["tests"], self.folder / "calibration.json"))

    def __iter__(self) -> Iterator[Trial]:
        return iter(self.trials)

    def __len__(self) -> int:
        return len(self.trials)


def _estimate(name: str, one: dict) -> Estimate:
    return Estimate(number(one["value"]), number(one.get("half_width")), one["unit"], name)


def open_calibration(folder: str | os.PathLike) -> Calibration:
    """Opens the folder of `grouser soil --calibrate`. FileError if it has no calibration.json."""
    return Calibration(folder)
