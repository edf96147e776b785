# SPDX-License-Identifier: BSD-3-Clause
"""The panels of [[output.plot]]: columns of the results over time or each other."""
import tomllib

import numpy

import drawing

COLUMNS = 2  # panels side by side


def column(run, name):
    """A column by its name in timeseries.csv; the last part may be a vector component."""
    if name == "time":
        return run.time
    path = name.replace(".", "/")
    values = run.get(path)
    if values is not None:
        return values
    path, part = path.rsplit("/", 1)
    return run.get(path)[:, run.components(path).index(part)]


def scaled(values, plot, axis):
    known = values[numpy.isfinite(values)]
    start = known[0] if plot[f"{axis}_from_start"] and len(known) else 0.0
    return plot[f"{axis}_scale"] * (values - start) + plot[f"{axis}_offset"]


def panel(axes, run, plot):
    x = scaled(column(run, plot["x"]), plot, "x")
    curves = [scaled(column(run, name), plot, "y") for name in plot["y"]]
    if plot["sum"]:
        curves = [sum(curves)]
    for values, label in zip(curves, plot.get("labels", [None] * len(curves))):
        axes.plot(x, values, label=drawing.label(label), linewidth=1.2)
    for k, (level, label) in enumerate(zip(plot.get("levels", []), plot.get("level_labels", []))):
        axes.axhline(level, color="black", linewidth=1.0, linestyle=("--", ":", "-.")[k % 3], label=drawing.label(label))
    axes.set_xlabel(plot["x_label"])
    axes.set_ylabel(plot["y_label"])
    axes.set_xlim(plot.get("x_range"))
    axes.set_ylim(plot.get("y_range"))
    drawing.legend_above(axes, columns=2)
    if plot.get("title"):
        axes.set_title(plot["title"], fontsize=10, pad=6 + 14 * -(-len(axes.get_legend_handles_labels()[1]) // 2))


def plot(run):
    panels = tomllib.loads(run.text("scene")).get("output", {}).get("plot", [])
    if not panels or len(run.time) == 0:
        return None
    across = min(COLUMNS, len(panels))
    down = -(-len(panels) // across)
    figure = drawing.Figure(figsize=(5.2 * across, 3.6 * down))
    places = list(figure.subplots(down, across, squeeze=False).flat)
    for axes, one in zip(places, panels):
        panel(axes, run, one)
    for axes in places[len(panels):]:
        axes.remove()
    return figure
