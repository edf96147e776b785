#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Each rule of tests/rooms finds violations and accepts correct code."""
import sys
import tempfile
import unittest
from pathlib import Path

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).resolve().parent))
import rules  # noqa: E402
from checkout import House  # noqa: E402
from cpp_outline import outline  # noqa: E402

LICENCE = '// SPDX-License-Identifier: BSD-3-Clause\n'


def include(folder, header):
    """A line that includes a library header, assembled so that this file does not contain it."""
    return f'#include <{folder}/{header}>\n'


def faults(rule, files):
    """Violations of a rule in a checkout of these files: {path: text}; adds licence lines."""
    with tempfile.TemporaryDirectory() as folder:
        for path, text in files.items():
            place = Path(folder, path)
            place.parent.mkdir(parents=True, exist_ok=True)
            place.write_text(LICENCE + text if path.endswith(('.hpp', '.cpp', '.cu', '.cuh')) else text)
        return list(rule(House(folder)))


class Joins(unittest.TestCase):
    def test_needs_the_header_of_ranges(self):
        call = 'std::string f() { return fmt::join(words, ","); }\n'
        told = faults(rules.joins, {'base/x.cpp': include('fmt', 'format.h') + call})
        self.assertEqual(told, ['base/x.cpp: fmt::join without #include <fmt/ranges.h>'])
        self.assertEqual(faults(rules.joins, {'base/x.cpp': include('fmt', 'ranges.h') + call, 'base/y.cpp': '// fmt::join\n'}),
                         [])


class Places(unittest.TestCase):
    def test_code_lies_in_a_room(self):
        for bad in ('tools/x.cpp', 'tools/deep/x.h', 'x.cpp', 'tools/x.py'):
            told = faults(rules.places, {bad: ''})
            self.assertEqual(told, [f'{bad}: not in a room; rooms are listed in tests/house/rules.py'], bad)

    def test_no_file_escapes_by_its_suffix(self):
        for bad in ('base/x.h', 'base/x.inl', 'terrain/detail/x.ipp', 'runs/setup/x.cc', 'tests/base/x.hxx'):
            self.assertEqual(len(faults(rules.places, {bad: ''})), 1, bad)

    def test_what_is_right(self):
        for good in ('base/x.cuh', 'base/CMakeLists.txt', 'CMakeLists.txt', 'LICENSE', 'tests/rooms', 'build/x.h',
                     'build_cuda/x.h', 'out/x.h', '.git/x.h', 'tests/house/__pycache__/x.pyc', 'results/rows.csv',
                     'runs/support/build_info.hpp', 'docs/a.png', 'cmake/options.cmake'):
            self.assertEqual(faults(rules.places, {good: ''}), [], good)

    def test_a_folder_like_a_build_is_read_below_the_top(self):
        self.assertEqual(len(faults(rules.places, {'runs/build/x.h': ''})), 1)
        files = {'runs/support/build_info.hpp': '#include "contact/b.hpp"\n', 'contact/b.hpp': ''}
        self.assertEqual(len(faults(rules.order, files)), 1)


    def test_a_test_mirrors_a_room(self):
        for bad in ('tests/runs/x_test.cpp', 'tests/runs/validation/x_test.cpp', 'tests/simulation/x_test.cpp',
                    'tests/runs/sweeps/x_test.cu'):
            told = faults(rules.places, {bad: ''})
            self.assertEqual(told, [f'{bad}: not a folder of tests; these are listed in tests/house/rules.py'], bad)
        for good in ('tests/coupling/x_test.cpp', 'tests/runs/validation/studies/x_test.cpp', 'tests/base/x_test.cu',
                     'tests/system/x_test.cpp', 'tests/ranks/x_test.cpp', 'tests/runs/x_fixture.hpp',
                     'tests/terrain/detail/x_test.cpp', 'tests/python/x_test.py'):
            self.assertEqual(faults(rules.places, {good: ''}), [], good)


