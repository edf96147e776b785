#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Every rule of tests/rooms sees what it is there for, and passes what is right beside it."""
import sys
import tempfile
import unittest
from pathlib import Path

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).resolve().parent))
import rules  # noqa: E402
from cpp_outline import outline  # noqa: E402

LICENCE = '// SPDX-License-Identifier: BSD-3-Clause\n'


def faults(rule, files):
    """What the rule says of a house of these files: {path: text}; code gets its licence line."""
    with tempfile.TemporaryDirectory() as folder:
        for path, text in files.items():
            place = Path(folder, path)
            place.parent.mkdir(parents=True, exist_ok=True)
            place.write_text(text if path.endswith('.md') else LICENCE + text)
        return list(rule(rules.House(folder)))


class Order(unittest.TestCase):
    def test_a_library_does_not_include_one_above_it(self):
        files = {'base/a.hpp': '#include "contact/b.hpp"\n', 'contact/b.hpp': ''}
        self.assertEqual(faults(rules.order, files), ['base/a.hpp:2: base may not include contact (contact/b.hpp)'])

    def test_a_library_includes_one_below_it(self):
        self.assertEqual(faults(rules.order, {'contact/b.hpp': '#include "base/a.hpp"\n', 'base/a.hpp': ''}), [])

    def test_terrain_and_vehicle_do_not_meet(self):
        files = {'terrain/a.hpp': '#include "vehicle/b.hpp"\n', 'vehicle/b.hpp': '#include "terrain/a.hpp"\n'}
        self.assertEqual(len(faults(rules.order, files)), 2)

    def test_no_arrow_points_back_up_inside_runs(self):
        rooms = [name for line in rules.PROGRAM for name in line]
        files = {f'runs/{name}/{name}.hpp': '' for name in rooms}
        for line, below in enumerate(rules.PROGRAM):
            for above in (name for later in rules.PROGRAM[line + 1:] for name in later):
                with self.subTest(below=below, above=above):
                    wrong = {f'runs/{below[0]}/x.cpp': f'#include "runs/{above}/{above}.hpp"\n'}
                    self.assertEqual(len(faults(rules.order, {**files, **wrong})), 1)
                    right = {f'runs/commands/x.cpp': f'#include "runs/{above}/{above}.hpp"\n'}
                    self.assertEqual(faults(rules.order, {**files, **right}), [])

    def test_render_studies_and_bench_do_not_see_each_other(self):
        side = rules.PROGRAM[5]
        self.assertEqual(side, ['render', 'studies', 'bench'])
        for one in side:
            for other in side:
                if one != other:
                    files = {f'runs/{one}/a.hpp': f'#include "runs/{other}/b.hpp"\n', f'runs/{other}/b.hpp': ''}
                    self.assertEqual(len(faults(rules.order, files)), 1, (one, other))

    def test_a_file_that_is_not_there_and_a_room_that_is_not_planned(self):
        self.assertIn('no file base/gone.hpp', faults(rules.order, {'base/a.hpp': '#include "base/gone.hpp"\n'})[0])
        files = {'runs/kitchen/a.hpp': '#include "base/b.hpp"\n', 'base/b.hpp': ''}
        self.assertIn('runs/kitchen is no room', faults(rules.order, files)[0])

    def test_what_is_commented_out_is_not_included(self):
        files = {'base/a.hpp': '/*\n#include "contact/b.hpp"\n*/\n// #include "contact/b.hpp"\n', 'contact/b.hpp': ''}
        self.assertEqual(faults(rules.order, files), [])


