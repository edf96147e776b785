# SPDX-License-Identifier: BSD-3-Clause
"""Plot of a soil's tests: soil.py PLATES.csv SHEAR.csv SOIL.json FILE.png

Pressure over sinkage of both plates on logarithmic axes with Bekker's equation, shear stress over displacement of each
load with the Janosi-Hanamoto equation, and shear over normal stress with the Mohr-Coulomb line; missing tests are
omitted.
"""
import json
import math

import drawing


def draw_plates(axis, table, soil):
    """Loading of each test from the fitted origin of that test (thin lines), and k z^n of each plate."""
    curves = {}
    for row in table:
        sinkage = float(row["sinkage [m]"]) - float(row["origin [m]"])
        if float(row["phase"]) == 0 and sinkage > 0 and float(row["pressure [Pa]"]) > 0:
            curves.setdefault((row["plate"], float(row["breadth [m]"]), row["seed"]), []).append(
                (1e3 * sinkage, 1e-3 * float(row["pressure [Pa]"])))
    plates = sorted({(breadth, plate) for plate, breadth, _ in curves})
    for (plate, breadth, _), points in curves.items():
        axis.loglog(*zip(*points), linewidth=0.4, alpha=0.6, color=f"C{plates.index((breadth, plate))}",
                    label=f"{plate}, {1e3 * breadth:.0f} mm")
    n = (soil.get("constants", {}).get("n") or {}).get("value")
    for index, plate in enumerate(soil.get("plates", [])):
        k = plate["k"]["value"]
        depths = [z for (name, _, _), points in curves.items() if name == ("small", "large")[index] for z, _ in points]
        if n is None or k is None or not depths:
            continue
        ends = [max(max(depths) / 100, min(depths)), max(depths)]
        axis.loglog(ends, [k * (1e-3 * z) ** n for z in ends], "k--" if index else "k-", linewidth=1.0,
                    label=f"k z^n, {('small', 'large')[index]}")
    axis.set_xlabel("sinkage [mm]")
    axis.set_ylabel("pressure [kPa]")


def draw_shear(left, right, table, soil):
    """Shear curves of each load, and the residual strength."""
    curves = {}
    for row in table:
        curves.setdefault((float(row["load [Pa]"]), row["seed"]), []).append(
            tuple(1e-3 * float(row[key]) for key in ("shear stress [Pa]", "normal stress [Pa]"))
            + (1e3 * float(row["displacement [m]"]),))
    loads = sorted({load for load, _ in curves})
    constants = soil.get("constants", {})
    c, phi, modulus = (constants.get(key, {}).get("value") for key in ("c", "phi", "K"))
    for (load, _), points in curves.items():
        colour = f"C{loads.index(load)}"
        left.plot([p[2] for p in points], [p[0] for p in points], linewidth=0.4, alpha=0.6, color=colour,
                  label=f"{1e-3 * load:g} kPa")
        half = points[len(points) // 2:]
        right.plot(sum(p[1] for p in half) / len(half), sum(p[0] for p in half) / len(half), "o", markersize=3,
                   color=colour)
    way = max(p[2] for points in curves.values() for p in points)
    if None not in (c, phi, modulus):
        strength = [c + 1e-3 * load * math.tan(math.radians(phi)) for load in loads]
        steps = [way * k / 100 for k in range(101)]
        for limit in strength:
            left.plot(steps, [limit * -math.expm1(-j / modulus) for j in steps], "k-", linewidth=0.8)
        ends = [0, 1.1e-3 * loads[-1]]
        right.plot(ends, [c + p * math.tan(math.radians(phi)) for p in ends], "k-", linewidth=0.8,
                   label=f"c = {c:.2f} kPa, phi = {phi:.1f} deg")
    left.set_xlabel("displacement [mm]")
    left.set_ylabel("shear stress [kPa]")
    right.set_xlabel("normal stress [kPa]")
    right.set_ylabel("residual shear stress [kPa]")


def draw(plates, shear, results):
    with open(results, encoding="utf-8") as file:
        soil = json.load(file)
    plate_rows, shear_rows = drawing.rows(plates), drawing.rows(shear)
    count = bool(plate_rows) + 2 * bool(shear_rows)
    if not count:
        return None
    figure, axes = drawing.panels(count)
    if plate_rows:
        draw_plates(axes[0], plate_rows, soil)
    if shear_rows:
        draw_shear(*axes[-2:], shear_rows, soil)
    for axis in axes:
        drawing.legend_above(axis, 2, 6)
    care = " (coarse)" if soil["care"] == "coarse" else ""
    figure.suptitle(f"{soil['soil']}{care}, grains of {2e3 * soil['grain_radius_m']:g} mm", fontsize=9)
    return figure


if __name__ == "__main__":
    drawing.main(__doc__, draw, files=3)
