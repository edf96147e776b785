# SPDX-License-Identifier: BSD-3-Clause
"""Plot of `grouser bench contacts`: contacts.py FIGURES.json FILE.png

Time of a search and contacts a second over the number of contacts, beside Bullet's where there are.
Exit status: 0, 3 where a Python package is missing; its last line then says which.
"""
import json
import pathlib
import sys

try:
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib.figure import Figure
except ImportError as missing:
    packages = {"matplotlib": "python3-matplotlib", "numpy": "python3-numpy"}
    name = (missing.name or "").split(".")[0]
    print(f"the Python package {name} is missing; install {packages.get(name, name)}")
    sys.exit(3)

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import series


def curves(figures):
    """[(label, marker, contacts, seconds)]"""
    points = figures["points"]
    with_bullet = [p for p in points if "bullet" in p]
    found = [
        (f"grouser, {figures['device']}", "o-", [p["contacts"] for p in points], [p["seconds"]["total"] for p in points])
    ]
    if with_bullet:
        contacts = [p["bullet"]["contacts"] for p in with_bullet]
        cold = [p["bullet"]["seconds_set_up"] + p["bullet"]["seconds_cold"] for p in with_bullet]
        warm = [p["bullet"]["seconds_warm"] for p in with_bullet]
        name = f"Bullet {figures['bullet_version']}, one thread"
        found += [(f"{name}, cold", "^--", contacts, cold), (f"{name}, warm pairs", "s--", contacts, warm)]
    return found


def plot(figures):
    figure = Figure(figsize=(10.5, 4.4))
    times, rates = figure.subplots(1, 2)
    for label, style, contacts, seconds in curves(figures):
        times.loglog(contacts, seconds, style, label=label, markersize=4)
        rates.loglog(contacts, [c / s for c, s in zip(contacts, seconds)], style, label=label, markersize=4)
    last = figures["points"][-1]
    ends = [figures["points"][0]["contacts"], last["contacts"]]
    times.loglog(ends, [last["seconds"]["total"] * c / ends[1] for c in ends], ":", color="0.5", label="linear growth")
    times.set_ylabel(f"time of a search, pairs {figures['pairs']} [s]")
    rates.set_ylabel("contacts a second [1/s]")
    for axes in (times, rates):
        axes.set_xlabel("contacts, each pair once")
    times.legend(fontsize=8)
    return figure


def main(arguments):
    if len(arguments) != 3:
        print(__doc__)
        return 2
    matplotlib.rcParams.update(series.STYLE)
    figures = json.loads(pathlib.Path(arguments[1]).read_text(encoding="utf-8"))
    plot(figures).savefig(arguments[2], dpi=150)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv))
