#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Drops a boulder from several heights and fits an exponent, with error bar, to penetration depth over drop height.

    python/examples/boulder_drops.py [FOLDER] [SEEDS] [PICTURE]      # default: out/boulder_drops, 3 seeds, no picture

Experiments with balls in dry grains follow depth = 0.14 / mu (rho / rho_bed)^(1/2) D^(2/3) H^(1/3): ball diameter D and
density rho, total drop height H (drop height plus depth), mu the tangent of the angle of repose (Uehara, Ambroso, Ojha,
Durian 2003, Phys. Rev. Lett. 90, 194301).
"""
from __future__ import annotations

import sys
from pathlib import Path

import numpy

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))  # if the package is not installed
import grouser  # noqa: E402

SCENE = Path(__file__).resolve().parents[2] / "runs/scenes/boulder.toml"
DROP_HEIGHTS = (0.0625, 0.125, 0.25, 0.5, 1.0)  # [m]
RADIUS, DENSITY = 0.1, 2600  # boulder [m], [kg/m3]
REPOSE = 32  # angle of repose of the sand (docs/soils.md#virtual-soil-tests) [deg]
GRAVITY = 9.81  # [m/s2]


def depth_of(run: grouser.Run) -> float:
    """Largest penetration depth [m]: drop of the lowest point since the start, minus the clearance."""
    place = run["bodies.boulder.position"]["z"].value
    return float(place[0] - place.min()) - 0.001


def exponent(heights: numpy.ndarray, depths: numpy.ndarray) -> tuple[float, float]:
    """Slope of log(depth) over log(total drop height) and half width of its 95 % interval (linear regression) [-]."""
    x, y = numpy.log(heights[:, None] + depths).ravel(), numpy.log(depths).ravel()
    slope, offset = numpy.polyfit(x, y, 1)
    free = len(x) - 2
    deviation = numpy.sqrt(numpy.sum((y - slope * x - offset) ** 2) / free / numpy.sum((x - x.mean()) ** 2))
    return float(slope), float(student(free) * deviation)


def student(free: int) -> float:
    """97.5 % quantile of Student's distribution (Cornish-Fisher expansion, within 1 % from 5 degrees of freedom on)."""
    z = 1.959964
    return z + (z**3 + z) / (4 * free) + (5 * z**5 + 16 * z**3 + 3 * z) / (96 * free**2)


def expected(height: float, depth: float, solid: float) -> float:
    """Penetration depth according to the experiments [m]; `solid`: solid fraction of the bed."""
    ratio = DENSITY / (2650 * solid)
    return 0.14 / numpy.tan(numpy.radians(REPOSE)) * ratio**0.5 * (2 * RADIUS) ** (2 / 3) * (height + depth) ** (1 / 3)


def main(folder: str = "out/boulder_drops", seeds: int = 3, picture: str = "", heights=DROP_HEIGHTS) -> numpy.ndarray:
    """Returns the penetration depths [heights, seeds] [m]."""
    scene = grouser.Scene.read(SCENE)
    scene["output"]["plots"] = scene["output"]["picture"] = False
    rows, porosity = [], 0.4
    for height in heights:
        scene["body"][0]["velocity"] = [0, 0, -float(numpy.sqrt(2 * GRAVITY * height))]
        depths = []
        for seed in range(1, int(seeds) + 1):
            scene["run.seed"] = seed
            with scene.run(Path(folder) / f"{height:g}_{seed}", force=True) as run:
                depths.append(depth_of(run))
                porosity = float(run.constants["terrain.bed.porosity"])
        rows.append(depths)
        mean = float(numpy.mean(depths))
        print(f"from {height:6.4f} m: depth {1000 * mean:.1f} mm, {1000 * min(depths):.1f} to {1000 * max(depths):.1f}; "
              f"experiments {1000 * expected(height, mean, 1 - porosity):.1f} mm", flush=True)
    result = numpy.array(rows)
    slope, bar = exponent(numpy.array(heights), result)
    print(f"depth scales as the {slope:.3f} +- {bar:.3f} th power of the total drop height; experiments: 1/3")
    if picture:
        draw(numpy.array(heights), result, 1 - porosity, picture)
    return result


def draw(heights: numpy.ndarray, depths: numpy.ndarray, solid: float, picture: str) -> None:
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    figure, axes = pyplot.subplots(figsize=(5, 3.8))
    whole = heights[:, None] + depths
    axes.loglog(whole, 1000 * depths, "o", color="tab:blue", alpha=0.6)
    slope, bar = exponent(heights, depths)
    line = numpy.linspace(whole.min(), whole.max(), 50)
    fit = numpy.exp(numpy.mean(numpy.log(depths)) - slope * numpy.mean(numpy.log(whole))) * line**slope
    axes.loglog(line, 1000 * fit, "-", color="tab:blue", label=f"grains: exponent {slope:.2f} +- {bar:.2f}")
    axes.loglog(line, [1000 * expected(h, 0, solid) for h in line], "k--", label="experiments: exponent 1/3")
    axes.set(xlabel="total drop height [m]", ylabel="penetration depth [mm]")
    for axis, ticks in ((axes.xaxis, (0.1, 0.2, 0.5, 1)), (axes.yaxis, (40, 60, 80, 100, 120))):
        axis.set_major_formatter("{x:g}")
        axis.set_ticks(ticks)
        axis.set_minor_formatter("")
    axes.legend()
    figure.tight_layout()
    figure.savefig(picture, dpi=110)


if __name__ == "__main__":
    main(*sys.argv[1:])
