# SPDX-License-Identifier: BSD-3-Clause
"""Plot of the precision study: study_precision.py TOUCH.csv DRIFT.csv MACROSCOPIC.csv FILE.png

Wrong contact decisions over the configurations; distance between the same grains in two runs; difference between single
and double precision / standard error of this difference.
"""
import drawing

ARITHMETICS = ("float from the origin", "float from a local cell", "float of exact difference", "double from the origin")


def draw(*paths):
    touch, drift, macro = (drawing.rows(path) for path in paths)
    figure = drawing.Figure(figsize=(11.5, 3.8))
    left, middle, right = figure.subplots(1, 3)

    steps = [float(r["step"]) for r in touch]
    for name in ARITHMETICS:
        share = [(int(r[f"{name}: missed"]) + int(r[f"{name}: invented"])) / max(1, int(r["candidate pairs"])) for r in touch]
        left.plot(steps, share, label=name)
    left.set_yscale("symlog", linthresh=1e-7)
    left.set(xlabel="step", ylabel="wrong decisions / candidate pairs [-]", title="contact decisions")

    for scene, colour in (("gas", "tab:blue"), ("dropped bed", "tab:orange")):
        for pair in dict.fromkeys(r["pair"] for r in drift):
            of = [r for r in drift if r["scene"] == scene and r["pair"] == pair and float(r["rms [m]"]) > 0]
            style = "-" if pair.startswith("single") else ":"
            middle.semilogy([float(r["time [s]"]) for r in of], [float(r["rms [m]"]) for r in of], color=colour,
                            linestyle=style, linewidth=1, label=f"{scene}, {pair}")
    middle.axhline(0.054, color="black", linewidth=0.6, linestyle="--")
    middle.set(xlabel="time [s]", ylabel="rms distance [m]", title="same grains of two runs; dashed: one diameter")

    for quantity in dict.fromkeys(r["quantity"] for r in macro):
        of = [r for r in macro if r["quantity"] == quantity and float(r["standard error of the bias"]) > 0]
        right.plot([float(r["time [s]"]) for r in of],
                   [float(r["bias"]) / float(r["standard error of the bias"]) for r in of], marker="o", markersize=3,
                   label=quantity)
    right.axhspan(-2, 2, color="black", alpha=0.06)
    right.set(xlabel="time [s]", ylabel="bias / standard error [-]", title="single - double, run means", ylim=(-5, 5))
    for axis in (left, middle, right):
        axis.title.set_fontsize(9)
        axis.tick_params(labelsize=7)
        axis.legend(fontsize=6)
    return figure


if __name__ == "__main__":
    drawing.main(__doc__, draw, files=3, dpi=80)
