#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""`grouser report`: pages of runs opened in Chromium, and rejected input."""
import json
import math
import os
import re
import shlex
import signal
import subprocess
import time
import unittest

import h5py
import numpy
from fixture import ROOT, FolderTest
from report_pages import FILM, FILM_TEXT, GRAINS, PageTest, report

import grouser

SCRIPT = ["/usr/bin/python3", "-B", str(ROOT / "runs/report/report.py")]


class Refused(FolderTest):
    def refuses(self, folder, words, *options):
        done = report(folder, *options)
        self.assertEqual(done.returncode, 2, done.stderr + done.stdout)
        self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
        self.assertTrue(done.stderr.startswith("grouser: error: "), done.stderr)
        for word in words:
            self.assertIn(word, done.stderr)

    def test_what_is_no_result(self):
        self.refuses("nosuch", ["nosuch", "is not a folder"])
        (self.folder / "empty").mkdir()
        self.refuses("empty", ["contains no results", "results.h5"])
        self.assertEqual(list((self.folder / "empty").iterdir()), [])
        (self.folder / "above/drive").mkdir(parents=True)
        (self.folder / "above/drive/results.h5").write_text("")
        self.refuses("above", ["contains no results", "above/drive"])
        (self.folder / "file").write_text("")
        self.refuses("file", ["is not a folder"])

    def test_what_has_no_numbers_yet(self):
        """No run has finished: one line with the reason and the command that continues."""
        head = "run,k,status,message,wall time [s],steps,simulated time [s],state hash,commit\n"
        row = {"event": "step", "title": "Up a step", "level": 0.2, "level_is": "height [m]", "verdict": "pending",
               "runs": 0, "go": 0, "failed": 0, "pending": 2, "why": "", "figures": []}
        found = {"soil": "sand", "care": "full", "status": "unfinished", "grain_radius_m": 0.01, "targets": [],
                 "trials": []}
        for name, text, words in (
                ("summary.csv", head, ["contains no run"]),
                ("summary.csv", head + "k=1,1,pending,,,,,,\nk=2,2,running,,,,,,\n", ["none of the 2 runs", "again"]),
                ("events.json", json.dumps({"rows": [row]}), ["none of the runs", "--resume"]),
                ("events.json", json.dumps({"rows": []}), ["none of the runs"]),
                ("calibration.json", json.dumps(found), ["no trial", "--resume"])):
            place = self.folder / name.replace(".", "_")
            place.mkdir(exist_ok=True)
            (place / name).write_text(text)
            self.refuses(place, [place.name, *words])
            self.assertEqual([file.name for file in place.iterdir()], [name])

    def test_what_is_damaged(self):
        for name in ("results.h5", "check.json", "soil.json", "summary.csv", "events.json", "calibration.json"):
            place = self.folder / name.replace(".", "_")
            place.mkdir()
            for text in (b"", b"\0{[damaged", b'{"figures": 1}', b"[1]", b"run,\xff\xfe\n"):
                (place / name).write_bytes(text)
                self.refuses(place, [name if name.endswith("json") and b"figures" not in text else place.name])
                self.assertEqual([file.name for file in place.iterdir()], [name])

    def test_a_file_cut_short_and_a_page_that_is_there(self):
        (self.folder / "grains.toml").write_text(GRAINS)
        grouser.call(["run", "grains.toml", "--out", "run", "--steps", "40"])
        self.assertEqual(report("run").returncode, 0)
        page = self.folder / "run/report.html"
        before = page.read_bytes()
        self.refuses("run", ["report.html", "already exists", "--force"])
        self.assertEqual(page.read_bytes(), before)
        self.assertEqual(report("run", "--force").returncode, 0)
        (self.folder / "run/film.mp4").write_bytes(FILM)
        (self.folder / "run/notes.mp4").write_text("no film")
        self.assertEqual(report("run", "--out", "other.html").returncode, 0)
        self.assertEqual((self.folder / "other.html").read_text().count(f'src="{FILM_TEXT}"'), 1)
        self.assertEqual((self.folder / "other.html").read_text().count("<video"), 1)
        self.assertEqual(page.read_text().count("<video"), 0)
        for file in ("run/scene.toml", "run/notes.mp4", "run/picture.png"):
            self.refuses("run", [f"--film {file}", "not a film", ".mp4", ".webm", ".gif"], "--film", file, "--force")
        self.refuses("run", ["nosuch.mp4"], "--film", "nosuch.mp4", "--force")
        self.refuses("run", ["nodir/x.html", "/nodir does not exist", "create it"], "--out", "nodir/x.html")
        self.assertFalse((self.folder / "nodir").exists())
        results = (self.folder / "run/results.h5").read_bytes()
        for size in (len(results) // 2, 2000, 100):
            (self.folder / "run/results.h5").write_bytes(results[:size])
            self.refuses("run", ["run"], "--out", "damaged.html")
        (self.folder / "run/results.h5").write_bytes(results)
        for name in ("manifest.json", "frames.h5"):
            whole = (self.folder / "run" / name).read_bytes()
            for damaged in (whole[:len(whole) // 2], b"[1]"):
                (self.folder / "run" / name).write_bytes(damaged)
                self.refuses("run", [name], "--out", "damaged.html")
            (self.folder / "run" / name).write_bytes(whole)
        for name in ("manifest.json", "scene.toml", "results.h5"):
            (self.folder / "run" / name).rename(self.folder / "kept")
            self.refuses("run", ["run: ", name, "from a copy"], "--out", "damaged.html")
            (self.folder / "kept").rename(self.folder / "run" / name)
        for name in ("results.h5", "frames.h5"):  # damage inside: opening the file does not detect it
            whole = (self.folder / "run" / name).read_bytes()
            nodes = [m.start() for m in re.finditer(b"OHDR", whole)]  # headers of groups and datasets
            for node in (nodes[0], nodes[-1]):
                (self.folder / "run" / name).write_bytes(whole[:node] + b"LOST" + whole[node + 4:])
                self.refuses("run", [f"run/{name}: ", "damaged", "run it again"], "--out", "damaged.html")
            (self.folder / "run" / name).write_bytes(whole)
        (self.folder / "run/scene.toml").write_bytes(b"version = \xff")
        self.refuses("run", ["run/scene.toml: damaged or incomplete"], "--out", "damaged.html")
        (self.folder / "run/scene.toml").write_text("version = 1")
        (self.folder / "run/manifest.json").write_text('{"status": "finished",\n  "figures" 1}')
        self.refuses("run", ["manifest.json:2:13: ", "run it again"], "--out", "damaged.html")
        self.assertFalse((self.folder / "damaged.html").exists())
        self.assertEqual(list(self.folder.glob("**/*.part")), [])

    def test_what_cannot_be_entered(self):
        done = subprocess.run([*SCRIPT, "long" * 99, "page.html"], capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr), (2, ""))
        self.assertIn("cannot be read: File name too long", done.stdout)

    def test_a_library_that_is_missing(self):
        (self.folder / "grains.toml").write_text(GRAINS)
        grouser.call(["run", "grains.toml", "--out", "run", "--steps", "40"])
        code = ("import sys; sys.path.insert(0, sys.argv.pop(1)); import report; from pathlib import Path; import page; "
                "page.DEBIAN = Path('javascript'); report.main()")
        done = subprocess.run(["/usr/bin/python3", "-B", "-c", code, str(ROOT / "runs/report"), "run", "page.html"],
                              capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr), (3, ""))
        self.assertIn("is missing; install libjs-", done.stdout)

    def test_names_that_are_no_text(self):
        """A folder whose name is not UTF-8 has its page, and messages contain its bytes."""
        (self.folder / "grains.toml").write_text(GRAINS)
        grouser.call(["run", "grains.toml", "--out", "run", "--steps", "40"])
        (self.folder / "run").rename(os.fsdecode(b"r\xffn"))
        done = subprocess.run([*SCRIPT, b"r\xffn", b"r\xffn/page.html"], capture_output=True)
        self.assertEqual((done.returncode, done.stderr), (0, b""))
        self.assertTrue(done.stdout.startswith(b"report    r\xffn/page.html"), done.stdout)
        self.assertIn("r?n (run)", (self.folder / os.fsdecode(b"r\xffn/page.html")).read_text())
        self.assertEqual(list(self.folder.glob("**/*.part")), [])

    def test_what_is_interrupted_leaves_nothing(self):
        """Ctrl-C while the page is made, here while the script asks the program for a unit: one line, exit code 130."""
        (self.folder / "sweep").mkdir()
        (self.folder / "sweep/summary.csv").write_text(
            "run,run.x,status,message,wall time [s],steps,simulated time [s],force [N],state hash,commit\n"
            "x=1,1,finished,,1,1,1,1,,\nx=2,2,finished,,1,1,1,2,,\n")
        asked = self.folder / "asked"
        (self.folder / "program").write_text(f"#!/bin/sh\ntouch {asked}\nexec sleep 60\n")
        (self.folder / "program").chmod(0o755)
        started = subprocess.Popen([*SCRIPT, "sweep", "page.html", "--program", str(self.folder / "program")],
                                   stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, start_new_session=True)
        end = time.monotonic() + 60
        while not asked.exists() and started.poll() is None and time.monotonic() < end:
            time.sleep(0.02)
        os.killpg(started.pid, signal.SIGINT)
        told = started.communicate(timeout=60)[0]
        self.assertEqual((started.returncode, told), (130, "interrupted; no report was written\n"))
        self.assertEqual({file.name for file in self.folder.iterdir()}, {"sweep", "program", "asked"})

    def test_a_signal_to_the_program_reaches_the_script(self):
        (self.folder / "run").mkdir()
        script = self.folder / "share/runs/report/report.py"
        script.parent.mkdir(parents=True)
        script.write_text("import pathlib, signal, sys, time\nsignal.signal(signal.SIGTERM, lambda *_: sys.exit(130))\n"
                          "pathlib.Path('asked').touch()\ntime.sleep(60)\n")
        started = subprocess.Popen([str(grouser.find_program()), "report", "run"], stderr=subprocess.PIPE, text=True,
                                   env={**os.environ, "GROUSER_SHARE": str(self.folder / "share")})
        end = time.monotonic() + 60
        while not (self.folder / "asked").exists() and started.poll() is None and time.monotonic() < end:
            time.sleep(0.02)
        started.send_signal(signal.SIGTERM)
        told = started.communicate(timeout=60)[1]
        self.assertEqual((started.returncode, told[:50]), (143, "grouser: stopped by SIGTERM; no report was written"))

    def test_a_page_that_is_interrupted_while_it_is_written_is_taken_back(self):
        code = ("import os, sys; sys.argv = ['report.py', *sys.argv[2:]]; sys.path.insert(0, sys.argv.pop(1)); "
                "import report; from pathlib import Path\n"
                "def interrupted(*_): assert Path('page.html.part').exists(); raise KeyboardInterrupt\n"
                "os.replace = interrupted\n"
                "try: report.put('half', Path('page.html'))\nexcept KeyboardInterrupt: sys.exit(130)")
        done = subprocess.run(["/usr/bin/python3", "-B", "-c", code, "-", str(ROOT / "runs/report")], capture_output=True,
                              text=True)
        self.assertEqual((done.returncode, done.stderr), (130, ""))
        self.assertEqual(list(self.folder.iterdir()), [])


class Pages(PageTest):
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
        self.fits_narrow_screens()
        self.ground_pressure_is_of_the_shoes_in_contact("drive")
        self.opened("drive", "--grains", "100", "--frames", "3")
        self.assertEqual(self.browser.value("[report.space.grains.count, report.space.time.length]"), [100, 3])

    def ground_pressure_is_of_the_shoes_in_contact(self, folder):
        """Four shoes carry 100 kPa, the others are pulled by 102 kPa: the expected mean is 100 kPa in every row."""
        with h5py.File(f"{folder}/results.h5", "r+") as file:
            for side in ("left", "right"):
                pressure, carries = (file[f"vehicle/{side}/{name}/value"] for name in ("ground_pressure", "on_ground"))
                carries[...] = numpy.arange(carries.shape[1]) < 4
                pressure[...] = numpy.where(carries[...] > 0.5, 1e5, -1.02e5)
        self.opened(folder)
        values = self.browser.value("report.plots.find(p => p.entry.title.startsWith('Ground pressure')).curves"
                                    ".flatMap(c => c.columns.slice(1).flatMap(v => Array.from(v)))")
        self.assertEqual(set(values), {1e5})

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
            hints = self.browser.value("[...document.querySelectorAll('.term')].map(t => [t.textContent, t.title])")
            self.assertTrue(dict(hints)["Drive torque of each sprocket"] and all(title for _, title in hints))
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
        """All controls can be reached by Tab, show their focus, and work with the keyboard."""
        page.value("document.activeElement.blur(); window.scrollTo(0, 0)")
        reached = []
        for _ in range(60):
            page.press("Tab")
            where = page.value("document.activeElement.id || document.activeElement.tagName")
            if where == "BODY":  # past the last control
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
        """Keys select a series in the list of all series; the page draws it with unit and definition."""
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
        """The page is dark if the theme of the system is dark, and white in print."""
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

    def test_a_run_without_frames_says_why(self):
        (self.folder / "grains.toml").write_text(GRAINS)
        words = "document.getElementById('space').textContent"
        seen = "document.getElementById('space-words').textContent"
        grouser.call(["run", "grains.toml", "--set", "output.frames=false", "--out", "none"])
        self.opened("none")
        self.assertIn("the checkpoint: the scene writes no frames (output.frames = false)", self.browser.value(seen))
        (self.folder / "none/checkpoint.h5").unlink()
        self.opened("none")
        self.assertIn("No 3-D view: the scene writes no frames", self.browser.value(words))
        grouser.call(["run", "grains.toml", "--out", "lost"])
        (self.folder / "lost/frames.h5").unlink()
        self.opened("lost")
        self.assertIn("frames.h5 is missing although the scene writes frames", self.browser.value(seen))
        (self.folder / "lost/checkpoint.h5").unlink()
        self.opened("lost")
        self.assertIn("frames.h5 is missing although the scene writes frames", self.browser.value(words))
        self.opened("lost", "--frames", "0")
        self.assertFalse(self.browser.value("!!document.getElementById('space')"))

    def test_a_command_can_be_given_to_a_shell_again(self):
        (self.folder / "my folder").mkdir()
        (self.folder / "my folder/my grains.toml").write_text(GRAINS)
        words = ["run", "my folder/my grains.toml", "--set", "run.gravity=[0.5, 0, -9.81]", "--set", "run.duration=0.01",
                 "--out", "out/the run's"]
        program = str(grouser.find_program())
        subprocess.run([program, *words], check=True, capture_output=True)
        self.opened("out/the run's")
        facts = dict(self.browser.value("[...document.querySelectorAll('#provenance dt')].map(d => [d.textContent, "
                                        "d.nextElementSibling.textContent])"))
        self.assertEqual(shlex.split(facts["command"]), [program, *words])
        (self.folder / "out").rename("before")
        subprocess.run(facts["command"], shell=True, check=True, capture_output=True)
        self.assertTrue((self.folder / "out/the run's/results.h5").is_file())

    def test_grains_without_a_place_are_left_out(self):
        self.run_of_grains("run")
        with h5py.File("run/frames.h5", "r+") as frames:
            grains = frames[sorted(name for name in frames if name.isdigit())[-1]]["grains"]
            for name, row, value in (("position", 3, math.nan), ("position", 4, math.inf), ("speed", 5, math.inf)):
                grains[name][row] = value
        self.opened("run")
        words = self.browser.value("document.getElementById('space-words').textContent")
        self.assertIn("up to 3 grains of a frame omitted", words)
        self.assertTrue(math.isfinite(self.browser.value("report.space.grains.fastest")))

    def test_what_is_damaged_beside_the_results(self):
        """The scene comes from results.h5; damaged pictures and results of a short steady part are marked."""
        self.run_of_grains("run", "--steps", "40")
        grouser.call(["run", "grains.toml", "--out", "run", "--resume"])
        begun = grouser.open_run("run").manifest["resumed_from_step"]
        scene, picture = self.folder / "run/scene.toml", self.folder / "run/picture.png"
        whole, drawn = scene.read_text(), picture.read_bytes()
        self.opened("run")
        self.assertEqual(self.text("#scene pre"), whole)
        self.assertNotIn("is damaged", self.text("#content"))
        rows = self.browser.value("[...document.querySelectorAll('#figures details tbody tr')].map(r => [...r.cells].map("
                                  "c => c.textContent))")
        wall = next(row for row in rows if row[0] == "wall_steps_s")
        self.assertEqual(wall[2:], ["s", f"since the resume at step {begun}; from manifest.json"])
        self.assertNotIn("seven below", self.text("#plots"))
        for broken in ("", "version = [1"):
            scene.write_text(broken)
            self.opened("run")
            self.assertEqual(self.text("#scene pre").strip(), whole.strip())
            self.assertIn("scene.toml is damaged; this is the copy in results.h5.", self.text("#scene"))
        for broken in (b"", b"no picture", drawn[:-20]):
            picture.write_bytes(broken)
            self.opened("run")
            self.assertIn("picture.png is damaged", self.text("#pictures"))
            self.assertEqual(self.browser.value("document.querySelectorAll('#pictures img').length"), 0)

    def text(self, place):
        return self.browser.value(f"document.querySelector('{place}').textContent")

    def run_of_grains(self, folder, *words):
        (self.folder / "grains.toml").write_text(GRAINS)
        grouser.call(["run", "grains.toml", "--out", folder, *words])

    def test_why_a_run_has_ended_early(self):
        self.run_of_grains("run", "--steps", "40")
        self.opened("run")
        facts = "Object.fromEntries([...document.querySelectorAll('#provenance dt')].map(d => [d.textContent, " \
                "d.nextElementSibling.textContent]))"
        self.assertEqual(self.browser.value(facts)["ended by"], "--steps 40")
        manifest = json.loads((self.folder / "run/manifest.json").read_text())
        for status, key, why in (("failed", "error", "a < b"), ("stopped", "stopped", "SIGTERM"), ("incomplete",) * 2 + ("no",)):
            (self.folder / "run/manifest.json").write_text(json.dumps({**manifest, "status": status, key: why}))
            self.opened("run")
            self.assertIn(why, self.text("#content > .bad"))
            self.assertEqual(self.browser.value(facts)["why"], why)

    def test_figures_say_over_which_part_of_the_run_they_are(self):
        (self.folder / "grains.toml").write_text(GRAINS)
        grouser.call(["run", "grains.toml", "--out", "run", "--steps", "400"])
        end = grouser.open_run("run").manifest["simulated_time_s"]
        self.assertAlmostEqual(end, 0.04)
        figures = [{"name": "force [N]", "value": 1.5}, {"name": "steady from [s]", "value": 0.02}]
        early = "The run ended at 0.04\u00a0s, before the 0.1\u00a0s of its scene, by --steps 400."
        for since, words in ((None, "has no steady part"), (0.05, "which would start at 0.05\u00a0s"),
                             (0.02, "Means and extremes from 0.02\u00a0s on, as in the summary of a sweep; work, errors "
                                    "and values \u201cat the end\u201d are from the last row.")):
            (self.folder / "figures.json").write_text(json.dumps({"figures": figures, "steady_from": since}))
            subprocess.run([*SCRIPT, "run", "page.html", "--figures", "figures.json"], check=True, capture_output=True)
            self.browser.open(self.folder / "page.html")
            caption = self.browser.value("document.querySelector('#figures caption').textContent")
            self.assertIn(words, caption)
            self.assertIn(early, caption)
            self.assertEqual(self.browser.value("[...document.querySelectorAll('#figures table')[0].querySelectorAll("
                                                "'tbody tr')].map(r => r.cells[0].textContent)"), ["force"])
        for step in ("1e-4", "1.4e-4"):  # the last run ends before the duration of the scene
            grouser.call(["run", "grains.toml", "--out", f"whole{step}", "--set", f"run.time_step={step}"])
            self.opened(f"whole{step}")
            caption = self.browser.value("document.querySelector('#figures caption').textContent")
            self.assertIn("Means and extremes from 0.05\u00a0s", caption)
            self.assertNotIn("ended at", caption)

    def test_a_narrow_screen_shows_a_run_without_scrolling_sideways(self):
        long_name = "a_run_whose_folder_has_a_long_name_without_a_blank_in_it"
        (self.folder / "grains.toml").write_text(GRAINS)
        grouser.call(["run", "grains.toml", "--out", long_name])
        (self.folder / long_name / "film.mp4").write_bytes(FILM)
        self.opened(long_name)
        self.fits_narrow_screens()

    def test_one_grain_alone(self):
        (self.folder / "grain.toml").write_text(
            'version = 1\n[run]\nduration = 1e-3\ntime_step = 1e-5\n[material.glass]\n[[grain]]\n'
            'position = [0, 0, 1]\nradius = 0.01\nmaterial = "glass"\n[output]\nplots = false\npicture_width = 64\n')
        grouser.call(["run", "grain.toml", "--out", "grain"])
        self.opened("grain")
        self.assertGreater(self.colours_in_space()[0], 20)

    def test_walls_do_not_hide_grains(self):
        walls = "".join(f"[[plane]]\nmaterial = \"sand\"\npoint = {place}\nnormal = {normal}\n" for place, normal in
                        (("[0, -0.07, 0]", "[0, 1, 0]"), ("[0, 0.07, 0]", "[0, -1, 0]"), ("[-0.07, 0, 0]", "[1, 0, 0]"),
                         ("[0.07, 0, 0]", "[-1, 0, 0]")))
        (self.folder / "walls.toml").write_text(GRAINS + walls)
        grouser.call(["run", "walls.toml", "--out", "walls"])
        self.opened("walls")
        clear = self.browser.value("report.space.scene.children.filter(c => c.isMesh && c.material.transparent).length")
        self.assertEqual(clear, 1, "the four walls, which are one mesh")


if __name__ == "__main__":
    unittest.main()
