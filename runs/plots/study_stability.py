# SPDX-License-Identifier: BSD-3-Clause
"""Plot of the time-step stability study: study_stability.py STABILITY.csv LIMITS.csv FILE.png

One panel per case: step in units of 1 / sqrt(k / m) over damping ratio; stable (blue) and unstable (red) runs, with the
predicted limit and the calm step, which bounds the automatic step.
"""
import drawing


def draw(*paths):
    cells, limits = (drawing.rows(path) for path in paths)
    names = list(dict.fromkeys(row["case"] for row in cells))
    stiffnesses = sorted({float(row["stiffness [N/m]"]) for row in cells})
    figure = drawing.Figure(figsize=(3.4 * len(names), 4.2))
    panels = figure.subplots(1, len(names), sharey=True, squeeze=False)[0]
    for axis, name in zip(panels, names):
        for found, colour in (("stable", "tab:blue"), ("unstable", "tab:red")):
            for k, stiffness in enumerate(stiffnesses):
                of = [r for r in cells if r["case"] == name and r["found"] == found
                      and float(r["stiffness [N/m]"]) == stiffness]
                aside = 0.018 * (k - 0.5 * (len(stiffnesses) - 1))
                axis.scatter([float(r["zeta [-]"]) + aside for r in of], [float(r["step sqrt(k/m) [-]"]) for r in of],
                             s=5, color=colour, marker="os^D"[k % 4], linewidths=0,
                             label=f"{found}, k = {stiffness:g} N/m")
        of = [r for r in limits if r["case"] == name]
        zeta = [float(r["zeta [-]"]) for r in of]
        axis.plot(zeta, [float(r["predicted limit [1/sqrt(k/m)]"]) for r in of], color="black", label="predicted limit")
        axis.plot(zeta, [float(r["calm [1/sqrt(k/m)]"]) for r in of], color="black", linestyle="--",
                  label="calm step")
        axis.set_title(name, fontsize=9)
        axis.set_ylim(0, 2.4)
        axis.tick_params(labelsize=7)
    panels[0].legend(fontsize=6)
    figure.supxlabel("damping ratio zeta of a sphere on a plane [-]", fontsize=9)
    figure.supylabel("step sqrt(k / m) [-]", fontsize=9)
    return figure


if __name__ == "__main__":
    drawing.main(__doc__, draw, files=2, dpi=80)
