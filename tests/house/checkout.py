# SPDX-License-Identifier: BSD-3-Clause
"""Reads the files of a checkout for the coding rules."""
import re
from functools import cached_property
from pathlib import Path

from cpp_outline import without_comments

SUFFIXES = {'.hpp', '.cpp', '.cu', '.cuh'}
SCRIPTS = {'.py', '.sh', '.cmake', '.js', '.css'}  # and CMakeLists.txt, and files that begin with #!
OTHERS = {'.md', '.toml', '.txt', '.json', '.csv', '.png', '.svg', '.obj', '.html', '.mp4', '.pyi', '.typed', '.in'}
TOPS = ['base', 'contact', 'fluid', 'spheredecomp', 'multibody', 'terrain', 'scm', 'vehicle', 'coupling', 'assets', 'api', 'runs',
        'tests', 'docs', 'cmake', 'python']
GENERATED = {'grouser_commit.hpp'}  # written by the build
UNREAD, UNREAD_AT_TOP = re.compile(r'__pycache__|\..*'), re.compile(r'build.*|out')  # not part of the tree
INCLUDE = re.compile(r'^[ \t]*#[ \t]*(?:include|include_next|import)\b[ \t]*([^\s"<]*)(["<]?)([^">\n]*)', re.M)


class House:
    """The files of a checkout, read once."""

    def __init__(self, root):
        self.root = Path(root)
        self.files = sorted(str(path.relative_to(self.root)) for path in files_below(self.root))
        self.code = [path for path in self.files if Path(path).suffix in SUFFIXES]
        self.documents = [path for path in self.files if path.endswith('.md')]
        self.scripts = [path for path in self.files if is_script(self.root / path)]
        self.text = {path: (self.root / path).read_text() for path in self.code + self.documents + self.scripts}

    @cached_property
    def plain(self):
        """{code file: text without comments and strings}; line numbers do not change."""
        return {path: without_comments(self.text[path]) for path in self.code}

    @cached_property
    def endings(self):
        """All endings of paths: for a/b/c.hpp, also b/c.hpp and c.hpp."""
        return {'/'.join(Path(path).parts[k:]) for path in self.files for k in range(len(Path(path).parts))}

    @cached_property
    def includes(self):
        """{file: [(line, included name, included file or None)]}, without external headers."""
        found = {}
        for path in self.code:
            found[path] = []
            plain = without_comments(self.text[path], keep_strings=True)
            for match in INCLUDE.finditer(plain):
                line = plain.count('\n', 0, match.start()) + 1
                macro, opening, name = match.groups()
                target = None if macro else self._resolve(path, name, beside=opening == '"')
                if macro or target or opening == '"':
                    found[path].append((line, macro or name, target))
        return found

    def _resolve(self, path, name, beside):
        near = str((self.root / path).parent.joinpath(name).resolve()).removeprefix(str(self.root.resolve()) + '/')
        for candidate in (name, near) if beside else (name,):
            if candidate in self.text:
                return candidate
        return None


def files_below(root, top=True):
    for path in root.iterdir():
        if UNREAD.fullmatch(path.name) or (top and UNREAD_AT_TOP.fullmatch(path.name) and path.is_dir()):
            continue
        if path.is_dir():
            yield from files_below(path, top=False)
        else:
            yield path


def is_there(path):
    """True if git tracks the path; git does not track empty folders."""
    return any(files_below(path)) if path.is_dir() else path.exists()


def is_script(path):
    if path.suffix in SCRIPTS or path.name == 'CMakeLists.txt':
        return True
    if path.suffix:
        return False
    with path.open('rb') as file:
        return file.read(2) == b'#!'


def room_of(path):
    """'terrain' for terrain/detail/x.hpp, 'runs/campaigns/sweeps' for runs/campaigns/sweeps/x.hpp,
    'tests/runs/campaigns/sweeps' for its tests."""
    parts = Path(path).parts[:-1]
    if 'detail' in parts:
        parts = parts[:parts.index('detail')]
    if parts[:1] == ('assets',):
        parts = parts[:1]  # its folders contain generators
    return '/'.join(parts)


def line_at(text, at):
    return text.count('\n', 0, at) + 1
