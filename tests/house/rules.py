# SPDX-License-Identifier: BSD-3-Clause
"""The rules of the house that tests/rooms checks. Each takes a House and yields faults as 'place: what is wrong'."""
import re
from collections import deque
from functools import cached_property
from pathlib import Path

from cpp_outline import outline, without_comments

# A room, and the rooms beside itself that it may include.
LIBRARIES = {
    'base': set(),
    'contact': {'base'},
    'spheredecomp': {'base'},
    'multibody': {'base'},
    'terrain': {'base', 'contact'},
    'vehicle': {'base', 'contact', 'spheredecomp', 'multibody'},
    'assets': {'base'},
}
# The rooms of the program stand on the libraries and on the rooms before them, but not on those of the same line.
PROGRAM = [['support'], ['scene'], ['setup'], ['simulation'], ['output'], ['render', 'studies', 'bench'], ['commands']]
# What only reads, keeps or draws needs no physics.
NARROW = {
    'runs/support': {'base'},
    'runs/render': {'base'},
}
GENERATED = {'grouser_commit.hpp'}  # written by the build

MAX_FILE_LINES = 500
MAX_FUNCTION_LINES = 80
MAX_PUBLIC_FUNCTIONS = 25
MAX_PROSE_COLUMNS = 120

SUFFIXES = {'.hpp', '.cpp', '.cu', '.cuh'}
# Rooms that have a part in what a state becomes: elementary functions there are those of base/math.hpp.
STATE_ROOMS = [*LIBRARIES, 'runs/support', 'runs/scene', 'runs/setup', 'runs/simulation']
LIBM = ('sin cos tan asin acos atan atan2 sinh cosh tanh asinh acosh atanh exp exp2 expm1 log log2 log10 log1p pow '
        'cbrt hypot erf erfc tgamma lgamma')


def allowed_rooms():
    may = dict(LIBRARIES)
    before = set()
    for line in PROGRAM:
        for name in line:
            room = 'runs/' + name
            may[room] = NARROW.get(room, set(LIBRARIES) - {'assets'}) | before
        before = before | {'runs/' + name for name in line}
    return may


def room_of(path):
    """'terrain' of terrain/detail/x.hpp, 'runs/setup' of runs/setup/x.hpp, 'tests/runs/setup' of its tests."""
    parts = Path(path).parts[:-1]
    if 'detail' in parts:
        parts = parts[:parts.index('detail')]
    if parts[:1] == ('assets',):
        parts = parts[:1]  # its folders are programs that make what lies in it
    return '/'.join(parts)


class House:
    """The files of a checkout, read once."""

    def __init__(self, root):
        self.root = Path(root)
        tops = [*LIBRARIES, 'runs', 'tests']
        self.code = sorted(str(path.relative_to(self.root)) for top in tops for path in (self.root / top).rglob('*')
                           if path.suffix in SUFFIXES)
        self.documents = sorted(str(path.relative_to(self.root)) for path in self.root.rglob('*.md')
                                if not re.match(r'(build|out|\.)', str(path.relative_to(self.root))))
        self.text = {path: (self.root / path).read_text() for path in self.code + self.documents}

    @cached_property
    def includes(self):
        """{file: [(line, what stands between the quotes, the file it is or None)]}: quoted includes only."""
        found = {}
        for path in self.code:
            found[path] = []
            plain = without_comments(self.text[path], keep_strings=True)
            for match in re.finditer(r'^[ \t]*#[ \t]*include[ \t]*"([^"]+)"', plain, re.M):
                line = plain.count('\n', 0, match.start()) + 1
                found[path].append((line, match[1], self._resolve(path, match[1])))
        return found

    def _resolve(self, path, name):
        beside = str((self.root / path).parent.joinpath(name).resolve())
        for candidate in (name, beside.removeprefix(str(self.root.resolve()) + '/')):
            if candidate in self.text:
                return candidate
        return None


