#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Documents: commands and options exist, tutorial and how-tos work as written, and site and installed documents have no
dead links."""
import os
import re
import shutil
import subprocess
import sys
import unittest
from functools import cache
from pathlib import Path

from fixture import ROOT, FolderTest

import browser
import grouser

sys.path.insert(0, str(ROOT / "cmake"))
import documents  # noqa: E402

DOCUMENTS = [*ROOT.glob("*.md"), *(ROOT / "docs").glob("*.md")]
#: A call of the program in code: its words up to the next shell operator.
CALL = re.compile(r"(?:^|[\s`])(?:build/bin/)?grouser((?: +[^\s`|;&#)]+)+)")


@cache
def help_of(command):
    done = subprocess.run([str(grouser.find_program()), *command, "--help"], capture_output=True, text=True)
    return done.stdout if done.returncode == 0 else None


@cache
def commands_of(command):
    """Subcommands of a command, from its help."""
    text = help_of(command)
    if text is None or "Subcommands:" not in text:
        return set()
    return set(re.findall(r"^  ([a-z-]+)\s", text.split("Subcommands:")[1], re.M))


def code_of(text):
    """[(line, code)]: indented and fenced lines, and spans."""
    fenced = False
    for number, line in enumerate(text.split("\n"), 1):
        if line.startswith("```"):
            fenced = not fenced
        elif fenced or line.startswith("    "):
            yield number, line.strip()
        else:
            for span in re.findall(r"`([^`]+)`", line):
                yield number, span


def faults_of(words):
    """Errors in a call, as texts."""
    command = []
    while words and words[0] in commands_of(tuple(command)):
        command.append(words.pop(0))
    if not command:
        return [] if not words or words[0].startswith("-") or not re.fullmatch(r"[a-z]+", words[0]) else \
            [f"there is no command {words[0]}"]
    known = help_of(tuple(command))
    return [f"grouser {' '.join(command)} has no {option}"
            for option in (re.match(r"--[a-z][a-z-]*", word) for word in words) if option
            and not re.search(re.escape(option[0]) + r"(?![a-z-])", known) for option in [option[0]]]


class Commands(unittest.TestCase):
    def test_a_wrong_call_is_seen(self):
        self.assertEqual(faults_of("run scene.toml --set a=1 --out x".split()), [])
        self.assertEqual(faults_of("bench bed --threads 2".split()), [])
        self.assertEqual(faults_of("run scene.toml --sett a=1".split()), ["grouser run has no --sett"])
        self.assertEqual(faults_of("drive scene.toml".split()), ["there is no command drive"])

    def test_the_page_of_options_is_what_the_program_prints(self):
        printed = subprocess.run([grouser.find_program(), "manual", "--markdown"], capture_output=True, text=True).stdout
        self.assertEqual((ROOT / "docs/options.md").read_text(encoding="utf-8"), printed,
                         "build/bin/grouser manual --markdown > docs/options.md")
        told = re.split(r"^## grouser ", printed, flags=re.M)[1:]
        self.assertGreater(len(told), 25)
        for text in told:
            name, rows = text.split("\n", 1)
            options = re.findall(r"^  ((?:-\S+, )*-\S+)", help_of(tuple(name.split())), re.M)
            self.assertEqual(re.findall(r"^\| `((?:-\S+, )*-[\w-]+)", rows, re.M), options[1:], name)  # but for --help

    def test_help_words_values_plainly(self):
        self.assertRegex(help_of(("run",)), r"\n  --threads INT in 0\.\.1024 +number of CPU threads")
        self.assertRegex(help_of(("run",)), r"\n  --no-cache  +[a-z]")
        self.assertRegex(help_of(("bench", "bed")), r"--friction FLOAT >= 0 +Coulomb friction coefficient \[-\] \(default: 0\.5\)")
        self.assertRegex(help_of(("bench", "bed")), r"--peer-memory \{auto,never,always\}\s")
        for name in re.findall(r"^## grouser (.*)", (ROOT / "docs/options.md").read_text(encoding="utf-8"), re.M):
            for line in help_of(tuple(name.split())).split("\n"):
                self.assertIsNone(re.match(r"  -.*(INT|FLOAT|TEXT)[:=]|  \S* (\S+ )?x \d|  \S*\{false\}", line), f"{name}: {line}")

    def test_all_that_documents_name_are_there(self):
        count = 0
        for document in DOCUMENTS:
            for line, code in code_of(document.read_text(encoding="utf-8")):
                for call in CALL.findall(code):
                    count += 1
                    with self.subTest(place=f"{document.relative_to(ROOT)}:{line}", call=call):
                        self.assertEqual(faults_of(call.split()), [])
        self.assertGreater(count, 100)

    def test_scenes_that_are_called_are_there(self):
        for document in DOCUMENTS:
            for line, code in code_of(document.read_text(encoding="utf-8")):
                for name in re.findall(r"(?<![\w/.])((?:runs|tests|assets)/[\w/]+\.toml)", code):
                    self.assertTrue((ROOT / name).is_file(), f"{document.relative_to(ROOT)}:{line}: {name}")


class Sources(unittest.TestCase):
    """Statements in documents about the code are up to date."""

    def test_sources_that_are_named_are_there(self):
        name = re.compile(r"(?<![\w/.~$])(?:base|contact|spheredecomp|multibody|terrain|vehicle|coupling|runs|assets|python|"
                          r"tests|cmake)/[\w./]+\.(?:hpp|cpp|cuh|cu|py|js)(?!\w)")
        count = 0
        for document in DOCUMENTS:
            for line, code in code_of(document.read_text(encoding="utf-8")):
                for found in name.findall(code):
                    count += 1
                    self.assertTrue((ROOT / found).is_file(), f"{document.relative_to(ROOT)}:{line}: {found}")
        self.assertGreater(count, 25)

    def test_glossary_has_every_choice_of_laws_and_integrators(self):
        choices = (ROOT / "runs/scene/choices.hpp").read_text(encoding="utf-8")
        theory = (ROOT / "docs/glossary.md").read_text(encoding="utf-8")
        spans = set(re.findall(r"`([^`]+)`", theory))
        for enum, fewest in (("contact::LawKind", 5), ("multibody::Integrator", 2), ("multibody::JointType", 7),
                             ("multibody::DriveKind", 3), ("vehicle::SprocketDrive", 3), ("vehicle::HitchKind", 4)):
            body = re.search(rf"struct EnumWords<{enum}> {{(.*?)\n}};", choices, re.S)[1]
            words = re.findall(r'"(\w+)"', body)
            self.assertGreaterEqual(len(words), fewest, enum)
            for word in words:
                self.assertIn(word, spans, f"docs/glossary.md does not say what {enum} {word} is")


    def test_libraries_that_are_included_are_named(self):
        told = (ROOT / "docs/libraries.md").read_text(encoding="utf-8")
        rooms = ("base", "contact", "spheredecomp", "multibody", "terrain", "vehicle", "coupling", "runs", "api",
                 "python/module")
        sources = [file for room in rooms for file in (ROOT / room).rglob("*") if file.suffix in (".cpp", ".hpp", ".cu", ".cuh")]
        included = {name for file in sources
                    for name in re.findall(r"^ *#include <([\w+.-]+(?:/[^>]+|\.h))>", file.read_text(encoding="utf-8"), re.M)}
        # Licences of the system, the compiler and the CUDA toolkit are not listed.
        of_none = re.compile(r"(sys|linux|cooperative_groups|cuda).*|(fcntl|dlfcn|unistd|signal|sched|poll|dirent|errno|omp|"
                             r"immintrin|malloc|execinfo|fenv|termios|spawn|getopt|pwd|math|stdint|cxxabi)\.h|nv.*|grouser/.*")
        libraries = {name.split("/")[0] for name in included if not of_none.fullmatch(name)}
        self.assertTrue({"toml++", "CLI", "Eigen", "hdf5.h", "assimp"} <= libraries, libraries)
        for name in libraries:
            self.assertIn(f"<{name}", told, "docs/libraries.md does not say what this library is for")
        for package in re.findall(r"libjs-\w+", (ROOT / "runs/packages.sh").read_text(encoding="utf-8")):
            self.assertIn(package, told)

    def test_packages_are_those_that_scripts_install(self):
        def group(name):
            words = subprocess.run(["bash", "-c", f'. runs/packages.sh; echo "${{{name}[@]}}"'], cwd=ROOT, check=True,
                                   capture_output=True, text=True).stdout.split()
            self.assertGreater(len(words), 1, name)
            return set(words)
        told = (ROOT / "docs/install.md").read_text(encoding="utf-8").replace("\\\n", "")
        lists = [set(words.split()) for words in re.findall(r"^    sudo apt install (.*)", told, re.M)]
        for name in ("GROUSER_BUILD", "GROUSER_RUN", "GROUSER_TESTS", "GROUSER_PAGES"):
            self.assertIn(group(name), lists, f"docs/install.md does not name the packages {name} of runs/packages.sh")
        package = (ROOT / "cmake/package.cmake").read_text(encoding="utf-8")
        needed = re.findall(r'PROGRAM_PACKAGE_(?:DEPENDS|RECOMMENDS)\s+"(.*?)"', package)
        self.assertEqual({word for words in needed for word in words.replace("${python}", "python3").split(", ")},
                         group("GROUSER_RUN"))


    def test_lines_of_libraries_are_those_that_are_there(self):
        """Rounded line counts of files are right within 15 % or 10 lines."""
        told = []
        for row in re.findall(r"^\| (.*) \|$", (ROOT / "docs/libraries.md").read_text(encoding="utf-8"), re.M):
            cells = row.split(" | ")
            if len(cells) != 3:  # what was counted once
                continue
            what, second, third = cells
            told += re.findall(r"(\d+), ((?:`[^`]+`(?:, )?)+(?: and its header)?)", third)
            if second.isdigit() and "a part of" not in what:
                told.append((second, what))
        self.assertGreater(len(told), 20)
        for lines, words in told:
            files = [ROOT / name for name in re.findall(r"`([^`]+)`", words)]
            if "and its header" in words:
                files.append(files[0].with_suffix(".hpp"))
            counted = sum(file.read_text(encoding="utf-8").count("\n") for file in files)
            self.assertLessEqual(abs(int(lines) - counted), max(10, 0.15 * counted), f"{words}: {counted}")

    def test_every_file_of_a_run_is_described(self):
        source = (ROOT / "runs/output/output.cpp").read_text(encoding="utf-8")
        files = re.findall(r'"([^"]+)"', source.split("kFiles[] = {")[1].split("}")[0])
        self.assertGreater(len(files), 10)
        table = (ROOT / "docs/reports.md").read_text(encoding="utf-8").split("**A run that fails**")[0]
        for name in files:
            self.assertIn(f"`{name}`", table)


class Followed(FolderTest):
    """Follows the instructions of a page in a separate folder: saves its files and runs its commands."""

    def follow(self, page, names):
        """Runs the shell blocks of a page in order. names: file names of the other blocks, in order. Returns the
        output of each command."""
        text = (ROOT / "docs" / page).read_text(encoding="utf-8")
        (self.folder / "build/bin").mkdir(parents=True)
        (self.folder / "build/bin/grouser").symlink_to(grouser.find_program())
        for folder in ("assets", "python", "runs"):
            (self.folder / folder).symlink_to(ROOT / folder)
        self.environment = {**os.environ, "GROUSER_CACHE": str(self.folder / "cache"), "OMPI_ALLOW_RUN_AS_ROOT": "1",
                            "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMPI_MCA_rmaps_base_oversubscribe": "1",
                            "PRTE_MCA_rmaps_default_mapping_policy": ":oversubscribe"}
        self.environment.pop("PYTHONPATH", None)
        names, said = list(names), {}
        for language, code in re.findall(r"^```(\w+)\n(.*?)^```", text, re.M | re.S):
            if language != "sh":
                file = self.folder / names.pop(0)
                self.assertIn(file.name, text)
                self.assertEqual(file.suffix, {"toml": ".toml", "python": ".py"}[language])
                file.parent.mkdir(exist_ok=True)
                file.write_text(code)
                continue
            for command in code.strip().split("\n"):
                done = subprocess.run(["bash", "-c", command], capture_output=True, text=True, env=self.environment)
                self.assertEqual(done.returncode, 0, f"{command}\n{done.stdout}{done.stderr}")
                said[command] = done.stdout
        self.assertEqual(names, [])
        return said


class HowTo(Followed):
    def test_its_commands_work_as_they_stand(self):
        said = self.follow("scenes.md", ["small.toml", "heights.py", "soils/wet_sand.toml"])
        self.assertEqual(len(said), 13)
        told = list(said.values())
        self.assertEqual(grouser.open_run("out/small").status, "incomplete", "as the page says")
        run = grouser.open_run("out/small")["vehicle.left.slip"]
        self.assertAlmostEqual(run.time[-1], 0.15)
        self.assertEqual(told[2], "height_range = [-0.0400, 0.0400]\n")
        self.assertIn("dunes.png", told[3])
        self.assertIn("wet sand, uncalibrated", told[4])
        self.assertIn("wet_sand, wet_sand", told[5])
        self.assertIn("vehicle                  6518 kg", told[9])
        self.assertEqual(len(list(Path("out/small/pictures").glob("*.png"))), 3)
        hashes = [re.findall(r"^state-hash .*$", text, re.M) for text in (told[0], told[-1])]
        self.assertEqual(len(hashes[0]), 1)
        self.assertEqual(hashes[0], hashes[1])


class Tutorial(Followed):
    def test_its_commands_work_as_they_stand(self):
        self.assertEqual(len(self.follow("tutorial.md", ["thesis.toml", "figure.py"])), 6)
        for file in ("out/thesis/report.html", "out/slip/report.html", "out/slip/summary.csv", "pull.pdf"):
            self.assertGreater((self.folder / file).stat().st_size, 1000, file)
        sweep = grouser.open_sweep("out/slip")
        self.assertEqual([run.status for run in sweep.runs], ["finished"] * 6)
        for soil in ("lete_sand", "sandy_loam"):
            runs = [run.figures for run in sweep.runs if run.keys["terrain.material"] == soil]
            pulls = [figures["drawbar pull"] for figures in runs]
            self.assertEqual(len(pulls), 3)
            self.assertTrue(all(16e3 < pull < 30e3 for pull in pulls), pulls)
            self.assertEqual(pulls, sorted(pulls), "the pull rises with slip, as the page says")
        refused = subprocess.run("build/bin/grouser plan thesis.toml --set driver.drive_ramp=-1".split(),
                                 capture_output=True, text=True, env=self.environment)
        self.assertEqual(refused.returncode, 2)
        self.assertIn("is outside [0, 1000]", refused.stderr)


class QuickStart(FolderTest):
    def test_builds_the_python_module_and_prints_how_to_use_it(self):
        """With an empty build: the lines that the script prints at its end work in another folder."""
        house = self.folder / "a house"
        (house / "runs").mkdir(parents=True)
        (house / "runs/quickstart").write_text((ROOT / "runs/quickstart").read_text())
        (house / "runs/packages.sh").write_text(
            'install_packages() { :; }\n'
            'configure_and_build() { echo "$@" >targets; mkdir -p "$1/bin"; ln -s /bin/true "$1/bin/grouser"; }\n')
        (house / "python").symlink_to(ROOT / "python")
        done = subprocess.run(["bash", str(house / "runs/quickstart")], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual((house / "targets").read_text().split(), ["build", "grouser", "grouser_python"])
        lines = done.stdout.rstrip().split("\n")[-2:]
        environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
        told = subprocess.run(["bash", "-c", "\n".join(lines)], capture_output=True, text=True, env=environment)
        self.assertEqual(told.returncode, 0, told.stderr)
        self.assertRegex(told.stdout, r"^\d\.\d+ m/s, state hash [0-9a-f]{16}\n$")
        page = (ROOT / "docs/quickstart.md").read_text()
        for line in ("export PYTHONPATH=$PWD/python", "/usr/bin/python3 python/examples/hello_world.py"):
            self.assertIn(f"    {line}\n", page)


class Site(FolderTest):
    def site(self, root):
        return subprocess.run([str(root / "docs/site"), str(self.folder / "site")], capture_output=True, text=True)

    def setUp(self):
        super().setUp()
        if subprocess.run(["/usr/bin/python3", "-c", "import mkdocs"], capture_output=True).returncode != 0:
            self.skipTest("mkdocs is not installed: apt-get install mkdocs")

    def test_is_built_and_every_link_leads_somewhere(self):
        done = self.site(ROOT)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        index = (self.folder / "site/index.html").read_text()
        self.assertIn("tutorial.html", index)
        self.assertTrue((self.folder / "site/docs/tutorial.html").is_file())

    @unittest.skipIf(browser.find() is None, "no Chromium is installed: apt-get install chromium-headless-shell")
    def test_pages_fit_the_width_of_a_phone(self):
        self.assertEqual(self.site(ROOT).returncode, 0)
        with browser.Browser() as phone:
            phone.call("Emulation.setDeviceMetricsOverride", width=390, height=844, deviceScaleFactor=1, mobile=True)
            for page in [self.folder / "site/index.html", *(self.folder / "site/docs").glob("*.html")]:
                phone.open(page)
                self.assertLessEqual(phone.value("document.documentElement.scrollWidth"), 390, page.name)

    def test_broken_links_are_told(self):
        root = self.folder / "house"
        (root / "docs").mkdir(parents=True)
        (root / "docs/site").write_text((ROOT / "docs/site").read_text())
        (root / "docs/site").chmod(0o755)
        (root / "README.md").write_text("# Title\n\n[a](docs/index.md#guides) [b](docs/nosuch.md) [c](docs/index.md#no)\n")
        (root / "docs/index.md").write_text("# Documents\n\n## Guides\n\n![x](nosuch.png) [y](#guides)\n")
        for name in ("ARCHITECTURE.md", "CONTRIBUTING.md", "CHANGELOG.md"):
            (root / name).write_text(f"# {name}\n")
        done = self.site(root)
        self.assertEqual(done.returncode, 1, done.stderr)
        told = done.stderr.strip().split("\n")
        self.assertEqual(len(told), 3, told)
        for word in ("nosuch.md", "index.html#no has no such heading", "nosuch.png"):
            self.assertTrue(any(word in line for line in told), told)

    def test_other_files_are_not_written_over(self):
        (self.folder / "site").mkdir()
        (self.folder / "site/mine.txt").write_text("mine")
        self.assertEqual(self.site(ROOT).returncode, 2)
        self.assertEqual(sorted(p.name for p in (self.folder / "site").iterdir()), ["mine.txt"])


class Installed(FolderTest):
    """Documents installed by cmake/documents.py; tests/install/run checks those of a complete installation."""

    LAYOUT = ("share/grouser", "share/doc/grouser", "lib/python3/dist-packages")

    def test_links_and_paths_are_those_of_installed_files(self):
        for text, fitted in (
                ("[a](../runs/scenes/drum.toml) [b](keys.md#run)", "[a](../../../grouser/runs/scenes/drum.toml) [b](keys.md#run)"),
                ("[c](../contact/contact_law.hpp), [d\ne](../tests/run)", "c, d\ne"),
                ("[f](http://x.org/y) `x[i](j)` ![g](drum.png)", "[f](http://x.org/y) `x[i](j)` ![g](drum.png)"),
                ("build/bin/grouser run runs/scenes/a.toml; build/bin/grouser_tests",
                 "grouser run /opt/share/grouser/runs/scenes/a.toml; build/bin/grouser_tests"),
                ("see (assets/soils), runs/setup/laws.cpp.", "see (/opt/share/grouser/assets/soils), runs/setup/laws.cpp."),
                ("`runs/plots/check_sinkage.py FOLDER`", "`/opt/share/grouser/runs/plots/check_sinkage.py FOLDER`"),
                ("else `build/bin/grouser` of the checkout", "else `build/bin/grouser` of the checkout"),
                ("PYTHONPATH=python x", "PYTHONPATH=/opt/lib/python3/dist-packages x")):
            self.assertEqual(documents.fitted(text, "docs/x.md", "/opt", *self.LAYOUT), fitted)

    def test_places_that_are_told_whole_stay_so(self):
        layout = ("/srv/data/grouser", "/srv/doc/grouser", "/srv/python")
        for text, fitted in (("[a](../runs/scenes/drum.toml) [b](keys.md)", "[a](../../../data/grouser/runs/scenes/drum.toml) "
                              "[b](keys.md)"),
                             ("run runs/scenes/a.toml", "run /srv/data/grouser/runs/scenes/a.toml"),
                             ("PYTHONPATH=python x", "PYTHONPATH=/srv/python x")):
            self.assertEqual(documents.fitted(text, "docs/x.md", "/opt", *layout), fitted)
        subprocess.run([ROOT / "cmake/documents.py", "/opt", *layout], check=True, stdout=subprocess.DEVNULL,
                       env={**os.environ, "DESTDIR": str(self.folder)})
        self.assertTrue((self.folder / "srv/doc/grouser/docs/control.md").is_file())
        self.assertEqual([file.name for file in self.folder.iterdir()], ["srv"])

    def test_sources_may_lie_in_a_folder_with_a_blank(self):
        """The install script of install.cmake works in a separate project."""
        code = re.search(r"^install\(CODE .*?^  COMPONENT program\)", (ROOT / "cmake/install.cmake").read_text(), re.M | re.S)[0]
        sources = self.folder / "my sources"
        (sources / "cmake").mkdir(parents=True)
        (sources / "cmake/documents.py").write_text("import pathlib, sys\npathlib.Path('said').write_text(repr(sys.argv[1:]))\n")
        (sources / "CMakeLists.txt").write_text(
            "cmake_minimum_required(VERSION 3.25)\nproject(x NONE)\nset(share \"my data/grouser\")\n"
            f"set(CMAKE_INSTALL_DOCDIR doc)\nset(GROUSER_PYTHON_DIR lib)\nset(GROUSER_PYTHON {sys.executable})\n{code}\n")
        for words in (["-S", sources, "-B", "build"], ["--install", "build", "--prefix", self.folder / "my place"]):
            done = subprocess.run(["cmake", *words], capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual((self.folder / "said").read_text(),
                         repr([str(self.folder / "my place"), "my data/grouser", "doc", "lib"]))

    def test_every_link_leads_somewhere(self):
        share, doc, _ = (self.folder / "opt" / folder for folder in self.LAYOUT)
        for source, there in documents.SHARED.items():
            copy = shutil.copytree if (ROOT / source).is_dir() else shutil.copy
            (share / there).parent.mkdir(parents=True, exist_ok=True)
            copy(ROOT / source, share / there)
        shutil.copytree(ROOT / "docs", doc / "docs", ignore=shutil.ignore_patterns("*.md"))
        subprocess.run([ROOT / "cmake/documents.py", "/opt", *self.LAYOUT], check=True, stdout=subprocess.DEVNULL,
                       env={**os.environ, "DESTDIR": str(self.folder)})
        def follow():
            done = subprocess.run([ROOT / "tests/install/documents", "/opt", self.folder], capture_output=True, text=True)
            return done.returncode, done.stdout + done.stderr
        self.assertEqual(follow(), (0, ""))
        (share / "runs/scenes/drum.toml").unlink()
        (doc / "docs/keys.md").unlink()
        status, told = follow()
        self.assertEqual(status, 1)
        for word in ("beds.md: missing /opt/share/grouser/runs/scenes/drum.toml",
                     "scenes.md: missing ../../../grouser/runs/scenes/drum.toml", "README.md: missing docs/keys.md"):
            self.assertIn(word, told)


class FirstProgram(unittest.TestCase):
    """The page of the C++ library shows the installed example program, which another test builds and runs."""

    def test_is_the_installed_example(self):
        page = (ROOT / "docs/control.md").read_text()
        example = (ROOT / "tests/install/example/example.cpp").read_text().split("\n", 1)[1].strip()
        self.assertIn(f"```cpp\n{example}\n```", page)
        cmake = (ROOT / "tests/install/example/CMakeLists.txt").read_text()
        self.assertEqual(re.search(r"```cmake\n(.*?)```", page, re.S)[1], cmake.split("\n", 1)[1])

    def test_names_every_public_header(self):
        page = (ROOT / "docs/control.md").read_text()
        for header in (ROOT / "api/include/grouser").glob("*.hpp"):
            self.assertIn(f"<grouser/{header.name}>", page)


if __name__ == "__main__":
    unittest.main()
