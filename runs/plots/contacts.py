# SPDX-License-Identifier: BSD-3-Clause
"""Plot of `grouser bench contacts`: contacts.py FIGURES.json FILE.png

Search time and contacts found per second over the number of contacts; with curves of Bullet if available.
"""
import json

import drawing


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


def draw(path):
    with open(path, encoding="utf-8") as file:
        figures = json.load(file)
    figure = drawing.Figure(figsize=(10.5, 4.4))
    times, rates = figure.subplots(1, 2)
    for label, style, contacts, seconds in curves(figures):
        times.loglog(contacts, seconds, style, label=label, markersize=4)
        rates.loglog(contacts, [c / s for c, s in zip(contacts, seconds)], style, label=label, markersize=4)
    last = figures["points"][-1]
    ends = [figures["points"][0]["contacts"], last["contacts"]]
    times.loglog(ends, [last["seconds"]["total"] * c / ends[1] for c in ends], ":", color="0.5", label="linear growth")
    times.set_ylabel(f"time of a contact search, pairs {figures['pairs']} [s]")
    rates.set_ylabel("contacts per second [1/s]")
    for axes in (times, rates):
        axes.set_xlabel("number of contacts (each pair once)")
    times.legend(fontsize=8)
    return figure


if __name__ == "__main__":
    drawing.main(__doc__, draw, dpi=150)
