# SPDX-License-Identifier: BSD-3-Clause
"""Mobility events: what a vehicle passed at which level, its limits, and what was measured."""
from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from .errors import FileError
from .files import fields_of, read_json
from .run import Run
from .series import Estimate, counted, number, split_unit


@dataclass(frozen=True, eq=False)
class EventRun:
    """One run of an event at a level."""

    verdict: str  #: "go", "no-go", "failed" (for another cause than the vehicle's), "incomplete", "pending"
    why: str
    folder: Path


@dataclass(frozen=True, eq=False)
class EventRow:
    """An event at one of its levels."""

    event: str  #: its word, as `grouser events --only` takes it
    title: str
    level: float  #: NaN for an event without levels
    level_is: str  #: what the level is, with its unit
    verdict: str  #: "go", "no-go", "pending"..., as events.txt has it
    why: str  #: of the first run that is no go; where all are, of the first
    runs: int  #: that have ended
    each: tuple[EventRun, ...]  #: all of them, by seed; empty in files of versions that did not write it
    figures: dict[str, Estimate]  #: means with half of the 95 % interval over the seeds; NaN where there is one
    overrides: tuple[str, ...]  #: keys of this level, "key=value", laid over `scene`
    scene: str  #: of the event
    folder: Path | None  #: of its first run

    def open(self) -> Run:
        """The results of its first run. FileError where there are none."""
        if self.folder is None:
            raise FileError(f"{self.event}: none of its runs has ended")
        return Run(self.folder)


@dataclass(frozen=True, eq=False)
class EventLimit:
    """Between which levels an event ends to be passed."""

    event: str
    level_is: str
    go: float  #: the hardest level that all runs pass; NaN where there is none
    no_go: float  #: the easiest that some do not; NaN where all pass
    reference: str  #: what geometry and friction say
    agrees: bool | None  #: None where that cannot be said


class Events:
    """The folder of `grouser events`. `for row in events` goes through events and levels; `events["step"]` has the rows
    of one event."""

    def __init__(self, folder: str | os.PathLike):
        self.folder: Path = Path(folder)
        file = self.folder / "events.json"
        self.json: dict = read_json(file, "events")  #: all of events.json
        if "rows" not in self.json:
            raise FileError(f"{file}: is no file of events")
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
        each = tuple(EventRun(run["verdict"], run["why"], self.folder / run["run"]) for run in one.get("each", []))
        return EventRow(one["event"], one["title"], number(one["level"]), one["level_is"], one["verdict"], one["why"],
                        one["runs"], each, figures, tuple(one.get("overrides", ())), one.get("scene", ""),
                        self.folder / Path(picture).parent if picture else None)

    def __getitem__(self, event: str) -> list[EventRow]:
        """KeyError names the events that there are."""
        rows = [row for row in self.rows if row.event == event]
        if not rows:
            raise KeyError(f"{self.folder}: there is no event {event!r}; there are "
                           f"{', '.join(dict.fromkeys(row.event for row in self.rows))}")
        return rows

    def __iter__(self) -> Iterator[EventRow]:
        return iter(self.rows)

    def __len__(self) -> int:
        return len(self.rows)


def open_events(folder: str | os.PathLike) -> Events:
    """Opens the folder of `grouser events`. FileError where it has no events.json."""
    return Events(folder)
