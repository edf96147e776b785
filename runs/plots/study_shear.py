# SPDX-License-Identifier: BSD-3-Clause
"""Plot of the shear box study: study_shear.py SHEAR.csv FILE.png

Shear force / normal force and rise of the lid over displacement, one line per sample, one colour per load.
"""
import drawing


def draw(path):
    rows = drawing.numbers(path)
    samples = {}
    for row in rows:
        samples.setdefault((row["stress [Pa]"], row["seed"]), []).append(row)
    stresses = sorted({stress for stress, seed in samples})
    figure = drawing.Figure(figsize=(8, 3.4))
    left, right = figure.subplots(1, 2)
    for (stress, seed), lines in samples.items():
        colour = f"C{stresses.index(stress)}"
        label = f"{stress:g} Pa" if seed == 1 else None
        way = [1e3 * row["displacement [m]"] for row in lines]
        ratio = [row["shear force [N]"] / row["normal force [N]"] for row in lines]
        smooth = [sum(ratio[max(0, k - 4):k + 1]) / len(ratio[max(0, k - 4):k + 1]) for k in range(len(ratio))]
        left.plot(way, smooth, color=colour, linewidth=0.8, label=label)
        right.plot(way, [1e3 * (row["lid [m]"] - lines[0]["lid [m]"]) for row in lines], color=colour, linewidth=0.8)
    left.set_ylabel("shear / normal force [-]")
    left.legend(fontsize=7)
    right.set_ylabel("rise of the lid [mm]")
    for axis in (left, right):
        axis.set_xlabel("displacement [mm]")
    return figure


if __name__ == "__main__":
    drawing.main(__doc__, draw)
