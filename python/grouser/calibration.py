# SPDX-License-Identifier: BSD-3-Clause
"""A search for the contact parameters that give a soil wanted constants."""
from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from .errors import FileError
from .files import fields_of, read_json
from .series import Estimate, counted, number
from .soil import SoilTest


@dataclass(frozen=True, eq=False)
class Trial:
    """One trial: a soil, and what its tests came to."""

    name: str  #: of its folder: "shear_2", "plate_1"
    kind: str  #: "shear" or "plate"
    parameters: dict[str, float | str | bool]  #: keys of the material, in the units of docs/keys.md
    measured: dict[str, Estimate]  #: "phi", "c", "K" of shear; "pressure" of the small plate, "sinkage" it is meant at


@dataclass(frozen=True, eq=False)
class Outcome:
    """A target beside what was reached with the parameters that were found."""

    what: str  #: "phi", "pressure, small plate"
    wanted: float  #: in the unit of `reached`
    tolerance: float  #: NaN where it was not sought, but follows
    reached: Estimate  #: with half of the 95 % interval over the tests; NaN where there is one
    verdict: str  #: "reached", "not reached", "not sought"


class Calibration:
    """The folder of `grouser soil --calibrate`. `for trial in calibration` goes through the trials."""

    def __init__(self, folder: str | os.PathLike):
        self.folder: Path = Path(folder)
        file = self.folder / "calibration.json"
        self.json: dict = read_json(file, "a calibration")  #: all of calibration.json
        if "trials" not in self.json or "targets" not in self.json:
            raise FileError(f"{file}: is no file of a calibration")
        with fields_of(file, "a calibration"):
            self.name: str = self.json["soil"]
            self.grain_radius: float = self.json["grain_radius_m"]  #: [m]
            self.coarse: bool = self.json["care"] == "coarse"  #: with --quick
            self.status: str = self.json["status"]  #: "searching", "unfinished" (time was up), "finished"
            self.trials: list[Trial] = [
                Trial(one["name"], one["kind"], one["parameters"] or {},
                      {name: _estimate(name, value) for name, value in (one["measured"] or {}).items()})
                for one in self.json["trials"]]
            self.outcomes: list[Outcome] = [
                Outcome(one["what"], number(one["wanted"]), number(one["tolerance"]),
                        _estimate(one["what"], one["reached"]), one["verdict"])
                for one in self.json.get("outcomes", [])]  #: none before it has finished

    def __repr__(self) -> str:
        return f"<grouser.Calibration {self.folder}: {counted(len(self), 'trial')}>"

    @property
    def soil_file(self) -> Path | None:
        """The soil that was found; None before that."""
        name = self.json.get("soil_file")
        return self.folder / name if name else None

    def soil(self) -> SoilTest:
        """All tests of the soil that was found. FileError before that."""
        if "tests" not in self.json:
            raise FileError(f"{self.folder}: the search has not ended; go on with --resume")
        return SoilTest(self.folder / self.json["tests"])

    def __iter__(self) -> Iterator[Trial]:
        return iter(self.trials)

    def __len__(self) -> int:
        return len(self.trials)


def _estimate(name: str, one: dict) -> Estimate:
    return Estimate(number(one["value"]), number(one.get("half_width")), one["unit"], name)


def open_calibration(folder: str | os.PathLike) -> Calibration:
    """Opens the folder of `grouser soil --calibrate`. FileError where it has no calibration.json."""
    return Calibration(folder)
