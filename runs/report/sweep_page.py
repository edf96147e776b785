# SPDX-License-Identifier: BSD-3-Clause
"""The report of a sweep, or of anything else whose tables are a sweep's: figures over what was varied, means with
intervals over seeds, every run."""
import contextlib
import itertools
import math
import re
import subprocess

import numpy

import grouser
import page as pages
import run_page
import space
from page import esc, facts, folded, number, table, with_bar

MOST_CURVES = 7
MOST_SPACES = 16  # runs that can be chosen in space
MOST_LEDGERS = 100
MOST_FILMS = 6e6  # bytes


def text_of(keys):
    return ", ".join(f"{key.rpartition('.')[2]} = {value}" for key, value in keys.items()) or "as the scene says"


def follows(sweep, name):
    """Whether a figure only follows from what was varied: seeds make no difference to it, but for rounding."""
    means = [m.mean for m in sweep.means.get(name, []) if math.isfinite(m.mean.half_width)]
    return bool(means) and all(m.half_width <= 1e-9 * abs(m.value) for m in means)


def lively(sweep):
    """Figures that are there and that change; last those that only follow from what was varied."""
    found = []
    for name in sweep.units:
        values = sweep[name].value
        there = values[numpy.isfinite(values)]
        if len(there) and (numpy.ptp(there) > 0 or len(sweep.runs) == 1):
            found.append(name)
    return sorted(found, key=lambda name: follows(sweep, name))


def varied(sweep):
    """The key whose values the plots go over: the first with several numbers, but for the seed."""
    for key in sweep.keys:
        values = sweep.values(key)
        if key != "run.seed" and values.dtype.kind == "f" and len(set(values)) > 1:
            return key
    return None


def unit_of(key, program):
    """The unit of a scene's key, by the program's own tables; "-" where it has none, or cannot be asked."""
    words = key.split(".")
    section, asked = (words[1], ["--vehicle"]) if words[0] == "spec" else (words[0], [])
    try:
        text = subprocess.run([program, "fields", *asked], capture_output=True, text=True, check=True).stdout
    except (OSError, TypeError, subprocess.CalledProcessError):
        return "-"
    here = ""
    for line in text.split("\n"):
        if title := re.match(r"### `\[+([a-z_]+)", line):
            here = title[1]
        cells = [cell.strip(" `") for cell in line.split("|")]
        if here == section and len(cells) > 2 and cells[1] == words[-1]:
            return cells[2] or "-"
    return "-"


def plots(made, sweep, program):
    key = varied(sweep)
    if key is None:
        return ""
    across = f"{key} [{unit_of(key, program)}]"
    inner = []
    for name in lively(sweep):
        axis = f"{name} [{sweep.units[name]}]"
        means = sweep.means.get(name)
        groups = {}
        if means:
            for mean in means:
                rest = text_of({k: v for k, v in mean.keys.items() if k != key})
                groups.setdefault(rest, []).append((float(mean.keys[key]), mean.mean.value, mean.mean.half_width))
            caption = "Mean over the seeds; bar: its 95 % interval."
        else:
            for run in sweep.runs:
                rest = text_of({k: v for k, v in run.keys.items() if k != key})
                groups.setdefault(rest, []).append((float(run.keys[key]), run.figures[name]))
            caption = "A point for each run."
        drawn = []
        for label, points in list(groups.items())[:MOST_CURVES]:
            points = sorted(p for p in points if math.isfinite(p[1]))
            if points:
                columns = [list(c) for c in zip(*points)]
                if len(columns) == 3:
                    columns[2] = [h if math.isfinite(h) else 0.0 for h in columns[2]]
                drawn.append((label if len(groups) > 1 else name, *columns))
        if drawn:
            more = f" {len(groups) - MOST_CURVES} more combinations stand in the table." if len(groups) > MOST_CURVES else ""
            inner.append(made.plot(name[:1].upper() + name[1:], across, axis, drawn, caption + more, marks=True))
    return f'<div class="plots">{"".join(inner)}</div>' if inner else ""


