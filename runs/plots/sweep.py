# SPDX-License-Identifier: BSD-3-Clause
"""Plot of a sweep: sweep.py SUMMARY.csv FILE.png

Sinkage, slip, torque and tension over the first swept key, one line for each combination of the others.
"""
import drawing

# (axis label, factor, columns with their line style and name)
PANELS = (
    ("sinkage [mm]", 1000, (("sinkage mean [m]", "-", "mean"), ("sinkage max [m]", "--", "deepest shoe"))),
    ("slip [-]", 1, (("slip [-]", "-", ""),)),
    ("drive torque, both sprockets [N m]", 1, (("drive torque [N m]", "-", ""),)),
    ("track tension [N]", 1, (("tension mean [N]", "-", "mean"), ("tension peak [N]", "--", "peak"))),
)


def number(text):
    try:
        return float(text)
    except ValueError:
        return None


def curves(keys, rows):
    """[(label, rows)]: one for each combination of all keys but the first."""
    found = {}
    for row in rows:
        found.setdefault(tuple(row[key] for key in keys[1:]), []).append(row)
    return [(", ".join(f"{k} = {v}" for k, v in zip(keys[1:], values)), some) for values, some in found.items()]


def draw(path):
    table = drawing.rows(path)
    rows = [row for row in table if row["status"] == "finished"]
    if not any(number(row.get(column, "")) is not None for row in rows for _, _, columns in PANELS for column, _, _ in columns):
        return None
    names = list(table[0])
    keys = names[1 : names.index("status")]  # the swept ones
    values = [row[keys[0]] for row in rows]
    if all(number(value) is not None for value in values):
        place = {value: number(value) for value in values}
    else:  # words stand side by side
        words = list(dict.fromkeys(values))
        place = {value: words.index(value) for value in values}
    figure = drawing.Figure(figsize=(8.0, 6.5))
    panels = figure.subplots(2, 2, sharex=True).flatten()
    for axis, (label, factor, columns) in zip(panels, PANELS):
        for index, (name, some) in enumerate(curves(keys, rows)):
            for column, style, part in columns:
                points = [(place[r[keys[0]]], factor * float(r[column])) for r in some if number(r.get(column, "")) is not None]
                if points:
                    text = ", ".join(filter(None, (name, part)))
                    axis.plot(*zip(*sorted(points)), style, marker="o", markersize=4, color=f"C{index % 10}",
                              label=text or None)
        axis.set_ylabel(label)
        if axis.get_legend_handles_labels()[0]:
            axis.legend(fontsize=8)
        if any(number(value) is None for value in values):
            axis.set_xticks(sorted(set(place.values())), [w for w, _ in sorted(place.items(), key=lambda item: item[1])])
    for axis in panels[2:]:
        axis.set_xlabel(keys[0])
    panels[0].invert_yaxis()
    figure.suptitle("Means over the steady part of each run", fontsize=9)
    return figure


if __name__ == "__main__":
    drawing.main(__doc__, draw, dpi=110)
