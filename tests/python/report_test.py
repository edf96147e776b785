#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""`grouser report` as a user meets it: pages opened in Chromium, and what is refused."""
import json
import math
import os
import subprocess
import unittest

import browser
import numpy
from fixture import ROOT, FolderTest

import grouser

#: Ten grains fall onto a plane: seeds make a difference, and each run takes a moment.
GRAINS = """version = 1
[run]
duration = 0.1
time_step = 1e-4
output_interval = 0.002
frame_interval = 0.01
[material.sand]
stiffness = 1e4
friction = 0.5
[[plane]]
name = "ground"
material = "sand"
[[grains]]
material = "sand"
form = "random"
number = 10
radius = 0.01
low = [-0.05, -0.05, 0.02]
high = [0.05, 0.05, 0.06]
[output]
plots = false
picture_width = 200
"""


def report(folder, *words):
    return subprocess.run([str(grouser.find_program()), "report", str(folder), *words], capture_output=True, text=True)


class Refused(FolderTest):
    def refuses(self, folder, words, *options):
        done = report(folder, *options)
        self.assertEqual(done.returncode, 2, done.stderr + done.stdout)
        self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
        self.assertTrue(done.stderr.startswith("grouser: error: "), done.stderr)
        for word in words:
            self.assertIn(word, done.stderr)

    def test_what_is_no_result(self):
        self.refuses("nosuch", ["nosuch", "is no folder"])
        (self.folder / "empty").mkdir()
        self.refuses("empty", ["holds no results", "results.h5"])
        self.assertEqual(list((self.folder / "empty").iterdir()), [])

    def test_what_is_damaged(self):
        for name in ("results.h5", "check.json", "soil.json", "summary.csv", "events.json"):
            place = self.folder / name.replace(".", "_")
            place.mkdir()
            for text in ("", "\0{[damaged", '{"figures": 1}'):
                (place / name).write_text(text)
                self.refuses(place, [place.name])
                self.assertEqual([file.name for file in place.iterdir()], [name])

    def test_a_file_cut_short_and_a_page_that_is_there(self):
        (self.folder / "grains.toml").write_text(GRAINS)
        grouser.call(["run", "grains.toml", "--out", "run", "--steps", "40"])
        self.assertEqual(report("run").returncode, 0)
        page = self.folder / "run/report.html"
        before = page.read_bytes()
        self.refuses("run", ["report.html", "is there already", "--force"])
        self.assertEqual(page.read_bytes(), before)
        self.assertEqual(report("run", "--force").returncode, 0)
        (self.folder / "run/film.mp4").write_bytes(b"a film")
        self.assertEqual(report("run", "--out", "other.html").returncode, 0)
        self.assertIn('src="data:video/mp4;base64,YSBmaWxt"', (self.folder / "other.html").read_text())
        self.assertNotIn("<video", page.read_text())
        self.refuses("run", ["nosuch.mp4"], "--film", "nosuch.mp4", "--force")
        results = (self.folder / "run/results.h5").read_bytes()
        for size in (len(results) // 2, 2000, 100):
            (self.folder / "run/results.h5").write_bytes(results[:size])
            self.refuses("run", ["run"], "--out", "damaged.html")
        self.assertFalse((self.folder / "damaged.html").exists())
        self.assertEqual(list(self.folder.glob("**/*.part")), [])


@unittest.skipIf(browser.find() is None, "no Chromium is installed: apt-get install chromium-headless-shell")
class Pages(FolderTest):
    @classmethod
    def setUpClass(cls):
        cls.browser = browser.Browser()
        cls.addClassCleanup(cls.browser.close)

    def made(self, folder, *words):
        done = report(folder, "--out", "page.html", "--force", *words)
        self.assertEqual(done.returncode, 0, done.stderr)
        page = self.folder / "page.html"
        self.assertLess(page.stat().st_size, 15e6)
        return page

    def opened(self, folder, *words):
        """The page, drawn: without an error, and without asking for anything but itself."""
        page = self.made(folder, *words)
        self.browser.media()
        self.browser.open(page)
        self.browser.until("document.documentElement.dataset.ready === 'yes'")
        asked = [r for r in self.browser.requests if not r.startswith(("data:", "blob:"))]
        self.assertEqual(asked, [f"file://{page}"])
        self.assertEqual(self.browser.errors, [])
        self.plots_are_drawn()
        if kept := os.environ.get("GROUSER_REPORT_PICTURES"):  # for the eye
            self.browser.picture(f"{kept}/{self.id().rpartition('.')[2]}_{folder}.png", 4000)
        return self.browser

    def plots_are_drawn(self):
        """Every plot has lines of its curves, names with units at both axes, and a legend."""
        for k in range(self.browser.value("report.plots.length")):
            place = f"document.getElementById('plot{k}')"
            # dygraphs draws points and lines on the lower of its two canvases.
            colours = self.browser.value(f"""(() => {{ const c = {place}.querySelector("canvas");
              const p = c.getContext("2d").getImageData(0, 0, c.width, c.height).data, found = new Set();
              for (let i = 0; i < p.length; i += 4) if (p[i + 3] > 200) found.add(p[i] << 16 | p[i + 1] << 8 | p[i + 2]);
              return found.size; }})()""")
            title = self.browser.value(f"document.getElementById('plot{k}-title').textContent")
            self.assertGreater(colours, 1, title)
            for axis in ("x", "y"):
                text = self.browser.value(f"{place}.querySelector('.dygraph-{axis}label').textContent")
                self.assertRegex(text, r".+ \[.+\]", title)
            self.assertTrue(self.browser.value(f"document.getElementById('plot{k}-legend').textContent"), title)

    def numbers(self):
        """{name: number} of all that the page shows."""
        pairs = self.browser.value("[...document.querySelectorAll('main data[data-name]')]"
                                   ".map(d => [d.dataset.name, d.value])")
        return {name: float(value) if value else math.nan for name, value in pairs}

    def colours_in_space(self):
        """How many colours the 3-D picture has, and a sum over its points."""
        return self.browser.value("""(() => { const from = report.space.canvas, c = document.createElement("canvas");
          c.width = from.width; c.height = from.height;
          const pen = c.getContext("2d"); pen.drawImage(from, 0, 0);
          const p = pen.getImageData(0, 0, c.width, c.height).data, found = new Set(); let sum = 0;
          for (let i = 0; i < p.length; i += 4) {
            found.add(p[i] << 16 | p[i + 1] << 8 | p[i + 2]); sum = (sum * 31 + p[i] + 7 * p[i + 1]) % 1000003; }
          return [found.size, sum]; })()""")

    def same(self, shown, wanted, name):
        if not (math.isnan(shown) and math.isnan(wanted)):
            self.assertEqual(shown, wanted, name)

    def test_a_run_with_a_vehicle_on_grains(self):
        scene = ROOT / "tests/scenes/coupled.toml"
        grouser.call(["run", str(scene), "--out", "drive", "--steps", "240", "--set", "output.frames=true", "--set",
                      "run.frame_interval=0.004", "--set", "run.output_interval=0.002", "--set",
                      "terrain.settle_kinetic_energy=1", "--set", "terrain.grain_radius=0.05", "--set",
                      "vehicle.sphere_radius=0.03"])
        page = self.opened("drive")
        self.numbers_of_a_run("drive")
        self.space_shows_the_frames("drive")
        self.keys_work(page)
        self.any_series_is_drawn(page, "drive")
        self.looks_change(page)
        self.assertEqual(page.errors, [])
        self.opened("drive", "--grains", "100", "--frames", "3")
        self.assertEqual(self.browser.value("[report.space.grains.count, report.space.time.length]"), [100, 3])

    def numbers_of_a_run(self, folder):
        shown = self.numbers()
        with grouser.open_run(folder) as run:
            for name, quantity in run.constants.items():
                if quantity.value.shape == () and quantity.value.dtype.kind in "fiu":
                    self.same(shown[name], float(quantity), name)
            for name in run.names("ledger."):
                if run[name].value.ndim == 1:
                    self.same(shown[name + " at the end"], run[name].value[-1], name)
            for name in ("vehicle.left.speed", "terrain.contacts", "ledger.kinetic"):
                series = run[name].value
                self.assertEqual(self.browser.value(f"Array.from(report.arrays['series.{name}'])"), series.tolist())
                self.same(shown[name + " mean"], float(series[numpy.isfinite(series)].mean()), name)
            manifest = run.manifest
            text = self.browser.value("document.querySelector('main').textContent")
            for word in (manifest["program"]["commit"], manifest["machine"], manifest["command_line"],
                         manifest["started"]):
                self.assertIn(word, text)
            switches = self.browser.value("[...document.querySelectorAll('#switches tr')].map(r => r.textContent)")
            self.assertTrue(any(row.startswith("ongrains") for row in switches), switches)
            self.assertTrue(any(row.startswith("offcohesion") for row in switches), switches)

    def space_shows_the_frames(self, folder):
        with grouser.open_run(folder) as run:
            frames = run.frames
            self.assertEqual(self.browser.value("Array.from(report.space.time)"), frames.time.tolist())
            last = frames[-1]
            middle = numpy.array(self.browser.value("report.space.data.middle"))
            units = numpy.array(self.browser.value("report.space.grains.unit"))
            drawn = numpy.array(self.browser.value("Array.from(report.space.positions)")).reshape(-1, 3) + middle
            self.assertEqual(len(drawn), len(last))
            # Half a unit of 16 bits, and the rounding of single precision.
            self.assertTrue((numpy.abs(drawn - last.position[numpy.argsort(last.id)]) < 0.51 * units + 1e-6).all())
            place = self.browser.value("report.space.parts[0].mesh.position.toArray()")
            part = self.browser.value("report.space.parts[0].part")
            numpy.testing.assert_allclose(numpy.array(place) + middle, last.poses[part, :3], atol=1e-6)
        many, at_end = self.colours_in_space()
        self.assertGreater(many, 100)
        self.browser.value("report.space.show(0)")
        self.assertNotEqual(self.colours_in_space()[1], at_end)
        self.browser.value("report.space.show(report.space.time.length - 1)")

    def keys_work(self, page):
        """All controls are reached by Tab, show that they are, and do what they should by keys alone."""
        page.value("document.activeElement.blur(); window.scrollTo(0, 0)")
        reached = []
        for _ in range(60):
            page.press("Tab")
            where = page.value("document.activeElement.id || document.activeElement.tagName")
            if where == "BODY":  # behind the last
                break
            drawn = page.value("(() => { const s = getComputedStyle(document.activeElement); "
                               "return s.outlineStyle !== 'none' && parseFloat(s.outlineWidth) >= 1; })()")
            self.assertTrue(drawn, f"{where} shows no focus")
            reached.append(where)
        for control in ("theme", "space-canvas", "space-back", "space-play", "space-on", "space-frame", "space-home",
                        "space-follow", "space-colour", "plot0", "plot1"):
            self.assertIn(control, reached)
        page.value("document.getElementById('space-canvas').focus()")
        frame, frames = (lambda: page.value("report.space.frame")), page.value("report.space.time.length")
        for key, wanted in (("Home", 0), (".", 1), (".", 2), (",", 1), ("End", frames - 1)):
            page.press(key)
            self.assertEqual(frame(), wanted, key)
        before = self.colours_in_space()[1]
        page.press("ArrowLeft")
        self.assertNotEqual(self.colours_in_space()[1], before)
        page.press("Home")
        page.press(" ")
        page.until("report.space.frame >= 2")
        page.press(" ")
        self.assertFalse(page.value("!!report.space.timer"))
        page.value("document.getElementById('plot0').focus()")
        page.press("Home")
        first = page.value("document.getElementById('plot0-legend').textContent")
        page.press("ArrowRight")
        second = page.value("document.getElementById('plot0-legend').textContent")
        self.assertIn("time = 0:", first)
        self.assertIn("time = 0.002:", second)
        wide = page.value("report.plots[0].graph.xAxisRange()")
        page.press("+")
        narrow = page.value("report.plots[0].graph.xAxisRange()")
        self.assertLess(narrow[1] - narrow[0], wide[1] - wide[0])
        page.press("Escape")
        self.assertEqual(page.value("report.plots[0].graph.xAxisRange()"), wide)

    def any_series_is_drawn(self, page, folder):
        """The list of all series, by keys: what is chosen is drawn, with its unit and what it is."""
        page.value("document.getElementById('any-series').focus()")
        page.press("End")
        page.press("Enter")
        chosen = page.value("document.getElementById('any-series').selectedOptions[0].textContent")
        plot = "report.plots[report.data.explorer.plot]"
        page.until(f"{plot}.curves[0].label + ' [' === {json.dumps(chosen)}.slice(0, {plot}.curves[0].label.length + 2)")
        name = page.value(f"{plot}.curves[0].label")
        with grouser.open_run(folder) as run:
            series = run[name] if name in run else run[name.rpartition(".")[0]][name.rpartition(".")[2]]
            self.assertEqual(page.value(f"{plot}.curves[0].columns[1].length"), len(series.value))
            self.assertEqual(page.value("document.getElementById('any-help').textContent"), series.help)
            self.assertIn(f"[{series.unit}]", page.value(f"{plot}.entry.y"))

    def looks_change(self, page):
        """Dark where the system is dark, white on paper."""
        back = "getComputedStyle(document.body).backgroundColor"
        self.assertEqual(page.value(back), "rgb(255, 255, 255)")
        page.media(scheme="dark")
        self.assertNotEqual(page.value(back), "rgb(255, 255, 255)")
        page.value("(() => { const c = document.getElementById('theme'); c.value = 'light'; "
                   "c.dispatchEvent(new Event('change')); })()")
        self.assertEqual(page.value(back), "rgb(255, 255, 255)")
        page.media("print")
        self.assertEqual(page.value("getComputedStyle(document.querySelector('nav')).display"), "none")
        page.media()

    def test_a_sweep(self):
        (self.folder / "grains.toml").write_text(GRAINS)
        grouser.call(["sweep", "grains.toml", "--set", "material.sand.friction=0.2,0.6", "--seeds", "3", "--out",
                      "sweep"])
        self.opened("sweep")
        sweep, shown = grouser.open_sweep("sweep"), self.numbers()
        compared = 0
        for run in sweep.runs:
            for name, value in run.figures.items():
                if numpy.isfinite(sweep[name].value).any():
                    self.same(shown[f"{run.name} {name}"], value, name)
                    compared += 1
        for mean in sweep.means["ground force z"]:
            name = f"ground force z friction = {mean.keys['material.sand.friction']}"
            self.same(shown[name], mean.mean.value, name)
            self.same(shown[name + " bar"], mean.mean.half_width, name)
        self.assertGreater(compared, 20)
        self.assertGreater(self.colours_in_space()[0], 20)
        firsts = [run for run in sweep.runs if run.keys["run.seed"] == "1"]
        self.runs_are_chosen([run.folder for run in firsts])
        (firsts[1].folder / "film.mp4").write_bytes(b"a film")
        (self.folder / "sweep/long.mp4").write_bytes(b"long" * 2000000)
        self.opened("sweep")
        films = "[...document.querySelectorAll('#films video')].map(v => v.src)"
        self.assertEqual(self.browser.value(films), ["data:video/mp4;base64,YSBmaWxt"])
        self.assertIn("long.mp4", self.browser.value("document.getElementById('films').textContent"))

    def runs_are_chosen(self, folders):
        """By keys each run comes into view in turn, with its own frames; and each has its ledger."""
        page = self.browser
        self.assertEqual(page.value("report.data.spaces.map(s => s.name)"), [folder.name for folder in folders])
        page.value("document.getElementById('space-run').focus()")
        for folder in folders:
            self.assertEqual(page.value("report.space.data.name"), folder.name)
            with grouser.open_run(folder) as run:
                self.assertEqual(page.value("Array.from(report.space.time)"), run.frames.time.tolist())
                self.assertEqual(page.value("Number(report.space.slider.max)"), len(run.frames) - 1)
                drawn = page.value("Array.from(report.space.positions.slice(0, 3))")
                where = numpy.array(drawn) + page.value("report.space.data.middle")
                last = run.frames[-1]
                numpy.testing.assert_allclose(where, last.position[numpy.argmin(last.id)], atol=1e-5)
                for name in ("kinetic", "integration_error"):
                    self.same(self.numbers()[f"{folder.name} ledger.{name} at the end"],
                              run[f"ledger.{name}"].value[-1], name)
            page.press("ArrowDown")
        page.value("document.getElementById('space-canvas').focus()")
        page.press("Home")
        self.assertEqual(page.value("[report.space.frame, report.space.data.name]"), [0, folders[-1].name])
        self.assertEqual(page.errors, [])

    def test_a_check(self):
        (self.folder / "grains.toml").write_text(GRAINS)
        grouser.call(["check", "grains.toml", "--axes", "step", "--seeds", "3", "--out", "check"])
        self.opened("check")
        check, shown = grouser.open_check("check"), self.numbers()
        self.assertGreater(len(check), 3)
        for figure in check:
            self.same(shown[figure.name], figure.bar.value, figure.name)
            if math.isfinite(figure.bar.half_width):
                self.same(shown[figure.name + " bar"], figure.bar.half_width, figure.name)
            for axis, error in figure.errors.items():
                self.same(shown[f"{figure.name} {axis}"], error.change.value, figure.name)
        cheapest = json.loads((self.folder / "check/costs.json").read_text())["cheapest"]
        self.assertGreater(len(cheapest), 0)
        cells = [(f"{row['figure']} {percent}", one["wall_s"]) for row in cheapest for percent, one in row.items()
                 if isinstance(one, dict)]
        self.assertGreater(len(cells), 0, "no setting keeps any bar")
        for name, seconds in cells:
            self.same(shown[name], seconds, name)
        # Its runs write no frames: what is seen is the checkpoint's.
        with grouser.open_run("check/base,seed=1") as run:
            self.assertIsNone(run.frames)
            bed = run.bed()
            drawn = numpy.array(self.browser.value("Array.from(report.space.positions)")).reshape(-1, 3)
            numpy.testing.assert_allclose(drawn + self.browser.value("report.space.data.middle"), bed.position, atol=1e-5)
            self.same(shown["base,seed=1 ledger.dissipated at the end"], run["ledger.dissipated"].value[-1], "ledger")
        self.assertIn("of the checkpoint", self.browser.value("document.getElementById('space-words').textContent"))
        self.assertGreater(self.colours_in_space()[0], 20)

    def test_a_run_has_the_bars_of_its_last_check(self):
        (self.folder / "grains.toml").write_text(GRAINS)
        program = str(grouser.find_program())
        kept = {**os.environ, "GROUSER_CACHE": str(self.folder / "cache")}
        for words in (["check", "grains.toml", "--axes", "step", "--seeds", "3", "--out", "check"],
                      ["run", "grains.toml", "--out", "run"], ["report", "run", "--out", "page.html"]):
            subprocess.run([program, *words], env=kept, check=True, capture_output=True)
        self.browser.open(self.folder / "page.html")
        self.browser.until("document.documentElement.dataset.ready === 'yes'")
        force, shown = grouser.open_check("check")["ground force z"], self.numbers()
        self.assertTrue(math.isfinite(force.bar.half_width))
        self.same(shown["ground force z checked"], force.bar.value, "value")
        self.same(shown["ground force z checked bar"], force.bar.half_width, "bar")
        self.assertEqual(list((self.folder / "run").glob("*.part")), [])

    def test_one_grain_alone(self):
        (self.folder / "grain.toml").write_text(
            'version = 1\n[run]\nduration = 1e-3\ntime_step = 1e-5\n[material.glass]\n[[grain]]\n'
            'position = [0, 0, 1]\nradius = 0.01\nmaterial = "glass"\n[output]\nplots = false\npicture_width = 64\n')
        grouser.call(["run", "grain.toml", "--out", "grain"])
        self.opened("grain")
        self.assertGreater(self.colours_in_space()[0], 20)

    def test_events(self):
        folder = self.folder / "events"
        (self.folder / "grains.toml").write_text(GRAINS)
        for level in (0.1, 0.2):
            grouser.call(["run", "grains.toml", "--set", f"run.gravity=[-{level}, 0, -9.81]", "--out",
                          f"events/grade={level}"])
        def row(level, pull):
            return {"event": "grade", "title": "Up a slope", "level": level, "level_is": "tan of the slope [-]",
                    "picture": f"grade={level}/picture.png", "verdict": "go", "runs": 3, "go": 3, "failed": 0, "pending": 0, "why": "at the top", "figures": [
                        {"name": "speed [m/s]", "runs": 3, "mean": pull, "half_width": 0.0123456789}]}
        (folder / "events.json").write_text(json.dumps({
            "command": "grouser events", "commit": "0123abc", "machine": "this", "vehicle": "light", "soil": "sand",
            "quick": True, "seeds": 3, "speed_m_s": 0.5, "grain_radius_m": 0.02, "bed_depth_m": 0.3,
            "rows": [row(0.1, 0.4987654321), row(0.2, 0.31)], "limits": [
                {"event": "grade", "level_is": "tan of the slope [-]", "go": 0.2, "no_go": None, "reference": None,
                 "agrees": None}]}))
        self.opened("events")
        shown = self.numbers()
        self.assertEqual((shown["grade 0.1 speed"], shown["grade 0.1 speed bar"]), (0.4987654321, 0.0123456789))
        self.assertEqual(self.browser.value("Array.from(report.plots[0].curves[0].columns[1])"), [0.4987654321, 0.31])
        self.runs_are_chosen([folder / "grade=0.1", folder / "grade=0.2"])

    def test_a_soil(self):
        folder = self.folder / "sand"
        folder.mkdir()
        (folder / "soil.json").write_text(
            '{"soil": "sand", "care": "coarse", "grain_radius_m": 0.007, "constants": {"n": {"value": 0.8123456789, '
            '"half_width": 0.1, "unit": "-", "published": [{"value": 0.79, "source": "a book"}], "span": [0.7, 0.9], '
            '"verdict": "inside"}, "phi": {"value": 28.7, "half_width": null, "unit": "deg", "published": []}}, '
            '"plates": [{"k": {"value": 244.0, "half_width": 1.0}}], '
            '"breadth_m": [0.1], "shear": {"peak_phi": {"value": 31.25, "half_width": 0.5, "unit": "deg"}}, "version": "0.1.0", "commit": "0123abc"}')
        (folder / "plates.csv").write_text(
            "care,plate,breadth [m],seed,phase,sinkage [m],pressure [Pa]\n" +
            "".join(f"coarse,small,0.1,1,0,{0.001 * k},{1000 * k}\n" for k in range(20)))
        self.opened("sand")
        shown = self.numbers()
        self.assertEqual((shown["n"], shown["n bar"], shown["phi"]), (0.8123456789, 0.1, 28.7))
        self.assertEqual((shown["shear peak_phi"], shown["shear peak_phi bar"], shown["plate 0.1 k"]), (31.25, 0.5, 244.0))
        self.assertEqual(self.browser.value("Array.from(report.plots[0].curves[0].columns[1])"),
                         [1000.0 * k for k in range(20)])


if __name__ == "__main__":
    unittest.main()
