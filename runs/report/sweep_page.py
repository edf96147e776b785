# SPDX-License-Identifier: BSD-3-Clause
"""The report of a sweep, or of other folders with the tables of a sweep: figures over the varied keys, means with
intervals over seeds, all runs."""
import contextlib
import itertools
import math
import re
import subprocess
from collections import Counter

import numpy

import damage
import definitions
import grouser
import ground_table
import page as pages
import run_page
import space
from grouser.series import counted
from page import esc, facts, figure_with_bar, folded, number, run_name, table, term

MOST_CURVES = 7
MOST_SPACES = 16  # maximum number of runs in the list of the 3-D view
MOST_LEDGERS = 100
MOST_FILMS = 6e6  # maximum total size of embedded films [bytes]


def text_of(keys):
    return ", ".join(f"{name} = {value}" for name, value in zip(short_keys(keys), keys.values())) or "unchanged scene"


def short_keys(keys):
    """Shortest distinct endings of the keys: "sand.friction" and "rock.friction"."""
    words = [key.split(".") for key in keys]

    def end(of, count):
        return ".".join(of[-count:])

    return [end(of, next((count for count in range(1, len(of)) if sum(end(other, count) == end(of, count)
                                                                      for other in words) == 1), len(of)))
            for of in words]


def follows(sweep, name):
    """Whether a figure depends only on the varied keys: seeds change it by no more than rounding."""
    means = [m.mean for m in sweep.means.get(name, []) if math.isfinite(m.mean.half_width)]
    return bool(means) and all(m.half_width <= 1e-9 * abs(m.value) for m in means)


def lively(sweep):
    """Figures with values that change; figures that depend only on the varied keys come last."""
    found = []
    for name in sweep.units:
        values = sweep[name].value
        there = values[numpy.isfinite(values)]
        if len(there) and (numpy.ptp(there) > 0 or len(sweep.runs) == 1):
            found.append(name)
    return sorted(found, key=lambda name: follows(sweep, name))


def varied(sweep):
    """The key on the x axis of the plots: the first key with several numeric values, except the seed."""
    for key in sweep.keys:
        values = sweep.values(key)
        if key != "run.seed" and values.dtype.kind == "f" and len(set(values)) > 1:
            return key
    return None


def unit_of(key, program):
    """The unit of a scene key from the program's tables; "-" if the key has no unit or the program does not answer."""
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


def without(keys, *left_out):
    return {key: value for key, value in keys.items() if key not in left_out}


def across_of(sweep, program):
    """x axis of the plots: label, functions from a run's keys to position and curve, and a note. The first key with
    several numeric values, else the number of the combination; None for a single combination."""
    key = varied(sweep)
    if key is not None:
        return (f"{key} [{unit_of(key, program)}]", lambda keys: float(keys[key]),
                lambda keys: text_of(without(keys, key)), "")
    names = list(dict.fromkeys(text_of(without(run.keys, "run.seed")) for run in sweep.runs))
    words = " " + "; ".join(f"{k}: {name}" for k, name in enumerate(names, 1)) + "."
    return (("combination [-]", lambda keys: names.index(text_of(without(keys, "run.seed"))) + 1.0, lambda keys: "", words)
            if len(names) > 1 else None)


def curves_of(sweep, name, place, curve):
    """{curve: sorted points} of a figure: means over the seeds with error bars, or one point per run; and the number of
    points omitted because the vehicle drove too little."""
    groups, left_out = {}, 0
    for mean in sweep.means.get(name, []):
        half = mean.mean.half_width
        if mean.inconclusive and not mean.mean.inconclusive:
            left_out += math.isfinite(mean.mean.value)
            continue
        groups.setdefault(curve(mean.keys), []).append(
            (place(mean.keys), mean.mean.value, half if math.isfinite(half) else math.nan))
    for run in sweep.runs if name not in sweep.means else []:
        if run.doubt(name):
            left_out += math.isfinite(run.figures[name])
            continue
        groups.setdefault(curve(run.keys), []).append((place(run.keys), run.figures[name]))
    return {label: sorted(p for p in points if math.isfinite(p[1])) for label, points in groups.items()}, left_out


