#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Presses a plate into a settled bed and compares the vertical stress below it with Boussinesq's.

    python/examples/plate_stress.py [FOLDER] [SEEDS] [PICTURE]      # default: out/plate_stress, 4 seeds, no picture
"""
from __future__ import annotations

import sys
from pathlib import Path

import numpy

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))  # if the package is not installed
import grouser  # noqa: E402

PLATE = 0.12  # edge of the plate [m]
CELL = 0.04  # cell size: a third of the plate, two grain diameters [m]
DEPTH, SIDE = 0.3, 0.5  # bed [m]


def scene_of(seed: int) -> grouser.Scene:
    """A plate that sinks at 20 mm/s."""
    scene = grouser.Scene(name="plate_stress")
    scene["run"] = {"duration": 0.6, "output_interval": 0.02, "frame_interval": 0.02, "seed": seed}
    scene["material.sand"] = {"density": 2600, "stiffness": 1e5, "restitution": 0.3, "friction": 0.5}
    scene["material.steel"] = {"stiffness": 1e5, "restitution": 0.3, "friction": 0.3}
    scene["terrain"] = {"heightmap": "heightmaps/flat.png", "size": [SIDE, SIDE], "height_range": [0, 0],
                        "material": "sand", "grain_radius": 0.01, "depth": DEPTH}
    scene.add("box", name="plate", position=[SIDE / 2, 0, 0], above_bed=0.001, size=[PLATE, PLATE, 0.02],
              velocity=[0, 0, -0.02], material="steel")
    half = 5.5 * CELL  # 11 x 11 cells, the inner 3 x 3 below the plate
    scene["output"] = {"plots": False, "picture": False, "fields_cell": CELL,
                       "fields_low": [SIDE / 2 - half, -half, -DEPTH], "fields_high": [SIDE / 2 + half, half, 0.02]}
    return scene


def below_corner(width: numpy.ndarray, length: numpy.ndarray, depth: float) -> numpy.ndarray:
    """Vertical stress / pressure at `depth` below a corner of a rectangle [-] (Boussinesq 1885, integrated: Newmark
    1935); odd in width and length."""
    r1, r2, r3 = width**2 + depth**2, length**2 + depth**2, width**2 + length**2 + depth**2
    return (numpy.arctan(width * length / (depth * numpy.sqrt(r3)))
            + width * length * depth / numpy.sqrt(r3) * (1 / r1 + 1 / r2)) / (2 * numpy.pi)


def boussinesq(depth: float) -> float:
    """Vertical stress over the pressure under a square of uniform pressure, mean over its footprint at a depth [-]."""
    x, y = numpy.meshgrid(*2 * [(numpy.arange(24) + 0.5) / 24 * PLATE])
    corners = [below_corner(a, b, depth) for a in (x, PLATE - x) for b in (y, PLATE - y)]
    return float(numpy.mean(sum(corners)))


def profile(run: grouser.Run) -> tuple[numpy.ndarray, numpy.ndarray]:
    """Depth of the cells [m], and added vertical stress / plate pressure [-]: means over the footprint of the plate and
    over the frames with a sinkage from 4 to 11 mm."""
    stress = run.fields("stress")
    force = run["surfaces.plate.force"]["z"]
    below = slice(len(stress.x) // 2 - 1, len(stress.x) // 2 + 2)
    vertical = -stress.value[:, :, below, below, 2, 2].mean(axis=(2, 3))
    pressed = [k for k, time in enumerate(stress.time) if 0.004 <= 0.02 * time - 0.001 <= 0.0111]
    pressure = numpy.mean([force.at(stress.time[k]) for k in pressed]) / PLATE**2
    return -stress.z[::-1], ((vertical[pressed].mean(axis=0) - vertical[0]) / pressure)[::-1]


def main(folder: str = "out/plate_stress", seeds: int = 4, picture: str = "") -> tuple[numpy.ndarray, numpy.ndarray]:
    """Depths [m], and the profiles of all seeds [seeds, depths]."""
    rows = []
    for seed in range(1, int(seeds) + 1):
        with scene_of(seed).run(Path(folder) / str(seed), force=True) as run:
            depth, ratio = profile(run)
            rows.append(ratio)
    depth, profiles = depth[depth > 0], numpy.array(rows)[:, depth > 0]
    for z, ratio in zip(depth, profiles.T):
        print(f"depth {z / PLATE:.2f} plates: {ratio.mean():.3f} of the pressure, {ratio.min():.3f} to {ratio.max():.3f}; "
              f"Boussinesq {boussinesq(z):.3f}")
    if picture:
        draw(depth, profiles, picture)
    return depth, profiles


def draw(depth: numpy.ndarray, profiles: numpy.ndarray, picture: str) -> None:
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    figure, axes = pyplot.subplots(figsize=(5, 4.2))
    fine = numpy.linspace(0.01, depth.max(), 200)
    axes.plot([boussinesq(z) for z in fine], fine / PLATE, "k-", label="Boussinesq, uniform pressure on a square")
    axes.plot(profiles.T, numpy.tile(depth / PLATE, (len(profiles), 1)).T, ".", color="tab:blue", alpha=0.5)
    axes.plot(profiles.mean(axis=0), depth / PLATE, "o-", color="tab:blue", label=f"grains, mean of {len(profiles)} beds")
    axes.set(xlabel="added vertical stress / plate pressure [-]", ylabel="depth / plate width [-]")
    axes.invert_yaxis()
    axes.legend()
    figure.tight_layout()
    figure.savefig(picture, dpi=110)


if __name__ == "__main__":
    main(*sys.argv[1:])
