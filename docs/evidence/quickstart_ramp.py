# SPDX-License-Identifier: BSD-3-Clause
"""Speed of the hull after the drive ramp, in percent of its mean: quickstart_ramp.py TIMESERIES.csv...

Reads the start of the drive and the ramp from the manifest.json and scene.toml next to each file.
"""
import csv
import json
import pathlib
import sys
import tomllib

for name in sys.argv[1:]:
    folder = pathlib.Path(name).parent
    start = json.loads((folder / "manifest.json").read_text())["figures"]["drive_start_s"]
    ramp = tomllib.loads((folder / "scene.toml").read_text())["driver"]["drive_ramp"]
    with open(name, newline="", encoding="utf-8") as file:
        rows = [{key: float(text) for key, text in row.items()} for row in csv.DictReader(file)]
    end = rows[-1]["time [s]"]
    for label, since in ("after the ramp", start + ramp), ("steady part", (start + ramp + end) / 2):
        speeds = [(row["vehicle.left.speed [m/s]"] + row["vehicle.right.speed [m/s]"]) / 2
                  for row in rows if row["time [s]"] >= since]
        mean, low, high = sum(speeds) / len(speeds), min(speeds), max(speeds)
        print(f"{folder.name}: {label}, from {since:.2f} s: mean {mean:.3f} m/s, range {low:.3f} to {high:.3f} m/s, "
              f"half-range {50 * (high - low) / mean:.1f} %")
