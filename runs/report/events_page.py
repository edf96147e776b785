# SPDX-License-Identifier: BSD-3-Clause
"""The report of mobility events: verdicts by level, limits next to expected ones, figures over the level."""
import math

import damage
import definitions
import grouser
import page as pages
import sweep_page
from page import esc, facts, figure_with_bar, number, table, term


def level_of(row):
    return "" if row["level"] is None else number(row["level"], "", f"{row['event']} level")


def known(value):
    return math.nan if value is None else value


def causes(row):
    """Verdict and reason of each run, one line per run; of the whole row if the file has no verdicts of single runs."""
    more = [f"{row[what]} {what}" for what in ("failed", "incomplete", "pending") if row.get(what)]
    if not row.get("each"):
        return esc("; ".join([row["why"], *more] if row["why"] else more))
    if len(row["each"]) == 1:
        return esc(row["each"][0]["why"])
    return "<br>".join(f"{esc(seed_of(run['run']))}: {esc(run['verdict'])}{', ' if run['why'] else ''}{esc(run['why'])}"
                       for run in row["each"])


def seed_of(run):
    """"seed 2" of the folder "step=0.3,seed=2"."""
    word = run.rpartition(",")[2]
    return word.replace("=", " ") if word.startswith("seed=") else run


def verdicts(rows):
    lines = [[esc(row["title"]), level_of(row), esc(row["level_is"]), f"<strong>{esc(row['verdict'])}</strong>",
              causes(row)] for row in rows]
    return table(["event", "level", "meaning of the level", "verdict", "runs and reasons"], lines,
                 "2/3: two of three runs (beds with different seeds) pass. Partly: some runs pass, others fail.",
                 numeric=(1,))


def limits(found, titles):
    lines = [[esc(titles.get(limit["event"], limit["event"])), esc(limit["level_is"]), number(limit["go"]),
              number(limit["no_go"]), esc(limit["reference"] or ""),
              "" if limit["agrees"] is None else "agrees" if limit["agrees"] else "does not agree"] for limit in found]
    return table(["event", "meaning of the level", "hardest go", "easiest no-go", "expected (geometry, friction)",
                  "agreement"], lines,
                 "Hardest go: all runs pass at this level and at all easier levels. Easiest no-go: at least one run "
                 "fails at this level. None: no such level was run.", numeric=(2, 3)) if lines else ""


def by_event(rows):
    """[(title, meaning of the level, rows by level)], in the order of the file."""
    found = {}
    for row in rows:
        found.setdefault((row["event"], row["title"], row["level_is"]), []).append(row)
    return [(title, level, sorted(of, key=lambda row: row["level"] if row["level"] is not None else 0))
            for (_, title, level), of in found.items()]


def figures(rows, drawn):
    """One table per event: rows are figures, columns are levels."""
    inner = []
    for title, level, of in by_event(rows):
        names = list(dict.fromkeys(figure["name"] for row in of for figure in row["figures"]))
        if not names:
            continue
        lines = []
        for heading in names:
            name, unit = grouser.series.split_unit(heading)
            cells = []
            for row in of:
                figure = next((f for f in row["figures"] if f["name"] == heading), None)
                label = f"{row['event']} {'' if row['level'] is None else row['level']} {name}"
                half = known(figure["half_width"]) if figure else math.nan
                cells.append(figure_with_bar(figure["mean"], half if math.isfinite(half) else None, "", label,
                                             figure.get("inconclusive", False)) if figure else "")
            lines.append([term(name), esc(unit), *cells])
        across = [f"{row['level']:g}" if row["level"] is not None else "measured" for row in of]
        seeds = sorted({figure["runs"] for row in of for figure in row["figures"]})
        told = f"Levels: {esc(level)}. " if level else ""
        what = "95 % prediction interval for one more draw of the constants, from" if drawn else "95 % interval over"
        told += f"\u00b1 half width of the {what} {' or '.join(map(esc, seeds))} runs." if seeds[-1] > 1 else \
            "One run per level: no error bars."
        told += definitions.note({grouser.series.split_unit(figure["name"])[0]: [known(figure["mean"])]
                                  for row in of for figure in row["figures"]})
        inner.append(f"<h3>{esc(title)}</h3>" + table(["figure", "unit", *across], lines, told,
                                                     numeric=range(2, 2 + len(of))))
    return "".join(inner)


