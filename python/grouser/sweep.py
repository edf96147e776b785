# SPDX-License-Identifier: BSD-3-Clause
"""The results of a sweep: one row per run, and means with intervals over seeds."""
from __future__ import annotations

import os
import re
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy

from .errors import FileError
from .files import fields_of, inside, read_csv
from .run import Run
from .series import Estimate, Quantity, counted, split_unit

#: Prefix of a reason followed by the names of inconclusive figures; cell text if the column "message" has the reason.
_TURNED, _SEE_MESSAGE = "direction of motion changes: ", "see message"

#: Columns of summary.csv between the swept keys and the figures.
_ABOUT = ("status", "message", "wall time [s]", "steps", "simulated time [s]")
_NOTICES = "warnings and notes"
_BEHIND = ("state hash", "commit", _NOTICES)


def value_of(text: str) -> float:
    """Converts a cell to a number; NaN if it is empty or not numeric."""
    try:
        return float(text)
    except (TypeError, ValueError):  # None in a truncated row
        return float("nan")


@dataclass(frozen=True, eq=False)
class SweepRun:
    """One run of a sweep."""

    name: str  #: name of the folder
    keys: dict[str, str]  #: {swept key: its value as given}
    status: str  #: "finished", "incomplete", "failed"...
    message: str  #: reason why the run failed or is incomplete
    inconclusive: str  #: reason why its figures are inconclusive (e.g. fewer than two sprocket teeth), else ""
    figures: dict[str, float]  #: {"sinkage mean": ...}; NaN if missing; units are in Sweep.units
    state_hash: str
    folder: Path
    notices: tuple[str, ...] = ()  #: "WARNING: ..." and "note: ..." that the run printed

    def doubt(self, figure: str) -> str:
        """Reason why a figure of the run is inconclusive, else ""."""
        named = self.inconclusive.removeprefix(_TURNED)
        return "" if named != self.inconclusive and figure not in named.split(", ") else self.inconclusive

    def open(self) -> Run:
        """Opens the results of the run."""
        return Run(self.folder)


@dataclass(frozen=True, eq=False)
class SweepMean:
    """Mean of a figure over the seeds of one combination."""

    keys: dict[str, str]  #: {swept key: its value as given}, without the seed
    seeds: int
    mean: Estimate
    difference: Estimate  #: difference from the first combination, paired by seed, in the figure's unit
    inconclusive: str = ""  #: reason why the mean is inconclusive (e.g. fewer than two sprocket teeth), else ""


@dataclass(frozen=True, eq=False, repr=False)
class _OfRuns(Quantity):
    """Values of a figure in all runs."""

    doubtful: tuple[str, ...] = ()  #: names of the runs with an inconclusive value

    def _summary(self) -> str:
        return super()._summary() + (f", inconclusive: {', '.join(self.doubtful)}" if self.doubtful else "")


class _Means(dict[str, list[SweepMean]]):
    def __missing__(self, figure: str) -> list[SweepMean]:
        raise KeyError(f"no means of {figure!r}; means are {', '.join(self) or 'none, since no seeds were run'}; "
                       "sweep[figure] has the values of all runs")


class Sweep:
    """The folder of a sweep. `sweep["sinkage mean"]` has this figure for all runs, in the order of `sweep.runs`."""

    def __init__(self, folder: str | os.PathLike):
        self.folder: Path = Path(folder)
        if self.folder.is_dir() and not (self.folder / "summary.csv").exists():
            run = "; open_run opens the folder of a run" if (self.folder / "results.h5").exists() else ""
            raise FileError(f"{self.folder}: no summary.csv; specify the folder of a sweep{run}")
        rows = read_csv(self.folder / "summary.csv")
        columns = list(rows[0]) if rows else []
        if not rows and (self.folder / "summary.csv").read_text(encoding="utf-8").startswith("run,"):
            raise FileError(f"{self.folder / 'summary.csv'}: contains no runs")
        if not rows or columns[0] != "run" or any(name not in columns for name in _ABOUT):
            raise FileError(f"{self.folder / 'summary.csv'}: not the summary of a sweep")
        first = columns.index("status")
        self.keys: list[str] = columns[1:first]  #: swept keys
        figures = [c for c in columns[first:] if c not in (*_ABOUT, "inconclusive", *_BEHIND)]
        with fields_of(self.folder / "summary.csv", "the summary of a sweep"):
            self.units: dict[str, str] = dict(map(split_unit, figures))  #: {figure: unit}
            self.runs: list[SweepRun] = [
                SweepRun(row["run"], {key: row[key] for key in self.keys}, row["status"], row["message"],
                         row["message"] if row.get("inconclusive") == _SEE_MESSAGE else row.get("inconclusive", ""),
                         {split_unit(c)[0]: value_of(row[c]) for c in figures},
                         row["state hash"], inside(self.folder, row["run"], self.folder / "summary.csv"),
                         tuple(re.findall(r"(?:WARNING|note): .*?(?=; (?:WARNING|note): |$)", row.get(_NOTICES) or "")))
                for row in rows]

    def __repr__(self) -> str:
        told = f"{self.folder}: {counted(len(self.runs), 'run')} over {', '.join(self.keys) or 'no key'}"
        for what, runs in (("incomplete", [run.name for run in self.runs if run.status == "incomplete"]),
                           ("inconclusive", [run.name for run in self.runs if run.inconclusive and run.status != "incomplete"])):
            told += f"; {what}: {', '.join(runs)}" if runs else ""
        return f"<grouser.Sweep {told}>"

    def __getitem__(self, figure: str) -> Quantity:
        """[runs] values of a figure, NaN if missing. `doubtful` lists the runs with an inconclusive value. KeyError
        lists the figures."""
        if figure not in self.units:
            raise KeyError(f"{self.folder}: no figure {figure!r}; figures are {', '.join(self.units)}")
        return _OfRuns(numpy.array([run.figures[figure] for run in self.runs]), self.units[figure], "", figure,
                       tuple(run.name for run in self.runs if run.doubt(figure)))

    def values(self, key: str) -> numpy.ndarray:
        """[runs] values of a swept key: numbers if all are numeric, else strings. KeyError for other keys."""
        if key not in self.keys:
            raise KeyError(f"{self.folder}: {key!r} was not swept; swept keys are {', '.join(self.keys)}")
        texts = [run.keys[key] for run in self.runs]
        numbers = numpy.array([value_of(text) for text in texts])
        return numpy.array(texts) if numpy.isnan(numbers).any() else numbers

    @cached_property
    def means(self) -> dict[str, list[SweepMean]]:
        """{figure: [mean of each combination]} with 95 % intervals over seeds; {} for a sweep without seeds. Figures
        have the names in `units`, that is the column names of summary.csv without units. KeyError lists the figures."""
        file = self.folder / "intervals.csv"
        means = _Means()
        if not file.is_file():
            return means
        with fields_of(file, "means of a sweep"):
            for row in read_csv(file):
                name, unit = split_unit(row["figure"])
                mean = Estimate(value_of(row["mean"]), value_of(row["half width"]), unit, name)
                difference = Estimate(value_of(row["difference to the first"]),
                                      value_of(row["half width of the difference"]), unit,
                                      f"{name}, difference to the first")
                keys = {key: row[key] for key in self.keys if key in row}
                means.setdefault(name, []).append(SweepMean(keys, int(row["seeds"]), mean, difference, row.get("inconclusive", "")))
        return means


def open_sweep(folder: str | os.PathLike) -> Sweep:
    """Opens the folder of a sweep. FileError if it has no summary.csv."""
    return Sweep(folder)
