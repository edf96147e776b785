# SPDX-License-Identifier: BSD-3-Clause
"""Rule on language: documents, messages, help and comments do not contain certain unidiomatic phrases and openings."""
import re
from pathlib import Path

from checkout import line_at

#: Phrases, each with better words.
PHRASES = {
    r'\b(?:is|are|was|were|be|been) told\b': 'prints, reports, names',
    r'\b(?:is|are) asked for\b': 'requires, requests',
    r'\b(?:goes|go|going) with\b': 'depends on, belongs to, requires',
    r'\bheld against\b': 'compared with',
    r'\bsay(?:s)? the same\b': 'mutually exclusive, equal',
    r'\bleave (?:that|this|it|one) out\b': 'remove',
    r'\bis no (?:command|case|key|section|work|number)\b.*\bfor\b': 'does not support',
    r'\bWhoever\b': 'a noun',
    r'\b(?:left over)\b': 'residual',
    r'\bjust as well\b': 'equally',
    r'\bit comes to\b': 'it is',
    r'\bwhat hangs on\b': 'loads on',
}
#: A comment that begins with such a word does not name its subject; if it is a line within a sentence, the sentence
#: should be wrapped elsewhere.
OPENINGS = r'(?:[Oo]f|[Ww]hat|[Ww]hatever|Whoever|[Ww]hose|How|[Tt]hose|By what)\b'
MARKS = {'.py': '#', '.toml': '#', '.sh': '#', '.cmake': '#', '.js': '//'}
#: Files in which these words are data: columns of stored results, and this list.
EXCEPTIONS = {'tests/house/words.py', 'tests/house/words_test.py',
              'runs/validation/studies/trial_files.hpp', 'runs/validation/studies/random_vehicles_command.cpp'}


def words(house):
    """Texts are plain English: they contain no phrase of the list in tests/house/words.py, and comments begin with
    their subject."""
    for path in [*house.code, *house.documents]:
        if path in EXCEPTIONS or path.startswith(('tests/', 'docs/evidence/')) or path == 'CHANGELOG.md':
            continue
        text = house.text[path]
        for phrase, better in PHRASES.items():
            for match in re.finditer(phrase, text):
                yield f'{path}:{line_at(text, match.start())}: "{match[0]}"; better: {better}'
    for path in house.files:
        suffix = Path(path).suffix
        mark = MARKS.get(suffix, '//[/!]?<?' if path in house.code else None)
        if mark is None or path.startswith('tests/') or path in EXCEPTIONS:
            continue
        text = house.text.get(path) or (house.root / path).read_text(encoding='utf-8')
        for match in re.finditer(rf'(?:^|[ \t]){mark} +({OPENINGS})', text, re.M):
            yield f'{path}:{line_at(text, match.start(1))}: a comment begins with "{match[1]}"; name its subject first'
