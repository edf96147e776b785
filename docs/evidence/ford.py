#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Lift and drag of the light vehicle in water: reads folders of runs of runs/scenes/ford.toml and prints a table.

    docs/evidence/ford.py [--program PROGRAM] FOLDER...

Rest: mean lift by the water over the last third of the time before the drive begins, beside the weight of the water
that the vehicle displaces below the level of the probe (`grouser plan`). Drive: mean speed, force of the water along x
and sprocket torque over the last second of the run. Level: that of the probe over the same times.
"""
import argparse
import csv
import re
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
PARTS = ("hull", "left_track", "right_track")


def rows(folder):
    with open(Path(folder) / "timeseries.csv", encoding="utf-8") as file:
        return [{k.split(" [")[0]: float(v) for k, v in row.items()} for row in csv.DictReader(file)]


def mean(part, *names):
    return sum(row[name] for row in part for name in names) / len(part)


def force(part, axis, pieces=PARTS):
    return mean(part, *(f"fluid.vehicle.{p}.force.{axis}" for p in pieces))


def lift_at_rest(program, folder, level):
    words = [program, "plan", Path(folder) / "scene.toml", "--set", f"fluid.level={level}"]
    text = subprocess.run([str(w) for w in words], check=True, capture_output=True, text=True).stdout
    return float(re.search(r"buoyancy at rest ([0-9.e+-]+) N", text).group(1))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=ROOT / "build/bin/grouser")
    parser.add_argument("folders", nargs="+")
    options = parser.parse_args()
    for folder in options.folders:
        series = rows(folder)
        start = next((r["time"] for r in series if abs(r["vehicle.left.sprocket_speed"]) > 1e-9), series[-1]["time"])
        rest = [r for r in series if 2 * start / 3 < r["time"] <= start]
        level = mean(rest, "fluid.probes.front")
        statics = lift_at_rest(options.program, folder, round(level, 5))
        print(f"{folder}: rest: level {level:.4f} m, lift {force(rest, 'z'):.0f} N "
              f"(hull {force(rest, 'z', PARTS[:1]):.0f} N), displaced weight {statics:.0f} N, "
              f"ratio {force(rest, 'z') / statics:.3f}")
        drive = [r for r in series if r["time"] > max(start, series[-1]["time"] - 1)]
        if drive:
            torque = mean(drive, "vehicle.left.drive_torque", "vehicle.right.drive_torque")
            print(f"    drive: speed {mean(drive, 'vehicle.velocity.x'):.3f} m/s, force of the water along x "
                  f"{force(drive, 'x'):.0f} N (hull {force(drive, 'x', PARTS[:1]):.0f} N), torque {torque:.0f} N m, "
                  f"level {mean(drive, 'fluid.probes.front'):.4f} m, "
                  f"fastest water {max(r['fluid.max_speed'] for r in drive):.2f} m/s")


if __name__ == "__main__":
    main()
