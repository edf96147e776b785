# SPDX-License-Identifier: BSD-3-Clause
"""Single shoes over time: single_shoes.py RESULTS.h5 [CONTROL.h5] SHOES FILE.png   SHOES: 10,11,12; for one track
left:10,11,12

Pad heights and sinkage over time. Curves of a control run are grey, in the background, and shifted in time so that the
sprockets of both runs start together.
"""
import packages

packages.require("numpy", "matplotlib", "h5py")
import h5py
import numpy

import drawing
import series
from shoes import say_empty

CARRYING = {"linewidth": 2.0}
OFF_GROUND = {"linewidth": 0.8, "alpha": 0.5}


def drive_begin(run):
    """Time of the last row before the sprockets turn [s]; 0 if unknown."""
    teeth = run.get("vehicle/left/teeth_passed")
    if teeth is None:
        return 0.0
    turning = numpy.nonzero(numpy.abs(teeth) > 1e-6)[0]
    return run.time[max(0, turning[0] - 1)] if len(turning) else 0.0


def surface_under(pads, sinkage):
    """Mean height of the undisturbed surface under the shoes [m]."""
    return numpy.nanmean(pads + sinkage) if numpy.isfinite(sinkage).any() else 0.0


def draw_control(axes, run, control, side, shoes):
    """Height offset between the grounds of both runs, by which the pads of the control run are shifted."""
    time = control.time - drive_begin(control) + drive_begin(run)
    pads, sinkage = control.shoes("pad_height").get(side), control.shoes("sinkage").get(side)
    if sinkage is None:
        return
    lift = surface_under(run.shoes("pad_height")[side], run.shoes("sinkage")[side]) - surface_under(pads, sinkage)
    for shoe in shoes:
        axes[0].plot(time, pads[:, shoe] + lift, color="0.75", zorder=0, linewidth=1.0)
        axes[1].plot(time, 1000 * sinkage[:, shoe], color="0.75", zorder=0, **CARRYING)
    axes[1].plot([], [], color="0.75", label="control", **CARRYING)


def main():
    results, *others, chosen, file = drawing.words(__doc__, lambda given: len(given) in (3, 4))
    *track, chosen = chosen.split(":")
    shoes = [int(shoe) for shoe in chosen.split(",")]
    with h5py.File(results, "r") as opened:
        run = series.Run(opened)
        tracks = {side: values for side, values in run.shoes("sinkage").items() if side in track or not track}
        pads = run.shoes("pad_height")
        figure = drawing.Figure(figsize=(4.5 + 4.5 * (len(tracks) - 1), 6.5))
        columns = figure.subplots(2, len(tracks), sharex=True, sharey="row", squeeze=False).T
        for axes, (side, sinkage) in zip(columns, tracks.items()):
            for other in others:
                with h5py.File(other, "r") as control:
                    draw_control(axes, run, series.Run(control), side, shoes)
            for shoe in shoes:
                on_ground = numpy.isfinite(sinkage[:, shoe])
                height = pads[side][:, shoe]
                (line,) = axes[0].plot(run.time, height, **OFF_GROUND)
                axes[0].plot(run.time, numpy.where(on_ground, height, numpy.nan), color=line.get_color(),
                             **CARRYING)
                axes[1].plot(run.time, 1000 * sinkage[:, shoe], color=line.get_color(), label=f"shoe {shoe}",
                             **CARRYING)
            if not numpy.isfinite(sinkage[:, shoes]).any():
                say_empty(axes[1])
            axes[0].set_title(f"{side} track")
            axes[1].set_xlabel("time [s]")
            axes[1].legend(loc="upper center", bbox_to_anchor=(0.5, -0.18), fontsize=8, ncol=4)
        columns[0][1].invert_yaxis()
        columns[0][0].set_ylabel("pad height [m]")
        columns[0][1].set_ylabel("sinkage [mm]")
        drawing.save(figure, file, dpi=150)


if __name__ == "__main__":
    main()
