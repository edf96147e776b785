# SPDX-License-Identifier: BSD-3-Clause
"""The undisturbed surface that sinkage is measured from, or how far the vehicle has pressed and raised it: a map with the
way of the vehicle, and a section along it."""
import numpy

import drawing


def plot(run):
    field = run.field("terrain/surface/height")
    x, y = run.field("terrain/surface/x"), run.field("terrain/surface/y")
    way = run.get("vehicle/position")
    if field is None or way is None:
        return None
    final = run.field("terrain/surface/final_height")
    figure = drawing.Figure(figsize=(8.0, 6.0))
    plan, section = figure.subplots(2, 1, gridspec_kw={"height_ratios": [2, 1]})
    shown = field if final is None else final - field
    if final is None:
        mesh = plan.pcolormesh(x, y, 1000 * shown, shading="gouraud", cmap="terrain", rasterized=True)
    else:
        most = 1000 * float(numpy.percentile(numpy.abs(shown), 99.5)) + 1e-3
        mesh = plan.pcolormesh(x, y, 1000 * shown, shading="gouraud", cmap="RdBu", vmin=-most, vmax=most, rasterized=True)
    plan.plot(way[:, 0], way[:, 1], color="black", linewidth=1.0, label="middle of the sprockets' axle")
    plan.set_aspect("equal")
    plan.set_ylabel("y [m]")
    plan.grid(False)
    plan.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0))
    figure.colorbar(mesh, ax=plan, label="undisturbed surface [mm]" if final is None else "rise of the surface [mm]")
    row = int(numpy.argmin(numpy.abs(y - way[0, 1])))
    if final is not None:
        # Through the deepest rut.
        row = int(numpy.argmin(shown.mean(axis=1)))
        section.plot(x, 1000 * final[row], color="black", linewidth=1.0, label="at the end")
    section.plot(x, 1000 * field[row], color="tab:brown", label="undisturbed")
    section.set_xlim(x[0], x[-1])
    section.set_xlabel("x [m]")
    if final is not None:
        section.legend(fontsize=8)
    section.set_ylabel(f"height at y = {y[row]:.2f} m [mm]")
    return figure