class Order(unittest.TestCase):
    def test_a_library_does_not_include_one_above_it(self):
        files = {'base/a.hpp': '#include "contact/b.hpp"\n', 'contact/b.hpp': ''}
        self.assertEqual(faults(rules.order, files), ['base/a.hpp:2: base may not include contact (contact/b.hpp)'])

    def test_a_library_includes_one_below_it(self):
        self.assertEqual(faults(rules.order, {'contact/b.hpp': '#include "base/a.hpp"\n', 'base/a.hpp': ''}), [])

    def test_terrain_and_vehicle_do_not_meet(self):
        files = {'terrain/a.hpp': '#include "vehicle/b.hpp"\n', 'vehicle/b.hpp': '#include "terrain/a.hpp"\n'}
        self.assertEqual(len(faults(rules.order, files)), 2)

    def test_the_coupling_stands_on_all_physics_and_below_runs(self):
        for room in ('base', 'contact', 'spheredecomp', 'multibody', 'terrain', 'vehicle', 'runs/support'):
            files = {'coupling/x.hpp': f'#include "{room}/a.hpp"\n', f'{room}/a.hpp': ''}
            self.assertEqual(len(faults(rules.order, files)), room == 'runs/support', room)
            if room != 'runs/support':
                files = {f'{room}/a.hpp': '#include "coupling/x.hpp"\n', 'coupling/x.hpp': ''}
                self.assertEqual(len(faults(rules.order, files)), 1, room)

    def test_no_arrow_points_back_up_inside_runs(self):
        rooms = [name for line in rules.PROGRAM for name in line]
        files = {f'runs/{name}/x.hpp': '' for name in rooms}
        for line, below in enumerate(rules.PROGRAM):
            for above in (name for later in rules.PROGRAM[line + 1:] for name in later):
                for room in below:
                    with self.subTest(below=room, above=above):
                        wrong = {f'runs/{room}/x.cpp': f'#include "runs/{above}/x.hpp"\n'}
                        self.assertEqual(len(faults(rules.order, {**files, **wrong})), 1)
                        right = {f'runs/commands/x.cpp': f'#include "runs/{above}/x.hpp"\n'}
                        self.assertEqual(faults(rules.order, {**files, **right}), [])

    def test_rooms_of_one_line_do_not_see_each_other(self):
        pairs = [(one, other) for line in rules.PROGRAM for one in line for other in line if one != other]
        self.assertIn(('validation/studies', 'campaigns/forecast'), pairs)
        for one, other in pairs:
            files = {f'runs/{one}/a.hpp': f'#include "runs/{other}/b.hpp"\n', f'runs/{other}/b.hpp': ''}
            self.assertEqual(len(faults(rules.order, files)), 1, (one, other))

    def test_a_room_may_lie_in_a_folder_of_rooms(self):
        self.assertEqual(rules.room_of('runs/validation/studies/x.hpp'), 'runs/validation/studies')
        self.assertEqual(rules.room_of('tests/runs/campaigns/sweeps/x_test.cpp'), 'tests/runs/campaigns/sweeps')
        files = {'runs/campaigns/events/a.hpp': '#include "runs/campaigns/sweeps/b.hpp"\n',
                 'runs/campaigns/sweeps/b.hpp': ''}
        self.assertEqual(faults(rules.order, files), [])
        files = {'runs/campaigns/a.hpp': '#include "base/b.hpp"\n', 'base/b.hpp': ''}
        self.assertIn('runs/campaigns is no room', faults(rules.order, files)[0])

    def test_every_way_to_write_an_include(self):
        for line in ('#include <terrain/a.hpp>', '#  include\t<terrain/a.hpp>', '#include_next <terrain/a.hpp>',
                     '#import "terrain/a.hpp"', '#include "../terrain/a.hpp"', '#include"terrain/a.hpp"'):
            told = faults(rules.order, {'vehicle/x.cpp': line + '\n', 'terrain/a.hpp': ''})
            self.assertEqual(len(told), 1, line)
            self.assertIn('vehicle may not include terrain', told[0])

    def test_an_include_by_a_macro(self):
        files = {'vehicle/x.cpp': '#define X "terrain/a.hpp"\n#include X\n', 'terrain/a.hpp': ''}
        self.assertEqual(faults(rules.order, files),
                         ['vehicle/x.cpp:3: no file X; include it by its path from the top folder'])

    def test_what_others_have_made(self):
        self.assertEqual(faults(rules.order, {'base/a.hpp': '#include <fmt/format.h>\n#include <vector>\n'}), [])

    def test_no_scene_behind_setup(self):
        scene = {'runs/scene/scene.hpp': ''}
        for room in ('coupling', 'runs/storage', 'runs/output', 'runs/render', 'runs/session'):
            direct = {f'{room}/x.cpp': '#include "runs/scene/scene.hpp"\n', **scene}
            self.assertEqual(len(faults(rules.order, direct)), 1, room)
            brought_along = {f'{room}/x.cpp': 'double of(const scene::Scene& s);\n'}
            self.assertEqual(faults(rules.scenes, brought_along), [f'{room}/x.cpp:2: {room} may not see a scene'])
        for room in ('setup', 'virtual_tests', 'validation/studies', 'campaigns/sweeps', 'commands'):
            files = {f'runs/{room}/x.cpp': '#include "runs/scene/scene.hpp"\nscene::Scene s;\n', **scene}
            self.assertEqual(faults(rules.order, files) + faults(rules.scenes, files), [], room)
        self.assertEqual(faults(rules.scenes, {'coupling/x.cpp': '// scene::Scene\nmy_scene::A a;\n'}), [])

    def test_render_needs_no_physics(self):
        for other in ('contact', 'terrain', 'coupling', 'runs/setup'):
            files = {'runs/render/x.cpp': f'#include "{other}/y.hpp"\n', f'{other}/y.hpp': ''}
            self.assertEqual(len(faults(rules.order, files)), 1, other)
        for other in ('base', 'runs/support', 'runs/output'):
            files = {'runs/render/x.cpp': f'#include "{other}/y.hpp"\n', f'{other}/y.hpp': ''}
            self.assertEqual(faults(rules.order, files), [], other)

    def test_a_file_that_is_not_there_and_a_room_that_is_not_planned(self):
        self.assertIn('no file base/gone.hpp', faults(rules.order, {'base/a.hpp': '#include "base/gone.hpp"\n'})[0])
        files = {'runs/kitchen/a.hpp': '#include "base/b.hpp"\n', 'base/b.hpp': ''}
        self.assertIn('runs/kitchen is no room', faults(rules.order, files)[0])

    def test_what_is_commented_out_is_not_included(self):
        files = {'base/a.hpp': '/*\n#include "contact/b.hpp"\n*/\n// #include "contact/b.hpp"\n', 'contact/b.hpp': ''}
        self.assertEqual(faults(rules.order, files), [])


