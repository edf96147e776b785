# SPDX-License-Identifier: BSD-3-Clause
"""Common parts of report tests: the command, a small scene, pages opened in Chromium."""
import base64
import math
import os
import subprocess
import unittest

import browser
from fixture import FolderTest

import grouser

#: Ten grains fall onto a plane: results depend on the seed, and a run takes about a second.
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


#: The first bytes of a film, and their form in a page.
FILM = b"\0\0\0\x18ftypmp42 a film"
FILM_TEXT = "data:video/mp4;base64," + base64.b64encode(FILM).decode()


def report(folder, *words):
    return subprocess.run([str(grouser.find_program()), "report", str(folder), *words], capture_output=True, text=True)


@unittest.skipIf(browser.find() is None, "no Chromium is installed: apt-get install chromium-headless-shell")
class PageTest(FolderTest):
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
        """The rendered page: no errors, no requests except itself."""
        page = self.made(folder, *words)
        self.browser.media()
        self.browser.width(1300)
        self.browser.open(page)
        self.browser.until("document.documentElement.dataset.ready === 'yes'")
        asked = [r for r in self.browser.requests if not r.startswith(("data:", "blob:"))]
        self.assertEqual(asked, [f"file://{page}"])
        self.assertEqual(self.browser.errors, [])
        self.plots_are_drawn()
        if self.browser.value("!!report.space"):
            self.assertTrue(self.browser.value("report.space.isInView()"), "the label of the scale is cut off")
        if kept := os.environ.get("GROUSER_REPORT_PICTURES"):  # for manual inspection
            self.browser.picture(f"{kept}/{self.id().rpartition('.')[2]}_{folder}.png", 4000)
        return self.browser

    def fits_narrow_screens(self):
        """At a width of 320 pixels with all sections unfolded, no content exceeds the right edge."""
        self.browser.width(320)
        self.browser.open(self.folder / "page.html")
        self.browser.until("document.documentElement.dataset.ready === 'yes'")
        self.browser.value("document.querySelectorAll('details').forEach(d => { d.open = true; })")
        wide, there = self.browser.value("[document.documentElement.scrollWidth, document.documentElement.clientWidth]")
        self.assertEqual(there, 320)
        self.assertLessEqual(wide, there)

    def plots_are_drawn(self):
        """Every plot has curves, axis labels with units, and a legend."""
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
        """{name: number} for all numbers of the page."""
        pairs = self.browser.value("[...document.querySelectorAll('main data[data-name]')]"
                                   ".map(d => [d.dataset.name, d.value])")
        return {name: float(value) if value else math.nan for name, value in pairs}

    def colours_in_space(self):
        """Number of colours of the 3-D view, and a checksum of its pixels."""
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
