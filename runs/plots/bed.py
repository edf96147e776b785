# SPDX-License-Identifier: BSD-3-Clause
"""Structure of the settled bed: porosity over depth, and radial distribution."""
import drawing


def plot(run):
    depth, porosity = run.field("terrain/bed/depth"), run.field("terrain/bed/porosity_at_depth")
    distance, radial = run.field("terrain/bed/distance"), run.field("terrain/bed/radial_distribution")
    if depth is None or len(depth) == 0:
        return None
    # Beds of few layers have no radial distribution.
    figure, (left, *rest) = drawing.panels(2 if len(distance) > 0 else 1)
    bulk = run.get("terrain/bed/porosity")
    left.plot(porosity, 1000 * depth, color="tab:brown")
    left.axvline(bulk, color="black", linestyle=":", linewidth=1, label=f"bulk {bulk:.3f}")
    left.set_xlabel("porosity [-]")
    left.set_ylabel("depth below the surface [mm]")
    left.set_xlim(0, 1)
    left.invert_yaxis()
    drawing.legend_above(left)
    for right in rest:
        right.plot(distance, radial, color="tab:brown")
        right.axhline(1, color="black", linestyle=":", linewidth=1)
        right.set_xlabel("distance [mean diameters]")
        right.set_ylabel("radial distribution [-]")
        order = run.get("terrain/bed/order")
        right.set_title(f"{100 * order:.1f} % of the grains in crystalline order", fontsize=9)
    return figure
