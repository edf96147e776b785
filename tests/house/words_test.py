#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The rule on language finds its phrases and openings, and accepts plain text."""
import sys
import unittest
from pathlib import Path

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).resolve().parent))
from evidence import evidence, index  # noqa: E402
from rules_test import faults  # noqa: E402
from words import words  # noqa: E402


class Words(unittest.TestCase):
    def test_phrases_are_found_in_messages_comments_and_documents(self):
        for bad in ('what is told of a run', 'it is asked for', 'a key that goes with another', 'it says the same',
                    'leave that out', 'Whoever moved it', 'left over 1e-9'):
            self.assertEqual(len(faults(words, {'docs/a.md': bad})), 1, bad)
            self.assertEqual(len(faults(words, {'base/a.cpp': f'const char* kText = "{bad}";'})), 1, bad)
            self.assertEqual(faults(words, {'docs/evidence/a.md': bad, 'tests/base/a.cpp': f'// {bad}'}), [], bad)

    def test_openings_that_name_nothing(self):
        for bad in ('Of one step.', 'What swings on it.', 'How it ends.', 'Those that stay.', 'of the bed [m]'):
            for text in (f'/// {bad}\nint a;', f'int a; ///< {bad}\n', f'int a; // {bad}\n'):
                self.assertEqual(len(faults(words, {'base/a.hpp': text})), 1, text)
            self.assertEqual(len(faults(words, {'runs/scenes/a.toml': f'a = 1  # {bad}\n'})), 1, bad)
        for good in ('Offset of a step.', 'Howe truss.', 'Mass that oscillates on it.'):
            self.assertEqual(faults(words, {'base/a.hpp': f'/// {good}\nint a;'}), [], good)


class Evidence(unittest.TestCase):
    RECORD = '# Speed\n\n2026-11-20, commit ef291b3.\n\nVerdict: it is\nfast.\n'

    def test_records_have_date_verdict_and_index(self):
        path, listed = 'docs/evidence/a.md', 'docs/evidence/README.md'
        whole = {path: self.RECORD, listed: index({path: self.RECORD})}
        self.assertIn('| [Speed](a.md) | 2026-11-20 | it is fast. |', whole[listed])
        self.assertEqual(faults(evidence, whole), [])
        for lacks in ('2026-11-20', 'Verdict: '):
            text = self.RECORD.replace(lacks, '')
            self.assertEqual(len(faults(evidence, {path: text, listed: index({path: text})})), 1, lacks)
        self.assertEqual(len(faults(evidence, whole | {listed: '# Records\n'})), 1)


if __name__ == '__main__':
    unittest.main()
