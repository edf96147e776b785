# SPDX-License-Identifier: BSD-3-Clause
"""Runs whose files are missing or damaged: which, and why."""
import grouser
from page import esc

NEEDED = ("results.h5", "manifest.json", "scene.toml")
MOST_TOLD = 10


def open_whole(folder):
    """The run of a folder. FileError where one of its files is missing or cannot be read."""
    if not folder.is_dir():
        raise grouser.FileError(f"{folder}: the folder is missing; run it again, or take it from a copy")
    missing = [name for name in NEEDED if not (folder / name).is_file()]
    if missing:
        raise grouser.FileError(f"{folder}: without {' and '.join(missing)} it is no readable run; run it again, or take "
                                "what is missing from a copy")
    try:
        (folder / "scene.toml").read_text(encoding="utf-8")
    except ValueError as error:
        raise damaged(folder / "scene.toml") from error
    try:
        run = grouser.open_run(folder)
        for name in run:
            run[name]
        run.constants, run.facts, run.scene
    except grouser.FileError:
        raise
    except (OSError, KeyError, RuntimeError, AttributeError, TypeError, ValueError) as error:
        raise damaged(folder / "results.h5") from error
    run.manifest
    try:
        run.frames
    except (OSError, KeyError, RuntimeError) as error:
        raise damaged(folder / "frames.h5") from error
    return run


def damaged(file):
    return grouser.FileError(f"{file}: cannot be read in whole: it is damaged; run it again, or take it from a copy")


def without_frames(run):
    """Why a run has no frames; empty where it has some."""
    if run.frames is not None and len(run.frames):
        return ""
    if not run.scene.get("output", {}).get("frames", True):
        return "the scene asks for no frames (output.frames = false)"
    what = "holds no frame" if run.frames is not None else "is missing"
    return f"frames.h5 {what}, though the scene asks for frames (output.frames = true)"


def fault_of(folder):
    """What of a run that has finished is missing or damaged; empty where nothing is."""
    try:
        with open_whole(folder) as run:
            why = without_frames(run)
            return why if "though" in why and run.status in ("finished", "incomplete") else ""
    except grouser.FileError as error:
        return " ".join(str(error).replace(f"{folder}/", "").replace(f"{folder}: ", "").split())


def warn(made, faults, words=""):
    """Puts {run: fault} on top of the page, and `words` of what that does to it."""
    if not faults:
        return
    told = [f"<li><code>{esc(name)}</code>: {esc(fault)}</li>" for name, fault in list(faults.items())[:MOST_TOLD]]
    more = f"<p>And {len(faults) - MOST_TOLD} more.</p>" if len(faults) > MOST_TOLD else ""
    count = f"{len(faults)} runs have" if len(faults) > 1 else "1 run has"
    made.warnings.append(f"<p>{count} missing or damaged files.{words}</p><ul>{''.join(told)}</ul>{more}")