def order(house):
    """A room includes only what its line in ARCHITECTURE.md names; tests may include every room."""
    may = allowed_rooms()
    for path, includes in house.includes.items():
        room = room_of(path)
        for line, name, target in includes:
            if target is None:
                if name not in GENERATED:
                    yield f'{path}:{line}: there is no file {name}; name it from the top folder'
                continue
            other = room_of(target)
            if other == room or room.startswith('tests'):
                continue
            if room not in may:
                yield f'{path}:{line}: {room or "the top folder"} is no room; the rooms stand in tests/house/rules.py'
            elif other not in may[room]:
                yield f'{path}:{line}: {room} may not include {other} ({name})'


def privacy(house):
    """What lies in ROOM/detail/ is included by ROOM and tests/ROOM alone."""
    for path, includes in house.includes.items():
        for line, name, target in includes:
            if target and '/detail/' in target:
                room = room_of(target)
                if room_of(path) not in (room, 'tests/' + room):
                    yield f'{path}:{line}: {name} is private to {room} and its tests'


def circles(house):
    """No file includes itself by way of others; nor does x, where x.hpp, x.cpp, x.cu and x.cuh are one."""
    between = {}  # (unit, unit): how the first is seen to include the second
    files, units = {}, {}
    for path, includes in house.includes.items():
        files[path] = {target for _, _, target in includes if target}
        for line, _, target in includes:
            if target:
                pair = unit_of(path), unit_of(target)
                between.setdefault(pair, f'{path}:{line} includes {target}')
                if pair[0] != pair[1]:
                    units.setdefault(pair[0], set()).add(pair[1])
        units.setdefault(unit_of(path), set())
    told = []
    for circle in circles_of(units):
        told.append(set(circle))
        yield ' -> '.join(circle) + ''.join(f'\n    {between[pair]}' for pair in zip(circle, circle[1:]))
    for circle in circles_of(files):  # within a unit, such as x.hpp and x.cuh
        if not any({unit_of(path) for path in circle} <= names for names in told):
            yield ' -> '.join(circle)


def unit_of(path):
    return str(Path(path).with_suffix(''))


def circles_of(graph):
    """For every strongly connected component of {node: nodes} one of its shortest circles, its first node repeated."""
    for component in components(graph):
        if len(component) > 1 or component[0] in graph.get(component[0], ()):
            inside = set(component)
            yield min((shortest_circle(graph, node, inside) for node in sorted(component)), key=len)


def components(graph):
    """Tarjan's strongly connected components, without recursion."""
    number, low, on_stack, stack, found = {}, {}, set(), [], []
    for root in graph:
        if root in number:
            continue
        work = [(root, iter(sorted(graph[root])))]
        number[root] = low[root] = len(number)
        stack.append(root)
        on_stack.add(root)
        while work:
            node, targets = work[-1]
            for target in targets:
                if target not in graph:
                    continue
                if target not in number:
                    number[target] = low[target] = len(number)
                    stack.append(target)
                    on_stack.add(target)
                    work.append((target, iter(sorted(graph[target]))))
                    break
                if target in on_stack:
                    low[node] = min(low[node], number[target])
            else:
                work.pop()
                if work:
                    low[work[-1][0]] = min(low[work[-1][0]], low[node])
                if low[node] == number[node]:
                    at = stack.index(node)
                    found.append(stack[at:])
                    on_stack.difference_update(stack[at:])
                    del stack[at:]
    return found


def shortest_circle(graph, start, inside):
    """From start back to it, within a component: breadth first."""
    came = {}
    queue = deque([start])
    while queue:
        node = queue.popleft()
        for target in sorted(graph.get(node, ())):
            if target == start:
                way = [start, node]
                while way[-1] != start:
                    way.append(came[way[-1]])
                return way[::-1] if len(way) > 2 else [start, start]
            if target in inside and target not in came:
                came[target] = node
                queue.append(target)
    return [start]


