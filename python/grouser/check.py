# SPDX-License-Identifier: BSD-3-Clause
"""The results of a check: figures and series with error bars, and the cost of each case."""
from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import numpy

from .errors import FileError
from .files import fields_of, read_csv, read_json
from .series import Estimate, Series, counted, no_values, number, split_unit
from .sweep import value_of


@dataclass(frozen=True, eq=False)
class AxisError:
    """Change of a figure if one axis varies: time step, bed extent, grain size..."""

    axis: str
    change: Estimate  #: difference from the unchanged scene, in the figure's unit
    verdict: str  #: "equal", "differs" or "inconclusive"
    order: float  #: observed order of convergence in the step; NaN if unknown


@dataclass(frozen=True, eq=False)
class CheckFigure:
    """A figure with its error bar."""

    name: str
    bar: Estimate  #: value, with the error bar that combines seeds and axes
    by_seeds: Estimate  #: value, with half of the 95 % interval over the seeds
    seeds: int
    errors: dict[str, AxisError]  #: by axis
    inconclusive: bool = False  #: the tracks advance by fewer than two sprocket teeth, or the bar exceeds the value


@dataclass(frozen=True, eq=False, repr=False)
class BarredSeries(Series):
    """A series with half widths, each of shape [rows]; NaN if unknown. `2 * s` doubles the half widths. `s + t` and
    `s - t` add the half widths; the sum is an upper bound, since errors of one check are not independent. A series
    without half widths counts as exact."""

    by_seeds: numpy.ndarray = field(default_factory=no_values)  #: half width of the 95 % interval over the seeds
    by_step: numpy.ndarray = field(default_factory=no_values)  #: half width of the step
    bar: numpy.ndarray = field(default_factory=no_values)  #: both combined

    def _bars(self) -> dict[str, numpy.ndarray]:
        return {"by_seeds": self.by_seeds, "by_step": self.by_step, "bar": self.bar}


class Check:
    """A check's folder: `check["speed"]` is a CheckFigure; `for figure in check` iterates over all figures."""

    def __init__(self, folder: str | os.PathLike):
        self.folder: Path = Path(folder)
        file = self.folder / "check.json"
        self.json: dict = read_json(file, "a check")  #: contents of check.json
        if "figures" not in self.json or "cases" not in self.json:
            raise FileError(f"{file}: not the check.json of a check")
        with fields_of(file, "a check"):
            figures = [self._figure(one) for one in self.json["figures"]]
        self.figures: dict[str, CheckFigure] = {figure.name: figure for figure in figures}

    def __repr__(self) -> str:
        return f"<grouser.Check {self.folder}: {counted(len(self), 'figure')}>"

    @staticmethod
    def _figure(one: dict) -> CheckFigure:
        name, unit = split_unit(one["name"])
        errors = {e["axis"]: AxisError(e["axis"], Estimate(number(e["change"]), number(e["half_width"]), unit, name),
                                       e["verdict"], number(e.get("order"))) for e in one["errors"]}
        value = number(one["value"])
        return CheckFigure(name, Estimate(value, number(one["bar"]), unit, name),
                           Estimate(value, number(one["seeds_half_width"]), unit, name), one["seeds"], errors,
                           one.get("inconclusive", False))

    def __getitem__(self, name: str) -> CheckFigure:
        """Returns a figure by name. KeyError lists the figures."""
        if name not in self.figures:
            raise KeyError(f"{self.folder}: no figure {name!r}; figures are {', '.join(self.figures)}")
        return self.figures[name]

    def __iter__(self) -> Iterator[CheckFigure]:
        return iter(self.figures.values())

    def __len__(self) -> int:
        return len(self.figures)

    @property
    def not_run(self) -> dict[str, str]:
        """{axis that was not varied: reason}"""
        with fields_of(self.folder / "check.json", "a check"):
            return {omitted["axis"]: omitted["why"] for omitted in self.json["not_asked"]}

    @property
    def costs(self) -> dict[str, dict]:
        """{case: {"wall_s": [s], "cpu_s": [s], "steps"}}: medians over the runs of each case."""
        file = self.folder / "costs.json"
        told = read_json(file, "costs of a check")
        with fields_of(file, "costs of a check"):
            return {case["name"]: case for case in told["cases"]}

    @cached_property
    def series(self) -> dict[str, BarredSeries]:
        """{name: series with error bars}, from series.csv."""
        file = self.folder / "series.csv"
        rows = read_csv(file)
        columns = {name: numpy.array([value_of(row[name]) for row in rows]) for name in (rows[0] if rows else ())}
        series: dict[str, BarredSeries] = {}
        with fields_of(file, "series of a check"):
            for heading, values in columns.items():
                if f"{heading} both +-" not in columns:
                    continue
                name, unit = split_unit(heading)
                seeds, step, both = (columns[f"{heading} {what} +-"] for what in ("seeds", "step", "both"))
                series[name] = BarredSeries(values, unit, "", name, columns["time [s]"], None, (), seeds, step, both)
        return series


def open_check(folder: str | os.PathLike) -> Check:
    """Opens the folder of a check. FileError if it has no check.json."""
    return Check(folder)
