# SPDX-License-Identifier: BSD-3-Clause
"""The undisturbed surface, or its change by the vehicle: a map with the vehicle's path, and a section along x."""
import numpy

import drawing

LEFT, MAP, BAR = 0.9, 6.0, 1.1  # [inch] across
BELOW, SECTION, GAP, ABOVE = 0.9, 1.7, 0.25, 0.4  # [inch] upwards


def layout(wide, high):
    """A figure with a map of `wide` x `high` to scale, a section below the map with the same x axis, and a colour
    bar."""
    height = min(9.0, max(0.6, MAP * high / wide))
    width = min(MAP, height * wide / high)
    across, up = LEFT + width + BAR, BELOW + SECTION + GAP + height + ABOVE
    figure = drawing.Figure(figsize=(across, up))
    figure.set_layout_engine("none")

    def place(left, bottom, right, top, **more):
        return figure.add_axes((left / across, bottom / up, (right - left) / across, (top - bottom) / up), **more)

    bottom = BELOW + SECTION + GAP
    plan = place(LEFT, bottom, LEFT + width, bottom + height)
    section = place(LEFT, BELOW, LEFT + width, BELOW + SECTION, sharex=plan)
    return figure, plan, section, place(LEFT + width + 0.15, bottom, LEFT + width + 0.3, bottom + height)


def ways(run):
    """[(positions, label)] of the vehicle, or of the bodies of a scene without a vehicle."""
    way = run.get("vehicle/position")
    if way is not None:
        return [(way, "middle of the sprocket axle")]
    bodies = [run.get(f"bodies/{name}/position") for name in run.names("bodies")]
    return [(way, "centres of mass of the bodies" if not k else None)
            for k, way in enumerate(way for way in bodies if way is not None)]


def soil(run):
    """Deformable soil: a map of the sinkage of the touched area, and a section along the deepest rut."""
    sinkage, (x0, y0) = run.field("terrain/soil/sinkage"), run.field("terrain/soil/origin")
    spacing = float(run.field("terrain/soil/spacing")[0])
    x, y = (start + spacing * numpy.arange(count) for start, count in zip((x0, y0), sinkage.shape[::-1]))
    figure, plan, section, bar = layout(float(x[-1] - x[0]) + spacing, float(y[-1] - y[0]) + spacing)
    for axes in (plan, bar):
        axes.grid(False)
    mesh = plan.pcolormesh(x, y, 1000 * sinkage, shading="nearest", cmap="YlOrBr", rasterized=True)
    for way, label in ways(run):
        plan.plot(way[:, 0], way[:, 1], color="black", linewidth=1.0, label=label,
                  marker="." if numpy.ptp(way[:, :2], axis=0).max() < spacing else None)
    plan.tick_params(labelbottom=False)
    plan.set_ylabel("y [m]")
    drawing.legend_above(plan)
    figure.colorbar(mesh, cax=bar, label="sinkage [mm]")
    row = int(numpy.argmax(sinkage.mean(axis=1)))
    section.plot(x, -1000 * sinkage[row], color="tab:brown")
    plan.set_xlim(x[0] - spacing / 2, x[-1] + spacing / 2)
    plan.set_ylim(y[0] - spacing / 2, y[-1] + spacing / 2)
    section.set_xlabel("x [m]")
    section.set_ylabel(f"height [mm]\nat y = {y[row]:.2f} m")
    return figure


def plot(run):
    if run.field("terrain/soil/sinkage") is not None:
        return soil(run)
    field = run.field("terrain/surface/height")
    x, y = run.field("terrain/surface/x"), run.field("terrain/surface/y")
    way = run.get("vehicle/position")
    if field is None or way is None:
        return None
    final = run.field("terrain/surface/final_height")
    figure, plan, section, bar = layout(float(x[-1] - x[0]), float(y[-1] - y[0]))
    shown = field if final is None else final - field
    plan.grid(False)
    bar.grid(False)
    if final is None:
        mesh = plan.pcolormesh(x, y, 1000 * shown, shading="gouraud", cmap="terrain", rasterized=True)
    else:
        most = 1000 * float(numpy.percentile(numpy.abs(shown), 99.5)) + 1e-3
        mesh = plan.pcolormesh(x, y, 1000 * shown, shading="gouraud", cmap="RdBu", vmin=-most, vmax=most, rasterized=True)
    plan.plot(way[:, 0], way[:, 1], color="black", linewidth=1.0, label="middle of the sprocket axle")
    plan.tick_params(labelbottom=False)
    plan.set_ylabel("y [m]")
    drawing.legend_above(plan)
    figure.colorbar(mesh, cax=bar, label="undisturbed surface [mm]" if final is None else "rise of the surface [mm]")
    row = int(numpy.argmin(numpy.abs(y - way[0, 1])))
    if final is not None:
        # Section through the deepest rut.
        row = int(numpy.argmin(shown.mean(axis=1)))
        section.plot(x, 1000 * final[row], color="black", linewidth=1.0, label="at the end")
    section.plot(x, 1000 * field[row], color="tab:brown", label="undisturbed")
    plan.set_xlim(x[0], x[-1])
    plan.set_ylim(y[0], y[-1])
    section.set_xlabel("x [m]")
    if final is not None:
        section.legend(loc="upper center", bbox_to_anchor=(0.5, -0.26), ncol=2, fontsize=8)
    section.set_ylabel(f"height [mm]\nat y = {y[row]:.2f} m")
    return figure
