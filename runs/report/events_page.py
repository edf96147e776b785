# SPDX-License-Identifier: BSD-3-Clause
"""The report of mobility events: what was passed at which level, limits beside what is expected, figures over the
level."""
import math

import grouser
import page as pages
import sweep_page
from page import esc, facts, number, table, with_bar


def level_of(row):
    return "" if row["level"] is None else number(row["level"], "", f"{row['event']} level")


def known(value):
    return math.nan if value is None else value


def verdicts(rows):
    lines = []
    for row in rows:
        more = [f"{row[what]} {what}" for what in ("failed", "pending") if row.get(what)]
        lines.append([esc(row["title"]), level_of(row), esc(row["level_is"]), f"<strong>{esc(row['verdict'])}</strong>",
                      str(row["runs"]), esc("; ".join([row["why"], *more] if row["why"] else more))])
    return table(["event", "level", "level is", "verdict", "runs", "why"], lines, "Go: how many of the runs pass it.",
                 numeric=(1, 4))


def limits(found, titles):
    lines = [[esc(titles.get(limit["event"], limit["event"])), esc(limit["level_is"]), number(limit["go"]),
              number(limit["no_go"]), esc(limit["reference"] or ""),
              "" if limit["agrees"] is None else "agrees" if limit["agrees"] else "does not agree"] for limit in found]
    return table(["event", "level is", "go up to", "no-go from", "expected", "and it"], lines,
                 "The hardest level that all runs pass, and the easiest that some do not.", numeric=(2, 3)) if lines \
        else ""


def figures(rows):
    lines = []
    for row in rows:
        for figure in row["figures"]:
            name, unit = grouser.series.split_unit(figure["name"])
            half = known(figure["half_width"])
            label = f"{row['event']} {'' if row['level'] is None else row['level']} {name}"
            lines.append([esc(row["title"]), level_of(row), esc(name),
                          with_bar(figure["mean"], half if math.isfinite(half) else None, "", label), esc(unit),
                          str(figure["runs"])])
    return table(["event", "level", "figure", "mean", "unit", "runs"], lines,
                 "\u00b1 half of the 95 % interval over the seeds, where there are several.", numeric=(1, 3, 5))


def plots(made, rows):
    """Each figure over the level, of the events that have several levels."""
    curves = {}
    for row in rows:
        for figure in row["figures"]:
            if row["level"] is not None and figure["mean"] is not None:
                points = curves.setdefault((row["event"], row["title"], row["level_is"], figure["name"]), [])
                half = known(figure["half_width"])
                points.append((row["level"], figure["mean"], half if math.isfinite(half) else 0.0))
    inner = []
    for (_, title, level, name), points in curves.items():
        if len(points) > 1:
            columns = [list(column) for column in zip(*sorted(points))]
            across = level if "[" in level else f"{level} [-]"
            inner.append(made.plot(f"{title}: {grouser.series.split_unit(name)[0]}", across,
                                   name if "[" in name else f"{name} [-]", [(name, *columns)],
                                   "Mean over the runs of a level; band: its 95 % interval, where there are several."))
    return f'<div class="plots">{"".join(inner)}</div>' if inner else ""


def page(folder, options):
    opened = grouser.open_events(folder)
    events = opened.json
    made = pages.Page(f"{folder.resolve().name} (events)", "series of mobility events", folder)
    rows = events["rows"]
    left_out = "".join(f"<p>Left out: {esc(event)}: {esc(why)}</p>" for event, why in events.get("left_out", {}).items())
    coarse = '<p class="bad">Coarse: made with <code>--quick</code>.</p>' if events.get("quick") else ""
    made.section("figures", "Go or no-go", coarse + verdicts(rows) + left_out)
    made.section("limits", "Limits", limits(events.get("limits", []), {row["event"]: row["title"] for row in rows}))
    made.section("pictures", "Pictures", pages.pictures([
        pages.picture(folder / name, words) for name, words in (("pictures.png", "Every event"),
                                                                ("events.png", "Figures over the levels"),
                                                                ("drawbar.png", "Drawbar pull over slip"))]))
    made.section("numbers", "Figures", figures(rows))
    made.section("plots", "Plots", plots(made, rows))
    sweep_page.add_runs(made, [row.folder for row in opened if row.folder], options, "The first run of each level.")
    made.section("provenance", "Where it comes from", facts([
        ("command", f"<code>{esc(events.get('command', ''))}</code>"), ("vehicle", esc(events.get("vehicle", ""))),
        ("soil", esc(events.get("soil", ""))), ("seeds", esc(str(events.get("seeds", "")))),
        ("speed", number(events.get("speed_m_s"), "m/s", "speed_m_s")),
        ("grain radius", number(events.get("grain_radius_m"), "m", "grain_radius_m")),
        ("depth of beds", number(events.get("bed_depth_m"), "m", "bed_depth_m")),
        ("commit", f"<code>{esc(events.get('commit', ''))}</code>"), ("machine", esc(events.get("machine", "")))]))
    return made
