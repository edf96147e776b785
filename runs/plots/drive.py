# SPDX-License-Identifier: BSD-3-Clause
"""Vehicle speed and sprocket speed x pitch radius, track tension, drive torque."""
import numpy

import drawing
import series

COLOURS = {"left": "tab:blue", "right": "tab:orange"}
# The right track is thin and on top, so that both are visible if they coincide.
WIDTHS = {"left": 2.4, "right": 1.0}


def plot(run):
    speeds = {side: run.get(f"vehicle/{side}/sprocket_speed") for side in series.SIDES}
    if all(values is None for values in speeds.values()):
        return None
    radius = run.get("vehicle/pitch_radius")
    figure = drawing.Figure(figsize=(8.0, 8.0))
    speed, tension, torque = figure.subplots(3, 1, sharex=True)
    for side, omega in speeds.items():
        if omega is None:
            continue
        colour, width = COLOURS[side], WIDTHS[side]
        hull = run.get(f"vehicle/{side}/speed")
        if hull is not None:
            speed.plot(run.time, hull, color=colour, linewidth=width, label=f"hull at the {side} track")
        if radius is not None:
            speed.plot(run.time, omega * radius, color=colour, linestyle="--", linewidth=width,
                       label=f"{side} sprocket speed x pitch radius")
        joints = run.get(f"vehicle/{side}/tension")
        if series.finite(joints):
            tension.fill_between(run.time, joints.min(axis=1), joints.max(axis=1), color=colour, alpha=0.2, linewidth=0)
            tension.plot(run.time, numpy.mean(joints, axis=1), color=colour, linewidth=width,
                         label=f"{side}: mean (line) and range (band) of its pins")
        drive_torque = run.get(f"vehicle/{side}/drive_torque")
        if drive_torque is not None:
            torque.plot(run.time, drive_torque, color=colour, linewidth=width, label=f"{side} sprocket")
    speed.set_ylabel("speed [m/s]")
    tension.set_ylabel("track tension [N]")
    torque.set_ylabel("drive torque of each sprocket [N m]")
    torque.set_xlabel("time [s]")
    for axis in (speed, tension, torque):
        drawing.legend_above(axis, 2, 9)
    return figure
