#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Each rule on references finds violations and accepts correct text."""
import sys
import tempfile
import unittest
from pathlib import Path

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).resolve().parent))
from checkout import House  # noqa: E402
from references import commits, links, long_tests, mutants, prose  # noqa: E402
from rules_test import faults  # noqa: E402


class Documents(unittest.TestCase):
    WIDE = 'word ' * 30

    def test_prose_is_wrapped(self):
        for text in (self.WIDE, '- ' + self.WIDE, '  ' + self.WIDE, '- item\n\n    ' + self.WIDE):
            self.assertEqual(len(faults(prose, {'docs/a.md': text})), 1, text)

    def test_tables_code_and_long_links_are_not(self):
        for text in ('| ' + self.WIDE, '    ' + self.WIDE, '```\n' + self.WIDE + '\n```\n',
                     '- <https://' + 'a' * 130 + '>'):
            self.assertEqual(faults(prose, {'docs/a.md': text}), [], text)

    def test_commits_stand_in_records(self):
        for bad in ('on one H200, commit ef291b3', '(fb19f37c)', 'commit\n4063015', '    run # 82d7a24'):
            self.assertEqual(len(faults(commits, {'docs/a.md': bad})), 1, bad)
            self.assertEqual(faults(commits, {'docs/evidence/a.md': bad}), [], bad)
        for good in ('2000000 grains', 'feedback', 'a hash 9f86d081884c7d65', 'commit 12'):
            self.assertEqual(faults(commits, {'README.md': good}), [], good)

    def test_links(self):
        files = {'docs/a.md': '# Title: of `code`\n\n## Part two\n', 'README.md': ''}
        for good in ('(docs/a.md)', '(docs/a.md#part-two)', '(docs/a.md#title-of-code)', '(https://x.org/y)', '(docs)'):
            self.assertEqual(faults(links, {**files, 'README.md': f'[x]{good}\n'}), [], good)
        for bad in ('(docs/b.md)', '(docs/a.md#part-three)', '(#nowhere)'):
            self.assertEqual(len(faults(links, {**files, 'README.md': f'[x]{bad}\n'})), 1, bad)

    def test_paths(self):
        files = {'base/comm.hpp': ''}
        for good in ('base/comm.hpp', 'base/comm', 'base/', 'comm.hpp', 'elsewhere/x.csv', 'base/ROOM-NAME'):
            self.assertEqual(faults(links, {**files, 'README.md': f'`{good}`\n'}), [], good)
        for bad in ('base/com', 'base/comm.cpp', 'contact/exchange', 'elsewhere/comm.hpp', 'com.hpp',
                    'python3 gone.py'):
            self.assertEqual(len(faults(links, {**files, 'README.md': f'`{bad}`\n'})), 1, bad)

    def test_an_empty_folder_is_none_to_git(self):
        with tempfile.TemporaryDirectory() as folder:
            Path(folder, 'base/detail').mkdir(parents=True)
            Path(folder, 'README.md').write_text('`base/detail`\n')
            self.assertEqual(len(list(links(House(folder)))), 1)

    def test_files_named_in_comments(self):
        files = {'base/comm.hpp': '', 'tests/base/comm_test.cpp': ''}
        for good in ('// see comm.hpp', '/* tests/base/comm_test.cpp */', '/// `base/comm_test.cpp`', '// *_test.cpp',
                     '// NAME_options.cpp', 'f("gone.hpp");', '// grouser_commit.hpp', '// grain_step.{hpp,cu}'):
            self.assertEqual(faults(links, {**files, 'base/a.cpp': good + '\n'}), [], good)
        for bad in ('// see gone.hpp', '/*\n gone.hpp */', '/// tests/comm_test.cpp', 'int a; // (plots/gone.py)'):
            self.assertEqual(len(faults(links, {**files, 'base/a.cpp': bad + '\n'})), 1, bad)
        self.assertIn('base/a.cpp:4:', faults(links, {'base/a.cpp': '/*\n\n gone.hpp */\n'})[0])


class Mutants(unittest.TestCase):
    def test_the_text_of_a_fault_stands_just_once_where_it_says(self):
        table = '[[fault]]\nfile = "base/a.cpp"\nold = "x += 1;"\nnew = "x -= 1;"\nuser = "counts down"\n'
        for code, count in (('x += 1;\n', 1), ('x += 2;\n', 0), ('x += 1; x += 1;\n', 2)):
            told = faults(mutants, {'base/a.cpp': code, 'tests/mutation/base.toml': table})
            self.assertEqual(len(told), 0 if count == 1 else 1, code)
        self.assertIn('occurs 0 times in base/b.cpp', faults(mutants, {
            'base/a.cpp': 'x += 1;\n', 'tests/mutation/base.toml': table.replace('base/a', 'base/b')})[0])

    def test_the_tests_that_should_see_a_fault_are_there(self):
        house = {'base/a.cpp': 'x += 1;\n', 'tests/runs/campaigns/sweeps/a_test.cpp': 'TEST(Sum, Grows) {}\n',
                 'tests/system/b_test.cpp': 'TEST_F(Bed, Rests) {}\nTEST_P(Laws, Hold) {}\n'}
        table = '[[fault]]\nfile = "base/a.cpp"\nold = "x += 1;"\nnew = "x -= 1;"\nuser = "counts down"\ntests = [{}]\n'
        for good in ('"sweeps:Sum.*"', '"sweeps:*Grow*"', '"sweeps:Sum.*", "system:Bed.Rests:All/Laws.*"', '"system:*"'):
            self.assertEqual(faults(mutants, {**house, 'tests/mutation/a.toml': table.format(good)}), [], good)
        for bad in ('"system:Sum.*"', '"sweeps:Bed.*"', '"simulation:Bed.*"', '"system:Bed.*:Beds.*"', '"sweeps:sum.*"'):
            told = faults(mutants, {**house, 'tests/mutation/a.toml': table.format(bad)})
            self.assertEqual(len(told), 1, bad)
            self.assertIn('there is no test', told[0])


class LongTests(unittest.TestCase):
    def test_they_and_quicker_ones_of_their_claims_are_there(self):
        house = {'tests/system/a_test.cpp': 'TEST(Bed, Sinks) {}\nTEST(Bed, Rests) {}\nTEST_F(Ground, Holds) {}\n'}
        table = 'foreach(row\n    "Bed.Sinks 60 Bed.Rests"\n    "{}")\nendforeach()\nforeach(row\n    "Bed.Rests 20")\n'
        def told(row):
            return faults(long_tests, {**house, 'tests/long_tests.cmake': table.format(row)})
        self.assertEqual(told('Ground.Holds 30 Bed.Rests'), [])
        self.assertEqual(told('Ground.Gives 30 Bed.Rests'), ['tests/long_tests.cmake: there is no test Ground.Gives'])
        self.assertEqual(told('Ground.Holds 30 Bed.Rest'), ['tests/long_tests.cmake: there is no test Bed.Rest'])
        self.assertEqual(told('Ground.Holds 30 Bed.Sinks'), ['tests/long_tests.cmake: Bed.Sinks is itself a long test'])


if __name__ == '__main__':
    unittest.main()
