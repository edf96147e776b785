# SPDX-License-Identifier: BSD-3-Clause
"""The results of mobility events: verdicts by level, limits of the vehicle, and measured figures."""
from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from .errors import FileError
from .files import fields_of, inside, read_json
from .run import Run
from .series import Estimate, counted, number, split_unit


@dataclass(frozen=True, eq=False)
class EventRun:
    """One run of an event at a level."""

    verdict: str  #: "go", "no-go", "failed" (the run failed, not the vehicle), "incomplete", "pending"
    why: str  #: reason for the verdict
    folder: Path


@dataclass(frozen=True, eq=False)
class EventRow:
    """An event at one of its levels."""

    event: str  #: name, as in `grouser events --only`
    title: str
    level: float  #: NaN for an event without levels
    level_is: str  #: meaning of the level, with its unit
    verdict: str  #: "go", "no-go", "pending"..., as in events.txt
    why: str  #: reason for the verdict of the first run that is not a go, else of the first run
    runs: int  #: number of finished runs
    each: tuple[EventRun, ...]  #: all runs, by seed; empty in files of older versions
    figures: dict[str, Estimate]  #: means, with half of the 95 % interval over the seeds; half width NaN for one seed
    overrides: tuple[str, ...]  #: keys of this level, "key=value", applied to `scene`
    scene: str  #: scene of the event
    folder: Path | None  #: folder of the first run

    def open(self) -> Run:
        """Opens the results of the first run. FileError if no run has finished."""
        if self.folder is None:
            raise FileError(f"{self.event}: no run has finished")
        return Run(self.folder)


@dataclass(frozen=True, eq=False)
class EventLimit:
    """The limit of a vehicle in an event: it is between two levels."""

    event: str
    level_is: str
    go: float  #: the hardest level that all runs pass; NaN if there is no such level
    no_go: float  #: the easiest level that a run fails; NaN if there is no such level
    reference: str  #: limit expected from geometry and friction
    agrees: bool | None  #: True if the verdicts of all levels agree with the reference; None without a reference


class Events:
    """The folder of `grouser events`. `for row in events` iterates over all events and levels; `events["step"]` returns
    the rows of one event."""

    def __init__(self, folder: str | os.PathLike):
        self.folder: Path = Path(folder)
        file = self.folder / "events.json"
        self.json: dict = read_json(file, "events")  #: contents of events.json
        if "rows" not in self.json:
            raise FileError(f"{file}: not the events.json of mobility events")
        self.vehicle: str = self.json.get("vehicle", "")
        self.soil: str = self.json.get("soil", "")
        with fields_of(file, "events"):
            self.rows: list[EventRow] = [self._row(one) for one in self.json["rows"]]
            self.limits: dict[str, EventLimit] = {
                one["event"]: EventLimit(one["event"], one["level_is"], number(one["go"]), number(one["no_go"]),
                                         one.get("reference") or "", one.get("agrees"))
                for one in self.json.get("limits", [])}

    def __repr__(self) -> str:
        return f"<grouser.Events {self.folder}: {counted(len(self), 'row')}>"

    def _row(self, one: dict) -> EventRow:
        figures = {}
        for figure in one["figures"]:
            name, unit = split_unit(figure["name"])
            figures[name] = Estimate(number(figure["mean"]), number(figure["half_width"]), unit, name)
        picture = one.get("picture")
        file = self.folder / "events.json"
        each = tuple(EventRun(run["verdict"], run["why"], inside(self.folder, run["run"], file))
                     for run in one.get("each", []))
        return EventRow(one["event"], one["title"], number(one["level"]), one["level_is"], one["verdict"], one["why"],
                        one["runs"], each, figures, tuple(one.get("overrides", ())), one.get("scene", ""),
                        inside(self.folder, picture, file).parent if picture else None)

    def __getitem__(self, event: str) -> list[EventRow]:
        """Returns the rows of an event. KeyError lists the events."""
        rows = [row for row in self.rows if row.event == event]
        if not rows:
            raise KeyError(f"{self.folder}: no event {event!r}; events are "
                           f"{', '.join(dict.fromkeys(row.event for row in self.rows))}")
        return rows

    def __iter__(self) -> Iterator[EventRow]:
        return iter(self.rows)

    def __len__(self) -> int:
        return len(self.rows)


def open_events(folder: str | os.PathLike) -> Events:
    """Opens the folder of `grouser events`. FileError if it has no events.json."""
    return Events(folder)
