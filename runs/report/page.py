# SPDX-License-Identifier: BSD-3-Clause
"""Framework of a report: sections, tables, plots, and the self-contained HTML file."""
import base64
import hashlib
import html
import json
import math
import re
import zlib
from pathlib import Path

import numpy

import definitions
import grouser

HERE = Path(__file__).resolve().parent
DEBIAN = Path("/usr/share/javascript")
#: JavaScript libraries, from Debian: (files, package).
PLOTS = (("dygraphs/dygraph.min.js",), "libjs-dygraphs")
STYLE = ("dygraphs/dygraph.min.css", "libjs-dygraphs")
SPACE = (("three/three.min.js", "three/examples/js/controls/OrbitControls.js"), "libjs-three")
MOST_ROWS = 2000  # maximum number of points per curve
NOTHING = 1e-30  # in SI units: smaller values are treated as 0
MOST_LINES = 20  # maximum rows of a table without a scroll bar


def esc(text):
    return html.escape(str(text), quote=True)


def packed(values):
    """An array for the page: type, shape, and bytes (deflate, base64)."""
    values = numpy.ascontiguousarray(values)
    kind = {"float64": "f8", "float32": "f4", "uint32": "u4", "uint16": "u2", "uint8": "u1"}[str(values.dtype)]
    little = values.astype(values.dtype.newbyteorder("<"), copy=False)
    return {"kind": kind, "shape": list(values.shape),
            "data": base64.b64encode(zlib.compress(little.tobytes(), 9)).decode()}


def shown(value, digits=5):
    """A number, rounded for display."""
    if value is None or math.isnan(value):
        return "none"
    if math.isinf(value):
        return "unknown"
    if abs(value) < NOTHING:
        return "0"
    text = f"{value:.{digits}g}"
    if "e" in text and 1e-4 <= abs(value) < 1e6:  # digits beyond the requested ones are zeros
        text = f"{float(text):.0f}"
    if "e" not in text:
        return text.replace("-", "\u2212")
    mantissa, exponent = text.split("e")
    return f"{mantissa}\u00b7e{int(exponent)}".replace("\u00b7e", " \u00d7 10^").replace("-", "\u2212")


def superscript(text):
    """10^-4 in HTML."""
    before, mark, exponent = text.partition("^")
    return f"{before}<sup>{exponent}</sup>" if mark else text


def exact(value):
    """The shortest text that round-trips to the same number."""
    return "" if value is None else repr(float(value))


def number(value, unit="", name="", digits=5):
    """A number in HTML: rounded text, full precision in the attribute `value`; `name`: attribute data-name."""
    named = f' data-name="{esc(name)}"' if name else ""
    unit_text = f"\u00a0{esc(unit)}" if unit and unit != "-" else ""
    return f'<data value="{exact(value)}"{named}>{superscript(shown(value, digits))}</data>{unit_text}'


def with_bar(value, half, unit="", name=""):
    """A number with its error bar, rounded to the digits of the bar."""
    if half is None or value is None or not math.isfinite(half) or not math.isfinite(value):
        return number(value, unit, name)
    value_text, half_text, power = (str(part).replace("-", "\u2212") for part in grouser.series.estimate_text(value, half))
    if not half_text:  # the runs agree except for rounding
        mark = f' data-name="{esc(name)} bar"' if name else ""
        return f'{number(value, unit, name, 6)} <data value="{exact(half)}"{mark}>(exact)</data>'
    before, behind = ("", "") if power == "0" else ("(", f") \u00d7 10<sup>{power}</sup>")
    named = f' data-name="{esc(name)}"' if name else ""
    bar = f' data-name="{esc(name)} bar"' if name else ""
    unit_text = f"\u00a0{esc(unit)}" if unit and unit != "-" else ""
    return (f'<span class="nowrap">{before}<data value="{exact(value)}"{named}>{value_text}</data> \u00b1 '
            f'<data value="{exact(half)}"{bar}>{half_text}</data>{behind}{unit_text}</span>')


def term(name, about=""):
    """The name of a figure with its definition as a tooltip: from the table of definitions, else `about`."""
    words = definitions.definition(name) or about
    text = esc(definitions.label(name))
    return f'<span class="term" title="{esc(words)}">{text}</span>' if words else text


INCONCLUSIVE = ' <span class="bad">inconclusive</span>'


def figure_with_bar(value, half, unit="", name="", inconclusive=False):
    """with_bar(), marked if inconclusive or if the bar exceeds the value, so that the sign is not certain. Values that
    are 0 in all runs are certain."""
    wide = None not in (value, half) and math.isfinite(half) and half > abs(value)
    known = value is not None and not value == half == 0
    return with_bar(value, half, unit, name) + (INCONCLUSIVE if wide or inconclusive and known else "")


def table(headings, rows, caption="", numeric=()):
    """An HTML table; `numeric`: columns with numbers."""
    def cells(tag, scope, row):
        return "".join(f'<{tag}{scope}{" class=n" if k in numeric else ""}>{cell}</{tag}>' for k, cell in enumerate(row))
    head = f"<thead><tr>{cells('th', ' scope=col', map(esc, headings))}</tr></thead>"
    body = "".join(f"<tr>{cells('td', '', row)}</tr>" for row in rows)
    words = f"<caption>{caption}</caption>" if caption else ""
    tall = ' tall" tabindex="0" role="region" aria-label="table' if len(rows) > MOST_LINES else ""
    return f'<div class="wide{tall}"><table>{words}{head}<tbody>{body}</tbody></table></div>'


