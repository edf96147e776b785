# SPDX-License-Identifier: BSD-3-Clause
"""Final pictures of the first run of each level of a series of events: event_pictures.py EVENTS.json FILE.png"""
import json
import pathlib

import drawing
from matplotlib import image

COLUMNS = 4


def draw(path):
    with open(path, encoding="utf-8") as file:
        results = json.load(file)
    folder = pathlib.Path(path).resolve().parent
    shown = [row for row in results["rows"]
             if row["picture"] and (folder / row["picture"]).resolve().is_relative_to(folder)]
    if not shown:
        return None
    columns = min(COLUMNS, len(shown))
    lines = -(-len(shown) // columns)
    figure = drawing.Figure(figsize=(3.2 * columns, 2.05 * lines))
    axes = figure.subplots(lines, columns, squeeze=False).flatten()
    for axis in axes:
        axis.set_axis_off()
    for axis, row in zip(axes, shown):
        axis.imshow(image.imread(pathlib.Path(path).parent / row["picture"])[::2, ::2])
        level = "" if row["level"] is None else f" {row['level']:g}"
        axis.set_title(f"{row['event'].replace('_', ' ')}{level}: {row['verdict'].split(' ')[0]}", fontsize=8)
    return figure


if __name__ == "__main__":
    drawing.main(__doc__, draw, dpi=100)
