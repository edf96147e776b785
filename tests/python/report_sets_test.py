#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Reports of several runs and of soils, opened in Chromium: sweeps, checks, events, soil tests, calibrations."""
import csv
import json
import math
import unittest
from shutil import rmtree

import numpy
from report_pages import FILM, FILM_TEXT, GRAINS, PageTest

import grouser


class Pages(PageTest):
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
        (firsts[1].folder / "film.mp4").write_bytes(FILM)
        (self.folder / "sweep/long.mp4").write_bytes(FILM + b"long" * 2000000)
        self.opened("sweep")
        films = "[...document.querySelectorAll('#films video')].map(v => v.src)"
        self.assertEqual(self.browser.value(films), [FILM_TEXT])
        self.assertIn("long.mp4", self.browser.value("document.getElementById('films').textContent"))

    def test_a_sweep_names_runs_whose_files_are_missing_or_damaged(self):
        """The report lists damaged runs with causes in their rows and at the top; the next seed replaces such a run."""
        (self.folder / "grains.toml").write_text(GRAINS)
        grouser.call(["sweep", "grains.toml", "--set", "material.sand.friction=0.2,0.4,0.6", "--seeds", "2", "--out",
                      "sweep"])
        self.opened("sweep")
        self.assertEqual(self.browser.value("document.querySelectorAll('.fault, #content > .bad').length"), 0)
        runs = [run.folder for run in grouser.open_sweep("sweep").runs]
        rmtree(runs[0])
        (runs[1] / "manifest.json").unlink()
        (runs[2] / "results.h5").write_bytes((runs[2] / "results.h5").read_bytes()[:3000])
        (runs[3] / "manifest.json").write_text('{"status": ')
        (runs[4] / "frames.h5").unlink()
        causes = ("the folder is missing", "manifest.json missing", "results.h5: damaged",
                  "manifest.json:1:12: ", "frames.h5 is missing although the scene writes frames", "")
        self.opened("sweep")
        top = self.browser.value("document.querySelector('#content > .bad').textContent")
        self.assertIn("5 runs have missing or damaged files", top)
        rows = self.browser.value("[...document.querySelectorAll('#figures details tbody tr')].map(r => [...r.cells].map("
                                  "c => c.textContent))")
        self.assertEqual(len(rows), 6)
        for row, folder, cause in zip(rows, runs, causes):
            self.assertEqual(row[0], folder.name)
            self.assertEqual(any("Files: " in cell for cell in row), bool(cause), row)
            if cause:
                self.assertIn(f"Files: {cause}", "".join(row))
                self.assertIn(f"{folder.name}: {cause}", top)
        self.assertEqual(self.browser.value("report.data.spaces.map(s => s.name)"), [runs[5].name], "the next seed")
        ledger = [name for name in self.numbers() if name.endswith("ledger.kinetic at the end")]
        self.assertEqual(len(ledger), 1, "that of the only combination with a whole run")
        frames = (runs[5] / "frames.h5").read_bytes()
        within = frames.rindex(b"OHDR")  # damage inside: opening the file does not detect it
        (runs[5] / "frames.h5").write_bytes(frames[:within] + b"LOST" + frames[within + 4:])
        self.opened("sweep")
        self.assertIn(f"{runs[5].name}/frames.h5: cannot be read as the frames of a run: a part of it is unreadable", self.browser.value(
            "[...document.querySelectorAll('#content > .bad')].map(e => e.textContent).join(' ')"))

    def test_a_check_names_runs_whose_files_are_missing(self):
        (self.folder / "grains.toml").write_text(GRAINS)
        grouser.call(["check", "grains.toml", "--axes", "step", "--seeds", "2", "--out", "check"])
        def opened():
            self.opened("check")
            return (self.browser.value("document.querySelector('#content > .bad').textContent"),
                    self.browser.value("report.data.spaces.map(s => s.name)"))

        lost = self.folder / "check/base,seed=2/results.h5"
        lost.rename("kept")
        top, spaces = opened()
        self.assertIn("base,seed=2: results.h5 missing", top)
        self.assertIn("1 run has missing or damaged files", top)
        self.assertEqual(spaces[0], "base,seed=1")
        (self.folder / "kept").rename(lost)
        rmtree(self.folder / "check/base,seed=1")
        top, spaces = opened()
        self.assertIn("base,seed=1: ", top)
        self.assertIn("1 run has missing or damaged files", top)
        self.assertEqual(spaces[0], "base,seed=2", "the next seed")
        self.assertIn("base,seed=2", self.browser.value("document.querySelector('#scene summary').textContent"))

    def test_sweeps_without_seeds_or_numbers_have_points_without_bars(self):
        (self.folder / "grains.toml").write_text(GRAINS)
        for name, words, places in (
                ("values", ["--set", "material.sand.friction=0.2,0.6"], [0.2, 0.6]),
                ("cases", ["--case", "slippery: material.sand.friction=0.2", "--case", "rough: material.sand.friction=0.6"],
                 [1, 2])):
            grouser.call(["sweep", "grains.toml", *words, "--out", name])
            self.opened(name)
            plots = self.browser.value("report.plots.map(p => [p.entry.title, p.entry.curves[0].columns.length, "
                                       "Array.from(p.curves[0].columns[0]), Array.from(p.curves[0].columns[1])])")
            force = [plot for plot in plots if plot[0] == "Ground force z"]
            self.assertEqual(force, [["Ground force z", 2, places, grouser.open_sweep(name)["ground force z"].value.tolist()]])
            told = self.browser.value("document.querySelector('#plots figcaption').textContent")
            self.assertIn("One point per run, without error bars", told)
            if name == "cases":
                self.assertIn("1: case = slippery; 2: case = rough", told)

    def test_a_runs_warnings_stand_at_its_top_and_once(self):
        (self.folder / "grains.toml").write_text(GRAINS)
        grouser.call(["run", "grains.toml", "--out", "run"])
        manifest = json.loads((self.folder / "run/manifest.json").read_text())
        more = {"status": "incomplete", "incomplete": "it never drove", "bed_warnings": "loose & thin"}
        (self.folder / "run/manifest.json").write_text(json.dumps({**manifest, **more}))
        self.opened("run")
        tops = self.browser.value("[...document.querySelectorAll('#content > .bad')].map(e => e.textContent)")
        self.assertEqual(tops, ["WARNING: this run is incomplete: it never drove", "WARNING: loose & thin"])
        figures = self.browser.value("document.querySelector('#figures').textContent")
        self.assertIn("Inconclusive: see the warning at the top.", figures)

    def test_one_seed_alone_has_no_bar(self):
        (self.folder / "grains.toml").write_text(GRAINS)
        grouser.call(["sweep", "grains.toml", "--set", "material.sand.friction=0.2,0.6", "--seeds", "2", "--out", "sweep"])
        self.opened("sweep")
        caption = "[...document.querySelectorAll('#plots figure')].find(f => f.textContent.startsWith('Ground force z'))" \
                  ".querySelector('figcaption').textContent"
        self.assertNotIn("No error bar", self.browser.value(caption))
        table = self.folder / "sweep/intervals.csv"
        with open(table, newline="") as kept:
            rows = list(csv.DictReader(kept))
        row = next(row for row in rows if row["figure"].startswith("ground force z"))
        row.update({"seeds": "1", "half width": "inf"})  # as the program writes it for one seed
        with open(table, "w", newline="") as fresh:
            writer = csv.DictWriter(fresh, rows[0])
            writer.writeheader()
            writer.writerows(rows)
        self.opened("sweep")
        self.assertIn("No error bar for 1 point with only one finished seed.", self.browser.value(caption))
        halves = self.browser.value("Array.from(report.plots.find(p => p.entry.title === 'Ground force z').curves[0]"
                                    ".columns[2]).map(Number.isFinite)")
        self.assertEqual(sorted(halves), [False, True])

    def test_the_same_key_of_two_materials_keeps_its_material(self):
        (self.folder / "grains.toml").write_text(GRAINS + "[material.rock]\n")
        grouser.call(["sweep", "grains.toml", "--set", "material.sand.friction=0.2,0.4", "--set",
                      "material.rock.friction=0.2,0.4", "--seeds", "2", "--out", "sweep"])
        self.opened("sweep")
        names = self.browser.value("[...document.querySelectorAll('#figures thead th')].map(h => h.textContent)")
        self.assertIn("sand.friction = 0.2, rock.friction = 0.4", ", ".join(names))

    def test_a_narrow_screen_shows_a_sweep_without_scrolling_sideways(self):
        """Names break after commas; long tables scroll, and their headings remain visible."""
        (self.folder / "grains.toml").write_text(GRAINS)
        grouser.call(["sweep", "grains.toml", "--set", "material.sand.friction=0.2,0.4", "--set",
                      "run.gravity=[0,0,-9.81],[0.5,0,-9.81]", "--seeds", "6", "--out", "sweep"])
        self.opened("sweep")
        self.fits_narrow_screens()
        self.browser.width(1300)
        box = "document.querySelector('#figures details .wide')"
        self.assertEqual(self.browser.value(f"{box}.querySelectorAll('tbody tr').length"), 24)
        self.assertLess(self.browser.value(f"{box}.getBoundingClientRect().height"), 810)
        lines = f"[...{box}.querySelectorAll('tbody code.name')].map(c => c.getClientRects().length && c.offsetHeight)"
        one_line = self.browser.value("parseFloat(getComputedStyle(document.querySelector('code.name')).lineHeight)")
        self.assertLess(max(self.browser.value(lines)), 1.5 * one_line)
        self.browser.value(f"{box}.scrollTop = 400")
        self.assertAlmostEqual(self.browser.value(f"{box}.querySelector('th').getBoundingClientRect().top - "
                                                  f"{box}.getBoundingClientRect().top"), 0, delta=1.0)

    def runs_are_chosen(self, folders):
        """The keyboard selects each run in turn, with its own frames; each run has a ledger."""
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
        grouser.call(["check", "grains.toml", "--axes", "step,precision", "--seeds", "3", "--out", "check"])
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
        for figure in check.json["figures"]:
            for error in figure["errors"]:  # small scatter over seeds, and a bar of the step far above the change
                error["bar"] = {"step": 0.7, "precision": 0.9}[error["axis"]] * abs(figure["value"])
            figure["seeds_half_width"], figure["bar"] = 0.1 * abs(figure["value"]), 0.75 * abs(figure["value"])
        (self.folder / "check/check.json").write_text(json.dumps(check.json))
        self.opened("check")
        over = "report.plots.find(p => p.entry.title === 'Error over run time')"
        self.assertTrue(self.browser.value(f"{over}.looks.length && {over}.looks.every(look => look.marked)"))
        largest = self.browser.value("[...document.querySelectorAll('#shares td:last-child')].map(c => c.textContent)")
        self.assertEqual(set(largest), {"step (70 %)"}, "precision is in no bar where seeds matter")
        # These runs write no frames; the view shows the checkpoint.
        with grouser.open_run("check/base,seed=1") as run:
            self.assertIsNone(run.frames)
            bed = run.bed()
            drawn = numpy.array(self.browser.value("Array.from(report.space.positions)")).reshape(-1, 3)
            numpy.testing.assert_allclose(drawn + self.browser.value("report.space.data.middle"), bed.position, atol=1e-5)
            self.same(shown["base,seed=1 ledger.dissipated at the end"], run["ledger.dissipated"].value[-1], "ledger")
        self.assertIn("from the checkpoint", self.browser.value("document.getElementById('space-words').textContent"))
        self.assertGreater(self.colours_in_space()[0], 20)
        self.fits_narrow_screens()

    def test_events(self):
        folder = self.folder / "events"
        (self.folder / "grains.toml").write_text(GRAINS)
        for level, name in ((0.1, "0.1,seed=1"), (0.1, "0.1,seed=2"), (0.2, "0.2")):
            grouser.call(["run", "grains.toml", "--set", f"run.gravity=[-{level}, 0, -9.81]", "--out",
                          f"events/grade={name}"])
        def row(level, pull):
            each = [{"run": f"grade={level},seed=1", "verdict": "go", "why": "5.0 m in 6.2 s"},
                    {"run": f"grade={level},seed=2", "verdict": "no-go", "why": "throws a <track>"}]
            return {"event": "grade", "title": "Up a slope", "level": level, "level_is": "tan of the slope [-]",
                    "picture": f"grade={level}/picture.png", "verdict": "partly 1/2", "runs": 2, "go": 1, "failed": 0,
                    "pending": 0, "why": "throws a <track>", "each": each if level == 0.1 else [], "figures": [
                        {"name": "speed [m/s]", "runs": 3, "mean": pull, "half_width": 0.0123456789}]}
        (folder / "events.json").write_text(json.dumps({
            "command": "grouser events", "commit": "0123abc", "machine": "this", "vehicle": "light", "soil": "sand",
            "quick": True, "seeds": 3, "speed_m_s": 0.5, "grain_radius_m": 0.02, "bed_depth_m": 0.3,
            "rows": [row(0.2, 0.31), row(0.1, 0.4987654321)], "limits": [
                {"event": "grade", "level_is": "tan of the slope [-]", "go": 0.2, "no_go": None, "reference": None,
                 "agrees": None}]}))
        self.opened("events")
        shown = self.numbers()
        self.assertEqual((shown["grade 0.1 speed"], shown["grade 0.1 speed bar"]), (0.4987654321, 0.0123456789))
        self.assertEqual(self.browser.value("Array.from(report.plots[0].curves[0].columns[1])"), [0.4987654321, 0.31])
        rows = self.browser.value("[...document.querySelectorAll('#figures tbody tr')].map(r => r.innerText)")
        self.assertIn("seed 1: go, 5.0 m in 6.2 s\nseed 2: no-go, throws a <track>", rows[0])
        self.assertIn("throws a <track>", rows[1], "of a file that does not tell of each run")
        self.assertEqual(self.browser.value("[...document.querySelectorAll('#numbers th')].map(h => h.textContent)"),
                         ["figure", "unit", "0.1", "0.2"], "levels in their order")
        self.assertEqual(self.browser.value("document.querySelectorAll('#content > .bad').length"), 0)
        self.assertEqual((shown["grain_radius_m"], shown["bed_depth_m"]), (0.02, 0.3))
        self.runs_are_chosen([folder / "grade=0.1,seed=1", folder / "grade=0.2"])
        (folder / "grade=0.1,seed=1/results.h5").unlink()
        told = json.loads((folder / "events.json").read_text())
        (folder / "events.json").write_text(json.dumps({**told, "grain_radius_m": 0.0, "bed_depth_m": 0.0}))
        self.opened("events")
        self.assertIn("grade=0.1,seed=1: results.h5 missing",
                      self.browser.value("document.querySelector('#content > .bad').textContent"))
        self.assertEqual(self.browser.value("report.data.spaces.map(s => s.name)"), ["grade=0.1,seed=2", "grade=0.2"])
        self.assertFalse({"grain_radius_m", "bed_depth_m"} & set(self.numbers()), "of rigid ground")
        self.fits_narrow_screens()

    @staticmethod
    def put_soil(folder):
        """A folder as written by `grouser soil`."""
        folder.mkdir(parents=True)
        (folder / "soil.json").write_text(
            '{"soil": "sand", "care": "coarse", "grain_radius_m": 0.007, "constants": {"n": {"value": 0.8123456789, '
            '"half_width": 0.1, "unit": "-", "published": [{"value": 0.79, "source": "a book"}], "span": [0.7, 0.9], '
            '"verdict": "inside"}, "phi": {"value": 28.7, "half_width": null, "unit": "deg", "published": []}}, '
            '"plates": [{"k": {"value": 244.0, "half_width": 1.0}}], '
            '"breadth_m": [0.1], "shear": {"peak_phi": {"value": 31.25, "half_width": 0.5, "unit": "deg"}}, "version": "0.1.0", "commit": "0123abc"}')
        (folder / "plates.csv").write_text(
            "care,plate,breadth [m],seed,phase,sinkage [m],pressure [Pa]\n" +
            "".join(f"coarse,small,0.1,1,0,{0.001 * k},{1000 * k}\n" for k in range(20)))

    def test_a_soil(self):
        self.put_soil(self.folder / "sand")
        self.opened("sand")
        shown = self.numbers()
        self.assertEqual((shown["n"], shown["n bar"], shown["phi"]), (0.8123456789, 0.1, 28.7))
        self.assertEqual((shown["shear peak_phi"], shown["shear peak_phi bar"], shown["plate 0.1 k"]), (31.25, 0.5, 244.0))
        self.assertEqual(self.browser.value("Array.from(report.plots[0].curves[0].columns[1])"),
                         [1000.0 * k for k in range(20)])
        self.fits_narrow_screens()

    def test_a_calibration(self):
        """The page contains targets and results, all trials, the soil file, and all measurements of this soil."""
        folder = self.folder / "found"
        self.put_soil(folder / "final")
        def value(number, half, unit):
            return {"value": number, "half_width": half, "unit": unit}
        def trial(kind, name, rolling, young, **measured):
            return {"name": name, "kind": kind, "measured": measured, "parameters": {
                "law": "hertz", "young": young, "friction": 0.5, "rolling_friction": rolling}}
        trials = [trial("shear", "shear_1", 0.19, 8e7, phi=value(27.123456789, 0.7, "deg"), K=value(1.7, None, "mm")),
                  trial("shear", "shear_2", 0.314159265, 8e7, phi=value(31.5, 0.6, "deg"), K=value(1.5, 0.2, "mm")),
                  trial("plate", "plate_1", 0.314159265, 8e7, pressure=value(25.5, 3.25, "kPa"),
                        sinkage=value(2.4, None, "mm"))]
        found = {"soil": "sand", "targets_file": "wanted.toml", "care": "coarse", "status": "unfinished",
                 "grain_radius_m": 0.007, "seeds": {"small": 2, "large": 1, "shear": 2}, "targets": [
                     {"quantity": "phi", "wanted": 31.1, "unit": "deg", "tolerance": 1.0},
                     {"quantity": "K", "wanted": 12.0, "unit": "mm", "tolerance": None}],
                 "pressure": {"wanted": 47.5, "unit": "kPa", "tolerance": 4.75}, "trials": trials,
                 "missing": {"trial": "plate_2", "tests": 7}, "command": "grouser soil --calibrate wanted.toml",
                 "machine": "this one", "version": "0.1.0", "commit": "0123abc"}
        (folder / "calibration.json").write_text(json.dumps(found))
        self.opened("found")
        text = "document.querySelector('main').textContent"
        for words in ("7 tests of plate_2 missing", "--resume", "wanted.toml", "0123abc", "this one"):
            self.assertIn(words, self.browser.value(text))
        found.update(status="finished", soil_file="sand.toml", tests="final", outcomes=[
            {"what": "phi", "wanted": 31.1, "tolerance": 1.0, "reached": value(31.50123, 0.61, "deg"), "verdict": "reached"},
            {"what": "c", "wanted": 1.25, "tolerance": 0.5, "reached": value(1.5, 0.9, "kPa"), "verdict": "reached"},
            {"what": "K", "wanted": 12.0, "tolerance": None, "reached": value(1.5, 0.2, "mm"), "verdict": "not sought"}])
        del found["missing"]
        found["trials"].append(trial("plate", "plate_2", 0.314159265, 3e8, pressure=value(49.0, 4.5, "kPa"),
                                     sinkage=value(2.4, None, "mm")))
        (folder / "calibration.json").write_text(json.dumps(found))
        (folder / "sand.toml").write_text("[soil]\ntitle = \"of <sand>\"\n")
        self.opened("found")
        self.calibration_is_shown(self.numbers())
        self.fits_narrow_screens()

    def calibration_is_shown(self, shown):
        for name, number in {
                "phi wanted": 31.1, "phi wanted bar": 1.0, "phi reached": 31.50123, "phi reached bar": 0.61, "n": 0.8123456789,
                "K reached": 1.5, "shear_1 phi": 27.123456789, "shear_1 phi bar": 0.7, "shear_1 K": 1.7, "sinkage": 2.4,
                "shear_1 rolling_friction": 0.19, "shear_2 rolling_friction": 0.314159265, "plate_1 pressure": 25.5,
                "plate_1 pressure bar": 3.25, "plate_2 young": 3e8, "all friction": 0.5}.items():
            self.assertEqual(shown[name], number, name)
        self.assertNotIn("shear_1 K bar", shown)
        self.assertNotIn("shear_1 friction", shown, "it is the same in all trials")
        text = self.browser.value("document.querySelector('main').textContent")
        rows = self.browser.value("[...document.querySelectorAll('#targets tbody tr')].map(r => r.innerText)")
        self.assertTrue(rows[0].endswith("reached"), rows[0])
        self.assertIn("1.25 \u00b1 0.5", rows[1])
        self.assertTrue(rows[1].endswith("the error bar exceeds the tolerance"), rows[1])
        for words in ('title = "of <sand>"', "grouser soil --calibrate wanted.toml", "not sought", "hertz"):
            self.assertIn(words, text)
        self.assertNotIn("is not finished", text)
        plots = self.browser.value("report.plots.map(p => [p.entry.title, p.entry.y, p.curves.map(c => "
                                   "c.columns.map(a => Array.from(a)))])")
        plots = {title: (axis, curves) for title, axis, curves in plots}
        self.assertEqual(plots["phi: angle of internal friction"], ("phi [deg]", [[[1, 2], [27.123456789, 31.5], [0.7, 0.6]],
                                                      [[0.5, 4.5], [31.1, 31.1], [1, 1]]]))
        self.assertEqual(plots["Young"], ("young [Pa]", [[[1, 2, 3, 4], [8e7, 8e7, 8e7, 3e8]]]))
        self.assertEqual(plots["Pressure of the small plate"][1][0], [[3, 4], [25.5, 49.0], [3.25, 4.5]])
        self.assertIn("Plates", plots, "tests of the calibrated soil")
        # The bar of the first trial is visible, upright and in place.
        marked = self.browser.value("""(() => { const g = report.plots.find(p => p.entry.title.startsWith("phi")).graph;
          const c = g.hidden_.getContext("2d"), scale = g.hidden_.width / g.hidden_.clientWidth;
          const [x, y] = g.toDomCoords(1, 27.123456789 - 0.5);
          const p = c.getImageData(Math.round(x * scale) - 1, Math.round(y * scale), 3, 1).data;
          return Math.max(p[3], p[7], p[11]); })()""")
        self.assertGreater(marked, 150)


if __name__ == "__main__":
    unittest.main()
