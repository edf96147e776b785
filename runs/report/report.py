#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""One page for a browser of all that a run, a sweep, a check or a soil's tests have left in a folder:

    report.py FOLDER PAGE.html [--figures FILE.json] [--frames N] [--grains N] [--film FILE] [--program FILE]

`grouser report` calls it, and gives in FILE.json what it computes itself of a run (runs/campaigns/sweeps/run_figures), and its
own file. Exit status: 0; 2 where the folder holds no results or damaged ones, or an option is wrong; 3 where a package
is missing, 4 where the page cannot be written, 130 where it is interrupted; the last line then says what.
"""
import argparse
import contextlib
import json
import os
import signal
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
# The Python package: of the checkout, beside the installed program, or where Debian's Python has it.
sys.path[1:1] = [str(HERE.parent / "plots"), str(HERE.parents[1] / "python"),
                 str(HERE.parents[1].parent.parent / "lib/python3/dist-packages")]
sys.dont_write_bytecode = True
import packages

WRONG, NOT_WRITTEN, INTERRUPTED = 2, 4, 130
KINDS = (("check.json", "check"), ("events.json", "series of events"), ("calibration.json", "calibration"),
         ("soil.json", "soil's tests"), ("summary.csv", "sweep"), ("results.h5", "run"))


def kind_of(folder):
    """What a folder holds, by the file that says so; nothing where there is none of them."""
    return next((kind for file, kind in KINDS if (folder / file).is_file()), None)


def instead(folder):
    """What to say of a folder without results: which of those in it have some, or what makes them."""
    try:
        there = sorted(inner for inner in folder.iterdir() if inner.is_dir() and kind_of(inner))
    except OSError as error:
        return f"it cannot be read: {error.strerror}"
    if (folder / "manifest.json").is_file():
        return "it is the folder of a run without its results.h5; run it again, or take that file from a copy"
    if there:
        more = f" and {len(there) - 3} more" if len(there) > 3 else ""
        return (f"these in it do: {', '.join(str(inner) for inner in there[:3])}{more} (sweeps, checks, events and soils "
                "have a page of their own when their tables are written)")
    return ("a folder of a run, a sweep, a check, events, a calibration or a soil's tests has one of "
            f"{', '.join(file for file, _ in KINDS)}")


def contents(folder, kind, options):
    import calibration_page
    import check_page
    import events_page
    import run_page
    import soil_page
    import sweep_page
    write = {"check": check_page.page, "soil's tests": soil_page.page, "sweep": sweep_page.page, "run": run_page.page,
             "series of events": events_page.page, "calibration": calibration_page.page}
    return write[kind](folder, options)


def end(status, message):
    print(message)
    sys.exit(status)


def put(text, file):
    """Writes the page under another name and renames it: whoever opens it finds it whole."""
    fresh = file.with_name(file.name + ".part")
    try:
        fresh.write_text(text, encoding="utf-8", errors="replace")  # names of files may be no UTF-8
        os.replace(fresh, file)
    except OSError as error:
        end(NOT_WRITTEN, f"{file}: cannot be written: {error.strerror}")
    finally:
        with contextlib.suppress(OSError):
            fresh.unlink()


def check_places(options):
    """What is asked for that cannot be, before anything is read."""
    import run_page
    if not options.page.parent.is_dir():
        end(WRONG, f"--out {options.page}: there is no folder {options.page.parent}; make it, or name a file in another")
    if options.film and not run_page.is_film(options.film):
        end(WRONG, f"--film {options.film}: is no film that a browser shows; allowed are {', '.join(run_page.FILMS)}, as "
                   "grouser render --film drive.mp4 makes one")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("page", type=Path)
    parser.add_argument("--figures", type=Path)
    parser.add_argument("--film", type=Path)
    parser.add_argument("--program")
    parser.add_argument("--frames", type=int, default=60)
    parser.add_argument("--grains", type=int, default=40000)
    sys.stdout.reconfigure(errors="surrogateescape")  # names of files as they are
    make(parser.parse_args())


def make(options):
    packages.require("numpy", "h5py")
    try:
        import grouser
    except ImportError:
        end(packages.MISSING, "the Python package grouser is missing, which the program is installed with; set "
                              "PYTHONPATH to the folder that it lies in")
    check_places(options)
    try:
        kind = kind_of(options.folder)
    except OSError as error:
        end(WRONG, f"{options.folder}: cannot be read: {error.strerror}; change that, or name another folder")
    if kind is None:
        end(WRONG, f"{options.folder}: holds no results; {instead(options.folder)}")
    try:
        options.figures = json.loads(options.figures.read_text(encoding="utf-8")) if options.figures else {}
        text = contents(options.folder, kind, options).html()
    except grouser.FileError as error:
        end(WRONG, str(error).replace("\n", " "))
    except FileNotFoundError as error:
        end(packages.MISSING if "javascript" in str(error.filename) else WRONG, f"{error.filename}: {error.strerror}")
    except KeyError as error:
        end(WRONG, f"{options.folder}: its files of a {kind} are damaged, or of another version: they lack {error}")
    except OSError as error:
        end(WRONG, f"{options.folder}: its files of a {kind} cannot be read: {' '.join(str(error).split())}")
    except (ValueError, RuntimeError, IndexError, TypeError, AttributeError):
        end(WRONG, f"{options.folder}: its files of a {kind} are damaged, or of another version; make them again")
    put(text, options.page)
    print(f"report    {options.page}, {options.page.stat().st_size / 1e6:.1f} MB; open it in a browser")


def interrupt(*_):
    raise KeyboardInterrupt


if __name__ == "__main__":
    signal.signal(signal.SIGTERM, interrupt)  # what the program passes on
    try:
        main()
    except KeyboardInterrupt:
        end(INTERRUPTED, "interrupted; no page was written")
