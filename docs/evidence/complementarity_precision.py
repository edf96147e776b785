#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Error against run time of both contact methods: sinkage of a loaded plate into a box of grains, as a table.

    docs/evidence/complementarity_precision.py [--program PROGRAM] [--seeds N] [--stiffness K] FOLDER

1000 grains (radius 7.5 to 12.5 mm) are poured with penalty contacts; every run starts from the same places. A plate of
0.5 kg, pressed with 60 N within 0.1 s, sinks for 0.3 s. The reference is penalty contacts with 160 steps a contact.
Error: root mean square over the seeds of the difference in mean sinkage over the last 0.1 s. Runs have one thread each,
two at a time; wall time is that of the steps.
"""
import argparse
import concurrent.futures
import csv
import json
import statistics
import subprocess
from pathlib import Path

import h5py

ROOT = Path(__file__).resolve().parent.parent.parent
SCENE = """version = 1
[run]
duration = {duration}
output_interval = 0.005
frame_interval = 0.5
seed = {seed}
[material.sand]
density = 2600
stiffness = {stiffness}
restitution = 0.3
friction = 0.5
[[plane]]
material = "sand"
"""
WALLS = "".join(f"[[plane]]\npoint = [{-0.12 * x}, {-0.12 * y}, 0]\nnormal = [{x}, {y}, 0]\nmaterial = \"sand\"\n"
                for x, y in ((1, 0), (-1, 0), (0, 1), (0, -1)))
POURED = """[[grains]]
form = "random"
low = [-0.12, -0.12, 0]
high = [0.12, 0.12, 0.4]
radius = 0.0075
radius_to = 0.0125
number = 1000
material = "sand"
"""
LOADED = """[[grains]]
form = "file"
file = "grains.txt"
material = "sand"
[[box]]
name = "plate"
position = [0, 0, {height}]
size = [0.1, 0.1, 0.02]
free = "z"
mass = 0.5
load = -60
load_ramp = 0.1
material = "sand"
"""


def variants():
    for steps in (160, 80, 40, 20, 10):
        yield f"penalty, {steps} steps a contact", [f"run.steps_per_contact={steps}"]
    for step in (8e-4, 4e-4, 2e-4):
        for share in (0.1, 0.01):
            yield (f"complementarity, {step * 1e3:g} ms, residual {share:g} g h",
                   ["run.contact=complementarity", f"run.time_step={step}", f"run.residual={share * 9.81 * step:.6g}",
                    "complementarity.iterations=2000"])


def call(options, scene, folder, words=()):
    command = [options.program, "run", scene, "--force", "--threads", "1", "--out", folder]
    for word in words:
        command += ["--set", word]
    subprocess.run([str(word) for word in command], check=True, capture_output=True, text=True)


def settle(options, seed):
    """Writes the poured grains and the scene of the plate above them; returns the scene's path."""
    folder = options.folder / f"seed_{seed}"
    folder.mkdir(parents=True, exist_ok=True)
    values = {"seed": seed, "stiffness": f"{options.stiffness:g}"}
    pour = folder / "pour.toml"
    pour.write_text(SCENE.format(duration=1.0, **values) + WALLS + POURED, encoding="utf-8")
    call(options, pour, folder / "pour")
    with h5py.File(folder / "pour/frames.h5") as file:
        last = file[max(name for name in file if name.isdigit())]["grains"]
        places, radii = last["position"][:], last["radius"][:]
    lines = [" ".join(f"{value:.9g}" for value in (*place, radius)) for place, radius in zip(places, radii)]
    (folder / "grains.txt").write_text("\n".join(lines) + "\n", encoding="utf-8")
    below = (abs(places[:, 0]) < 0.06) & (abs(places[:, 1]) < 0.06)
    height = float((places[:, 2] + radii)[below].max()) + 0.0105
    scene = folder / "plate.toml"
    scene.write_text(SCENE.format(duration=0.3, **values) + WALLS + LOADED.format(height=height), encoding="utf-8")
    return scene


def run(options, scene, words, folder):
    """Sinkage [m], steps, wall time of the steps [s], iterations."""
    call(options, scene, folder, words)
    with open(folder / "timeseries.csv", encoding="utf-8") as file:
        rows = [{k.split(" [")[0]: float(v) for k, v in row.items()} for row in csv.DictReader(file)]
    last = [row for row in rows if row["time"] > rows[-1]["time"] - 0.1]
    sinkage = rows[0]["surfaces.plate.position.z"] - statistics.mean(r["surfaces.plate.position.z"] for r in last)
    manifest = json.loads((folder / "manifest.json").read_text(encoding="utf-8"))
    return sinkage, manifest["steps"], manifest["figures"]["wall_steps_s"], rows[-1].get("solver.all_iterations", 0)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=ROOT / "build/bin/grouser")
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--stiffness", type=float, default=1e5, help="[N/m]")
    parser.add_argument("folder", type=Path)
    options = parser.parse_args()
    seeds = range(1, options.seeds + 1)
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        scenes = dict(zip(seeds, pool.map(lambda seed: settle(options, seed), seeds)))
        tasks = {(name, seed): pool.submit(run, options, scenes[seed], words, options.folder / f"{k}_{seed}")
                 for k, (name, words) in enumerate(variants()) for seed in seeds}
        found = {key: task.result() for key, task in tasks.items()}
    names = [name for name, _ in variants()]
    reference = {seed: found[names[0], seed][0] for seed in seeds}
    mean = statistics.mean(reference.values())
    print(f"stiffness {options.stiffness:g} N/m; sinkage of the reference {1e3 * mean:.3f} mm over {len(seeds)} seeds "
          f"({', '.join(f'{1e3 * z:.3f}' for z in reference.values())})")
    print("| method | steps | iterations a step | error [% of the sinkage] | wall time [s] |\n|---|---|---|---|---|")
    for name in names:
        results = [found[name, seed] for seed in seeds]
        error = statistics.mean((r[0] - reference[s]) ** 2 for r, s in zip(results, seeds)) ** 0.5
        steps = statistics.mean(r[1] for r in results)
        iterations = f"{statistics.mean(r[3] for r in results) / steps:.1f}" if results[0][3] else ""
        print(f"| {name} | {steps:.0f} | {iterations} | {100 * error / mean:.2g} | "
              f"{statistics.mean(r[2] for r in results):.2f} |")


if __name__ == "__main__":
    main()