class Chains(unittest.TestCase):
    """The same rooms with others in between."""
    SETUP = {'runs/scene/scene.hpp': '', 'runs/setup/a.hpp': '#include "runs/scene/scene.hpp"\n'}

    def test_no_header_brings_a_scene_along(self):
        for room in ('runs/storage', 'runs/output', 'runs/session'):
            files = {**self.SETUP, f'{room}/x.hpp': '#include "runs/setup/a.hpp"\n'}
            self.assertEqual(faults(rules.order, files), [], room)
            self.assertEqual(faults(rules.chains, files), [
                f'{room}/x.hpp: {room} may not reach runs/scene: {room}/x.hpp -> runs/setup/a.hpp -> '
                'runs/scene/scene.hpp'], room)

    def test_nor_any_other_header_of_that_room(self):
        files = {'runs/session/x.cpp': '#include "runs/setup/a.hpp"\n',
                 'runs/setup/a.hpp': '#include "runs/setup/b.hpp"\n',
                 'runs/setup/b.hpp': '#include "runs/scene/soil.hpp"\n', 'runs/scene/soil.hpp': ''}
        self.assertEqual(len(faults(rules.chains, files)), 1)

    def test_a_library_reaches_nothing_of_the_program(self):
        files = {**self.SETUP, 'coupling/x.hpp': '#include "runs/setup/a.hpp"\n',
                 'terrain/x.hpp': '#include "contact/y.hpp"\n', 'contact/y.hpp': '#include "vehicle/z.hpp"\n',
                 'vehicle/z.hpp': ''}
        told = faults(rules.chains, files)
        self.assertEqual(told, ['coupling/x.hpp: coupling may not reach runs/scene: coupling/x.hpp -> runs/setup/a.hpp '
                                '-> runs/scene/scene.hpp'])  # terrain's is contact's
        self.assertEqual(len(faults(rules.order, files)), 2)

    def test_render_reaches_what_it_may_include(self):
        files = {'runs/render/x.hpp': '#include "runs/output/y.hpp"\n',
                 'runs/output/y.hpp': '#include "terrain/z.hpp"\n', 'terrain/z.hpp': ''}
        self.assertEqual(faults(rules.order, files), [])
        self.assertEqual(faults(rules.chains, files),
                         ['runs/render/x.hpp: runs/render may not reach terrain: runs/render/x.hpp -> '
                          'runs/output/y.hpp -> terrain/z.hpp'])

    def test_only_the_first_file_at_fault_is_named(self):
        files = {**self.SETUP, 'runs/storage/x.hpp': '#include "runs/setup/a.hpp"\n',
                 'runs/storage/x.cpp': '#include "runs/storage/x.hpp"\n',
                 'runs/output/y.hpp': '#include "runs/storage/x.hpp"\n'}
        self.assertEqual(len(faults(rules.chains, files)), 1)

    def test_the_name_of_a_scene_is_enough(self):
        declared = 'namespace grouser::scene {\nstruct Scene;\n}\n'
        files = {**self.SETUP, 'runs/setup/a.hpp': declared, 'runs/setup/a.cpp': '#include "runs/scene/scene.hpp"\n',
                 'runs/session/x.cpp': '#include "runs/setup/a.hpp"\n'}
        self.assertEqual(faults(rules.chains, files), [])

    def test_what_may_see_a_scene_may_reach_it(self):
        for room in ('runs/setup', 'runs/commands', 'runs/virtual_tests', 'tests/runs/session', 'tests/system'):
            files = {**self.SETUP, f'{room}/x.cpp': '#include "runs/setup/a.hpp"\n'}
            self.assertEqual(faults(rules.chains, files), [], room)