def means_table(sweep):
    if not sweep.means:
        return ""
    names = [name for name in lively(sweep) if name in sweep.means]
    if not names:
        return ""
    combinations = [m.keys for m in sweep.means[names[0]]]
    def half(estimate):
        return estimate.half_width if math.isfinite(estimate.half_width) else None
    words = "Means over the seeds, \u00b1 half of the 95 % interval."
    if max(m.seeds for m in sweep.means[names[0]]) == 2:
        words += " Of two seeds that is 12.7 standard errors: three or more tell more."
    if len(combinations) <= 6:
        rows = [[esc(n), esc(sweep.units[n]), *(with_bar(m.mean.value, half(m.mean), "", f"{n} {text_of(m.keys)}")
                                                for m in sweep.means[n])] for n in names]
        return table(["figure", "unit", *map(text_of, combinations)], rows,
                     f"{words} Seeds: {', '.join(str(m.seeds) for m in sweep.means[names[0]])}.",
                     numeric=range(2, 2 + len(combinations)))
    rows = [[esc(text_of(keys)), str(sweep.means[names[0]][k].seeds),
             *(with_bar(sweep.means[n][k].mean.value, half(sweep.means[n][k].mean), "", f"{n} {text_of(keys)}")
               for n in names)] for k, keys in enumerate(combinations)]
    return table(["", "seeds", *(f"{n} [{sweep.units[n]}]" for n in names)], rows, words,
                 numeric=range(1, 2 + len(names)))


def runs_table(sweep):
    names = [n for n in sweep.units if numpy.isfinite(sweep[n].value).any()]
    rows = [[f"<code>{esc(run.name)}</code>", *(esc(v) for v in run.keys.values()), esc(run.status), esc(run.message),
             *(number(run.figures[n], "", f"{run.name} {n}") for n in names), f"<code>{esc(run.state_hash)}</code>"]
            for run in sweep.runs]
    first = 3 + len(sweep.keys)
    return table(["run", *sweep.keys, "status", "message", *(f"{n} [{sweep.units[n]}]" for n in names), "state hash"],
                 rows, "Every run, as summary.csv has it.", numeric=range(first, first + len(names)))


def opened(folders):
    """The runs of folders that hold some."""
    for folder in folders:
        try:
            yield grouser.open_run(folder)
        except grouser.FileError:
            continue


def add_runs(made, folders, options, words):
    """Of runs that are there: films, the view in space of one after the other, their ledgers; of the first what was on
    and off, its scene, its machine. `folders`: whose runs are told; `words`: which these are."""
    with contextlib.ExitStack() as stack:
        runs = [stack.enter_context(run) for run in itertools.islice(opened(folders), MOST_LEDGERS)]
        made.section("films", "Films", films(folders, options))
        if not runs:
            return
        view = space.section(made, runs[:MOST_SPACES], options)
        made.section("space", "In space", f"<p>{esc(words)}</p>{view}" if view else "")
        made.section("ledger", "Energy ledgers", run_page.ledger(runs))
        name = esc(runs[0].folder.name)
        made.section("switches", "What was on and off",
                     f"<p>In the run <code>{name}</code>.</p>{run_page.switches(runs[0].manifest)}")
        made.section("scene", "Scene", folded(f"The resolved scene of {runs[0].folder.name}: every key with its value",
                                              f"<pre>{esc(run_page.pages_text(runs[0]))}</pre>"))
        made.section("first", "The first run", run_page.provenance(runs[0]))


def films(folders, options):
    """Those of the runs: in their folders, or beside them with their names."""
    if options.film:
        return run_page.films([], options)
    return run_page.films(list(dict.fromkeys([*(f.parent for f in folders), *(f for f in folders if f.is_dir())])),
                          options, MOST_FILMS)


def first_seeds(sweep):
    """Folders of the runs that have finished, of each combination the first one."""
    found = {}
    for run in sweep.runs:
        if run.status == "finished":
            found.setdefault(tuple((k, v) for k, v in run.keys.items() if k != "run.seed"), run.folder)
    return list(found.values())


def page(folder, options):
    sweep = grouser.open_sweep(folder)
    made = pages.Page(f"{sweep.folder.resolve().name} (sweep)", "sweep", folder)
    ended = [run.status for run in sweep.runs]
    if all(status in ("pending", "running") for status in ended):
        raise grouser.FileError(f"{folder}: none of the {len(ended)} runs of this sweep has ended yet; the same call of "
                                "grouser sweep goes on with it")
    bad = [run for run in sweep.runs if run.status not in ("finished", "pending")]
    told = facts([("varied", ", ".join(f"<code>{esc(k)}</code>: {esc(', '.join(dict.fromkeys(r.keys[k] for r in sweep.runs)))}"
                                       for k in sweep.keys)),
                  ("runs", f"{len(ended)}, of which {ended.count('finished')} have finished")])
    if bad:
        told += "".join(f'<p class="bad">{esc(run.name)}: {esc(run.status)}. {esc(run.message)}</p>' for run in bad)
    made.section("figures", "Figures", told + means_table(sweep) + folded("Every run", runs_table(sweep),
                                                                           opened=not sweep.means))
    made.section("plots", "Plots", plots(made, sweep, options.program))
    add_runs(made, first_seeds(sweep), options, "The first run of each combination.")
    return made
