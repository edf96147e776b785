# SPDX-License-Identifier: BSD-3-Clause
"""Plot of the column collapse study: study_collapse.py COLLAPSE.csv FILE.png

Run-out and deposit height over the aspect ratio of the column, one point per column; scaling laws of channel
experiments as lines with 15 % bands.
"""
import drawing


def draw(path):
    rows = drawing.numbers(path)
    aspect = [row["aspect [-]"] for row in rows]
    line = [0.2 + 0.05 * k for k in range(int(20 * max(aspect)))]
    laws = {
        "run-out [-]": ("run-out / initial length [-]", lambda a: 1.2 * a if a < 2.3 else 1.9 * a ** (2 / 3)),
        "deposit height [-]": ("height at the wall / initial length [-]", lambda a: a if a < 1.15 else 0.65 * a**0.4),
    }
    figure = drawing.Figure(figsize=(8, 3.4))
    for axis, (key, (label, law)) in zip(figure.subplots(1, 2), laws.items()):
        channel = [law(a) for a in line]
        axis.plot(line, channel, color="black", linewidth=1, label="channels")
        axis.fill_between(line, [0.85 * y for y in channel], [1.15 * y for y in channel], color="black", alpha=0.1)
        axis.plot(aspect, [row[key] for row in rows], "o", markersize=3, color="tab:blue", label="grouser")
        axis.set_xlabel("initial height / initial length [-]")
        axis.set_ylabel(label)
        axis.legend(fontsize=7)
    return figure


if __name__ == "__main__":
    drawing.main(__doc__, draw)
