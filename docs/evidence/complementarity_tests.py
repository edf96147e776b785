#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Figures of five macroscopic tests by both contact methods: means of finished runs with 95 % intervals over seeds.

    docs/evidence/complementarity_tests.py {shock,cone,triaxial,hopper,repose} FOLDER...

FOLDER: results of `grouser compare` or `grouser sweep`, with one run per subfolder LABEL,seed=N. Each LABEL is a
column; for two labels, a third column contains the mean difference of runs with the same seed.
"""
import csv
import json
import math
import sys
import tomllib
from pathlib import Path

import h5py
import numpy as np

from complementarity import interval

DENSITY, GRAVITY = 2500, 9.81


def series(run):
    rows = list(csv.reader((run / "timeseries.csv").read_text(encoding="utf-8").splitlines()))
    return {name.split(" [")[0]: np.array([float(row[k] or "nan") for row in rows[1:]])
            for k, name in enumerate(rows[0])}


def frames(run):
    """Time [s], positions [m], velocities [m/s], radii [m] of the free grains in each frame."""
    with h5py.File(run / "frames.h5") as file:
        for name in sorted(name for name in file if name.isdigit()):
            grains = file[name]["grains"]
            free = grains["fixed"][:] == 0 if "fixed" in grains else slice(None)
            yield (file[name].attrs["time"], grains["position"][:][free], grains["velocity"][:][free],
                   grains["radius"][:][free])


def masses(radii):
    return DENSITY * 4 / 3 * math.pi * radii ** 3


def shock(run, speed=0.5, slab=0.01, diameter=0.01, area=0.06 ** 2):
    rows, times, profiles = series(run), [], []
    for time, position, velocity, radius in frames(run):
        if not times:
            heights = position[:, 2] - position[:, 2].min()
            index, weight = (heights / slab).astype(int), masses(radius)
            density = weight.sum() / area / heights.max()
        times.append(time)
        profiles.append(np.bincount(index, velocity[:, 2] * weight) / np.bincount(index, weight))
    profiles, depths = np.array(profiles), slab * (np.arange(len(profiles[0])) + 0.5)
    arrival = {level: np.array([np.interp(level * speed, np.maximum.accumulate(profile), times, right=np.nan)
                                for profile in profiles.T]) for level in (.25, .5, .75)}
    fit = (depths > 0.05) & (depths < 0.2) & np.isfinite(arrival[.5])
    front = 1 / np.polyfit(depths[fit], arrival[.5][fit], 1)[0]
    width = (arrival[.75] - arrival[.25]) * front / diameter
    near, far = (width[(depths > low) & (depths < low + 0.05)].mean() for low in (0.04, 0.16))
    force = -rows["surfaces.plate.force.z"][(rows["time"] > 0.0015) & (rows["time"] < 0.0045)].mean()
    return {"front speed [m/s]": front, "width at 6 diameters [diameters]": near, "at 18 diameters [diameters]": far,
            "pressure on the plate, without weight [kPa]": (force - weight.sum() * GRAVITY) / area / 1e3,
            "density x front speed x plate speed [kPa]": density * front * speed / 1e3}


def cone(run):
    rows = series(run)
    depth, index = rows["joints.slide.position"] - 0.001, rows["bodies.cone.contact_force.z"] * 0.35368
    return {f"cone index, {low} to {high} mm [kPa]": index[(depth * 1e3 > low) & (depth * 1e3 <= high)].mean()
            for low, high in ((20, 50), (50, 80), (80, 110), (110, 140))}


def triaxial(run):
    rows = series(run)
    width, depth = rows["surfaces.right.position.x"], rows["surfaces.back.position.y"]
    height = rows["surfaces.top.position.z"]
    lateral = (rows["surfaces.right.force.x"] / depth + rows["surfaces.back.force.y"] / width) / height / 2
    begin = (rows["time"] > 0.2).argmax()
    strain, volume = 1 - height[begin:] / height[begin], (width * depth * height)[begin:]
    ratio = (rows["surfaces.top.force.z"] / (width * depth))[begin:] / lateral[begin:]
    smooth = np.convolve(ratio, np.ones(10) / 10, "valid")
    residual = ratio[strain > 0.1].mean()
    return {"lateral stress [kPa]": lateral[begin:].mean() / 1e3,
            "stress ratio, 4 to 6 % strain": ratio[(strain > 0.04) & (strain < 0.06)].mean(),
            "largest stress ratio (50 ms mean)": smooth.max(), "stress ratio, 10 to 20 % strain": residual,
            "friction angle, 10 to 20 % strain [deg]": math.degrees(math.asin((residual - 1) / (residual + 1))),
            "volume change at 20 % strain [%]": 100 * (volume[-1] / volume[0] - 1)}


def hopper(run, length=0.032, width=0.1, diameter=0.006):
    boxes = tomllib.loads((run / "scene.toml").read_text(encoding="utf-8"))["box"]
    slot = next(box["size"][0] for box in boxes if box["name"] == "gate")
    times, below = [], []
    for time, position, _, radius in frames(run):
        mass = masses(radius)
        if time < 0.301:
            filled = mass[(position[:, 2] > 0.01) & (position[:, 2] < 0.06)].sum() / (0.05 * width * length)
        times.append(time)
        below.append(mass[position[:, 2] < -0.01].sum())
    steady = (np.array(below) > 0.1 * mass.sum()) & (np.array(below) < 0.45 * mass.sum())
    flow = np.polyfit(np.array(times)[steady], np.array(below)[steady], 1)[0]
    return {"bulk density before [kg/m3]": filled, "mass flow [kg/s]": flow,
            "Beverloo's constant": flow / (filled * GRAVITY ** 0.5 * length * (slot - 1.4 * diameter) ** 1.5)}


def repose(run, width=0.01):
    *_, (_, position, _, radius) = frames(run)
    angles = []
    for side in (-1, 1):
        x, tops = side * position[:, 0], position[:, 2] + radius
        lows = np.arange(0.03, 0.135, width)
        highest = [tops[(x > low) & (x < low + width)].max() for low in lows]
        angles.append(math.degrees(math.atan(-np.polyfit(lows, highest, 1)[0])))
    return {"angle of repose [deg]": np.mean(angles), "height of the heap [mm]": 1e3 * tops.max(),
            "grains on the tray": int((position[:, 2] > 0).sum())}


def cost(run):
    manifest = json.loads((run / "manifest.json").read_text(encoding="utf-8"))
    keys = {"wall time of the steps [s]": "wall_steps_s", "iterations per step": "solver_iterations_a_step",
            "steps above the tolerance": "solver_missed_steps", "relaxed steps": "solver_relaxed_steps"}
    return {"steps": manifest["steps"], **{name: manifest["figures"].get(key, math.nan) for name, key in keys.items()}}


def main():
    test, runs = globals()[sys.argv[1]], {}
    for run in sorted((run for folder in sys.argv[2:] for run in Path(folder).glob("*seed=*")), reverse=True):
        if (run / "manifest.json").exists():
            label, seed = run.name.split(",seed=")
            runs.setdefault(label, {})[seed] = {**test(run), **cost(run)}
    pair = list(runs.values()) if len(runs) == 2 else []
    print("| figure | " + " | ".join(runs) + (" | difference |" if pair else " |"))
    print("|---" * (len(runs) + 1) + ("|---|" if pair else "|"))
    for figure in next(iter(next(iter(runs.values())).values())):
        cells = [interval([values[figure] for values in seeds.values()]) for seeds in runs.values()]
        if pair:  # by seed
            cells.append(interval([pair[1][seed][figure] - pair[0][seed][figure] for seed in pair[1]]))
        print(f"| {figure} | " + " | ".join(cells) + " |")


if __name__ == "__main__":
    main()