class Privacy(unittest.TestCase):
    FILES = {'terrain/detail/a.hpp': '', 'runs/render/detail/b.hpp': ''}

    def test_others_stay_out(self):
        for place, name in (('runs/setup/x.cpp', 'terrain/detail/a.hpp'),
                            ('tests/vehicle/x.cpp', 'terrain/detail/a.hpp'),
                            ('runs/commands/x.cpp', 'runs/render/detail/b.hpp'),
                            ('tests/runs/commands/x.cpp', 'runs/render/detail/b.hpp')):
            self.assertEqual(len(faults(rules.privacy, {**self.FILES, place: f'#include "{name}"\n'})), 1, place)

    def test_angles_open_no_door(self):
        files = {**self.FILES, 'runs/setup/x.cpp': '#include <terrain/detail/a.hpp>\n'}
        self.assertEqual(len(faults(rules.privacy, files)), 1)

    def test_the_room_and_its_tests_come_in(self):
        for place, name in (('terrain/x.cpp', 'terrain/detail/a.hpp'), ('terrain/detail/x.cpp', 'terrain/detail/a.hpp'),
                            ('tests/terrain/x.cpp', 'terrain/detail/a.hpp'),
                            ('tests/runs/render/x.cpp', 'runs/render/detail/b.hpp')):
            self.assertEqual(faults(rules.privacy, {**self.FILES, place: f'#include "{name}"\n'}), [], place)


class Circles(unittest.TestCase):
    def test_headers_in_a_circle(self):
        files = {'base/a.hpp': '#include "base/b.hpp"\n', 'base/b.hpp': '#include "base/c.hpp"\n',
                 'base/c.hpp': '#include "base/a.hpp"\n'}
        self.assertEqual(len(faults(rules.circles, files)), 1)

    def test_a_circle_in_angles(self):
        files = {'base/a.hpp': '#include <base/b.hpp>\n', 'base/b.hpp': '#include "base/a.hpp"\n'}
        self.assertEqual(len(faults(rules.circles, files)), 1)

    def test_a_circle_through_a_source(self):
        files = {'base/a.hpp': '', 'base/a.cpp': '#include "base/a.hpp"\n#include "base/b.hpp"\n',
                 'base/b.hpp': '#include "base/a.hpp"\n'}
        told = faults(rules.circles, files)
        self.assertEqual(len(told), 1)
        self.assertIn('base/a.cpp:3 includes base/b.hpp', told[0])
        self.assertIn('base/b.hpp:2 includes base/a.hpp', told[0])

    def test_a_circle_inside_a_unit(self):
        files = {'base/a.hpp': '#include "base/a.cuh"\n', 'base/a.cuh': '#include "base/a.hpp"\n'}
        self.assertEqual(len(faults(rules.circles, files)), 1)

    def test_two_circles_are_two_faults(self):
        files = {f'base/{one}.hpp': f'#include "base/{other}.hpp"\n' for one, other in ('ab', 'ba', 'cd', 'dc')}
        self.assertEqual(len(faults(rules.circles, files)), 2)

    def test_a_diamond_is_no_circle(self):
        files = {'base/a.cpp': '#include "base/a.hpp"\n#include "base/b.hpp"\n#include "base/c.hpp"\n',
                 'base/a.hpp': '', 'base/b.hpp': '#include "base/d.hpp"\n', 'base/c.hpp': '#include "base/d.hpp"\n',
                 'base/d.hpp': ''}
        self.assertEqual(faults(rules.circles, files), [])


