# SPDX-License-Identifier: BSD-3-Clause
"""Plot of a study: study.py MULTIBODY.csv FILE.png

Error over CPU time, one panel per case, one line per integrator; the two precision levels as dashed lines.
"""
import drawing

COLOURS = {"euler": "tab:gray", "rattle2": "tab:blue", "rattle4": "tab:orange", "rattle8": "tab:red"}
LEVELS = (1e-1, 1e-3)


def read(path):
    """{case: {integrator: [(CPU s, error)]}} of the finished runs."""
    cases = {}
    for row in drawing.rows(path):
        lines = cases.setdefault(row["case"], {})
        if row["error [-]"] and float(row["error [-]"]) > 0:
            lines.setdefault(row["integrator"], []).append((float(row["CPU [s]"]), float(row["error [-]"])))
    return cases


def draw(path):
    cases = read(path)
    columns = min(4, len(cases))
    rows = -(-len(cases) // columns)
    figure = drawing.Figure(figsize=(3.1 * columns, 2.5 * rows))
    panels = figure.subplots(rows, columns, squeeze=False).flatten()
    for axis, (name, lines) in zip(panels, cases.items()):
        for integrator, points in lines.items():
            axis.loglog(*zip(*points), marker="o", markersize=3, color=COLOURS.get(integrator), label=integrator)
        for level in LEVELS:
            axis.axhline(level, color="black", linewidth=0.6, linestyle="--")
        axis.set_title(name, fontsize=9)
        axis.tick_params(labelsize=7)
    for axis in panels[len(cases):]:
        axis.set_visible(False)
    drawing.legend_below(figure, panels[:len(cases)])
    for axis in panels[max(0, len(cases) - columns):len(cases)]:
        axis.set_xlabel("CPU time [s]", fontsize=8)
    figure.supylabel("error [-]", fontsize=9)
    return figure


if __name__ == "__main__":
    drawing.main(__doc__, draw)
