# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of the soil fields: a vertical section of the last frame."""
import numpy

from page import esc, number

WIDTH, HEIGHT = 760.0, 260.0  # maximum size of a section [px]
#: Colours from low to high: viridis, equally spaced.
RAMP = numpy.array([[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]], dtype=float)
RAMP_BAR = '<span class="ramp"></span>'  # with these colours in report.css
#: Title, unit, field, definition, and function from field values [..., cells] to the scalar that is drawn.
SECTIONS = (
    ("Mean stress in the soil", "Pa", "stress", "pressure (a third of the trace), positive in compression",
     lambda value: -numpy.trace(value, axis1=-2, axis2=-1) / 3),
    ("Porosity of the soil", "-", "porosity", "pore volume / total volume in cells with grains", lambda value: value),
    ("Speed of the soil", "m/s", "velocity", "magnitude of the mean velocity",
     lambda value: numpy.linalg.norm(value, axis=-1)),
)


def colour(share):
    """SVG colour of a value between 0 and 1."""
    at = min(max(share, 0.0), 1.0) * (len(RAMP) - 1)
    k = min(int(at), len(RAMP) - 2)
    return "#" + "".join(f"{round(c):02x}" for c in RAMP[k] + (at - k) * (RAMP[k + 1] - RAMP[k]))


def drawn(title, values, spacing, unit, words):
    """[z, across] as coloured cells with a scale below; NaN is left blank."""
    there = values[numpy.isfinite(values)]
    if not there.size:
        return ""
    low, high = float(there.min()), float(there.max())
    rows, columns = values.shape
    scale = min(WIDTH / (columns * spacing[0]), HEIGHT / (rows * spacing[1]))
    w, h = spacing[0] * scale, spacing[1] * scale
    cells = "".join(
        f'<rect x="{i * w:.2f}" y="{(rows - 1 - k) * h:.2f}" width="{w + 0.3:.2f}" height="{h + 0.3:.2f}" '
        f'fill="{colour((values[k, i] - low) / (high - low) if high > low else 0.5)}"/>'
        for k in range(rows) for i in range(columns) if numpy.isfinite(values[k, i]))
    picture = (f'<svg viewBox="0 0 {columns * w:.1f} {rows * h:.1f}" width="{columns * w:.0f}" role="img" '
               f'aria-label="{esc(title)}">{cells}</svg>')
    bar = (f"<div>{number(low, unit, title + ' least')}{RAMP_BAR}{number(high, unit, title + ' largest')}</div>")
    return f"<figure><strong>{esc(title)}</strong><br>{picture}{bar}<figcaption>{words}</figcaption></figure>"


def section(run):
    """Vertical section through the middle of the cells; "" if the run has no fields."""
    if run.frames is None:
        return ""
    last = next((frame for frame in reversed(list(run.frames)) if frame.has_fields), None)
    if last is None:
        return ""
    filled = last.field("porosity").value[0] < 1
    figures = []
    for title, unit, name, words, take in SECTIONS:
        field = last.field(name)
        values = numpy.where(filled, take(field.value[0].astype(float)), numpy.nan)
        middle = values.shape[1] // 2
        about = (f"{esc(words)}; section at y = {number(float(field.y[middle]), 'm')}, one cell thick, x to the right, "
                 f"t = {number(last.time, 's')}; cells of {number(float(field.spacing[0]), 'm')}")
        figures.append(drawn(title, values[:, middle], field.spacing[[0, 2]], unit, about))
    return "".join(figures)