class Code(unittest.TestCase):
    def test_thrust(self):
        line = include('thrust', 'sort.h')
        self.assertEqual(faults(rules.thrust, {'base/a.cu': line}), [])
        self.assertEqual(len(faults(rules.thrust, {'base/a.hpp': line})), 1)
        self.assertEqual(len(faults(rules.thrust, {'contact/a.cu': include('cub', 'cub.cuh')})), 1)

    def test_libm(self):
        for call in ('std::sin(x)', '::exp(x)', 'pow(x, y)', 'std::logf(x)', 'y = atan2(x, y)'):
            self.assertEqual(len(faults(rules.libm, {'runs/setup/a.cpp': f'double y = {call};\n'})), 1, call)
        for call in ('base::sin(x)', 'std::sqrt(x)', 'file.log(x)', 'sine(x)', '"sin(x)"', '1; // sin(x)'):
            self.assertEqual(faults(rules.libm, {'runs/setup/a.cpp': f'double y = {call};\n'}), [], call)
        self.assertEqual(faults(rules.libm, {'runs/render/a.cpp': 'double y = std::sin(x);\n'}), [])

    def test_libm_by_other_ways(self):
        for call in ('std::pow<double>(x, y)', 'std::pow<double, int> (x, y)', '(std::sin)(x)', '(::sin)(x)',
                     '&std::sin', 'apply(std::sin, x)', '__builtin_sin(x)', '__builtin_sinf(x)', 'std::fma(a, b, c)',
                     'fmaf(a, b, c)',
                     '__builtin_fma(a, b, c)', '__fmaf_rn(a, b, c)', '__sinf(x)', '_mm256_fmadd_pd(a, b, c)',
                     '_mm512_fnmsub_ps(a, b, c)', '_mm_rsqrt_ps(x)', 'rsqrt(x)', 'sincos(x, &s, &c)',
                     'std :: sin (x)'):
            self.assertEqual(len(faults(rules.libm, {'base/a.cpp': f'auto y = {call};\n'})), 1, call)
        self.assertEqual(faults(rules.libm, {'base/moderate.hpp': 'y = __fmaf_rn(a, b, c);\n'}), [])
        self.assertEqual(len(faults(rules.libm, {'base/a.cpp': 'using std::sin;\n'})), 1)
        for call in ('base::pow<double>(x, y)', '&base::sin', 'std::fmax(x, y)', '__builtin_popcount(x)',
                     'a.log<int>(x)', '_mm256_floor_pd(x)', 'std::log_of(x)', 'own::sin', 'std::fabs(x)'):
            self.assertEqual(faults(rules.libm, {'base/a.cpp': f'auto y = {call};\n'}), [], call)

    def test_the_file_of_functions_calls_its_own_only(self):
        for good in ('double sin(double x);', 'y = cos(x);'):
            self.assertEqual(faults(rules.libm, {'base/math.hpp': good + '\n'}), [], good)
        for bad in ('y = std::cos(x);', 'y = __builtin_fma(a, b, c);'):
            self.assertEqual(len(faults(rules.libm, {'base/math.hpp': bad + '\n'})), 1, bad)

    def test_mpi(self):
        for bad in ('#include <mpi.h>\n', '#include "mpi.h"\n', 'int n = MPI_Comm_size(MPI_COMM_WORLD, &n);\n'):
            self.assertGreaterEqual(len(faults(rules.mpi, {'contact/a.cu': bad})), 1, bad)
            self.assertEqual(faults(rules.mpi, {'base/comm.cpp': bad, 'runs/support/hdf5_file.cpp': bad}), [], bad)
        self.assertEqual(faults(rules.mpi, {'contact/a.cu': '// MPI_Send\nf("MPI_Send");\n#include <my_mpi.h>\n'}), [])

    def test_sums(self):
        def said(text, place='spheredecomp/a.cpp'):
            return faults(rules.sums, {place: text})
        loop = '#pragma omp parallel for reduction({})\nfor (int i = 0; i < n; ++i) a += f(i);\n'
        for kind in ('double a = 0;\n', 'float a = 0, b = 0;\n', 'auto a = f();\n', 'Real a{};\n', '',
                     'std::int64_t a = 0;\n}\ndouble a = 0;\n'):
            self.assertEqual(len(said(kind + loop.format('+ : a'))), 1, kind)
        for kind in ('std::int64_t a = 0;\n', 'int b = 0, a = 0;\n', 'std::size_t a{};\n', 'unsigned a = 0;\n'):
            self.assertEqual(said(kind + loop.format('+:a')), [], kind)
        self.assertEqual(said('double a = 0;\n' + loop.format('max : a')), [])
        self.assertEqual(len(said('std::int64_t a = 0;\ndouble b = 0;\n' + loop.format('+:a,b'))), 1)
        self.assertEqual(len(said('double a = 0;\n#pragma omp parallel for \\\n  reduction(+:a)\n')), 1)
        self.assertEqual(len(said('#pragma omp atomic\na += f(i);\n')), 1)
        self.assertEqual(len(said('double a = std::reduce(v.begin(), v.end());\n')), 1)
        self.assertEqual(said('double a = std::accumulate(v.begin(), v.end(), 0.0);\n#pragma omp parallel\n'), [])
        self.assertEqual(said('double a = 0;\n' + loop.format('+:a'), 'runs/render/a.cpp'), [])

    def test_kernels(self):
        for bad in ('base::forEach(exec, "name", n, [=](int i) { p[i] = 0; });',
                    'forEach(e, "n", f(1, 2), [&] (int) {});',
                    'const auto body = [=](int i) { p[i] = 0; };\nbase::forEach(exec, "name", n, body);',
                    'base::forEachGroup(exec, "n", n, [](int) {});'):
            self.assertEqual(len(faults(rules.kernels, {'terrain/a.cu': bad + '\n'})), 1, bad)
        for good in ('base::forEach(exec, "name", n, Body{p, q[1]});',
                     'arrays.forEach([&](auto& field) { field = 0; });',
                     'forEach([&](auto& a, auto& b) { f(a, b); });', 'base::forEach(exec, "name", a[1], body);'):
            self.assertEqual(faults(rules.kernels, {'terrain/a.cu': good + '\n'}), [], good)

    def test_sizes_of_files(self):
        self.assertEqual(faults(rules.sizes, {'base/a.hpp': '\n' * (rules.MAX_FILE_LINES - 1)}), [])
        for path in ('base/a.hpp', 'tests/house/a.py', 'runs/a.sh', 'base/CMakeLists.txt'):
            self.assertEqual(len(faults(rules.sizes, {path: '\n' * (rules.MAX_FILE_LINES + 1)})), 1, path)
        self.assertEqual(len(faults(rules.sizes, {'tests/lint': '#!/bin/sh\n' + '\n' * rules.MAX_FILE_LINES})), 1)
        self.assertEqual(faults(rules.sizes, {'LICENSE': '\n' * 900, 'runs/scenes/a.toml': '\n' * 900}), [])

    def test_sizes_of_functions(self):
        def body(lines):
            return 'template <class T = int>\nvoid f() {\n' + '  g();\n' * (lines - 3) + '}\n'
        self.assertEqual(faults(rules.sizes, {'base/a.hpp': body(rules.MAX_FUNCTION_LINES)}), [])
        self.assertIn(': f has', faults(rules.sizes, {'base/a.hpp': body(rules.MAX_FUNCTION_LINES + 1)})[0])

    def test_sizes_of_lambdas_outside_functions(self):
        for head in ('const auto f = [](int a) {', 'inline constexpr auto f = []<class T>(T a) -> int {',
                     'const std::map<int, int> f = [] {'):
            for end in ('};', '}();'):
                text = 'namespace n {\n' + head + '\n' + '  g();\n' * rules.MAX_FUNCTION_LINES + end + '\n}\n'
                told = faults(rules.sizes, {'base/a.cpp': text})
                self.assertEqual(len(told), 1, text[:60])
                self.assertIn(': f has', told[0])

    def test_sizes_of_classes(self):
        def house(count):
            verbs = ''.join(f'  void verb{i}(int a = 1);\n' for i in range(count))
            return 'class A {\n public:\n' + verbs + ' private:\n  void own();\n  int a_ = f(1);\n};\n'
        self.assertEqual(faults(rules.sizes, {'base/a.hpp': house(rules.MAX_PUBLIC_FUNCTIONS)}), [])
        self.assertEqual(len(faults(rules.sizes, {'base/a.hpp': house(rules.MAX_PUBLIC_FUNCTIONS + 1)})), 1)

    def test_licence(self):
        script = {'tests/run': '#!/bin/sh\n# SPDX-License-Identifier: BSD-3-Clause\n', 'runs/a.toml': '',
                  'base/CMakeLists.txt': '# SPDX-License-Identifier: BSD-3-Clause\n'}
        self.assertEqual(faults(rules.licence, {'base/a.hpp': '', **script}), [])
        for path in ('tests/a.py', 'tests/CMakeLists.txt', 'tests/run'):
            self.assertEqual(len(faults(rules.licence, {path: '#!/bin/sh\n\n'})), 1, path)
        with tempfile.TemporaryDirectory() as folder:
            Path(folder, 'base').mkdir()
            Path(folder, 'base/a.hpp').write_text('#pragma once\n')
            self.assertEqual(len(list(rules.licence(House(folder)))), 1)


