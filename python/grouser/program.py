# SPDX-License-Identifier: BSD-3-Clause
"""Runs the program `grouser`, reports its progress by callbacks, and raises its errors as exceptions."""
from __future__ import annotations

import codecs
import os
import pty
import re
import shutil
import subprocess
import threading
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path

from .errors import KINDS, GrouserError, briefly

#: "settling:  12.3 %, t 0.10 s, about 4 s left", as runs/support/progress.cpp writes it
_PROGRESS = re.compile(r"(?P<what>.+?): +(?P<percent>[\d.]+) %, (?P<detail>.*), "
                       r"(?P<left>[^,]+ left|time left unknown)")
_ERASE = "\x1b[K"  # erases a terminal line before it is rewritten
_ERROR = "grouser: error: "


@dataclass(frozen=True, eq=False)
class Progress:
    """A progress line of a running program."""

    what: str  #: phase: "settling", "driving"
    fraction: float  #: completed fraction of the phase, 0 to 1
    detail: str  #: "t 1.20 s"
    left: str  #: "about 42 s left"

    def __str__(self) -> str:
        return f"{self.what}: {100 * self.fraction:5.1f} %, {self.detail}, {self.left}"


def find_program() -> Path:
    """Path of the program: environment variable GROUSER_PROGRAM, else build/bin/grouser in the checkout of this
    package, else the program installed with the package, else `grouser` in PATH. FileNotFoundError if none exists."""
    given = os.environ.get("GROUSER_PROGRAM")
    here = Path(__file__).resolve().parent
    installed = [up / "bin" / "grouser" for up in here.parents]  # PREFIX/lib/python3/dist-packages/grouser
    found = shutil.which("grouser")
    candidates = [Path(given)] if given else [here.parents[1] / "build/bin/grouser", *installed]
    for candidate in candidates + ([Path(found)] if found and not given else []):
        if candidate.is_file() and os.access(candidate, os.X_OK):
            return candidate.absolute()
    raise FileNotFoundError(
        f"GROUSER_PROGRAM: {given} is not an executable file" if given else
        "program grouser not found: build it (cmake --build build --target grouser), install it, or set the "
        "environment variable GROUSER_PROGRAM to its path")


class Job:
    """A running process of the program. Several jobs can run at the same time.

    words: arguments of the program. folder: working directory. progress: callback(Progress), called from another thread
    for each progress line; if it raises an exception, the program stops and `wait()` raises the exception again.
    environment: additional environment variables. refused: called on exit code 2. worded: function that rewrites the
    error message.
    """

    def __init__(self, words: Iterable[str | os.PathLike], folder: str | os.PathLike | None = None,
                 progress: Callable[[Progress], None] | None = None, environment: dict[str, str] | None = None,
                 refused: Callable[[], None] | None = None, worded: Callable[[str], str] | None = None):
        self.command = [str(find_program()), *(os.fspath(word) for word in words)]
        self.progress: Progress | None = None  #: the last progress line
        self._tell, self._refused, self._worded = progress, refused, worded
        self._raised: BaseException | None = None  # exception of the callback
        self._lines: list[str] = []
        self._errors: list[str] = []
        # On a terminal the program prints progress five times per second, otherwise every five seconds.
        reader, writer = pty.openpty()
        try:
            self._process = subprocess.Popen(
                self.command, cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=writer, text=True,
                errors="replace", env={**os.environ, **(environment or {})}, start_new_session=True)
        except BaseException:
            os.close(reader)
            raise
        finally:
            os.close(writer)
        self._threads = [threading.Thread(target=self._read_output, daemon=True),
                         threading.Thread(target=self._read_errors, args=(reader,), daemon=True)]
        for thread in self._threads:
            thread.start()

    @property
    def running(self) -> bool:
        return self._process.poll() is None

    @property
    def output(self) -> str:
        """Standard output so far."""
        return "".join(self._lines)

    @property
    def messages(self) -> list[str]:
        """Standard error so far, without progress: warnings and errors."""
        return list(self._errors)

    def stop(self) -> None:
        """Stops the program: a run first writes a checkpoint; `wait()` then raises StoppedError."""
        if self.running:
            self._process.terminate()  # background processes ignore SIGINT

    def wait(self) -> str:
        """Waits for the end of the program and returns its standard output. Raises InputError, SimulationError,
        DeviceError, StoppedError or GrouserError with the message and exit code of the program. An exception during the
        wait (such as Ctrl-C) or in `progress` stops the program before it is raised."""
        try:
            code = self._process.wait()
        except BaseException:
            self.stop()
            self._process.wait()
            raise
        for thread in self._threads:
            thread.join()
        if self._raised is not None:
            raise self._raised
        if code != 0:
            message = self._message(code)
            raise KINDS.get(code, GrouserError)(self._worded(message) if self._worded else message, code, self.command,
                                                self.output)
        return self.output

    def _message(self, code: int) -> str:
        for k, line in enumerate(self._errors):
            if line.startswith(_ERROR):
                return "\n".join(self._errors[k:])[len(_ERROR):]
        return "\n".join(self._errors) or f"{' '.join(self.command)}: exit code {code} without a message"

    def _read_output(self) -> None:
        assert self._process.stdout  # a pipe
        with self._process.stdout as output:
            for line in output:
                self._lines.append(line)

    def _read_errors(self, reader: int) -> None:
        rest, decoder = "", codecs.getincrementaldecoder("utf-8")(errors="replace")
        with open(reader, "rb", buffering=0) as terminal:
            while True:
                try:
                    piece = decoder.decode(terminal.read(4096))
                except OSError:  # the program has closed its end of the terminal
                    piece = ""
                *whole, rest = re.split(r"[\r\n]+", rest + piece)
                for line in whole:
                    self._take(line)
                # A line of progress has no newline until the next one.
                if _PROGRESS.fullmatch(rest.replace(_ERASE, "")):
                    self._take(rest)
                    rest = ""
                if not piece:
                    self._take(rest)
                    break
        if self._process.wait() == 2 and self._refused:
            self._refused()

    def _take(self, line: str) -> None:
        line = line.replace(_ERASE, "")
        told = _PROGRESS.fullmatch(line)
        if told:
            self.progress = Progress(told["what"], float(told["percent"]) / 100, told["detail"], told["left"])
            if self._tell and self._raised is None:
                try:
                    self._tell(self.progress)
                except BaseException as error:  # wait() raises it in the caller's thread
                    self._raised = error
                    self.stop()
        elif line.strip():
            self._errors.append(line)


@briefly
def call(words: Iterable[str | os.PathLike], folder: str | os.PathLike | None = None,
         progress: Callable[[Progress], None] | None = None, environment: dict[str, str] | None = None) -> str:
    """Runs the program and waits for its end; the same as `Job(...).wait()`."""
    return Job(words, folder, progress, environment).wait()
