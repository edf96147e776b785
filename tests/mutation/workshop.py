# SPDX-License-Identifier: BSD-3-Clause
"""A copy of the sources with its own build; faults are inserted in this copy."""
import hashlib
import os
import re
import shutil
import subprocess
import tempfile
import tomllib
from contextlib import contextmanager
from pathlib import Path

MOST_SECONDS = 600  # of one call of a test program; a timeout counts as detection
FAILED = re.compile(r'^\[  FAILED  \] ([^\s,]+)(?:,.*)? \(\d+ ms\)$', re.M)
BEGUN = re.compile(r'^\[ RUN      \] (\S+)$', re.M)
ENDED = re.compile(r'^\[ {2,7}(?:OK|FAILED|SKIPPED) {1,2}\] ([^\s,]+)', re.M)


class BuildError(Exception):
    """A compiler error."""


def digest_of(files):
    """Hash of names and contents. files: pairs of name and bytes."""
    whole = hashlib.sha256()
    for name, content in files:
        whole.update(f'{name}\0{len(content)}\0'.encode() + content)
    return whole.hexdigest()[:16]


class Workshop:
    def __init__(self, tree, jobs):
        self.tree = Path(tree)
        self.jobs = jobs
        self.source = self.tree / 'build-mutate'
        self.build_folder = self.source / 'build'
        kinds = tomllib.loads((self.tree / 'tests' / 'mutation' / 'tests.toml').read_text())
        self.hashes, self.noisy = kinds['hash'], kinds['noisy']
        self.built = set()

    def copy(self):
        """Updates the copy from the working tree; returns a digest of the sources."""
        listed = subprocess.run(['git', 'ls-files', '-co', '--exclude-standard', '-z'], cwd=self.tree, check=True,
                                capture_output=True, text=True).stdout.split('\0')
        names = sorted(n for n in listed if n and (self.tree / n).is_file())
        keep = set(names)
        for name in names:
            there = self.source / name
            there.parent.mkdir(parents=True, exist_ok=True)
            if not there.exists() or there.read_bytes() != (self.tree / name).read_bytes():
                shutil.copyfile(self.tree / name, there)
                shutil.copymode(self.tree / name, there)
        for there in self.source.rglob('*'):
            name = there.relative_to(self.source).as_posix()
            if there.is_file() and name not in keep and not name.startswith(('build/', 'results.')):
                there.unlink()
        self.configure()
        code = [n for n in names if n.endswith(('.cpp', '.hpp', '.cu', '.cuh'))]
        return digest_of((n, (self.tree / n).read_bytes()) for n in code)

    def configure(self):
        if (self.build_folder / 'CMakeCache.txt').exists():
            return
        words = ['cmake', '-S', str(self.source), '-B', str(self.build_folder), '-G', 'Ninja', '-DGROUSER_CUDA=OFF']
        if shutil.which('ccache'):
            words.append('-DCMAKE_CXX_COMPILER_LAUNCHER=ccache')
        done = subprocess.run(words, capture_output=True, text=True)
        if done.returncode:
            raise SystemExit(done.stdout + done.stderr)

    @contextmanager
    def with_fault(self, fault):
        """Context in which the copy contains the fault; yields True if the text of the fault occurs exactly once."""
        path = self.source / fault.file
        sound = path.read_text() if path.exists() else ''
        found = sound.count(fault.old) == 1
        self.built.clear()
        try:
            if found:
                path.write_text(sound.replace(fault.old, fault.new))
            yield found
        finally:
            if found:
                path.write_text(sound)
            self.built.clear()

    def rooms(self):
        """Folders with tests; each has its own program."""
        return sorted({file.parent.name for file in (self.tree / 'tests').rglob('*_test.c[pu]*')} - {'ranks'})

    def build(self, program):
        """Builds the test program of a folder, or all test programs. Raises BuildError."""
        if program in self.built:
            return
        target = 'grouser_tests' if program == 'all' else 'grouser_tests_' + program
        done = subprocess.run(['cmake', '--build', str(self.build_folder), '-j', str(self.jobs), '--target', target],
                              capture_output=True, text=True)
        if done.returncode:
            errors = [line for line in done.stdout.splitlines() if ' error: ' in line]
            raise BuildError(errors[0] if errors else done.stdout[-300:] + done.stderr[-300:])
        self.built.add(program)

    def run(self, program, pattern, first=True):
        """Failing tests of physics and results. first: stop at the first failure."""
        return self.call(program, pattern, self.hashes + self.noisy, first)

    def run_hashes(self):
        """Failing tests that compare a stored hash."""
        return self.call('all', ':'.join(self.hashes), self.noisy, False)

    def red_without_fault(self, program, tests):
        """Tests that fail without a fault."""
        self.build(program)
        return [t for t in self.call(program, ':'.join(tests), [], False) if t in tests]

    def call(self, program, pattern, but, first):
        red = []
        for room in self.rooms() if program == 'all' else [program]:
            words = [str(self.build_folder / 'bin' / f'grouser_tests_{room}'),
                     f'--gtest_filter={pattern}-{":".join(but)}' if but else f'--gtest_filter={pattern}']
            if first:
                words.append('--gtest_fail_fast')
            shards = self.jobs if program == 'all' else 1
            running = [self.start(words, k, shards) for k in range(shards)]
            red += [test for process, said in running for test in self.red_of(process, said)]
            if first and red:
                break
        return red

    @staticmethod
    def start(words, shard, shards):
        """Starts one of several processes that share the tests; returns the process and its output file."""
        environment = dict(os.environ, GROUSER_CACHE='', GOMP_SPINCOUNT='5000', GTEST_TOTAL_SHARDS=str(shards),
                           GTEST_SHARD_INDEX=str(shard))
        said = tempfile.TemporaryFile('w+', errors='replace')
        return subprocess.Popen(words, env=environment, stdout=said, stderr=subprocess.STDOUT,
                                start_new_session=True), said

    @staticmethod
    def red_of(process, said):
        """Failed tests, including a test that crashed or timed out."""
        try:
            process.wait(timeout=MOST_SECONDS)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, 9)
            process.wait()
        said.seek(0)
        text = said.read()
        said.close()
        red = list(dict.fromkeys(FAILED.findall(text)))
        ended = set(ENDED.findall(text))
        if process.returncode not in (0, 1):
            red += [t for t in BEGUN.findall(text)[-1:] if t not in ended]
        return red