def plots(made, rows):
    """Each figure over the level, for events with several levels."""
    curves = {}
    for row in rows:
        for figure in row["figures"]:
            if row["level"] is not None and figure["mean"] is not None:
                points = curves.setdefault((row["event"], row["title"], row["level_is"], figure["name"]), [])
                points.append((row["level"], figure["mean"], known(figure["half_width"])))
    inner = []
    for (_, title, level, name), points in curves.items():
        if len(points) > 1:
            levels, means, halves = (list(column) for column in zip(*sorted(points)))
            told = "Mean over the runs of a level; bars: 95 % intervals, if there are several runs."
            if not any(map(math.isfinite, halves)):
                told = "One point per level, without error bars: one run per level."
            columns = [levels, means, [half if math.isfinite(half) else math.nan for half in halves]]
            across = level if "[" in level else f"{level} [-]"
            plain = grouser.series.split_unit(name)[0]
            inner.append(made.plot(f"{title}: {definitions.label(plain)}", across,
                                   name if "[" in name else f"{name} [-]", [(name, *columns)],
                                   told, marks=True, about=definitions.definition(plain)))
    return f'<div class="plots">{"".join(inner)}</div>' if inner else ""


def runs_of(folder, row):
    """Folders of the runs with a verdict at a level; if the file lists no runs, the folder of the picture."""
    told = [run["run"] for run in row.get("each", []) if run["verdict"] != "failed"]
    names = told or [row.get("picture", "").rpartition("/")[0]]
    return [grouser.files.inside(folder, name, folder / "events.json") for name in names if name]


def page(folder, options):
    events = grouser.open_events(folder).json
    made = pages.Page(f"{folder.resolve().name} (events)", "series of mobility events", folder)
    rows = [row for _, _, of in by_event(events["rows"]) for row in of]
    if not any(row["runs"] or row.get("failed") or row.get("incomplete") for row in rows):
        raise grouser.FileError(f"{folder}: none of the runs of these events has finished; grouser events --resume "
                                "continues them")
    left_out = "".join(f"<p>Omitted: {esc(event)}: {esc(why)}</p>" for event, why in events.get("left_out", {}).items())
    coarse = '<p class="bad">WARNING: coarse settings (<code>--quick</code>).</p>' if events.get("quick") else ""
    made.section("figures", "Go or no-go", coarse + verdicts(rows) + left_out)
    made.section("limits", "Limits", limits(events.get("limits", []), {row["event"]: row["title"] for row in rows}))
    made.section("pictures", "Pictures", "".join(  # in a column, because they are wide
        pages.picture(folder / name, words) for name, words in (("pictures.png", "All events"),
                                                                ("events.png", "Figures over the levels"),
                                                                ("drawbar.png", "Drawbar pull over slip"))))
    made.section("numbers", "Figures", figures(rows, bool(events.get("draws"))))
    made.section("plots", "Plots", plots(made, rows))
    folders, faults = sweep_page.first_whole([runs_of(folder, row) for row in rows])
    damage.warn(made, faults)
    sweep_page.add_runs(made, folders, options, "First run of each level.")
    made.section("provenance", "Provenance", facts([
        ("command", f"<code>{esc(events.get('command', ''))}</code>"), ("vehicle", esc(events.get("vehicle", ""))),
        ("soil", esc(events.get("soil", ""))), ("seeds", esc(str(events.get("seeds", "")))), ("draws", esc(str(events.get("draws", 0)))),
        ("speed", number(events.get("speed_m_s"), "m/s", "speed_m_s")),
        *((what, number(events[key], "m", key)) for what, key in (("grain radius", "grain_radius_m"),
                                                                  ("bed depth", "bed_depth_m")) if events.get(key)),
        ("commit", f"<code>{esc(events.get('commit', ''))}</code>"), ("machine", esc(events.get("machine", "")))]))
    return made
