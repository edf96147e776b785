# SPDX-License-Identifier: BSD-3-Clause
"""Plot of the stability study with random scenes: study_random_stability.py RANDOM.csv FILE.png

One point per scene, over the smallest restitution: automatic step, automatic step at the minimum number of steps per
contact, and step limit, each divided by the longest step without blow-up (left) or without alarm (right).
"""
import drawing

STEPS = (("auto [s]", "auto", "tab:blue"), ("auto at fewest steps [s]", "auto, fewest steps per contact", "tab:green"),
         ("limit [s]", "limit", "tab:red"))


def draw(path):
    scenes = list(drawing.rows(path))
    figure = drawing.Figure(figsize=(10, 4.2))
    panels = figure.subplots(1, 2, sharey=True)
    for axis, column, title in zip(panels, ("bounded up to [s]", "silent up to [s]"),
                                   ("longest step without blow-up", "longest step without alarm")):
        for step, label, colour in STEPS:
            axis.scatter([float(r["restitution"]) for r in scenes],
                         [float(r[step]) / max(float(r[column]), 1e-300) for r in scenes], s=9, color=colour,
                         label=label, linewidths=0)
        axis.axhline(1, color="black", linewidth=0.8)
        axis.axhline(0.25, color="black", linewidth=0.8, linestyle="--")
        axis.set_yscale("log")
        axis.set_ylim(0.02, 3)
        axis.set_xlabel("smallest restitution [-]", fontsize=9)
        axis.set_title("step / " + title, fontsize=9)
        axis.tick_params(labelsize=7)
    panels[0].legend(fontsize=7)
    return figure


if __name__ == "__main__":
    drawing.main(__doc__, draw)
