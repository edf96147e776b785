# SPDX-License-Identifier: BSD-3-Clause
"""The frame of a report: sections, tables, plots, and the one file that holds them with all they need."""
import base64
import html
import json
import math
import zlib
from pathlib import Path

import numpy

import definitions
import grouser

HERE = Path(__file__).resolve().parent
DEBIAN = Path("/usr/share/javascript")
#: Libraries of the page, of Debian: (files, package).
PLOTS = (("dygraphs/dygraph.min.js",), "libjs-dygraphs")
STYLE = ("dygraphs/dygraph.min.css", "libjs-dygraphs")
SPACE = (("three/three.min.js", "three/examples/js/controls/OrbitControls.js"), "libjs-three")
MOST_ROWS = 2000  # of a curve
NOTHING = 1e-30  # in SI units: what is smaller stands for 0
MOST_LINES = 20  # of a table that stands as a whole; longer ones are scrolled in a box


def esc(text):
    return html.escape(str(text), quote=True)


def packed(values):
    """An array as the page takes it: its kind, its shape, and its bytes, deflated and as base64."""
    values = numpy.ascontiguousarray(values)
    kind = {"float64": "f8", "float32": "f4", "uint32": "u4", "uint16": "u2", "uint8": "u1"}[str(values.dtype)]
    little = values.astype(values.dtype.newbyteorder("<"), copy=False)
    return {"kind": kind, "shape": list(values.shape),
            "data": base64.b64encode(zlib.compress(little.tobytes(), 9)).decode()}


def shown(value, digits=5):
    """A number for the eye; the whole of it stands beside it in an attribute."""
    if value is None or math.isnan(value):
        return "none"
    if math.isinf(value):
        return "unknown"
    if abs(value) < NOTHING:
        return "0"
    text = f"{value:.{digits}g}"
    if "e" in text and 1e-4 <= abs(value) < 1e6:  # digits that were not asked for are noughts
        text = f"{float(text):.0f}"
    if "e" not in text:
        return text.replace("-", "\u2212")
    mantissa, exponent = text.split("e")
    return f"{mantissa}\u00b7e{int(exponent)}".replace("\u00b7e", " \u00d7 10^").replace("-", "\u2212")


def superscript(text):
    """10^-4 as HTML has it."""
    before, mark, exponent = text.partition("^")
    return f"{before}<sup>{exponent}</sup>" if mark else text


def exact(value):
    """The shortest text that reads back as the same number."""
    return "" if value is None else repr(float(value))


def number(value, unit="", name="", digits=5):
    """A number in HTML: rounded for the eye, whole in `value`; `name` for whoever looks for it."""
    named = f' data-name="{esc(name)}"' if name else ""
    unit_text = f"\u00a0{esc(unit)}" if unit and unit != "-" else ""
    return f'<data value="{exact(value)}"{named}>{superscript(shown(value, digits))}</data>{unit_text}'


def with_bar(value, half, unit="", name=""):
    """A number with its error bar, to the digits that the bar leaves."""
    if half is None or value is None or not math.isfinite(half) or not math.isfinite(value):
        return number(value, unit, name)
    value_text, half_text, power = (str(part).replace("-", "\u2212") for part in grouser.series.estimate_text(value, half))
    if not half_text:  # the runs agree but for rounding
        mark = f' data-name="{esc(name)} bar"' if name else ""
        return f'{number(value, unit, name, 6)} <data value="{exact(half)}"{mark}>(exact)</data>'
    before, behind = ("", "") if power == "0" else ("(", f") \u00d7 10<sup>{power}</sup>")
    named = f' data-name="{esc(name)}"' if name else ""
    bar = f' data-name="{esc(name)} bar"' if name else ""
    unit_text = f"\u00a0{esc(unit)}" if unit and unit != "-" else ""
    return (f'<span class="nowrap">{before}<data value="{exact(value)}"{named}>{value_text}</data> \u00b1 '
            f'<data value="{exact(half)}"{bar}>{half_text}</data>{behind}{unit_text}</span>')


