# SPDX-License-Identifier: BSD-3-Clause
"""Numbers with units, as returned by all readers."""
from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass, field, fields, replace
from numbers import Number
from typing import Any

import numpy


def no_values() -> numpy.ndarray:
    return numpy.empty(0)


class Brief:
    """repr() of a dataclass in one line: class name and fields, with the shape of each array."""

    def __repr__(self) -> str:
        def text(value: object) -> str:
            return f"array {list(value.shape)}" if isinstance(value, numpy.ndarray) else repr(value)
        return f"<{type(self).__name__} " + ", ".join(f"{f.name}: {text(getattr(self, f.name))}" for f in fields(self)) + ">"


@dataclass(frozen=True, eq=False, repr=False)
class Quantity:
    """A number or an array with a unit.

    `2 * q`, `q * 2` and `q / 2` keep the unit. `q + r` and `q - r` require equal units (a plain number has the unit
    "-"); otherwise ValueError names both units. numpy functions use the value: `numpy.mean(q)`,
    `numpy.asarray(q) ** 2`.
    """

    value: numpy.ndarray  #: any shape; a single number has the shape ()
    unit: str  #: "m"; "-": dimensionless; "": unknown
    help: str = ""  #: definition, in one line
    name: str = ""  #: with dots, as in timeseries.csv: "vehicle.pitch_radius"

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> numpy.ndarray:
        array = numpy.asarray(self.value, dtype=dtype)
        return array.copy() if copy else array

    def __float__(self) -> float:
        return float(self.value)

    def __repr__(self) -> str:
        """Summary in one line: "slip [-]: 0.0729", "depth [m]: [24], 0 to 0.23"."""
        return f"{self._told()}: {self._summary()}"

    def _summary(self) -> str:
        value = numpy.asarray(self.value)
        if value.dtype.kind not in "fiub" or value.size == 0:
            return f"{list(value.shape)}" if value.shape else str(value)
        if value.shape == ():
            return f"{float(value):.6g}"
        there = value[numpy.isfinite(value)]
        if not there.size:
            return f"{list(value.shape)}, no finite value"
        unknown = value.size - there.size
        return (f"{list(value.shape)}, {there.min():.4g} to {there.max():.4g}"
                + (f", {unknown} of {value.size} are NaN" if unknown else ""))

    def __len__(self) -> int:
        return len(self.value)

    def __iter__(self) -> Iterator:
        return iter(self.value)

    __array_priority__ = 1000  # a numpy scalar times q calls q.__rmul__

    def __mul__(self, factor: float | numpy.ndarray) -> Quantity:
        return self._scaled(factor, numpy.multiply, "*")

    __rmul__ = __mul__

    def __truediv__(self, divisor: float | numpy.ndarray) -> Quantity:
        return self._scaled(divisor, numpy.divide, "/")

    def __add__(self, other: Quantity | float) -> Quantity:
        return self._joined(other, numpy.add, "+")

    def __radd__(self, other: float) -> Quantity:
        return self._joined(other, numpy.add, "+", other_first=True)

    def __sub__(self, other: Quantity | float) -> Quantity:
        return self._joined(other, numpy.subtract, "-")

    def __rsub__(self, other: float) -> Quantity:
        return self._joined(other, numpy.subtract, "-", other_first=True)

    def __neg__(self) -> Quantity:
        return self._with(-numpy.asarray(self.value), f"-{self.name}")

    def _with(self, value: numpy.ndarray, name: str, bars: dict[str, numpy.ndarray] | None = None) -> Quantity:
        return replace(self, value=value, name=name, help="", **(bars or {}))

    def _bars(self) -> dict[str, numpy.ndarray]:
        """Half widths by field name, each with the shape of `value`."""
        return {}

    def _told(self) -> str:
        return f"{self.name or 'a quantity'} [{self.unit}]"

    def _scaled(self, factor: float | numpy.ndarray, function: numpy.ufunc, sign: str) -> Quantity:
        if isinstance(factor, Quantity):
            raise ValueError(f"{self._told()} {sign} {factor._told()}: products of units are not supported; use the "
                             "values: .value")
        if not isinstance(factor, (Number, numpy.ndarray)):
            return NotImplemented
        value = function(self.value, factor)
        if value.shape != numpy.shape(self.value):
            raise ValueError(f"{self._told()} has the shape {numpy.shape(self.value)} and cannot be multiplied or "
                             f"divided by an array of shape {numpy.shape(factor)}")
        return self._with(value, f"{self.name} {sign} {factor if isinstance(factor, Number) else 'an array'}",
                          {name: function(bar, numpy.abs(factor)) for name, bar in self._bars().items()})

    def _joined(self, other: Quantity | float, function: numpy.ufunc, sign: str, other_first: bool = False) -> Quantity:
        if isinstance(other, (Number, numpy.ndarray)):
            other = Quantity(numpy.asarray(other), "-", name=str(other) if isinstance(other, Number) else "an array")
        if not isinstance(other, Quantity):
            return NotImplemented
        left, right = (other, self) if other_first else (self, other)
        told = f"{left._told()} {sign} {right._told()}"
        if left.unit != right.unit:
            raise ValueError(f"{told}: the units differ")
        if isinstance(left, Series) and isinstance(right, Series) and not numpy.array_equal(left.time, right.time):
            raise ValueError(f"{told}: the rows have different times")
        whole = max(left, right, key=lambda one: (isinstance(one, Series), bool(one._bars())))
        value = function(left.value, right.value)
        if value.shape != numpy.shape(whole.value):
            raise ValueError(f"{told}: shapes {numpy.shape(left.value)} and {numpy.shape(right.value)} differ")
        bars = {name: numpy.add.reduce([one._bars()[name] for one in (left, right) if name in one._bars()])
                for name in whole._bars()}
        return whole._with(value, f"{left.name} {sign} {right.name}", bars)