def run_name(name):
    """A run's name as code, with line breaks only after commas."""
    return f'<code class="name">{esc(name).replace(",", ",<wbr>")}</code>'


def facts(rows):
    """A definition list: [(word, HTML)]; entries with empty HTML are omitted."""
    return "<dl>" + "".join(f"<dt>{esc(word)}</dt><dd>{text}</dd>" for word, text in rows if text) + "</dl>"


def folded(title, inner, opened=False):
    return f'<details{" open" if opened else ""}><summary>{esc(title)}</summary>{inner}</details>'


def picture(file, words):
    """A PNG in the page; "" if the file is missing, a warning if it is damaged or a link to another folder."""
    if not file.is_file():
        return ""
    if grouser.files.leads_out(file.parent, file):
        return f'<p class="bad">{esc(file.name)} is omitted: it is a link out of its folder.</p>'
    picture_ = file.read_bytes()
    if not picture_.startswith(b"\x89PNG\r\n\x1a\n") or picture_[-8:-4] != b"IEND":
        return f'<p class="bad">{esc(file.name)} is damaged: not a complete PNG file.</p>'
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
        self.warnings = []  # HTML at the top of the page
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
        """Bytes of all arrays in the page so far."""
        return sum(len(array["data"]) for array in self.data["arrays"].values())

    def plot(self, title, x, y, curves, caption="", **more):
        """HTML of an interactive plot. `x`, `y`: axis labels with units. `curves`: [(label, x, y)], with half widths of
        bars [(label, x, y, half)], or with both ends [(label, x, y, low, high)]. `more`: `about` (tooltip of the
        title), `points` (no lines), `marks` (True, or labels of the curves with point marks and vertical bars),
        `whole` (integer x), `log` ("x", "y", "xy")."""
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
        scripts = [self.script(library_text(DEBIAN / name, package)) for files, package in self.libraries for name in files]
        scripts += [self.script((HERE / name).read_text(encoding="utf-8")) for name in ("report.js", "view.js")]
        links = "".join(f'<li><a href="#{i}">{esc(t)}</a></li>' for i, t, _ in self.sections)
        warnings = "".join(f'<div class="bad" role="note">{warning}</div>' for warning in self.warnings)
        body = warnings + "".join(f'<section id="{i}" aria-labelledby="{i}-h"><h2 id="{i}-h">{esc(t)}</h2>{inner}</section>'
                       for i, t, inner in self.sections)
        frame = (HERE / "page.html").read_text(encoding="utf-8")
        style = library_text(DEBIAN / STYLE[0], STYLE[1]) if PLOTS in self.libraries else ""
        style = style.split("/*# sourceMappingURL")[0] + (HERE / "report.css").read_text(encoding="utf-8")
        data = json.dumps(self.data, allow_nan=False).replace("<", "\\u003c")
        parts = {"title": esc(self.title), "kind": esc(self.kind), "folder": esc(self.folder),
                 "style": style, "links": links, "body": body, "data": data,
                 "code": "".join(f"<script>{script}</script>\n" for script in scripts),
                 "styles": allowed([style]), "scripts": allowed(scripts),
                 "licences": esc(licences([package for _, package in self.libraries]))}
        return re.sub("<!--([a-z]+)-->", lambda place: parts[place[1]], frame)

    @staticmethod
    def script(text):
        """Text of a script for inlining, without closing tags and source map references."""
        lines = (line for line in text.split("\n") if not line.startswith("//# sourceMappingURL"))
        return "\n".join(lines).replace("</script", "<\\/script").replace("<!--", "<\\!--")


def allowed(texts):
    """Sources of a Content-Security-Policy: the browser uses these inline scripts or styles only, and no attributes."""
    return " ".join(f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'" for text in texts)


def library_text(file, package):
    """Text of a library. FileNotFoundError names the package to install."""
    if not file.is_file():
        raise FileNotFoundError(2, f"is missing; install {package}", str(file))
    return file.read_text(encoding="utf-8")


def licences(named):
    holders = {"libjs-three": "three.js: Copyright 2010-2019 three.js authors",
               "libjs-dygraphs": "dygraphs: Copyright 2006-2023 Dan Vanderkam, Google Inc. and contributors"}
    if not named:
        return "This page contains no libraries."
    text = " ".join((HERE / "mit.txt").read_text(encoding="utf-8").split("\n", 1)[1].split("\n"))
    return "; ".join(holders[name] for name in named) + ". " + text.strip()


def thinned(count, most=MOST_ROWS):
    """Indices of the rows, out of `count`, that a curve shows, and a note if rows are omitted."""
    every = max(1, math.ceil(count / most))
    rows = numpy.arange(0, count, every)
    if count and rows[-1] != count - 1:
        rows = numpy.append(rows, count - 1)
    return rows, "" if every == 1 else f" The plot shows every {every}th of {count} rows."