def term(name, about=""):
    """The name of a figure, with what it is where one points at it: by the table of definitions, else `about`."""
    words = definitions.definition(name) or about
    text = esc(definitions.label(name))
    return f'<span class="term" title="{esc(words)}">{text}</span>' if words else text


INCONCLUSIVE = ' <span class="bad">inconclusive</span>'


def figure_with_bar(value, half, unit="", name="", inconclusive=False):
    """The same, marked where it is inconclusive, as where the bar is larger than the value: then not even its sign is
    sure. What is 0 in all runs is sure."""
    wide = None not in (value, half) and math.isfinite(half) and half > abs(value)
    known = value is not None and not value == half == 0
    return with_bar(value, half, unit, name) + (INCONCLUSIVE if wide or inconclusive and known else "")


def table(headings, rows, caption="", numeric=()):
    """Rows of HTML; `numeric`: the columns that hold numbers."""
    def cells(tag, scope, row):
        return "".join(f'<{tag}{scope}{" class=n" if k in numeric else ""}>{cell}</{tag}>' for k, cell in enumerate(row))
    head = f"<thead><tr>{cells('th', ' scope=col', map(esc, headings))}</tr></thead>"
    body = "".join(f"<tr>{cells('td', '', row)}</tr>" for row in rows)
    words = f"<caption>{caption}</caption>" if caption else ""
    tall = ' tall" tabindex="0" role="region" aria-label="table' if len(rows) > MOST_LINES else ""
    return f'<div class="wide{tall}"><table>{words}{head}<tbody>{body}</tbody></table></div>'


def run_name(name):
    """A run's name as code, which may be broken behind its commas alone."""
    return f'<code class="name">{esc(name).replace(",", ",<wbr>")}</code>'


def facts(rows):
    """Words and what stands for them: [(word, HTML)]; those without are left out."""
    return "<dl>" + "".join(f"<dt>{esc(word)}</dt><dd>{text}</dd>" for word, text in rows if text) + "</dl>"


def folded(title, inner, opened=False):
    return f'<details{" open" if opened else ""}><summary>{esc(title)}</summary>{inner}</details>'


def picture(file, words):
    """A PNG in the page, or nothing where there is none; of a damaged one words that say so."""
    if not file.is_file():
        return ""
    picture_ = file.read_bytes()
    if not picture_.startswith(b"\x89PNG\r\n\x1a\n") or picture_[-8:-4] != b"IEND":
        return f'<p class="bad">{esc(file.name)} is damaged: it is no whole PNG picture.</p>'
    data = base64.b64encode(picture_).decode()
    return (f'<figure><img src="data:image/png;base64,{data}" alt="{esc(words)}"><figcaption>{esc(words)} '
            f'({esc(file.name)})</figcaption></figure>')


def pictures(figures):
    inner = "".join(figures)
    return f'<div class="pictures">{inner}</div>' if inner else ""