def plots(made, sweep, program):
    across = across_of(sweep, program)
    if across is None:
        return ""
    axis, place, curve, words = across
    told = "Means over the seeds; bars: 95 % intervals." if sweep.means else \
        "One point per run, without error bars: one run per combination."
    inner, hidden = [], []
    for name in lively(sweep):
        groups, left_out = curves_of(sweep, name, place, curve)
        drawn = [(label if len(groups) > 1 else name, *map(list, zip(*points)))
                 for label, points in list(groups.items())[:MOST_CURVES] if points]
        if left_out and not drawn:
            hidden.append(esc(definitions.label(name)))
        if drawn:
            alone = sum(math.isnan(half) for _, _, _, *halves in drawn for half in (halves[0] if halves else ()))
            more = f" No error bar for {counted(alone, 'point')} with only one finished seed." if alone else ""
            more += f" {len(groups) - MOST_CURVES} more combinations in the table." if len(groups) > MOST_CURVES else ""
            more += f" {counted(left_out, 'inconclusive point')} omitted." if left_out else ""
            label = definitions.label(name)
            inner.append(made.plot(label[:1].upper() + label[1:], axis, f"{label} [{sweep.units[name]}]", drawn,
                                   told + words + more, marks=True, whole=bool(words), about=definitions.definition(name)))
    note = f"<p>Not drawn because all values are inconclusive: {', '.join(hidden)}.</p>" if hidden else ""
    return note + (f'<div class="plots">{"".join(inner)}</div>' if inner else "")


def means_table(sweep):
    if not sweep.means:
        return ""
    names = [name for name in lively(sweep) if name in sweep.means]
    if not names:
        return ""
    combinations = [m.keys for m in sweep.means[names[0]]]
    def half(estimate):
        return estimate.half_width if math.isfinite(estimate.half_width) else None
    words = "Means over the seeds, \u00b1 half width of the 95 % interval."
    words += definitions.note({name: [m.mean.value for m in sweep.means[name]] for name in names})
    if max(m.seeds for m in sweep.means[names[0]]) == 2:
        words += " With two seeds, the half width is 12.7 standard errors; use three or more seeds."
    if len(combinations) <= 6:
        rows = [[term(n), esc(sweep.units[n]), *(figure_with_bar(m.mean.value, half(m.mean), "", f"{n} {text_of(m.keys)}",
                                                                         bool(m.inconclusive))
                                                for m in sweep.means[n])] for n in names]
        return table(["figure", "unit", *map(text_of, combinations)], rows,
                     f"{words} Seeds: {', '.join(str(m.seeds) for m in sweep.means[names[0]])}.",
                     numeric=range(2, 2 + len(combinations)))
    rows = [[esc(text_of(keys)), str(sweep.means[names[0]][k].seeds),
             *(figure_with_bar(sweep.means[n][k].mean.value, half(sweep.means[n][k].mean), "", f"{n} {text_of(keys)}",
                               bool(sweep.means[n][k].inconclusive))
               for n in names)] for k, keys in enumerate(combinations)]
    return table(["", "seeds", *(f"{n} [{sweep.units[n]}]" for n in names)], rows, words,
                 numeric=range(1, 2 + len(names)))


def runs_table(sweep, faults):
    """`faults`: {run: message about missing or damaged files}."""
    def message(run):
        fault = faults.get(run.name)
        doubt = f"Inconclusive: {run.inconclusive}" if run.inconclusive and run.inconclusive != run.message else ""
        return esc(" ".join(filter(None, (run.message, doubt)))) + (f' <strong class="fault">Files: {esc(fault)}</strong>' if fault else "")

    def figure(run, name):
        doubtful = run.doubt(name) and math.isfinite(run.figures[name])
        return number(run.figures[name], "", f"{run.name} {name}") + (pages.INCONCLUSIVE if doubtful else "")

    names = [n for n in sweep.units if numpy.isfinite(sweep[n].value).any()]
    has_words = faults or any(run.message or run.inconclusive for run in sweep.runs)
    rows = [[run_name(run.name), *(esc(v) for v in run.keys.values()), esc(run.status),
             *([message(run)] if has_words else []),
             *(figure(run, n) for n in names), f"<code>{esc(run.state_hash)}</code>"]
            for run in sweep.runs]
    first = (3 if has_words else 2) + len(sweep.keys)
    headings = ["run", *sweep.keys, "status", *(["message"] if has_words else []),
                *(f"{n} [{sweep.units[n]}]" for n in names), "state hash"]
    note = definitions.note({name: [run.figures[name] for run in sweep.runs] for name in names})
    return table(headings, rows, f"All runs, as in summary.csv.{note}", numeric=range(first, first + len(names)))


