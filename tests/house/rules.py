# SPDX-License-Identifier: BSD-3-Clause
"""The coding rules checked by tests/rooms. Each function has a House as argument and yields 'place: message'."""
import re
from pathlib import Path

from checkout import GENERATED, OTHERS, SCRIPTS, SUFFIXES, TOPS, line_at, room_of
from cpp_outline import outline
from evidence import evidence
from include_graph import chains_from, circles_of
from references import commits, links, long_tests, mutants, prose
from words import words

# Each room, with the other rooms that it may include.
LIBRARIES = {
    'base': set(),
    'contact': {'base'},
    'fluid': {'base', 'contact'},
    'spheredecomp': {'base'},
    'multibody': {'base'},
    'terrain': {'base', 'contact'},
    'vehicle': {'base', 'contact', 'spheredecomp', 'multibody'},
    'scm': {'base', 'contact', 'terrain'},
    'coupling': {'base', 'contact', 'fluid', 'spheredecomp', 'multibody', 'terrain', 'scm', 'vehicle'},
    'assets': {'base'},
}
# Rooms of the program may include the libraries and the rooms of previous lists, but not other rooms of their own list.
PROGRAM = [['support'], ['scene'], ['setup'], ['storage'], ['output'], ['render', 'jobs', 'validation/bench'],
           ['session', 'virtual_tests', 'campaigns/sweeps'], ['validation/studies', 'campaigns/forecast'],
           ['campaigns/events'], ['commands']]
# The public interface, with headers that include no other headers of the project, and the Python module based on it.
BESIDE = {'api': {'runs/' + room for room in 'support scene setup storage output session'.split()} | set(LIBRARIES),
          'api/include/grouser': set(), 'python/module': set()}
# Rooms without physics.
NARROW = {
    'runs/support': {'base'},
    'runs/render': {'base', 'runs/support', 'runs/output'},
}
# Rooms that use coupling::SimulationSetup and setup::RecordSetup instead of the scene.
BLIND = ['coupling', 'runs/storage', 'runs/output', 'runs/render', 'runs/session']
# Test folders without a room: whole scenes, and tests on several ranks.
TEST_ROOMS = {'tests/system', 'tests/ranks'}
MAX_FILE_LINES = 500
MAX_FUNCTION_LINES = 80
MAX_PUBLIC_FUNCTIONS = 25
# Outside the top folders a checkout may contain results, but no code.
STRANGE_CODE = {'.c', '.cc', '.cxx', '.h', '.hh', '.hxx', '.inc', '.inl', '.ipp', '.tpp', '.cl', '.hip', '.f90', '.rs'}

# Rooms that compute the state; they may use elementary functions only from base/math.hpp.
STATE_ROOMS = [*LIBRARIES, 'runs/support', 'runs/scene', 'runs/setup', 'runs/storage']
# This file uses fused multiply-adds for correctly rounded results; a test compares these with the operators.
ROUNDED_CORRECTLY = 'base/moderate.hpp'
LIBM = ('sin cos tan asin acos atan atan2 sinh cosh tanh asinh acosh atanh exp exp2 expm1 log log2 log10 log1p pow '
        'cbrt hypot erf erfc tgamma lgamma fma sincos exp10 sinpi cospi rsqrt').split()
# Files that may call MPI: communication, and parallel HDF5.
MPI_FILES = re.compile(r'base/comm[^/]*\.\w+|runs/support/hdf5_file\.cpp')


def allowed_rooms():
    may = LIBRARIES | BESIDE
    before = set()
    for line in PROGRAM:
        for name in line:
            room = 'runs/' + name
            may[room] = NARROW.get(room, (set(LIBRARIES) - {'assets'}) | before)
            if room in BLIND:
                may[room] = may[room] - {'runs/scene'}
        before = before | {'runs/' + name for name in line}
    return may


def places(house):
    """Files are in known folders and have known suffixes."""
    for path in house.files:
        top, suffix = Path(path).parts[0], Path(path).suffix
        if top in TOPS and top != path:
            if suffix not in SUFFIXES | SCRIPTS | OTHERS and suffix:
                yield f'{path}: unknown suffix; code ends in .hpp, .cpp, .cu or .cuh (others: tests/house/rules.py)'
        elif suffix in SUFFIXES | SCRIPTS | STRANGE_CODE:
            yield f'{path}: not in a room; rooms are listed in tests/house/rules.py'
        # CMake finds tests by their folders; tests in other folders would never be compiled.
        room = room_of(path)
        if re.fullmatch(r'tests/.+_test\.(cpp|cu)', path) and room not in TEST_ROOMS:
            if room.removeprefix('tests/') not in allowed_rooms():
                yield f'{path}: not a folder of tests; these are listed in tests/house/rules.py'


