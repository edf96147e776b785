#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes the index of docs/evidence: title, date and first verdict of each record.

    tests/house/evidence.py > docs/evidence/README.md
"""
import re
import sys
from pathlib import Path

FOLDER, INDEX = 'docs/evidence/', 'docs/evidence/README.md'
HEAD = """# Records of measurements

Each record documents one claim: measured quantities, command, machine, commit, table and verdict. To update this index,
run `tests/house/evidence.py > docs/evidence/README.md`, which reads the records.

| record | latest date | first verdict |
|---|---|---|
"""


def index(texts):
    """Returns the index. texts: {path from the root: text} of the records."""
    rows = []
    for path, text in sorted(texts.items(), key=lambda item: item[1].lower()):
        verdict = ' '.join(verdicts(text)[:1]).split()
        line = re.sub(r'\[([^\]]*)\]\([^)]*\)', r'\1', ' '.join(verdict))
        rows.append(f'| [{title(text)}]({path[len(FOLDER):]}) | {max(dates(text), default="")} | {line} |\n')
    return HEAD + ''.join(rows)


def title(text):
    return text.split('\n', 1)[0].lstrip('# ')


def dates(text):
    return re.findall(r'\b20\d\d-\d\d-\d\d\b', text)


def verdicts(text):
    return re.findall(r'^Verdict: (.*?)(?:\n\n|\n?\Z)', text, re.M | re.S)


def evidence(house):
    """Records under docs/evidence/ have a date and a verdict, and the index lists them all."""
    records = {path: house.text[path] for path in house.documents if path.startswith(FOLDER) and path != INDEX}
    for path, text in records.items():
        if not dates(text):
            yield f'{path}:1: no date (YYYY-MM-DD)'
        if not verdicts(text):
            yield f'{path}:1: no paragraph that begins with "Verdict: "'
    if records and house.text.get(INDEX) != index(records):
        yield f'{INDEX}:1: out of date; run tests/house/evidence.py > {INDEX}'


if __name__ == '__main__':
    root = Path(__file__).resolve().parent.parent.parent
    sys.stdout.write(index({str(path.relative_to(root)): path.read_text()
                            for path in (root / FOLDER).glob('*.md') if path.name != 'README.md'}))
