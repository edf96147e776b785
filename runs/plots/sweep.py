# SPDX-License-Identifier: BSD-3-Clause
"""Plot of a sweep: sweep.py SUMMARY.csv|INTERVALS.csv FILE.png

Sinkage, slip, torque, tension and, if the vehicle pulls, drawbar pull and motion resistance over the first swept key,
one line per combination of the other keys; with INTERVALS.csv also error bars (95 % intervals over the seeds).
"""
import math

import drawing

# (axis label, factor, columns with line style and name; names are in the title of panels with two columns)
PANELS = (
    ("sinkage [mm]", 1000, (("sinkage mean [m]", "-", "mean"), ("sinkage max [m]", "--", "deepest shoe"))),
    ("slip [-]", 1, (("slip [-]", "-", ""),)),
    ("drive torque, both sprockets [N m]", 1, (("drive torque [N m]", "-", ""),)),
    ("track tension [N]", 1, (("tension mean [N]", "-", "mean"), ("tension peak [N]", "--", "peak"))),
)
# Added if a drawbar pull exceeds this share of the gross traction; without a hitch, the pull is close to zero.
PULL_SHARE = 0.05
PULL_PANELS = (
    ("drawbar pull [N]", 1, (("drawbar pull [N]", "-", ""),)),
    ("motion resistance [N]", 1, (("motion resistance [N]", "-", ""),)),
)
PULLS = {column for _, _, columns in PULL_PANELS for column, _, _ in columns}
NOTE = "Means over the steady part"
OF_PULL = "direction of motion changes: "  # prefix of a reason that applies to the pull panels only


def number(text):
    try:
        return float(text)
    except ValueError:
        return None


def points(path):
    """Swept keys, [(values of the keys, {figure: (mean, half width, whether inconclusive)})], and whether these are
    means over seeds. Unknown half widths are NaN."""
    table = drawing.rows(path)
    names = list(table[0])
    found = {}
    if "figure" in names:
        keys = names[:names.index("figure")]
        for row in table:
            if number(row["mean"]) is not None:
                half = number(row["half width"])
                half = half if half is not None and math.isfinite(half) else math.nan
                one = number(row["mean"]), half, is_doubtful(row, row["figure"])
                found.setdefault(tuple(row[key] for key in keys), {})[row["figure"]] = one
        return keys, list(found.items()), True
    keys = names[1:names.index("status")]
    return keys, [(tuple(row[key] for key in keys), {name: (number(text), math.nan, is_doubtful(row, name))
                                                     for name, text in row.items() if number(text) is not None})
                  for row in table if row["status"] in ("finished", "incomplete")], False


def is_doubtful(row, column):
    doubt = row.get("inconclusive") or ""
    return row.get("status") == "incomplete" or bool(doubt) and (column in PULLS or not doubt.startswith(OF_PULL))


def curves(keys, rows):
    """[(label, rows)]: one entry for each combination of all keys except the first."""
    found = {}
    for values, figures in rows:
        found.setdefault(values[1:], []).append((values, figures))
    return [(", ".join(f"{k} = {v}" for k, v in zip(keys[1:], values)), some) for values, some in found.items()]


def has_pull(figures):
    pull, traction = (figures.get(name, (math.nan,))[0] for name in ("drawbar pull [N]", "gross traction [N]"))
    return abs(pull) > PULL_SHARE * abs(traction)


def note(rows, seeds, panels):
    """Caption: the values shown, and the marks of inconclusive values."""
    shown = [figures[column] for _, figures in rows for _, _, columns in panels for column, _, _ in columns if column in figures]
    text = NOTE + (" of each run" if not seeds else ", with 95 % intervals over the seeds"
                   if any(math.isfinite(half) for _, half, _ in shown) else ", without intervals: one seed each")
    return text + ("; crosses: inconclusive" if any(doubtful for _, _, doubtful in shown) else "")


def draw(path):
    keys, rows, seeds = points(path)
    if not any(column in figures for _, figures in rows for _, _, columns in PANELS for column, _, _ in columns):
        return None
    keys, rows = keys or ["all runs"], [(values or ("",), figures) for values, figures in rows]
    words = list(dict.fromkeys(values[0] for values, _ in rows))
    numeric = all(number(word) is not None for word in words)
    place = {word: number(word) if numeric else index for index, word in enumerate(words)}  # text: evenly spaced
    shown = PANELS + (PULL_PANELS if any(has_pull(figures) for _, figures in rows) else ())
    figure = drawing.Figure(figsize=(8.0, 3.25 * len(shown) / 2))
    panels = figure.subplots(len(shown) // 2, 2, sharex=True).flatten()
    for axis, (label, factor, columns) in zip(panels, shown):
        for index, (name, some) in enumerate(curves(keys, rows)):
            for column, style, part in columns:
                found = sorted((place[values[0]], factor * figures[column][0], factor * figures[column][1], figures[column][2])
                               for values, figures in some if column in figures)
                sound = [point[:3] for point in found if not point[3]], {
                    "marker": "o", "markersize": 4, "linestyle": style if numeric else "none",
                    "markerfacecolor": None if style == "-" else "none", "label": name if style == "-" and name else None}
                doubtful = [point[:3] for point in found if point[3]], {"marker": "x", "markersize": 5, "linestyle": "none"}
                for line, look in filter(lambda part: part[0], (sound, doubtful)):
                    x, y, half = zip(*line)
                    axis.errorbar(x, y, yerr=half if any(map(math.isfinite, half)) else None, capsize=3, color=f"C{index % 10}", **look)
        axis.set_ylabel(label)
        if len(columns) > 1:
            axis.set_title(", ".join(f"{'filled' if style == '-' else 'open'}: {part}" for _, style, part in columns), fontsize=8)
        if not numeric:
            axis.set_xticks(range(len(words)), words)
            axis.margins(x=0.15)
    for axis in panels[-2:]:
        axis.set_xlabel(keys[0])
    panels[0].invert_yaxis()
    figure.suptitle(note(rows, seeds, shown), fontsize=9)
    drawing.legend_below(figure, panels)
    return figure


if __name__ == "__main__":
    drawing.main(__doc__, draw, dpi=110)