class Page:
    def __init__(self, title, kind, folder):
        self.title, self.kind, self.folder = title, kind, Path(folder)
        self.sections = []  # (id, title, HTML)
        self.warnings = []  # HTML that stands before all
        self.data = {"plots": [], "arrays": {}}
        self.libraries = []

    def section(self, identity, title, inner):
        if inner:
            self.sections.append((identity, title, inner))

    def need(self, library):
        if library not in self.libraries:
            self.libraries.append(library)

    def array(self, name, values):
        self.data["arrays"][name] = packed(values)
        return name

    def bytes(self):
        """What the arrays take in the page so far."""
        return sum(len(array["data"]) for array in self.data["arrays"].values())

    def plot(self, title, x, y, curves, caption="", **more):
        """HTML of an interactive plot. `x`, `y`: what stands at the axes, with units. `curves`: [(label, x, y)], or
        with half widths of bars [(label, x, y, half)], or with both ends [(label, x, y, low, high)]. `more`: `about` (what
        it shows, where one points at the title), `points`
        (no lines), `marks` (True, or the labels of curves whose points are marked, with upright bars), `whole` (x counts
        something), `log` ("x", "y", "xy")."""
        self.need(PLOTS)
        index = len(self.data["plots"])
        about = more.pop("about", "")
        hint = f' class="term" title="{esc(about)}"' if about else ""
        entry = {"title": title, "x": x, "y": y, "curves": [], **more}
        for number_, curve in enumerate(curves):
            label, *columns = curve
            entry["curves"].append({"label": label, "columns": [
                self.array(f"plot{index}.{number_}.{k}", numpy.asarray(c, dtype=float))
                for k, c in enumerate(columns)]})
        self.data["plots"].append(entry)
        return (f'<figure class="plot"><h3 id="plot{index}-title"{hint}>{esc(title)}</h3>'
                f'<div class="canvas" id="plot{index}" tabindex="0" role="group" aria-roledescription="plot" '
                f'aria-labelledby="plot{index}-title" aria-describedby="plot-keys"></div>'
                f'<div class="legend" id="plot{index}-legend" aria-live="polite"></div>'
                f'<figcaption>{esc(caption[:1].upper() + caption[1:])}</figcaption></figure>')

    def html(self):
        libraries, named = "", []
        for files, package in self.libraries:
            named.append(package)
            for name in files:
                libraries += f"<script>{self.script(library_text(DEBIAN / name, package))}</script>\n"
        own = "".join(f"<script>{self.script((HERE / name).read_text(encoding='utf-8'))}</script>\n"
                      for name in ("report.js", "view.js"))
        links = "".join(f'<li><a href="#{i}">{esc(t)}</a></li>' for i, t, _ in self.sections)
        warnings = "".join(f'<div class="bad" role="note">{warning}</div>' for warning in self.warnings)
        body = warnings + "".join(f'<section id="{i}" aria-labelledby="{i}-h"><h2 id="{i}-h">{esc(t)}</h2>{inner}</section>'
                       for i, t, inner in self.sections)
        frame = (HERE / "page.html").read_text(encoding="utf-8")
        style = library_text(DEBIAN / STYLE[0], STYLE[1]) if PLOTS in self.libraries else ""
        style = style.split("/*# sourceMappingURL")[0] + (HERE / "report.css").read_text(encoding="utf-8")
        data = json.dumps(self.data, allow_nan=False).replace("<", "\\u003c")
        parts = {"title": esc(self.title), "kind": esc(self.kind), "folder": esc(self.folder),
                 "style": style, "links": links, "body": body, "data": data, "libraries": libraries, "own": own,
                 "licences": esc(licences(named))}
        for name, text in parts.items():
            frame = frame.replace(f"<!--{name}-->", text)
        return frame

    @staticmethod
    def script(text):
        """As it may stand in a page: nothing in it ends the script, and no browser looks for its source map."""
        lines = (line for line in text.split("\n") if not line.startswith("//# sourceMappingURL"))
        return "\n".join(lines).replace("</script", "<\\/script").replace("<!--", "<\\!--")


def library_text(file, package):
    """FileNotFoundError that names what to install where it is missing."""
    if not file.is_file():
        raise FileNotFoundError(2, f"is missing; install {package}", str(file))
    return file.read_text(encoding="utf-8")


def licences(named):
    holders = {"libjs-three": "three.js: Copyright 2010-2019 three.js authors",
               "libjs-dygraphs": "dygraphs: Copyright 2006-2023 Dan Vanderkam, Google Inc. and contributors"}
    if not named:
        return "This page contains no library."
    text = " ".join((HERE / "mit.txt").read_text(encoding="utf-8").split("\n", 1)[1].split("\n"))
    return "; ".join(holders[name] for name in named) + ". " + text.strip()


def thinned(count, most=MOST_ROWS):
    """Which of `count` rows a curve shows, and what to say of it."""
    every = max(1, math.ceil(count / most))
    rows = numpy.arange(0, count, every)
    if count and rows[-1] != count - 1:
        rows = numpy.append(rows, count - 1)
    return rows, "" if every == 1 else f" Every {every}th of {count} rows is drawn."
