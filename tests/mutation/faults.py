# SPDX-License-Identifier: BSD-3-Clause
"""The faults and their results."""
import hashlib
import json
import tomllib
from dataclasses import dataclass
from pathlib import Path

TESTS = Path(__file__).resolve().parent.parent


@dataclass(frozen=True)
class Fault:
    """One small change of a source file, and its effect for a user."""
    name: str    # 'vehicle/3'
    file: str
    old: str     # occurs exactly once in the file
    new: str
    user: str
    tests: tuple  # 'ROOM:GTEST FILTER' of tests that should detect it

    def room(self):
        """Name of the test program of a file's room: 'sweeps' for runs/campaigns/sweeps/x.cpp."""
        folders = self.file.split('/')[:-1]
        return folders[-2 if folders[-1] == 'detail' else -1]

    def stages(self):
        """Programs and filters to run, in this order, before the whole suite. For folders without tests: tests of
        whole scenes."""
        own = [tuple(t.split(':', 1)) for t in self.tests]
        has_tests = any(path.parent.name == self.room() for path in TESTS.rglob('*_test.c*'))
        return own + [(self.room() if has_tests else 'system', '*')]

    def key(self):
        return hashlib.sha256('\0'.join([self.file, self.old, self.new]).encode()).hexdigest()[:16]


def load_faults(folder):
    """All faults of folder/*.toml except tests.toml, numbered in each file."""
    faults = []
    for path in sorted(Path(folder).glob('*.toml')):
        if path.name == 'tests.toml':
            continue
        for number, entry in enumerate(tomllib.loads(path.read_text())['fault'], 1):
            unknown = set(entry) - {'file', 'old', 'new', 'user', 'tests'}
            if unknown or entry['old'] == entry['new']:
                raise SystemExit(f'{path}: fault {number}: {unknown or "changes nothing"}')
            faults.append(Fault(f'{path.stem}/{number}', entry['file'], entry['old'], entry['new'], entry['user'],
                                tuple(entry.get('tests', []))))
    keys = [f.key() for f in faults]
    for fault in faults:
        if keys.count(fault.key()) > 1:
            raise SystemExit(f'{fault.name}: duplicate fault')
    return faults


def find(faults, names):
    """All faults of the given folders or names; all if none is given."""
    if not names:
        return faults
    return [f for f in faults if any(f.name == n or f.name.startswith(n + '/') for n in names)]


class Results:
    """Results, stored in a file that is replaced atomically."""

    def __init__(self, path, fresh=False):
        self.path = path
        self.found = {}
        if path.exists() and not fresh:
            self.found = json.loads(path.read_text())

    def of(self, fault):
        entry = self.found.get(fault.key())
        return entry and (entry['verdict'], entry['tests'])

    def stands(self, fault, digest):
        """True if a result is still valid: for detected faults always, for others only with the same sources."""
        entry = self.found.get(fault.key())
        return bool(entry) and (entry['verdict'] == 'results' or
                                (entry['digest'] == digest and entry['verdict'] in ('hash', 'none')))

    def add(self, fault, verdict, tests, program, digest):
        """Adds a result. program: test program of the tests."""
        self.found[fault.key()] = {'name': fault.name, 'verdict': verdict, 'tests': tests, 'program': program,
                                   'digest': digest, 'confirmed': False}
        self.save()

    def newly_seeing(self, digest):
        """Tests, by program, that have detected a fault but have not yet run without a fault."""
        seeing = {}
        for e in self.found.values():
            if e['verdict'] == 'results' and not e['confirmed'] and e['digest'] == digest:
                seeing.setdefault(e.get('program', 'all'), set()).update(e['tests'])
        return {program: sorted(tests) for program, tests in sorted(seeing.items())}

    def confirm(self, digest):
        for entry in self.found.values():
            if entry['digest'] == digest:
                entry['confirmed'] = True
        self.save()

    def forget(self, test):
        for key, entry in list(self.found.items()):
            entry['tests'] = [t for t in entry['tests'] if t != test]
            if entry['verdict'] == 'results' and not entry['tests']:
                del self.found[key]
        self.save()

    def save(self):
        self.path.parent.mkdir(parents=True, exist_ok=True)
        part = self.path.with_suffix('.part')
        part.write_text(json.dumps(self.found, indent=1))
        part.replace(self.path)
