# SPDX-License-Identifier: BSD-3-Clause
"""Numbers with their units: what all readers return."""
from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass, fields, replace
from numbers import Number

import numpy


class Brief:
    """Of a dataclass: its name and fields in one line, of arrays the shape."""

    def __repr__(self) -> str:
        def text(value: object) -> str:
            return f"array {list(value.shape)}" if isinstance(value, numpy.ndarray) else repr(value)
        return f"<{type(self).__name__} " + ", ".join(f"{f.name}: {text(getattr(self, f.name))}" for f in fields(self)) + ">"


@dataclass(frozen=True, eq=False, repr=False)
class Quantity:
    """A number or an array with its unit.

    `2 * q`, `q * 2` and `q / 2` keep the unit; `q + r` and `q - r` are for quantities of the same unit, and for plain
    numbers where q has none ("-"): ValueError names both units where they differ. numpy takes a quantity as its value:
    `numpy.mean(q)`, `numpy.asarray(q) ** 2`.
    """

    value: numpy.ndarray  #: any shape; a single number has the shape ()
    unit: str  #: "m"; "-" where dimensionless; "" where the file says none
    help: str = ""  #: one line
    name: str = ""  #: with dots, as in timeseries.csv: "vehicle.pitch_radius"

    def __array__(self, dtype=None, copy=None) -> numpy.ndarray:
        return numpy.array(self.value, dtype=dtype, copy=bool(copy))

    def __float__(self) -> float:
        return float(self.value)

    def __repr__(self) -> str:
        """What it is, in one line: "slip [-]: 0.0729", "depth [m]: [24], 0 to 0.23"."""
        return f"{self._told()}: {self._summary()}"

    def _summary(self) -> str:
        value = numpy.asarray(self.value)
        if value.dtype.kind not in "fiub" or value.size == 0:
            return f"{list(value.shape)}" if value.shape else str(value)
        if value.shape == ():
            return f"{float(value):.6g}"
        there = value[numpy.isfinite(value)]
        if not there.size:
            return f"{list(value.shape)}, no number in it"
        unknown = value.size - there.size
        return (f"{list(value.shape)}, {there.min():.4g} to {there.max():.4g}"
                + (f", {unknown} of {value.size} are NaN" if unknown else ""))

    def __len__(self) -> int:
        return len(self.value)

    def __iter__(self) -> Iterator:
        return iter(self.value)

    __array_priority__ = 1000  # so that numpy leaves 2 * q to q, where it is numpy's 2

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
        """Half widths, of the shape of `value`, by the names of their fields."""
        return {}

    def _told(self) -> str:
        return f"{self.name or 'a quantity'} [{self.unit}]"

    def _scaled(self, factor: float | numpy.ndarray, function: numpy.ufunc, sign: str) -> Quantity:
        if isinstance(factor, Quantity):
            raise ValueError(f"{self._told()} {sign} {factor._told()}: of what unit that is, is not reckoned here; take "
                             "the values: .value")
        if not isinstance(factor, (Number, numpy.ndarray)):
            return NotImplemented
        value = function(self.value, factor)
        if value.shape != numpy.shape(self.value):
            raise ValueError(f"{self._told()} has the shape {numpy.shape(self.value)}, which is not multiplied or divided "
                             f"by one of {numpy.shape(factor)}")
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
            raise ValueError(f"{told}: their rows are of other times")
        whole = max(left, right, key=lambda one: (isinstance(one, Series), bool(one._bars())))
        value = function(left.value, right.value)
        if value.shape != numpy.shape(whole.value):
            raise ValueError(f"{told}: shapes {numpy.shape(left.value)} and {numpy.shape(right.value)} do not fit")
        bars = {name: sum(one._bars()[name] for one in (left, right) if name in one._bars()) for name in whole._bars()}
        return whole._with(value, f"{left.name} {sign} {right.name}", bars)


def _range(value: numpy.ndarray) -> str:
    there = value[numpy.isfinite(value)]
    return f"{there.min():.4g} to {there.max():.4g}" if there.size else "no number"


def nearest(times: numpy.ndarray, time: float, what: str, where: object) -> int:
    """Place of the one of `times` nearest to `time` [s]. ValueError where there are none, or where `time` lies further
    beyond the first or the last than they are apart there; `what` has these times, in `where`."""
    if len(times) == 0:
        raise ValueError(f"{where}: has no {what}")
    before, behind = (times[1] - times[0], times[-1] - times[-2]) if len(times) > 1 else (1e-9, 1e-9)
    if not times[0] - before <= time <= times[-1] + behind:
        raise ValueError(f"{where}: has no {what} at {time:g} s; they go from {times[0]:g} to {times[-1]:g} s")
    return int(numpy.argmin(numpy.abs(times - time)))