def order(house):
    """A room includes only the rooms that ARCHITECTURE.md lists for it; tests may include every room."""
    may = allowed_rooms()
    for path, includes in house.includes.items():
        room = room_of(path)
        for line, name, target in includes:
            if target is None:
                if name not in GENERATED:
                    yield f'{path}:{line}: no file {name}; include it by its path from the top folder'
                continue
            other = room_of(target)
            if other == room or room.startswith('tests'):
                continue
            if room not in may:
                yield f'{path}:{line}: {room or "the top folder"} is no room; rooms are listed in tests/house/rules.py'
            elif other not in may[room]:
                yield f'{path}:{line}: {room} may not include {other} ({name})'


def chains(house):
    """Forbidden rooms are not included indirectly either: libraries and rooms after setup reach no scene through any
    chain of includes."""
    may = allowed_rooms()
    rooms = {path: room_of(path) for path in house.code}
    files = {path: sorted({target for _, _, target in includes if target})
             for path, includes in house.includes.items()}
    reached = {}  # {file: {forbidden room: shortest chain of files to it}}
    for path in house.code:
        if rooms[path] in may:
            reached[path] = {}
            for chain in chains_from(path, files):
                other = rooms[chain[-1]]
                if other != rooms[path] and other not in may[rooms[path]]:
                    reached[path].setdefault(other, chain)
    for path, others in reached.items():
        for other, chain in others.items():
            # Direct includes are reported by order(); chains through a file that is reported itself are skipped.
            if len(chain) > 2 and other not in reached.get(chain[1], {}):
                yield f'{path}: {rooms[path]} may not reach {other}: {" -> ".join(chain)}'


def scenes(house):
    """Rooms after setup use plain values instead of the scene."""
    for path in house.code:
        if room_of(path) in BLIND:
            for match in re.finditer(r'\bscene\s*::', house.plain[path]):
                yield f'{path}:{line_at(house.plain[path], match.start())}: {room_of(path)} may not see a scene'


def privacy(house):
    """Only ROOM and tests/ROOM include files in ROOM/detail/."""
    for path, includes in house.includes.items():
        for line, name, target in includes:
            if target and '/detail/' in target:
                room = room_of(target)
                if room_of(path) not in (room, 'tests/' + room):
                    yield f'{path}:{line}: {name} is private to {room} and its tests'


def circles(house):
    """There are no include cycles, even if x.hpp, x.cpp, x.cu and x.cuh count as one unit."""
    between = {}  # (unit, unit): an include of the second by the first
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


def thrust(house):
    """Only base/*.cu uses Thrust and CUB, which take minutes to compile and have an unspecified summation order."""
    for path in house.code:
        if not re.fullmatch(r'base/[^/]+\.cu', path):
            for match in re.finditer(r'^[ \t]*#[ \t]*include[ \t]*<((?:thrust|cub)/[^>]+)>', house.text[path], re.M):
                yield f'{path}:{house.text[path].count(chr(10), 0, match.start()) + 1}: {match[1]} outside base/*.cu'


def mpi(house):
    """Only base/comm and the parallel HDF5 file use MPI."""
    for path in house.code:
        if not MPI_FILES.fullmatch(path):
            for text, words in ((house.plain[path], r'\bMPI_\w+'), (house.text[path], r'^[ \t]*#.*[<"](mpi\.h)[>"]')):
                for match in re.finditer(words, text, re.M):
                    yield f'{path}:{line_at(text, match.start())}: {match[0]} outside base/comm'


def libm(house):
    """Code that computes the state calls no functions whose bits differ between machines: transcendental functions of
    libm, fused multiply-adds, approximations of the processor."""
    names = '(' + '|'.join(LIBM) + ')([fl]?)'
    call = re.compile(r'(?:(\w*)\s*(::)|(\.|->))?\s*\b' + names + r'\s*(?:<[^<>;(){}]*>\s*)?\(')
    # With std:: and :: the name is enough: its address may be taken.
    name = re.compile(r'(?:\bstd\s*::|(?<![\w>:\s])\s*::)\s*' + names + r'\b(?!\s*::)')
    builtin = re.compile(r'\b(?:__builtin_|__nv_)' + names + r'\b|\b__' + names + r'(?:_r[nzud])?\s*\(|'
                         r'\b_mm\d*_\w*(?:fn?m(?:add|sub)|rsqrt|rcp)\w*|\b__frcp_\w+|\b__frsqrt_\w+')
    for path in house.code:
        if room_of(path) not in STATE_ROOMS or path == ROUNDED_CORRECTLY:
            continue
        text = house.plain[path]
        found = {}  # line: function
        for match in [*name.finditer(text), *builtin.finditer(text)]:
            word = re.sub(r'\s', '', match[0]).rstrip('(')
            found.setdefault(line_at(text, match.end()), word)
        if path != 'base/math.hpp':  # it defines and calls its own
            for match in call.finditer(text):
                qualifier, scope, member = match[1], match[2], match[3]
                if not member and not (scope and qualifier not in ('', 'std')):
                    found.setdefault(line_at(text, match.start(4)), match[4] + match[5])
        for line, word in sorted(found.items()):
            yield f'{path}:{line}: {word} of libm; use base/math.hpp'


