#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Pages of results from elsewhere: markup and scripts in names, units, notes and paths are shown as text, never
executed."""
import copy
import json
import shutil
import sys
import unittest
from argparse import Namespace

import h5py
from fixture import ROOT, FolderTest
from report_pages import FILM, GRAINS, PageTest

sys.path[:0] = [str(ROOT / "runs/plots"), str(ROOT / "runs/report")]

import grouser
import report

HIT = "window.hit=document.title='hit'"
IMAGE = f'<img src=x onerror="{HIT}">'
VECTORS = (
    IMAGE, f"<script>{HIT}</script>", f"</script><script>{HIT}</script>", f'"><svg onload={HIT}>',
    f"' autofocus onfocus='{HIT}", f'" onmouseover="{HIT}" x="', f'<iframe srcdoc="<script>parent.{HIT}</script>">',
    "<!--", f"--><script>{HIT}</script>", f"</title><script>{HIT}</script>", f"</style><script>{HIT}</script>",
    f"</pre></table><script>{HIT}</script>", f'<a href="javascript:{HIT}">link</a>', f"&lt;img src=x onerror={HIT}&gt;",
    f"\u2028{HIT}\u2029//", "${" + HIT + "}", "{{constructor.constructor('" + HIT + "')()}}",
    f"<details open ontoggle={HIT}>", f"<video><source onerror={HIT}></video>", f"<body onload={HIT}>",
    f'<meta http-equiv="refresh" content="0;url=javascript:{HIT}">', '<base href="http://127.0.0.1:9/">',
    f'<form action="javascript:{HIT}"><button autofocus>', "<style>* { display: none }</style>", r"$\frac$ <b>bold</b>",
    "<!--data-->", "<plaintext>", "]]><math><mtext></math>", f"\\'-{HIT}//", "__proto__",
    f"<!--<script>{HIT}//", f"<SCRIPT SRC=data:,{HIT}></SCRIPT>", f"<scr<script>ipt>{HIT}</script>", f"</SCRIPT ><script>{HIT}</script>",
    f"<svg><script>{HIT}</script></svg>", f"<svg><animate onbegin={HIT} attributeName=x dur=1s></svg>", f"<img/src=x/onerror={HIT}>",
    f"<input autofocus onfocus={HIT}>", f"<select autofocus onfocus={HIT}>", f"<textarea autofocus onfocus={HIT}></textarea>",
    f"</textarea></select></noscript><script>{HIT}</script>", f"<object data='javascript:{HIT}'></object>",
    f"<embed src='javascript:{HIT}'>", f"<a href=' java\tscript:{HIT}' autofocus>x</a>", "<link rel=stylesheet href=//127.0.0.1:9/x.css>",
    f"<marquee onstart={HIT}></marquee>", f"<template><script>{HIT}</script></template>", "<frameset onload=x>",
    f"<math><mi xlink:href='javascript:{HIT}'>x</mi></math>", f"<audio src=x onerror={HIT}></audio>", f"\u003cscript\u003e{HIT}",
    f"&#60;script&#62;{HIT}&#60;/script&#62;", f"%3Cscript%3E{HIT}%3C/script%3E", f"`${{{HIT}}}`", f"');{HIT};('", f'");{HIT};("',
    f"\x0b\x0c<img\x0csrc=x\x0conerror={HIT}>", "constructor", "toString", "=HYPERLINK(\"http://127.0.0.1:9/\")", "\ufeff\u202e<b>back</b>")

MECHANISM = GRAINS.replace("[output]", """[[body]]
name = "block"
mass = 1
box = [0.02, 0.02, 0.02]
position = [0, 0, 0.2]
material = "sand"
[[body.shape]]
kind = "box"
size = [0.02, 0.02, 0.02]
[output]""").replace('[[grains]]', '[[box]]\nname = "wall"\nmaterial = "sand"\nposition = [0.2, 0, 0.1]\nsize = [0.01, 0.1, 0.1]\n[[grains]]')


EACH = [{"run": "a", "verdict": "go", "why": "far"}, {"run": "b", "verdict": "no-go", "why": "stuck"}]
ROW = {"event": "grade", "title": "Up a slope", "level": 0.1, "level_is": "slope", "picture": "", "verdict": "partly",
       "runs": 2, "go": 1, "failed": 0, "pending": 0, "why": "throws", "each": EACH,
       "figures": [{"name": "speed", "runs": 2, "mean": 1.0, "half_width": 0.1}]}
OTHER = {**copy.deepcopy(ROW), "level": 0.2, "each": [], "why": "one", "failed": "two"}
EVENTS = {"command": "c", "commit": "0123", "machine": "this", "vehicle": "light", "soil": "sand", "seeds": "three",
        "speed_m_s": 0.5, "rows": [ROW, OTHER], "left_out": {"a": "why"}, "limits": [
            {"event": "grade", "level_is": "slope", "go": 0.2, "no_go": None, "reference": "some", "agrees": True}]}
CONSTANT = {"value": 0.8, "half_width": 0.1, "unit": "-", "published": [{"value": 0.79, "source": "a book"}],
            "span": [0.7, 0.9], "verdict": "inside", "inconclusive": ""}
SOIL = {"soil": "sand", "care": "coarse", "grain_radius_m": 0.007, "version": "0.1.0", "commit": "0123abc", "machine": "m",
        "constants": {"n": CONSTANT, "phi": {**CONSTANT, "published": [], "inconclusive": "doubt"}},
        "plates": [{"k": {"value": 244.0, "half_width": 1.0, "unit": "kPa"}}], "breadth_m": [0.1],
        "shear": {"peak": {"value": 31.0, "half_width": 0.5, "unit": "deg"}}, "tests_with_shorter_steps": ["a", "b"],
        "tests": [{"name": "plate", "tests": "two", "porosity": {"value": 0.4, "half_width": 0.1}, "grains": 3, "steps": 4,
                   "seconds": 5}]}
VALUE = {"value": 27.0, "half_width": 0.7, "unit": "deg"}
TRIALS = [{"name": name, "kind": "shear", "measured": {"phi": VALUE}, "parameters": {"law": "hertz", "young": young}}
          for name, young in (("one", 1e7), ("two", 2e7))]
CALIBRATION = {"soil": "sand", "targets_file": "wanted.toml", "care": "full", "status": "finished", "grain_radius_m": 0.007,
         "targets": [{"quantity": "phi", "wanted": 31.1, "unit": "deg", "tolerance": 1.0}], "trials": TRIALS,
         "outcomes": [{"what": "phi", "wanted": 31.1, "tolerance": 1.0, "reached": VALUE, "verdict": "near"}],
         "missing": {"trial": "two", "tests": "some"}, "command": "c", "machine": "m", "version": "0", "commit": "1",
         "soil_file": "sand.toml", "tests": "final"}


class Poison:
    """Replaces texts by the vectors, in turn; `used` lists them."""

    def __init__(self):
        self.used = []

    def next(self, plain=False):
        """The next vector. plain: without the characters / and . of paths in HDF5 files."""
        vector = VECTORS[len(self.used) % len(VECTORS)]
        self.used.append(vector.replace("/", "\u2215").replace(".", "\u2024") if plain else vector)
        return self.used[-1]

    def json(self, value, kept, keys=()):
        """A copy of the value with new texts, except below the keys `kept`; also the names in the tables `keys`."""
        if isinstance(value, str):
            return self.next()
        if isinstance(value, list):
            return [self.json(one, kept, keys) for one in value]
        if isinstance(value, dict):
            return {name: one if name in kept else {self.next(): self.json(v, kept, keys) for v in one.values()}
                    if name in keys and isinstance(one, dict) else self.json(one, kept, keys) for name, one in value.items()}
        return value

    def file(self, file, kept, keys=()):
        file.write_text(json.dumps(self.json(json.loads(file.read_text()), kept, keys)))

    def csv(self, file, column):
        """New texts in a column of a table."""
        head, *lines = file.read_text().splitlines()
        at = head.split(",").index(column)
        for k, line in enumerate(lines):
            cells = line.split(",")
            cells[at] = '"' + self.next().replace('"', '""') + '"'
            lines[k] = ",".join(cells)
        file.write_text("\n".join([head, *lines]) + "\n")

    def results(self, file):
        """New names of surfaces, new units, helps, labels and attributes."""
        with h5py.File(file, "r+") as results:
            for name in ("surfaces", "bodies"):
                for old in list(results.get(name, ())):
                    results.move(f"{name}/{old}", f"{name}/{self.next(plain=True)}")

            def visit(_, item):
                for name, value in item.attrs.items():
                    if name == "labels":
                        item.attrs[name] = [self.next() for _ in value]
                    elif name in ("unit", "help"):
                        item.attrs[name] = self.next()
            results.visititems(visit)
            for name, value in list(results.attrs.items()):
                if isinstance(value, (str, bytes)) and name != "scene":
                    results.attrs[name] = self.next()


class Shown(PageTest):
    def shows(self, folder, poison, *words, title=None, least=None):
        """The page shows the vectors as text, with all plots drawn, and executes none of them."""
        page = self.opened_attacked(folder, *words)
        self.assertEqual(page.value("document.title"), title or f"{folder} ({self.kind})")
        text = page.value("document.documentElement.textContent + [...document.querySelectorAll('[title],[aria-label],"
                          "[data-name],[class]')].map(e => [e.title, e.ariaLabel, e.dataset.name].join(' ')).join(' ')")
        shown = [vector for vector in set(poison.used) if vector in text]
        self.assertGreaterEqual(len(shown), least or min(len(VECTORS), len(set(poison.used))) * 2 // 3, shown)
        page.value("document.querySelectorAll('details').forEach(d => { d.open = true; })")
        if page.value("!!document.getElementById('any-series')"):  # each series in the plot of any series
            page.value("""(() => { const choice = document.getElementById("any-series");
              for (let k = 0; k < choice.length; ++k) { choice.selectedIndex = k; choice.dispatchEvent(new Event("change")); } })()""")
        page.value("report.plots.forEach(plot => { plot.select(0); plot.zoom(0.5); })")
        self.is_untouched()

    kind = "run"

    def opened_attacked(self, folder, *words):
        page = self.made(folder, *words)
        self.browser.media()
        self.browser.width(1300)
        self.browser.open(page)
        self.browser.until("document.documentElement.dataset.ready === 'yes'", 20)
        self.assertEqual([r for r in self.browser.requests if not r.startswith("data:")], [f"file://{page}"])
        self.assertEqual(self.browser.errors, [])
        for k in range(self.browser.value("report.plots.length")):
            self.assertGreater(self.browser.value(f"document.querySelectorAll('#plot{k} canvas').length"), 1)
            for axis in ("x", "y"):  # the label is the text of the file
                self.assertEqual(self.browser.value(f"document.querySelector('#plot{k} .dygraph-{axis}label').textContent"),
                                 self.browser.value(f"report.plots[{k}].entry.{axis}"))
        return self.browser

    def is_untouched(self):
        page = self.browser
        self.assertIsNone(page.value("window.hit"))
        self.assertNotEqual(page.value("document.title"), "hit")
        self.assertEqual(page.dialogs, [])
        self.assertEqual(page.errors, [])
        for strange in ("img:not([src^='data:'])", "iframe", "a[href^='javascript:']", "main script", "main style", "base", "form",
                        "video:not([src])", "source", "plaintext", "math", "body[onload]", "main object", "main embed", "main link", "main input[autofocus]",
                        "main textarea", "main marquee", "main template", "main audio", "main svg script", "main animate", "[onbegin]", "[onstart]", "[onerror]", "[onload]",
                        "[onfocus]", "[onmouseover]", "[ontoggle]", "main meta", "main b"):
            self.assertEqual(page.value(f'document.querySelectorAll("{strange}").length'), 0, strange)

    def policy_holds(self):
        """The policy of the page blocks inline scripts, styles and requests, even if markup gets into the page."""
        page = self.browser
        page.value(f"""(async () => {{
          const place = document.createElement("div");
          document.body.append(place);
          place.innerHTML = `{IMAGE}<svg onload="{HIT}"></svg><details open ontoggle="{HIT}"></details>
            <p id="styled" style="color: rgb(1, 2, 3)">text</p><style>#styled {{ color: rgb(1, 2, 3); }}</style>`;
          const script = document.createElement("script");
          script.textContent = "{HIT}";
          document.body.append(script);
          await new Promise((done) => setTimeout(done, 100)); }})()""")
        self.assertIsNone(page.value("window.hit"))
        self.assertNotEqual(page.value("document.title"), "hit")
        self.assertNotEqual(page.value("getComputedStyle(document.getElementById('styled')).color"), "rgb(1, 2, 3)")
        self.assertTrue(page.value("fetch('data:,x').then(() => false, () => true)"))
        self.assertTrue(page.value("fetch('http://127.0.0.1:9/').then(() => false, () => true)"))
        page.until("1", 1)
        self.assertTrue(any("Content Security Policy" in error for error in page.errors), page.errors)
        page.call("Page.navigate", url="about:blank")
        page.until("new Promise(done => setTimeout(() => done(true), 300))")  # late messages of the page

    def test_a_run(self):
        self.assertGreaterEqual(len(VECTORS), 60)
        (self.folder / "grains.toml").write_text(MECHANISM)
        grouser.call(["run", "grains.toml", "--out", "run"])
        poison, run = Poison(), self.folder / "run"
        poison.results(run / "results.h5")
        with h5py.File(run / "frames.h5", "r+") as frames:
            names = frames["parts/part"].attrs["names"]
            frames["parts/part"].attrs["names"] = [poison.next() for _ in names]
        manifest = json.loads((run / "manifest.json").read_text())
        manifest["switches"] = "\n".join(f'  {word:<5}{poison.next()[:24]:<26}{poison.next()}' for word in ('on', '<!--', '"><b>'))
        manifest.update(status="incomplete", incomplete="late", bed_warnings="many", branched_from="there", ended_by="stop",
                        soils={"sand": {"soil": "sand", "file": "sand.toml", "hash": "1", "grain_radius_m": 1.0, "scale": 1.0}},
                        inputs="file of sand 12ab", overrides=["a=1", "b=2"])
        (run / "manifest.json").write_text(json.dumps(manifest))
        poison.file(run / "manifest.json", {"status", "switches"}, {"files", "soils"})
        scene = run / "scene.toml"
        scene.write_text(scene.read_text() + "".join(f"# {vector}\n" for vector in VECTORS if "\u2028" not in vector))
        place = self.folder / '"><img src=x onerror=hit()>'
        run.rename(place)
        (place / "<img src=x onerror=hit()>.mp4").write_bytes(FILM)
        self.shows(place.name, poison)
        self.policy_holds()

    def test_a_sweep(self):
        self.kind = "sweep"
        (self.folder / "grains.toml").write_text(GRAINS)
        grouser.call(["sweep", "grains.toml", "--set", "material.sand.friction=0.2,0.6", "--out", "sweep"])
        poison, folder = Poison(), self.folder / "sweep"
        for column in ("material.sand.friction", "message", "state hash"):
            poison.csv(folder / "summary.csv", column)
        for vector in (IMAGE.replace(",", ""), VECTORS[2]):  # columns of figures
            table = (folder / "summary.csv").read_text()
            head = vector.replace('"', "'")
            poison.used.append(head)
            (folder / "summary.csv").write_text(table.replace("kinetic", head, 1) if "kinetic" in table else table)
        variants = [{"variant": poison.next(), "ended": poison.next(), "runs": poison.next(), "wall_time_s": 1.0, "wall_time_per_second": 2.0}]
        (folder / "compare.json").write_text(json.dumps({"variants": variants, "bar_percent": 5, "rows": [
            {"figure": poison.next(), "means": [{"mean": 1.0, "half_width": 0.1}], "differences": [
                {"to": poison.next(), "from": poison.next(), "change": 1.0, "half_width": 0.5, "verdict": poison.next()}]}]}))
        self.shows("sweep", poison)

    def test_events(self):
        self.kind = "events"
        poison, folder = Poison(), self.folder / "events"
        folder.mkdir()
        told = poison.json(EVENTS, (), {"left_out"})
        for word in ("event", "title", "level_is"):  # rows of one event
            told["rows"][1][word] = told["rows"][0][word]
        told["rows"][1]["figures"][0]["name"] = told["rows"][0]["figures"][0]["name"]
        (folder / "events.json").write_text(json.dumps(told))
        self.shows("events", poison)

    def test_a_soil_and_a_calibration(self):
        poison, folder = Poison(), self.folder / "soil"
        folder.mkdir()
        (folder / "soil.json").write_text(json.dumps(poison.json(SOIL, {"care"}, {"shear"})))
        self.kind = "soil"
        self.shows("soil", poison, title=f"{poison.used[0]} (soil)")
        for status in ("finished", "unfinished"):
            poison, folder = Poison(), self.folder / f"found_{status}"
            shutil.copytree(self.folder / "soil", folder / "final")
            told = poison.json({**CALIBRATION, "status": status, "outcomes": CALIBRATION["outcomes"] if status == "finished" else []},
                               {"care", "status", "tests", "soil_file", "quantity"})
            for trial in told["trials"]:  # further keys
                trial["parameters"][IMAGE] = IMAGE
            (folder / "calibration.json").write_text(json.dumps(told))
            (folder / "sand.toml").write_text("".join(f"# {vector}\n" for vector in VECTORS))
            self.shows(folder.name, poison, title=f"{poison.used[0]} (calibration)")

    def test_a_check(self):
        self.kind = "check"
        (self.folder / "grains.toml").write_text(GRAINS)
        grouser.call(["check", "grains.toml", "--axes", "step", "--seeds", "2", "--out", "check"])
        poison, folder = Poison(), self.folder / "check"
        cost = json.loads((folder / "costs.json").read_text())
        poison.file(folder / "check.json", {"name", "status", "axis", "headline"})
        (folder / "costs.json").write_text(json.dumps({**cost, "machine": poison.next()}))
        run = next(folder.glob("*,seed=1"))
        poison.file(run / "manifest.json", {"status"}, {"files"})
        self.shows("check", poison)


class Leaves(FolderTest):
    """Each single value of a file, also numbers and names: the page is refused, or contains no markup."""

    def leaves(self, value, path=()):
        if isinstance(value, (dict, list)):
            for key in value if isinstance(value, dict) else range(len(value)):
                yield from self.leaves(value[key], (*path, key))
        else:
            yield path

    def replaced(self, value, path):
        value = copy.deepcopy(value)
        inner = value
        for key in path[:-1]:
            inner = inner[key]
        inner[path[-1]] = IMAGE
        return value

    def none_escapes(self, file, kind):
        whole = json.loads(file.read_text())
        options = Namespace(figures={}, film=None, program=None, frames=1, grains=10)
        pages = 0
        # One entry of each list stands for all.
        for path in {tuple(key for key in path if isinstance(key, str)): path for path in self.leaves(whole)}.values():
            file.write_text(json.dumps(self.replaced(whole, path)))
            try:
                page = report.contents(file.parent, kind, options).html()
            except (grouser.FileError, ValueError, RuntimeError, KeyError, IndexError, TypeError, AttributeError, OSError):
                continue  # as in report.py: damaged
            pages += 1
            self.assertNotIn("<img src=x", page, path)
        file.write_text(json.dumps(whole))
        return pages

    def test_no_value_of_a_file_becomes_markup(self):
        (self.folder / "grains.toml").write_text(GRAINS)
        grouser.call(["run", "grains.toml", "--out", "run", "--steps", "40"])
        self.assertGreater(self.none_escapes(self.folder / "run/manifest.json", "run"), 20)
        grouser.call(["check", "grains.toml", "--axes", "step", "--seeds", "2", "--out", "check", "--set", "run.duration=0.01"])
        for run in (self.folder / "check").glob("*,seed=*"):  # without these, the page is quicker
            shutil.rmtree(run)
        (self.folder / "check/series.csv").unlink()
        for name, kind, told in (("soil", "soil test", SOIL), ("events", "series of events", EVENTS), ("calibration", "calibration", CALIBRATION)):
            (self.folder / name).mkdir()
            if name == "calibration":
                shutil.copytree(self.folder / "soil", self.folder / name / "soil")
                told = {**told, "tests": "soil"}
            (self.folder / name / f"{name}.json").write_text(json.dumps(told))
            self.assertGreater(self.none_escapes(self.folder / name / f"{name}.json", kind), 10)
        self.assertGreater(self.none_escapes(self.folder / "check/check.json", "check"), 20)


class Paths(FolderTest):
    """Results from elsewhere cannot bring other files of this machine into a page."""

    def setUp(self):
        super().setUp()
        (self.folder / "private").mkdir()
        (self.folder / "private/secret.txt").write_text("the secret")
        self.png = b"\x89PNG\r\n\x1a\n the secret IEND\0\0\0\0"
        (self.folder / "private/picture.png").write_bytes(self.png)
        (self.folder / "private/film.mp4").write_bytes(FILM)

    def outside(self):
        yield from ("..", "../private", str(self.folder / "private"), "a/../../private", "link", "link/..", "loop", "a\0b")

    def kept(self, name):
        folder = self.folder / name
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir()
        (folder / "link").symlink_to("../private")
        (folder / "loop").symlink_to("loop")
        return folder

    def refuses(self, function, folder, file, path):
        with self.subTest(file=file, path=path), self.assertRaises(grouser.FileError) as refused:
            function(folder)
        self.assertIn(f"{folder / file}: the path ", str(refused.exception))
        self.assertIn("leads out of the folder", str(refused.exception))

    def page(self, folder, kind):
        return report.contents(folder, kind, Namespace(figures={}, film=None, program=None, frames=1, grains=10)).html()

    def test_events(self):
        for path in self.outside():
            for change in ({"each": [{"run": path, "verdict": "go", "why": ""}]}, {"picture": f"{path}/picture.png", "each": []}):
                folder = self.kept("events")
                (folder / "events.json").write_text(json.dumps({**EVENTS, "rows": [{**ROW, **change}]}))
                self.refuses(grouser.open_events, folder, "events.json", path)
                self.refuses(lambda folder: self.page(folder, "series of events"), folder, "events.json", path)

    def test_sweep_check_and_calibration(self):
        for path in self.outside():
            if "\0" in path:
                continue  # not a text of a CSV file
            folder = self.kept("sweep")
            (folder / "summary.csv").write_text("run,run.seed,status,message,wall time [s],steps,simulated time [s],state hash\n"
                                                f"{path},1,finished,,1,1,1,0\n")
            self.refuses(grouser.open_sweep, folder, "summary.csv", path)
            folder = self.kept("calibration")
            (folder / "calibration.json").write_text(json.dumps({**CALIBRATION, "soil_file": f"{path}/secret.txt", "tests": path}))
            self.refuses(lambda folder: grouser.open_calibration(folder).soil(), folder, "calibration.json", path)
            self.refuses(lambda folder: grouser.open_calibration(folder).soil_file, folder, "calibration.json", path)

    def test_pictures_and_films_that_are_links(self):
        folder = self.kept("events")
        (folder / "events.json").write_text(json.dumps({**EVENTS, "rows": [{**ROW, "each": [], "picture": ""}]}))
        (folder / "pictures.png").symlink_to("../private/picture.png")
        (folder / "film.mp4").symlink_to("../private/film.mp4")
        (folder / "inner.png").write_bytes(self.png)
        (folder / "drawbar.png").symlink_to("inner.png")
        page = self.page(folder, "series of events")
        self.assertIn("pictures.png is omitted: it is a link out of its folder", page)
        self.assertEqual(page.count("data:image/png"), 1)  # the link within the folder
        self.assertNotIn("data:video", page)


if __name__ == "__main__":
    unittest.main()
