# SPDX-License-Identifier: BSD-3-Clause
"""Numbers with their units: what all readers return."""
from __future__ import annotations

from dataclasses import dataclass

import numpy


@dataclass(frozen=True, eq=False)
class Quantity:
    """A number or an array with its unit. numpy takes it as its value: `numpy.mean(q)`, `2 * numpy.asarray(q)`."""

    value: numpy.ndarray  #: any shape; a single number has the shape ()
    unit: str  #: "m"; "-" where dimensionless; "" where the file says none
    help: str = ""  #: one line
    name: str = ""  #: with dots, as in timeseries.csv: "vehicle.pitch_radius"

    def __array__(self, dtype=None, copy=None) -> numpy.ndarray:
        return numpy.array(self.value, dtype=dtype, copy=bool(copy))

    def __float__(self) -> float:
        return float(self.value)

    def __len__(self) -> int:
        return len(self.value)


@dataclass(frozen=True, eq=False)
class Series(Quantity):
    """A quantity over time: `value` has the shape [rows], or [rows, columns]."""

    time: numpy.ndarray = None  #: [rows] [s]
    step: numpy.ndarray = None  #: [rows] [-]
    labels: tuple[str, ...] = ()  #: of the columns, e.g. ("x", "y", "z"); empty: none, or one a shoe

    def __getitem__(self, label: str) -> Series:
        """A column by its label: `run["vehicle.position"]["x"]`, as a series of the shape [rows]. KeyError names those
        that there are."""
        if label not in self.labels:
            raise KeyError(f"{self.name} has no column {label!r}; it has {', '.join(self.labels) or 'none by name'}")
        column = self.value[:, self.labels.index(label)]
        return Series(column, self.unit, self.help, f"{self.name}.{label}", self.time, self.step)

    def between(self, start: float, end: float) -> Series:
        """The rows of times in [start, end] [s]."""
        kept = (self.time >= start) & (self.time <= end)
        return Series(self.value[kept], self.unit, self.help, self.name, self.time[kept], self.step[kept], self.labels)

    def at(self, time: float) -> numpy.ndarray:
        """The row nearest to `time` [s]: of the shape () or [columns]. ValueError where there are no rows."""
        if len(self.time) == 0:
            raise ValueError(f"{self.name}: the run has no rows")
        return self.value[numpy.argmin(numpy.abs(self.time - time))]


@dataclass(frozen=True, eq=False)
class Estimate:
    """A value with half of its interval, of 95 % where not said otherwise."""

    value: float  #: NaN where unknown
    half_width: float  #: inf or NaN where unknown
    unit: str
    name: str = ""

    @property
    def low(self) -> float:
        return self.value - self.half_width

    @property
    def high(self) -> float:
        return self.value + self.half_width

    def __float__(self) -> float:
        return self.value

    def __str__(self) -> str:
        return f"{self.name + ' = ' if self.name else ''}{self.value:.4g} +- {self.half_width:.2g} {self.unit}"


def number(value: float | None) -> float:
    """Of JSON, whose null stands for a number that is not known: NaN."""
    return float("nan") if value is None else float(value)


def split_unit(heading: str) -> tuple[str, str]:
    """("sinkage mean", "m") of "sinkage mean [m]"; the unit is "" where the heading has none."""
    if heading.endswith("]") and " [" in heading:
        name, unit = heading[:-1].rsplit(" [", 1)
        return name, unit
    return heading, ""
