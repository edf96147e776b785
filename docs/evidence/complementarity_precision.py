#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Error against run time of both contact methods: sinkage of a loaded plate (complementarity_plate.toml), as a table.

    docs/evidence/complementarity_precision.py [--program PROGRAM] [--seeds N] [--stiffness K] FOLDER

The reference is penalty contacts with 160 steps a contact. Error: root mean square over the seeds of the difference in
mean sinkage over the last 0.1 s. Runs have one thread each, two at a time; the bed settles once a seed.
"""
import argparse
import concurrent.futures
import csv
import json
import statistics
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent


def variants():
    for steps in (160, 80, 40, 20, 10):
        yield f"penalty, {steps} steps a contact", [f"run.steps_per_contact={steps}"]
    for step in (8e-4, 4e-4, 2e-4, 1e-4):
        for share in (0.1, 0.01, 0.001):
            yield (f"complementarity, {step * 1e3:g} ms, residual {share:g} g h",
                   ["run.contact=complementarity", f"run.time_step={step}", f"run.residual={share * 9.81 * step:.6g}",
                    "complementarity.iterations=2000"])


def run(options, words, seed, folder):
    command = [options.program, "run", ROOT / "docs/evidence/complementarity_plate.toml", "--force", "--threads", "1",
               "--out", folder]
    for word in (*words, f"run.seed={seed}", f"material.sand.stiffness={options.stiffness:g}"):
        command += ["--set", word]
    subprocess.run([str(word) for word in command], check=True, capture_output=True, text=True)
    with open(folder / "timeseries.csv", encoding="utf-8") as file:
        rows = [{k.split(" [")[0]: float(v) for k, v in row.items()} for row in csv.DictReader(file)]
    last = [row for row in rows if row["time"] > rows[-1]["time"] - 0.1]
    sinkage = rows[0]["surfaces.plate.position.z"] - statistics.mean(r["surfaces.plate.position.z"] for r in last)
    summary = json.loads((folder / "manifest.json").read_text(encoding="utf-8"))
    return sinkage, summary["steps"], summary["wall_time_s"], rows[-1].get("solver.all_iterations", 0)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=ROOT / "build/bin/grouser")
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--stiffness", type=float, default=1e5, help="[N/m]")
    parser.add_argument("folder", type=Path)
    options = parser.parse_args()
    found, seeds = {}, range(1, options.seeds + 1)
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        tasks = {(name, seed): pool.submit(run, options, words, seed, options.folder / f"{k}_{seed}")
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