def thrust(house):
    """Thrust and CUB are compiled in base/*.cu alone: they cost minutes, and the order of their sums is theirs."""
    for path in house.code:
        if not re.fullmatch(r'base/[^/]+\.cu', path):
            for match in re.finditer(r'^[ \t]*#[ \t]*include[ \t]*<((?:thrust|cub)/[^>]+)>', house.text[path], re.M):
                yield f'{path}:{house.text[path].count(chr(10), 0, match.start()) + 1}: {match[1]} outside base/*.cu'


def libm(house):
    """No transcendental function of libm where a state is made: its bits differ between machines."""
    call = re.compile(r'(?:(\w*)\s*(::)|(\.|->))?\s*\b(' + '|'.join(LIBM.split()) + r')([fl]?)\s*\(')
    for path in house.code:
        if room_of(path) not in STATE_ROOMS or path == 'base/math.hpp':
            continue
        text = without_comments(house.text[path])
        for match in call.finditer(text):
            qualifier, scope, member = match[1], match[2], match[3]
            if member or (scope and qualifier not in ('', 'std')):
                continue
            line = text.count('\n', 0, match.start(4)) + 1
            yield f'{path}:{line}: {match[4]}{match[5]} of libm; take the one of base/math.hpp'


def sizes(house):
    """Files, functions and classes that one can still read. Copying and ending are no functions of a class."""
    for path in house.code:
        lines = house.text[path].count('\n')
        if lines > MAX_FILE_LINES:
            yield f'{path}: {lines} lines, at most {MAX_FILE_LINES}'
        functions, classes = outline(house.text[path])
        for function in functions:
            if function.lines > MAX_FUNCTION_LINES:
                yield (f'{path}:{function.line}: {function.name} has {function.lines} lines, at most '
                       f'{MAX_FUNCTION_LINES}')
        for found in classes:
            if len(found.public) > MAX_PUBLIC_FUNCTIONS:
                yield (f'{path}:{found.line}: {found.name} has {len(found.public)} public functions, at most '
                       f'{MAX_PUBLIC_FUNCTIONS}')


def licence(house):
    """Every file of code begins with its licence."""
    for path in house.code:
        if 'SPDX-License-Identifier: BSD-3-Clause' not in house.text[path].split('\n', 1)[0]:
            yield f'{path}:1: the first line names the licence: // SPDX-License-Identifier: BSD-3-Clause'


def prose(house):
    """Documents are wrapped: but for tables, code, and what has no place to break."""
    for path in house.documents:
        for number, line in prose_lines(house.text[path]):
            # A line of one long word (a link, an address) behind its list mark cannot be shorter.
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


def links(house):
    """Links of documents, and paths named as `room/file`, lead to files, folders and headings that are there."""
    tops = '|'.join([*LIBRARIES, 'runs', 'tests', 'docs', 'cmake'])
    for path in house.documents:
        for number, line in prose_lines(house.text[path]):
            for target in re.findall(r'\]\(([^)\s]+)\)', re.sub(r'`[^`]*`', '', line)):
                fault = link_fault(house, path, target)
                if fault:
                    yield f'{path}:{number}: {fault}'
            # Without a suffix a unit is meant: `base/comm` for base/comm.hpp and base/comm.cpp.
            for name in re.findall(rf'`((?:{tops})/[\w./]+)`', line):
                if not (house.root / name).exists() and not list(house.root.glob(name + '.*')):
                    yield f'{path}:{number}: there is no {name}'


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
    """Anchors as GitHub makes them of the headings of a document."""
    titles = [line for _, line in prose_lines(text) if line.startswith('#')]
    plain = [re.sub(r'\[([^\]]*)\]\([^)]*\)', r'\1', title.lstrip('#').strip()).lower() for title in titles]
    return {re.sub(r'[^\w\- ]', '', title).replace(' ', '-') for title in plain}


RULES = [order, privacy, circles, thrust, libm, sizes, licence, prose, links]
