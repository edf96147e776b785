# SPDX-License-Identifier: BSD-3-Clause
"""Rules on references: links, paths, tests and code files named in a file must exist."""
import fnmatch
import re
import tomllib

from checkout import GENERATED, TOPS, is_there, line_at, room_of
from cpp_outline import comments

MAX_PROSE_COLUMNS = 120


def prose(house):
    """Lines of documents are at most 120 columns wide, except tables, code and unbreakable text."""
    for path in house.documents:
        for number, line in prose_lines(house.text[path]):
            # A line with a single long word (link, address) after its list mark cannot be shorter.
            words = re.sub(r'^[\s>*\-\d.]*', '', line).split()
            if len(line) > MAX_PROSE_COLUMNS and not line.lstrip().startswith('|') and len(words) > 1:
                yield f'{path}:{number}: {len(line)} columns, at most {MAX_PROSE_COLUMNS}'


def prose_lines(text):
    """Numbered lines outside fenced and indented code."""
    fenced, blank, listed = False, True, False
    for number, line in enumerate(text.split('\n'), 1):
        if re.match(r'\s*(```|~~~)', line):
            fenced = not fenced
            continue
        if re.match(r'\s*([-*]|\d+\.)\s', line):
            listed = True
        elif line and not line[0].isspace():
            listed = False
        indented = line.startswith('    ') and not listed
        if not fenced and not indented:
            yield number, line


def commits(house):
    """Guides contain no commits; the commits of measured figures are in the records under docs/evidence/."""
    for path in house.documents:
        if path.startswith('docs/evidence/'):
            continue
        text = house.text[path]
        for match in re.finditer(r'\b(?=\d*[a-f])(?=[a-f]*\d)[0-9a-f]{7,8}\b|\bcommits?\s+\d{7,8}\b', text):
            yield f'{path}:{line_at(text, match.start())}: names a commit, {match[0]}; move the figure to a record in docs/evidence'


def links(house):
    """Links of documents, paths such as `room/file`, and code files named in documents and comments exist."""
    tops = '|'.join(TOPS)
    for path in house.documents:
        for number, line in prose_lines(house.text[path]):
            for target in re.findall(r'\]\(([^)\s]+)\)', re.sub(r'`[^`]*`', '', line)):
                fault = link_fault(house, path, target)
                if fault:
                    yield f'{path}:{number}: {fault}'
            # Without suffix: a unit, such as `base/comm` for base/comm.hpp and base/comm.cpp.
            for name in re.findall(rf'`((?:{tops})/[\w./]+)`', line):
                if not is_there(house.root / name) and not list(house.root.glob(name + '.*')):
                    yield f'{path}:{number}: there is no {name}'
            for span in re.findall(r'`([^`]*)`', line):
                for name in code_named(span):
                    if name not in house.endings and not re.match(rf'(?:{tops})/', name):
                        yield f'{path}:{number}: there is no {name} anywhere'
    for path in house.code:
        for match in comments(house.text[path]):
            for name in code_named(match[0]):
                if name not in house.endings and name not in GENERATED:
                    yield f'{path}:{line_at(house.text[path], match.start() + match[0].find(name))}: there is no {name}'


def code_named(text):
    """Names of code files in a text, without patterns such as NAME.cpp and *_test.cpp."""
    for name in re.findall(r'[\w./*<>{}-]*\.(?:hpp|cpp|cuh|cu|py)\b', text):
        if not re.search(r'[*<>{}]|[A-Z]{2}|^\.', name) and not name.startswith('/'):
            yield name


def link_fault(house, path, target):
    if re.match(r'\w+:', target):
        return None
    name, _, heading = target.partition('#')
    place = (house.root / path).parent / name if name else house.root / path
    if not place.exists():
        return f'there is no {name}'
    if heading and place.suffix == '.md' and heading not in headings(place.read_text()):
        return f'{name or path} has no heading #{heading}'
    return None


def headings(text):
    """GitHub anchors of the headings of a document."""
    titles = [line for _, line in prose_lines(text) if line.startswith('#')]
    plain = [re.sub(r'\[([^\]]*)\]\([^)]*\)', r'\1', title.lstrip('#').strip()).lower() for title in titles]
    return {re.sub(r'[^\w\- ]', '', title).replace(' ', '-') for title in plain}


def tests_of(house):
    """{room of tests: names of its GoogleTests}"""
    tests = {}
    for path in house.code:
        if path.startswith('tests/'):
            named = re.findall(r'\bTEST(?:_F|_P)?\(\s*(\w+)\s*,\s*(\w+)', house.plain[path])
            tests.setdefault(room_of(path).split('/')[-1], []).extend('.'.join(name) for name in named)
    return tests


def long_tests(house):
    """Long tests, and the quicker tests of the same claims, exist (ctest ignores unknown names)."""
    path = house.root / 'tests/long_tests.cmake'
    there = {name for names in tests_of(house).values() for name in names}
    rows = [row.split() for row in re.findall(r'^ +"(\w+\.\w+.*)"', path.read_text() if path.exists() else '', re.M)]
    long = {row[0] for row in rows if not row[-1].isdigit()}
    for row in rows:
        yield from (f'tests/long_tests.cmake: there is no test {name}' for name in row if '.' in name and name not in there)
        yield from (f'tests/long_tests.cmake: {name} is itself a long test' for name in row[1:] if name in long)


def mutants(house):
    """Texts changed by tests/mutate occur exactly once in their file, and the tests of each fault exist."""
    tests = tests_of(house)
    for path in (path for path in house.files if re.fullmatch(r'tests/mutation/.+\.toml', path)):
        for number, fault in enumerate(tomllib.loads((house.root / path).read_text()).get('fault', []), 1):
            count = house.text.get(fault['file'], '').count(fault['old'])
            if count != 1:
                yield f'{path}: fault {number} occurs {count} times in {fault["file"]}: {fault["old"]}'
            for room, filters in (test.split(':', 1) for test in fault.get('tests', [])):
                for wanted in filters.split('-')[0].split(':'):
                    if not fnmatch.filter(tests.get(room, []), wanted.split('/')[-1]):  # Laws/Scale.* are tests of Scale
                        yield f'{path}: fault {number}: there is no test {wanted} in {room}'