def _range(value: numpy.ndarray) -> str:
    there = value[numpy.isfinite(value)]
    return f"{there.min():.4g} to {there.max():.4g}" if there.size else "no finite value"


def nearest(times: numpy.ndarray, time: float, what: str, where: object) -> int:
    """Index of the element of `times` nearest to `time` [s]. ValueError, with `what` and `where` in its message, if
    `times` is empty or `time` is more than one interval before the first or after the last."""
    if len(times) == 0:
        raise ValueError(f"{where}: has no {what}")
    before, behind = (times[1] - times[0], times[-1] - times[-2]) if len(times) > 1 else (1e-9, 1e-9)
    if not times[0] - before <= time <= times[-1] + behind:
        raise ValueError(f"{where}: has no {what} at {time:g} s; times are {times[0]:g} to {times[-1]:g} s")
    return int(numpy.argmin(numpy.abs(times - time)))


@dataclass(frozen=True, eq=False, repr=False)
class Series(Quantity):
    """A quantity over time: `value` has the shape [rows] or [rows, columns]. `for row in series` iterates over the rows
    of `value`."""

    time: numpy.ndarray = field(default_factory=no_values)  #: [rows] [s]
    step: numpy.ndarray | None = None  #: [rows] [-]; None in `Check.series`, whose rows are those of several runs
    labels: tuple[str, ...] = ()  #: column names, e.g. ("x", "y", "z"); empty: one column without name, or one per shoe

    def _summary(self) -> str:
        """Number of rows and time range. For one column: first, last, minimum, mean and maximum value. For named
        columns: the range of each column. For one value per shoe: the range over all shoes."""
        rows = counted(len(self.value), "row")
        if not len(self.value):
            return rows
        rows += f" from {self.time[0]:.6g} to {self.time[-1]:.6g} s" if self.time is not None and len(self.time) else ""
        several = numpy.ndim(self.value) > 1
        if several and not self.labels:
            rows += f" of {counted(numpy.shape(self.value)[1], 'column')}"
        if not several:
            rows += f", first {self.value[0]:.4g}, last {self.value[-1]:.4g}"
        there = self.value[numpy.isfinite(self.value)]
        if not there.size:
            return f"{rows}, no finite value"
        if not several:
            rows += f", min {there.min():.4g}, mean {there.mean():.4g}, max {there.max():.4g}"
        elif self.labels:
            rows += "".join(f", {label} {_range(self.value[:, k])}" for k, label in enumerate(self.labels))
        else:
            rows += f", {_range(self.value)}"
        unknown = numpy.size(self.value) - there.size
        return rows + (f", {unknown} of {numpy.size(self.value)} are NaN" if unknown else "")

    def __getitem__(self, label: str | int | slice) -> Series | numpy.ndarray:
        """A column by its label, as a series of shape [rows]: `run["vehicle.position"]["x"]`; KeyError lists the
        labels. `series[10:20]` is a series of these rows; `series[-1]` is the last row of `value`."""
        if isinstance(label, slice):
            return self._taken(label)
        if isinstance(label, (int, numpy.integer)):
            return self.value[label]
        if label not in self.labels:
            raise KeyError(f"{self.name}: no column {label!r}; named columns: {', '.join(self.labels) or 'none'}")
        column = self.value[:, self.labels.index(label)]
        return Series(column, self.unit, self.help, f"{self.name}.{label}", self.time, self.step)

    def between(self, start: float, end: float) -> Series:
        """Returns the rows with times in [start, end] [s]."""
        return self._taken((self.time >= start) & (self.time <= end))

    def _taken(self, rows: slice | numpy.ndarray) -> Series:
        by_row = {"value": self.value, "time": self.time, "step": self.step, **self._bars()}
        return replace(self, **{name: values[rows] for name, values in by_row.items() if values is not None})

    def at(self, time: float) -> numpy.ndarray:
        """The row nearest to `time` [s]: shape () or [columns]. ValueError if there are no rows, or if `time` is more
        than one interval before the first or after the last."""
        return self.value[nearest(self.time, time, "rows", self.name)]


