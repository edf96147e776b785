# SPDX-License-Identifier: BSD-3-Clause
"""Plot of a sweep: sweep.py SUMMARY.csv|INTERVALS.csv FILE.png

Sinkage, slip, torque and tension over the first swept key, one line for each combination of the others; from intervals
with bars, half of the 95 % interval over the seeds to either side.
"""
import drawing

# (axis label, factor, columns with their line style and name, which stand above the panel where there are two)
PANELS = (
    ("sinkage [mm]", 1000, (("sinkage mean [m]", "-", "mean"), ("sinkage max [m]", "--", "deepest shoe"))),
    ("slip [-]", 1, (("slip [-]", "-", ""),)),
    ("drive torque, both sprockets [N m]", 1, (("drive torque [N m]", "-", ""),)),
    ("track tension [N]", 1, (("tension mean [N]", "-", "mean"), ("tension peak [N]", "--", "peak"))),
)
NOTES = {False: "Means over the steady part of each run",
         True: "Means over the steady part, with 95 % intervals over the seeds"}


def number(text):
    try:
        return float(text)
    except ValueError:
        return None


def points(path):
    """Swept keys, and [(values of the keys, {figure: (mean, half width)})]."""
    table = drawing.rows(path)
    names = list(table[0])
    found = {}
    if "figure" in names:
        keys = names[:names.index("figure")]
        for row in table:
            if number(row["mean"]) is not None:
                pair = number(row["mean"]), number(row["half width"]) or 0.0
                found.setdefault(tuple(row[key] for key in keys), {})[row["figure"]] = pair
        return keys, list(found.items()), True
    keys = names[1:names.index("status")]
    return keys, [(tuple(row[key] for key in keys), {name: (number(text), 0.0) for name, text in row.items()
                                                     if number(text) is not None})
                  for row in table if row["status"] == "finished"], False


def curves(keys, rows):
    """[(label, rows)]: one for each combination of all keys but the first."""
    found = {}
    for values, figures in rows:
        found.setdefault(values[1:], []).append((values, figures))
    return [(", ".join(f"{k} = {v}" for k, v in zip(keys[1:], values)), some) for values, some in found.items()]


def draw(path):
    keys, rows, intervals = points(path)
    if not any(column in figures for _, figures in rows for _, _, columns in PANELS for column, _, _ in columns):
        return None
    keys, rows = keys or ["all runs"], [(values or ("",), figures) for values, figures in rows]
    words = list(dict.fromkeys(values[0] for values, _ in rows))
    numeric = all(number(word) is not None for word in words)
    place = {word: number(word) if numeric else index for index, word in enumerate(words)}  # words stand side by side
    figure = drawing.Figure(figsize=(8.0, 6.5))
    panels = figure.subplots(2, 2, sharex=True).flatten()
    for axis, (label, factor, columns) in zip(panels, PANELS):
        for index, (name, some) in enumerate(curves(keys, rows)):
            for column, style, part in columns:
                line = sorted((place[values[0]], factor * figures[column][0], factor * figures[column][1])
                              for values, figures in some if column in figures)
                if not line:
                    continue
                x, y, half = zip(*line)
                axis.errorbar(x, y, yerr=half if intervals else None, capsize=3, marker="o",
                              markersize=4, linestyle=style if numeric else "none", color=f"C{index % 10}",
                              markerfacecolor=None if style == "-" else "none", label=name if style == "-" and name else None)
        axis.set_ylabel(label)
        if len(columns) > 1:
            axis.set_title(", ".join(f"{'filled' if style == '-' else 'open'}: {part}" for _, style, part in columns), fontsize=8)
        if not numeric:
            axis.set_xticks(range(len(words)), words)
            axis.margins(x=0.15)
    for axis in panels[2:]:
        axis.set_xlabel(keys[0])
    panels[0].invert_yaxis()
    figure.suptitle(NOTES[intervals], fontsize=9)
    drawing.legend_below(figure, panels)
    return figure


if __name__ == "__main__":
    drawing.main(__doc__, draw, dpi=110)