class Outline(unittest.TestCase):
    def names(self, text):
        return [(found.name, found.lines) for found in outline(text)[0]]

    def test_functions(self):
        for text, name in (('auto f(int a) -> std::pair<int, int> {\n}\n', 'f'),
                           ('A::A(int a) : a_{a}, b_(a) {\n}\n', 'A::A'),
                           ('bool A::operator==(const A& b) const {\n}\n', 'A::operator_'),
                           ('TEST(Suite, Claim) {\n}\n', 'Suite.Claim'),
                           ('extern "C" void f() {\n}\n', 'f'),
                           ('template <class T>\n  requires(sizeof(T) > 1)\nvoid f() {}\n', None),
                           ('const auto f = [](int a) {\n return a;\n};\n', 'f'),
                           ('void f() {\n  auto g = [] { return "}"; };\n}\n', 'f')):
            found = self.names('namespace n {\n' + text + '}\n')
            self.assertEqual(len(found), 1, text)
            if name:
                self.assertEqual(found[0], (name, text.count('\n')), text)

    def test_values_are_no_functions(self):
        for text in ('const int a[] = {f(1), f(2)};\n', 'std::array<int, 2> a{1, 2};\n', 'enum class E { kA, kB };\n',
                     'INSTANTIATE(a, b, [](int a) { return a; });\n'):
            self.assertEqual(self.names(text), [], text)

    def test_branches_of_the_preprocessor(self):
        text = ('#if A\nvoid f() {\n#else\nvoid g() {\n#endif\n}\n'
                '#if A\nvoid h() {}\n#else\nvoid i() {}\n#endif\nvoid j() {}\n')
        self.assertEqual([name for name, _ in self.names(text)], ['f', 'h', 'i', 'j'])

    def test_public_functions(self):
        text = '''struct A : B<C> {
  A() = default;
  A(A&& other) noexcept;
  A& operator=(const A& other);
  ~A();
  explicit A(int a) : a_{a} {}
  std::function<void(int)> data;
  int size() const { return 1; }
  template <class T> T get(T value = T(1)) const;
  friend bool operator==(const A&, const A&) = default;
  bool operator<(const A& b) const;
  using Call = void (*)(int);
  struct Inner { void inner(); };
 protected:
  void kept();
};
'''
        found = {one.name: one.public for one in outline(text)[1]}
        self.assertEqual(found, {'A': ['A', 'size', 'get', 'operator_'], 'Inner': ['inner']})


if __name__ == '__main__':
    unittest.main()