def opened(folders):
    """The readable runs in the folders."""
    for folder in folders:
        try:
            yield damage.open_whole(folder)
        except grouser.FileError:
            continue


def faults_of(folders):
    """{run: message} for runs with missing or damaged files."""
    return {folder.name: fault for folder in folders if (fault := damage.fault_of(folder))}


def first_whole(groups):
    """From each group of run folders, the first undamaged folder, or else the first; and the faults of all folders."""
    faults = faults_of([folder for group in groups for folder in group])
    return [next((folder for folder in group if folder.name not in faults), group[0]) for group in groups if group], faults


def add_runs(made, folders, options, words):
    """Adds films, 3-D view and ledgers of the runs, and active features, scene and provenance of the first run.
    `folders`: folders of the runs; `words`: describes the selection."""
    with contextlib.ExitStack() as stack:
        runs = [stack.enter_context(run) for run in itertools.islice(opened(folders), MOST_LEDGERS)]
        made.section("films", "Films", films(folders, options))
        if not runs:
            return
        view = space.section(made, runs[:MOST_SPACES], options)
        made.section("space", "3-D view", f"<p>{esc(words)}</p>{view}" if view else "")
        made.section("ledger", "Energy ledgers", run_page.ledger(runs))
        name = esc(runs[0].folder.name)
        made.section("switches", "Active features",
                     f"<p>Run <code>{name}</code>.</p>{run_page.switches(runs[0].manifest)}")
        made.section("scene", "Scene", run_page.scene(runs[0], f"Resolved scene of {runs[0].folder.name}"))
        made.section("first", "First run", run_page.provenance(runs[0]))


def films(folders, options):
    """Films in the folders of the runs or next to them."""
    if options.film:
        return run_page.films([], options)
    return run_page.films(list(dict.fromkeys([*(f.parent for f in folders), *(f for f in folders if f.is_dir())])),
                          options, MOST_FILMS)


def first_seeds(sweep, faults):
    """Folder of the first finished and undamaged run of each combination."""
    found = {}
    for run in sweep.runs:
        if run.status in ("finished", "incomplete"):
            keys = tuple((k, v) for k, v in run.keys.items() if k != "run.seed")
            if found.setdefault(keys, run).name in faults and run.name not in faults:
                found[keys] = run
    return [run.folder for run in found.values()]


def notices_of(sweep):
    """Different warnings and notes of the runs: [(whether a warning, text, number of runs)], warnings first."""
    found = Counter(text for run in sweep.runs for text in dict.fromkeys(run.notices))
    return sorted(((text.startswith("WARNING: "), text.split(": ", 1)[1], runs) for text, runs in found.items()),
                  key=lambda one: not one[0])


def page(folder, options):
    sweep = grouser.open_sweep(folder)
    made = pages.Page(f"{sweep.folder.resolve().name} (sweep)", "sweep", folder)
    ended = [run.status for run in sweep.runs]
    if all(status in ("pending", "running") for status in ended):
        raise grouser.FileError(f"{folder}: none of the {counted(len(ended), 'run')} of this sweep has finished; run "
                                "the same grouser sweep command again to continue it")
    bad = [run for run in sweep.runs if run.status not in ("finished", "pending")]
    told = facts([("varied", ", ".join(f"<code>{esc(k)}</code>: {esc(', '.join(dict.fromkeys(r.keys[k] for r in sweep.runs)))}"
                                       for k in sweep.keys)),
                  ("runs", f"{len(ended)}, of which {ended.count('finished')} finished")])
    if bad:
        told += "".join(f'<p class="bad">{esc(run.name)}: {esc(run.status)}. {esc(run.message)}</p>' for run in bad)
    faults = faults_of([run.folder for run in sweep.runs if run.status in ("finished", "incomplete")])
    damage.warn(made, faults, " Figures are those of summary.csv; unreadable runs are missing in the 3-D view and the "
                "ledgers.")
    notes = damage.add_notices(made, notices_of(sweep))
    made.section("figures", "Figures", told + means_table(sweep) + notes + folded("All runs", runs_table(sweep, faults),
                                                                           opened=not sweep.means or bool(faults)))
    if grounds := ground_table.section(folder):
        made.section("grounds", "Comparison", grounds)
    made.section("plots", "Plots", plots(made, sweep, options.program))
    add_runs(made, first_seeds(sweep, faults), options, "First run of each combination.")
    return made