@dataclass(frozen=True, eq=False, repr=False)
class Series(Quantity):
    """A quantity over time: `value` has the shape [rows], or [rows, columns]. `for row in series` goes through the rows
    of `value`."""

    time: numpy.ndarray = None  #: [rows] [s]
    step: numpy.ndarray = None  #: [rows] [-]
    labels: tuple[str, ...] = ()  #: of the columns, e.g. ("x", "y", "z"); empty: none, or one a shoe

    def _summary(self) -> str:
        """Rows, and from when to when; of one number a row the first, last, least, mean and largest; of named columns
        the range of each; of one number a shoe the range of all."""
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
            return f"{rows}, no number in it"
        if not several:
            rows += f", min {there.min():.4g}, mean {there.mean():.4g}, max {there.max():.4g}"
        elif self.labels:
            rows += "".join(f", {label} {_range(self.value[:, k])}" for k, label in enumerate(self.labels))
        else:
            rows += f", {_range(self.value)}"
        unknown = numpy.size(self.value) - there.size
        return rows + (f", {unknown} of {numpy.size(self.value)} are NaN" if unknown else "")

    def __getitem__(self, label: str | int | slice) -> Series | numpy.ndarray:
        """A column by its label: `run["vehicle.position"]["x"]`, as a series of the shape [rows]; KeyError names those
        that there are. `series[10:20]` is a series of these rows, `series[-1]` the last row of `value`."""
        if isinstance(label, slice):
            return self._taken(label)
        if isinstance(label, (int, numpy.integer)):
            return self.value[label]
        if label not in self.labels:
            raise KeyError(f"{self.name} has no column {label!r}; it has {', '.join(self.labels) or 'none by name'}")
        column = self.value[:, self.labels.index(label)]
        return Series(column, self.unit, self.help, f"{self.name}.{label}", self.time, self.step)

    def between(self, start: float, end: float) -> Series:
        """The rows of times in [start, end] [s]."""
        return self._taken((self.time >= start) & (self.time <= end))

    def _taken(self, rows: slice | numpy.ndarray) -> Series:
        by_row = {"value": self.value, "time": self.time, "step": self.step, **self._bars()}
        return replace(self, **{name: field[rows] for name, field in by_row.items() if field is not None})

    def at(self, time: float) -> numpy.ndarray:
        """The row nearest to `time` [s]: of the shape () or [columns]. ValueError where there are no rows, or none near
        it: more than their interval before the first or behind the last."""
        return self.value[nearest(self.time, time, "rows", self.name)]


@dataclass(frozen=True, eq=False, repr=False)
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

    @property
    def inconclusive(self) -> bool:
        """Whether the interval is wider than the value is large: then not even its sign is sure."""
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
    """A value and half of its interval as texts: no more digits than the interval allows, two of its own; and a power of
    ten of both, 0 for none. The second text is "?" for an interval that is unknown, "" for one below 1e-9 of the value,
    where the runs agree but for rounding."""
    if half is None or not math.isfinite(half) or not math.isfinite(value):
        return f"{value:.4g}", "?" if math.isfinite(value) else "", 0
    if half <= 1e-9 * abs(value):
        return f"{value:.6g}", "", 0
    places = 1 - math.floor(math.log10(half))
    size = max(abs(value), half)
    if size >= 1e6 or size < 1e-3 or places > 9:  # one power of ten for both
        power = math.floor(math.log10(size))
        places = max(0, places + power)
        value, half = value / 10.0**power, half / 10.0**power
    else:
        power = 0
    return *(f"{round(one, places) + 0.0:.{max(0, places)}f}" for one in (value, half)), power


def number(value: float | None) -> float:
    """Of JSON, whose null stands for a number that is not known: NaN."""
    return float("nan") if value is None else float(value)


def counted(number: int, one: str, many: str = "") -> str:
    """"1 seed", "3 seeds": a number with the word that it counts."""
    return f"{number} {one if number == 1 else many or one + 's'}"


def split_unit(heading: str) -> tuple[str, str]:
    """("sinkage mean", "m") of "sinkage mean [m]", ("way at the end", "m") of "way [m] at the end"; the unit is ""
    where the heading has none."""
    found = re.fullmatch(r"(.*) \[([^\[\]]*)\]( .*)?", heading)
    return (found[1] + (found[3] or ""), found[2]) if found else (heading, "")
