# SPDX-License-Identifier: BSD-3-Clause
"""A mechanism: paths of the centres of mass in the plane of their largest extent, energies, integration error, and
joint errors."""
import numpy

import drawing
import series

MOST_BODIES = 12
ROUND_OFF = 1e-15  # joint errors below this are rounding [m, rad]
AXES = "xyz"
TERMS = (("kinetic", "kinetic", "tab:blue"), ("potential", "potential", "tab:green"), ("elastic", "elastic", "tab:orange"),
         ("dissipated", "dissipated", "tab:red"), ("drive_work", "drive work", "black"))


def paths(axis, bodies):
    spread = numpy.max([values.max(axis=0) for values in bodies.values()], axis=0) - numpy.min(
        [values.min(axis=0) for values in bodies.values()], axis=0)
    flat = int(numpy.argmin(spread[::-1]))  # equal extents: omits the last axis
    across, up = [k for k in range(3) if k != 2 - flat]
    for name, values in list(bodies.items())[:MOST_BODIES]:
        line, = axis.plot(values[:, across], values[:, up], label=drawing.label(name), linewidth=1.0)
        axis.plot(values[-1:, across], values[-1:, up], "o", markersize=4, color=line.get_color())
    axis.set_aspect("equal", adjustable="datalim")
    axis.set_xlabel(f"{AXES[across]} [m]")
    axis.set_ylabel(f"{AXES[up]} [m]")
    left_out = len(bodies) - MOST_BODIES
    axis.set_title("paths of the centres of mass" + (f": {MOST_BODIES} of {len(bodies)} bodies" if left_out > 0 else ""),
                   fontsize=10)
    axis.legend(fontsize=7, loc="center left", bbox_to_anchor=(1.0, 0.5))


def plot(run):
    bodies = {name: run.get(f"bodies/{name}/position") for name in run.names("bodies")}
    if not bodies or len(run.time) == 0:
        return None
    figure = drawing.Figure(figsize=(10.0, 7.0))
    (where, energy), (rest, gap) = figure.subplots(2, 2)
    paths(where, bodies)
    for name, label, colour in TERMS:
        values = run.get(f"ledger/{name}")
        if series.finite(values) and numpy.nanmax(numpy.abs(values)) > drawing.NOTHING:
            energy.plot(run.time, values, color=colour, label=label)
    energy.set_ylabel("energy change since the start [J]")
    drawing.legend_above(energy)
    rest.plot(run.time, run.get("ledger/integration_error"), color="tab:purple")
    rest.set_ylabel("integration error [J]")
    for name, label in (("position_error", "position [m, rad]"), ("velocity_error", "velocity [m/s, rad/s]")):
        values = run.get(f"constraints/{name}")
        if series.finite(values) and (values >= ROUND_OFF).any():
            gap.semilogy(run.time, numpy.where(values >= ROUND_OFF, values, numpy.nan), label=label)
    if gap.get_legend_handles_labels()[0]:
        gap.set_ylabel("maximum joint error\nper output interval")
        drawing.legend_above(gap)
    else:  # joint errors below rounding
        gap.remove()
    for axis in (energy, rest, *([gap] if gap.figure else [])):
        axis.set_xlabel("time [s]")
        axis.set_xlim(run.time[0], max(run.time[-1], run.time[0] + 1e-9))
    return figure