class Privacy(unittest.TestCase):
    FILES = {'terrain/detail/a.hpp': '', 'runs/render/detail/b.hpp': ''}

    def test_others_stay_out(self):
        for place, name in (('runs/setup/x.cpp', 'terrain/detail/a.hpp'),
                            ('tests/vehicle/x.cpp', 'terrain/detail/a.hpp'),
                            ('runs/commands/x.cpp', 'runs/render/detail/b.hpp'),
                            ('tests/runs/commands/x.cpp', 'runs/render/detail/b.hpp')):
            self.assertEqual(len(faults(rules.privacy, {**self.FILES, place: f'#include "{name}"\n'})), 1, place)

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
        line = '#include <thrust/sort.h>\n'
        self.assertEqual(faults(rules.thrust, {'base/a.cu': line}), [])
        self.assertEqual(len(faults(rules.thrust, {'base/a.hpp': line})), 1)
        self.assertEqual(len(faults(rules.thrust, {'contact/a.cu': '#include <cub/cub.cuh>\n'})), 1)

    def test_libm(self):
        for call in ('std::sin(x)', '::exp(x)', 'pow(x, y)', 'std::logf(x)', 'y = atan2(x, y)'):
            self.assertEqual(len(faults(rules.libm, {'runs/setup/a.cpp': f'double y = {call};\n'})), 1, call)
        for call in ('base::sin(x)', 'std::sqrt(x)', 'file.log(x)', 'sine(x)', '"sin(x)"', '1; // sin(x)'):
            self.assertEqual(faults(rules.libm, {'runs/setup/a.cpp': f'double y = {call};\n'}), [], call)
        self.assertEqual(faults(rules.libm, {'runs/render/a.cpp': 'double y = std::sin(x);\n'}), [])

    def test_sizes_of_files(self):
        self.assertEqual(faults(rules.sizes, {'base/a.hpp': '\n' * (rules.MAX_FILE_LINES - 1)}), [])
        self.assertEqual(len(faults(rules.sizes, {'base/a.hpp': '\n' * rules.MAX_FILE_LINES})), 1)

    def test_sizes_of_functions(self):
        def body(lines):
            return 'template <class T = int>\nvoid f() {\n' + '  g();\n' * (lines - 3) + '}\n'
        self.assertEqual(faults(rules.sizes, {'base/a.hpp': body(rules.MAX_FUNCTION_LINES)}), [])
        self.assertIn(': f has', faults(rules.sizes, {'base/a.hpp': body(rules.MAX_FUNCTION_LINES + 1)})[0])

    def test_sizes_of_classes(self):
        def house(count):
            verbs = ''.join(f'  void verb{i}(int a = 1);\n' for i in range(count))
            return 'class A {\n public:\n' + verbs + ' private:\n  void own();\n  int a_ = f(1);\n};\n'
        self.assertEqual(faults(rules.sizes, {'base/a.hpp': house(rules.MAX_PUBLIC_FUNCTIONS)}), [])
        self.assertEqual(len(faults(rules.sizes, {'base/a.hpp': house(rules.MAX_PUBLIC_FUNCTIONS + 1)})), 1)

    def test_licence(self):
        self.assertEqual(faults(rules.licence, {'base/a.hpp': ''}), [])
        with tempfile.TemporaryDirectory() as folder:
            Path(folder, 'base').mkdir()
            Path(folder, 'base/a.hpp').write_text('#pragma once\n')
            self.assertEqual(len(list(rules.licence(rules.House(folder)))), 1)


class Documents(unittest.TestCase):
    WIDE = 'word ' * 30

    def test_prose_is_wrapped(self):
        for text in (self.WIDE, '- ' + self.WIDE, '  ' + self.WIDE, '- item\n\n    ' + self.WIDE):
            self.assertEqual(len(faults(rules.prose, {'docs/a.md': text})), 1, text)

    def test_tables_code_and_long_links_are_not(self):
        for text in ('| ' + self.WIDE, '    ' + self.WIDE, '```\n' + self.WIDE + '\n```\n',
                     '- <https://' + 'a' * 130 + '>'):
            self.assertEqual(faults(rules.prose, {'docs/a.md': text}), [], text)

    def test_links(self):
        files = {'docs/a.md': '# Title: of `code`\n\n## Part two\n', 'README.md': ''}
        for good in ('(docs/a.md)', '(docs/a.md#part-two)', '(docs/a.md#title-of-code)', '(https://x.org/y)', '(docs)'):
            self.assertEqual(faults(rules.links, {**files, 'README.md': f'[x]{good}\n'}), [], good)
        for bad in ('(docs/b.md)', '(docs/a.md#part-three)', '(#nowhere)'):
            self.assertEqual(len(faults(rules.links, {**files, 'README.md': f'[x]{bad}\n'})), 1, bad)

    def test_paths(self):
        files = {'base/comm.hpp': ''}
        for good in ('base/comm.hpp', 'base/comm', 'base/', 'elsewhere/x.hpp', 'base/ROOM-NAME'):
            self.assertEqual(faults(rules.links, {**files, 'README.md': f'`{good}`\n'}), [], good)
        for bad in ('base/com', 'base/comm.cpp', 'contact/exchange'):
            self.assertEqual(len(faults(rules.links, {**files, 'README.md': f'`{bad}`\n'})), 1, bad)


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
                           ('void f() {\n  auto g = [] { return "}"; };\n}\n', 'f')):
            found = self.names('namespace n {\n' + text + '}\n')
            self.assertEqual(len(found), 1, text)
            if name:
                self.assertEqual(found[0], (name, text.count('\n')), text)

    def test_values_are_no_functions(self):
        for text in ('const int a[] = {f(1), f(2)};\n', 'const auto f = [](int a) {\n return a;\n};\n',
                     'std::array<int, 2> a{1, 2};\n', 'enum class E { kA, kB };\n',
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