@dataclass(frozen=True, eq=False, repr=False)
class Estimate:
    """A value with the half width of its confidence interval (95 % unless stated otherwise)."""

    value: float  #: NaN if unknown
    half_width: float  #: inf or NaN if unknown
    unit: str
    name: str = ""

    @property
    def low(self) -> float:
        return self.value - self.half_width

    @property
    def high(self) -> float:
        return self.value + self.half_width

    @property
    def inconclusive(self) -> bool:
        """True if the half width exceeds the absolute value, so that the sign is uncertain."""
        return abs(self.value) < self.half_width < float("inf")

    def __float__(self) -> float:
        return self.value

    def __repr__(self) -> str:
        value, half, power = estimate_text(self.value, self.half_width)
        text = f"{value} +- {half}" if half else value
        unit = "" if self.unit in ("", "-") else f" {self.unit}"
        doubt = " (inconclusive)" if self.inconclusive else ""
        return f"{self.name + ' = ' if self.name else ''}{f'({text})e{power}' if power else text}{unit}{doubt}"


def estimate_text(value: float, half: float | None) -> tuple[str, str, int]:
    """Returns a value and its half width as texts, rounded to two digits of the half width, and their common power of
    ten (0 if there is none). The second text is "?" for an unknown interval, "" for one below 1e-9 of the value (the
    runs agree to rounding)."""
    if half is None or not math.isfinite(half) or not math.isfinite(value):
        return f"{value:.4g}", "?" if math.isfinite(value) else "", 0
    if half <= 1e-9 * abs(value):
        return f"{value:.6g}", "", 0
    places = 1 - math.floor(math.log10(half))
    size = max(abs(value), half)
    if size >= 1e6 or size < 1e-3 or places > 9:  # common power of ten
        power = math.floor(math.log10(size))
        places = max(0, places + power)
        value, half = value / 10.0**power, half / 10.0**power
    else:
        power = 0
    digits = max(0, places)
    return f"{round(value, places) + 0.0:.{digits}f}", f"{round(half, places) + 0.0:.{digits}f}", power


def number(value: float | None) -> float:
    """Converts a JSON number; NaN for null (unknown)."""
    return float("nan") if value is None else float(value)


def counted(number: int, one: str, many: str = "") -> str:
    """"1 seed", "3 seeds"."""
    return f"{number} {one if number == 1 else many or one + 's'}"


def split_unit(heading: str) -> tuple[str, str]:
    """("sinkage mean", "m") from "sinkage mean [m]", ("way at the end", "m") from "way [m] at the end"; the unit is ""
    if the heading has none."""
    found = re.fullmatch(r"(.*) \[([^\[\]]*)\]( .*)?", heading)
    return (found[1] + (found[3] or ""), found[2]) if found else (heading, "")