def sums(house):
    """Code that computes the state has no sums of variable order: OpenMP reduces only integers, minima and maxima."""
    for path in house.code:
        if room_of(path) not in STATE_ROOMS:
            continue
        text = house.plain[path]
        for match in re.finditer(r'^[ \t]*#[ \t]*pragma[ \t]+omp\b((?:\\\n|[^\n])*)|'
                                 r'\bstd\s*::\s*(?:transform_)?reduce\b', text, re.M):
            line = line_at(text, match.start())
            if match[1] is None:
                yield f'{path}:{line}: {match[0]} has an unspecified order; use a loop or integers'
                continue
            for clause in re.finditer(r'\breduction\s*\(([^:]*):([^)]*)\)', match[1]):
                kind = clause[1].split(',')[-1].strip()
                if kind in ('min', 'max', '&', '|', '^', '&&', '||'):
                    continue
                for name in re.findall(r'\w+', clause[2]):
                    if not is_integer(name, text[:match.start()]):
                        yield (f'{path}:{line}: reduction({kind}:{name}) depends on the order of threads; sum declared '
                               'integers (base/fixed_point.hpp)')
            if re.search(r'\b(atomic|declare\s+reduction)\b', match[1]):
                yield f'{path}:{line}: omp{match[1]} depends on the order of threads; use base::atomicAdd64'


def is_integer(name, before):
    """True if the last declaration of `name` in the preceding text is an integer."""
    words = (r'(?:std\s*::\s*)?(?:u?int\d+_t|size_t|ptrdiff_t)|(?:unsigned\s+|signed\s+)?(?:int|long(?:\s+long)?)|'
             r'unsigned')
    # Other names of the same declaration may be in between: `std::int64_t a = 0, b = 0;`
    declared = list(re.finditer(r'\b(' + words + r'|double|float|auto|[A-Z]\w*)\s+(?:[^;(){}]*[\s,])?' + name +
                                r'\s*(?=[=;,{])', before))
    return bool(declared) and bool(re.fullmatch(words, declared[-1][1]))


def kernels(house):
    """Bodies of base::forEach are named functors, since nvcc does not compile lambdas here."""
    for path in house.code:
        text = house.plain[path]
        lambdas = set(re.findall(r'\b(\w+)\s*=\s*\[', text))
        for match in re.finditer(r'(?<![\w.>])(?:base\s*::\s*)?(forEach|forEachGroup)\s*(?:<[^<>;]*>\s*)?\(', text):
            given = arguments(text, match.end() - 1)
            if len(given) > 1 and (given[-1].startswith('[') or given[-1] in lambdas):
                yield f'{path}:{line_at(text, match.start())}: a lambda as body of {match[1]}; make it a named functor'


def arguments(text, at):
    """Arguments of the call whose parenthesis opens at `at`."""
    depth, begin, given = 0, at + 1, []
    for k in range(at, len(text)):
        if text[k] in '([{':
            depth += 1
        elif text[k] in ')]}':
            depth -= 1
        if (text[k] == ',' and depth == 1) or depth == 0:
            given.append(text[begin:k].strip())
            begin = k + 1
            if depth == 0:
                break
    return given


def sizes(house):
    """Files, functions and classes (without copy operations and destructors) are within the size limits."""
    for path in house.code + house.scripts:
        lines = house.text[path].count('\n')
        if lines > MAX_FILE_LINES:
            yield f'{path}: {lines} lines, at most {MAX_FILE_LINES}'
    for path in house.code:
        functions, classes = outline(house.text[path])
        for function in functions:
            if function.lines > MAX_FUNCTION_LINES:
                yield (f'{path}:{function.line}: {function.name} has {function.lines} lines, at most '
                       f'{MAX_FUNCTION_LINES}')
        for found in classes:
            if len(found.public) > MAX_PUBLIC_FUNCTIONS:
                yield (f'{path}:{found.line}: {found.name} has {len(found.public)} public functions, at most '
                       f'{MAX_PUBLIC_FUNCTIONS}')


def joins(house):
    """Code that calls fmt::join includes <fmt/ranges.h>: since fmt 11, <fmt/format.h> does not declare it."""
    for path in house.code:
        if 'fmt::join' in house.plain[path] and '<fmt/ranges.h>' not in house.text[path]:
            yield f'{path}: fmt::join without #include <fmt/ranges.h>'


def licence(house):
    """Code files begin with the licence line, scripts after #!."""
    for path in house.code + house.scripts:
        lines = house.text[path].split('\n', 2)
        number = 1 if lines[0].startswith('#!') and len(lines) > 1 else 0
        if 'SPDX-License-Identifier: BSD-3-Clause' not in lines[number]:
            yield f'{path}:{number + 1}: expected the licence line: SPDX-License-Identifier: BSD-3-Clause'


RULES = [places, order, chains, scenes, privacy, circles, thrust, mpi, libm, sums, kernels, sizes, joins, licence, prose, commits,
         links, long_tests, mutants, evidence, words]
