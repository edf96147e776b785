# SPDX-License-Identifier: BSD-3-Clause
"""Heights of four consecutive shoes, and sinkage of all shoes."""
import numpy
from matplotlib.lines import Line2D

import drawing
import series


def last_contact(on_ground):
    """(first row, last row) of the longest sequence of True that ends before the last row; None if there is none."""
    best, begin = None, None
    for row, on in enumerate(on_ground):
        if on and begin is None:
            begin = row
        if not on and begin is not None:
            if best is None or row - begin > best[1] - best[0] + 1:
                best = (begin, row - 1)
            begin = None
    return best


def picked_up(heights, stretch, rows):
    """Whether the shoe rises by more than 0.1 m after its ground contact."""
    end = stretch[1]
    return end + 1 < rows and numpy.nanmax(heights[end:]) - heights[end] > 0.1


def choose_four(heights, sinkage):
    """Four consecutive shoes of a track: those with the longest ground contact among the shoes that then move up to the
    sprocket; if no shoe moves up, those with the longest ground contact."""
    best = None
    for side, values in sinkage.items():
        rows, count = values.shape
        stretches = [last_contact(numpy.isfinite(values[:, s])) for s in range(count)]
        good = [st is not None and picked_up(heights[side][:, s], st, rows) for s, st in enumerate(stretches)]
        length = [st[1] - st[0] + 1 if st else 0 for st in stretches]
        carried = numpy.isfinite(values).sum(axis=0)
        for first in range(count):
            four = [(first + k) % count for k in range(4)]
            score = (sum(good[s] for s in four), min(length[s] for s in four), min(carried[s] for s in four))
            if best is None or score > best[0]:
                best = (score, side, four)
    return (best[1], best[2]) if best and best[0][2] > 0 else None


def key_of(line_styles):
    """Grey legend handles that explain the line widths."""
    return [Line2D([], [], color="0.3", label=label, **style) for label, style in line_styles]


CARRYING = {"linewidth": 2.2}
OFF_GROUND = {"linewidth": 0.9, "alpha": 0.5}


def say_empty(axis):
    """Text in place of curves."""
    axis.text(0.5, 0.5, "no shoe in ground contact\nat any output time", ha="center", va="center",
              transform=axis.transAxes)


def heights(run):
    pads, sinkage = run.shoes("pad_height"), run.shoes("sinkage")
    if not pads or not sinkage or not pads.keys() >= sinkage.keys():
        return None
    chosen = choose_four(pads, sinkage)
    figure = drawing.Figure(figsize=(8.0, 6.5))
    if chosen is None:
        say_empty(figure.subplots())
        return figure
    side, four = chosen
    level = numpy.concatenate([pads[side][numpy.isfinite(sinkage[side][:, shoe]), shoe] for shoe in four])
    margin = max(0.003, 0.6 * float(numpy.ptp(level)))
    low, high = level.min() - margin, level.max() + margin
    all_heights = pads[side][:, four]
    # Adds a close-up if the total height range is much larger than the range in ground contact.
    has_close = float(numpy.nanmax(all_heights) - numpy.nanmin(all_heights)) > 2 * (high - low)
    panels = figure.subplots(1 + has_close, 1, sharex=True, squeeze=False)[:, 0]
    whole = panels[0]
    for shoe in four:
        height, on_ground = pads[side][:, shoe], numpy.isfinite(sinkage[side][:, shoe])
        colour = f"C{four.index(shoe)}"
        for axis in panels:
            axis.plot(run.time, height, color=colour, **OFF_GROUND)
            axis.plot(run.time, numpy.where(on_ground, height, numpy.nan), color=colour, **CARRYING, label=f"shoe {shoe}")
    whole.set_ylabel("pad height [m]")
    figure.suptitle(f"Four consecutive shoes of the {side} track", fontsize=11)
    shown = whole.get_legend_handles_labels()[0] + key_of((("in ground contact", CARRYING), ("not in ground contact", OFF_GROUND)))
    whole.legend(handles=shown, ncol=6, fontsize=8, loc="lower center", bbox_to_anchor=(0.5, 1.0))
    if has_close:
        panels[-1].set_ylim(low, high)
        panels[-1].set_ylabel("pad height [m], close-up")
    panels[-1].set_xlabel("time [s]")
    return figure


DEFINITION = ("Sinkage: along the normal of the undisturbed surface, down to the middle of the pad plate's underside;\n"
              "negative while grousers carry the pad above the surface")


def sinkage(run):
    tracks = {side: values for side, values in run.shoes("sinkage").items() if len(values)}
    if not tracks:
        return None
    figure = drawing.Figure(figsize=(9.0, 5.0))
    axes = figure.subplots(1, len(tracks), sharey=True, squeeze=False)[0]
    for axis, (side, values) in zip(axes, tracks.items()):
        axis.set_title(f"{side} track")
        axis.set_xlabel("time [s]")
        some = numpy.isfinite(values).any(axis=1)
        if not some.any():
            axis.set_xlim(run.time[0], max(run.time[-1], run.time[0] + 1e-9))
            say_empty(axis)
            continue
        shoes = axis.plot(run.time, 1000 * values, color="tab:blue", alpha=0.25, linewidth=0.8)
        shoes[0].set_label("each shoe in ground contact")
        mean = numpy.full(len(run.time), numpy.nan)
        mean[some] = numpy.nanmean(values[some], axis=1)
        axis.plot(run.time, 1000 * mean, color="black", label="mean of shoes in ground contact")
        for line in axis.legend(loc="upper center", bbox_to_anchor=(0.5, -0.12), ncol=2, fontsize=8).get_lines():
            line.set_alpha(1)
    axes[0].set_ylabel("sinkage [mm]")
    axes[0].invert_yaxis()
    figure.suptitle(DEFINITION, fontsize=9)
    return figure
