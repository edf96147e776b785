# SPDX-License-Identifier: BSD-3-Clause
"""Heights of four consecutive shoes, and the sinkage of all."""
import numpy
from matplotlib.figure import Figure

import series


def last_contact(on_ground):
    """(first row, last row) of the longest stretch of True that ends before the last row; None where there is none."""
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
    """True where the shoe rises by more than 0.1 m within the run after it has left the ground run."""
    end = stretch[1]
    return end + 1 < rows and numpy.nanmax(heights[end:]) - heights[end] > 0.1


def choose_four(heights, sinkage):
    """Four consecutive shoes of one track that lie on the ground run and are then picked up by the sprocket: those that
    lay there longest. Falls back on the shoes that carry the vehicle longest where none has been picked up."""
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


def heights(run):
    pads, sinkage = run.shoes("pad_height"), run.shoes("sinkage")
    chosen = choose_four(pads, sinkage) if pads and sinkage and pads.keys() >= sinkage.keys() else None
    if chosen is None:
        return None
    side, four = chosen
    figure = Figure(figsize=(8.0, 6.5))
    whole, close = figure.subplots(2, 1, sharex=True)
    level = []
    for shoe in four:
        height, on_ground = pads[side][:, shoe], numpy.isfinite(sinkage[side][:, shoe])
        (line,) = whole.plot(run.time, height, label=f"{side} {shoe}")
        close.plot(run.time, height, color=line.get_color(), alpha=0.4, linewidth=0.9)
        close.plot(run.time, numpy.where(on_ground, height, numpy.nan), color=line.get_color(), linewidth=1.8)
        level.append(height[on_ground])
    level = numpy.concatenate(level)
    margin = max(0.003, 0.6 * float(numpy.ptp(level)))
    close.set_ylim(level.min() - margin, level.max() + margin)
    whole.set_ylabel("pad height [m]")
    whole.set_title("Four consecutive shoes over the ground run and up the sprocket")
    whole.legend(ncol=4, loc="upper left")
    close.set_ylabel("pad height [m], close-up")
    close.set_xlabel("time [s]")
    return figure


def sinkage(run):
    tracks = {side: values for side, values in run.shoes("sinkage").items() if series.finite(values)}
    if not tracks:
        return None
    figure = Figure(figsize=(8.0, 5.0))
    axes = figure.subplots(1, len(tracks), sharey=True, squeeze=False)[0]
    for axis, (side, values) in zip(axes, tracks.items()):
        axis.plot(run.time, 1000 * values, color="tab:blue", alpha=0.25, linewidth=0.8)
        some = numpy.isfinite(values).any(axis=1)
        mean = numpy.full(len(run.time), numpy.nan)
        mean[some] = numpy.nanmean(values[some], axis=1)
        axis.plot(run.time, 1000 * mean, color="black", label="mean of the shoes on the ground run")
        axis.set_title(f"{side} track")
        axis.set_xlabel("time [s]")
        axis.legend(loc="lower right")
    axes[0].set_ylabel("sinkage [mm]")
    axes[0].invert_yaxis()
    if all(numpy.nanmax(values) < 0 for values in tracks.values()):
        figure.suptitle("Below zero: grousers carry the pads above the surface", fontsize=9)
    return figure
