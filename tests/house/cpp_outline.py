# SPDX-License-Identifier: BSD-3-Clause
"""Functions and classes of a C++ file with their lines, for the size limits of tests/rooms.

This module is not a parser: it follows braces and classifies each brace by the text before it. This is correct for
formatted code without macros that contain braces; tests/format checks the format.
"""
import re
from dataclasses import dataclass, field


@dataclass
class Function:
    name: str
    line: int  # of its first word, 1-based
    lines: int  # to its closing brace


@dataclass
class Class:
    name: str
    line: int
    public: list = field(default_factory=list)  # one per overload, without copy operations and destructors


# Digit separators (1'000) are not quotes, hence the lookbehind.
_QUIET = re.compile(
    r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|(?<![0-9a-fA-F])\'(?:\\.|[^\'\\\n])+\'', re.S)
_DIRECTIVE = re.compile(r'^[ \t]*#(?:\\\n|[^\n])*', re.M)


def without_comments(text, keep_strings=False):
    """Replaces comments, and strings unless kept, by blanks; line numbers do not change."""
    def blank(match):
        word = match.group(0)
        if word[0] != '/':
            return word if keep_strings else '""' + '\n' * word.count('\n')
        return ' ' + '\n' * word.count('\n')
    return _QUIET.sub(blank, text)


def comments(text):
    """Regular-expression matches of the comments in a text."""
    return [match for match in _QUIET.finditer(text) if match[0][0] == '/']


def _without_directives(text):
    """Replaces preprocessor lines, and #else branches with unbalanced braces, by blanks."""
    joined = _DIRECTIVE.sub(lambda m: m[0].replace('\\\n', ' ') + '\n' * m[0].count('\\\n'), text)
    lines = joined.split('\n')
    branches = []  # start of the current branch of each open #if, None for a first branch
    for i, line in enumerate(lines):
        word = re.match(r'[ \t]*#\s*(\w+)', line)
        if not word:
            continue
        lines[i] = ''
        if word[1] in ('if', 'ifdef', 'ifndef'):
            branches.append(None)
        elif word[1] in ('else', 'elif', 'endif') and branches:
            begin = branches.pop()
            if begin is not None:
                branch = ''.join(lines[begin:i])
                if branch.count('{') != branch.count('}'):
                    lines[begin:i] = [''] * (i - begin)
            if word[1] != 'endif':
                branches.append(i)
    return '\n'.join(lines)


_OPEN, _CLOSE = {'(': ')', '[': ']', '{': '}'}, ')]}'


def _skip(text, at):
    """Position after the bracket that closes the one at `at`."""
    depth = 0
    while at < len(text):
        if text[at] in _OPEN:
            depth += 1
        elif text[at] in _CLOSE:
            depth -= 1
            if depth == 0:
                return at + 1
        at += 1
    return at


def _without_angles(head):
    """Removes template arguments and parameters: `template <class T = int> A<T, (3)> f()` becomes `template A f()`."""
    head = re.sub(r'operator\s*(<=>|<<=?|>>=?|<=?|>=?|->\*?|\(\)|[^\s\w(]+)', 'operator_', head)
    head = head.replace('->', ' ')
    while True:
        shorter = re.sub(r'<[^<>]*>', '', head)
        if shorter == head:
            return head
        head = shorter


_ATTRIBUTES = r'((?:\[\[[^\]]*\]\]\s*|\w+\s*\([^)]*\)\s*)*)'  # [[...]], alignas(...), __attribute__(...)
_CLASS = re.compile(r'\b(class|struct|union)\s+' + _ATTRIBUTES + r'([\w:]+)?')


def _opens(head):
    """Kind and name of the brace after a head: 'namespace', 'class', 'function', 'lambda' or 'value'."""
    plain = re.sub(r'\s+', ' ', _without_angles(head)).strip()
    plain = re.sub(r'^template\s*', '', plain)
    if re.match(r'(inline )?namespace\b', plain) or re.fullmatch(r'extern ""', plain):
        return 'namespace', ''
    if re.match(r'(typedef )?enum\b', plain):
        return 'value', ''
    named = _CLASS.match(re.sub(r'^typedef ', '', plain))
    if named and '(' not in plain[named.end():].split(':')[0] and '=' not in plain:
        return 'class', named[3] or '(unnamed)'
    written = re.search(r'(\w+)\s*=\s*\[', head)  # a lambda with a name
    if written:
        return 'lambda', written[1]
    parenthesis = plain.find('(')
    if parenthesis < 0 or '=' in plain[:parenthesis]:
        return 'value', ''
    name = re.search(r'([~\w:]+)\s*$', plain[:parenthesis])
    call = name[1] if name else '?'
    # Tests are named by the arguments of their macro: TEST(Suite, Claim).
    if re.match(r'(TEST|TEST_F|TEST_P|TYPED_TEST)$', call):
        call = re.sub(r'\s+', '', plain[parenthesis + 1:_skip(plain, parenthesis) - 1]).replace(',', '.')
    return 'function', call


def _inside_initialisers(head):
    """True if the brace after a head is a value in a constructor's initialiser list, not the body."""
    return re.search(r'\)\s*(noexcept\s*)?:(?!:)', head) and re.search(r'[\w>]\s*$', head)


def outline(text):
    """(functions, classes) in the text of a file. Functions include named lambdas outside of functions, but no nested
    or inherited functions."""
    text = _without_directives(without_comments(text))
    functions, classes = [], []
    _walk(text, 0, None, '', functions, classes)
    return functions, classes


def _walk(text, at, owner, access, functions, classes):
    """Reads declarations from `at` to the brace that closes this scope; returns the position after it."""
    start = at
    while at < len(text):
        c = text[at]
        if c in '([':
            at = _skip(text, at)
        elif c == '}':
            return at + 1
        elif c == ';':
            _declared(text[start:at], owner, access)
            at += 1
            start = at
        elif c == ':' and re.fullmatch(r'\s*(public|protected|private)\s*', text[start:at]):
            access = text[start:at].strip()
            at += 1
            start = at
        elif c == '{':
            head = text[start:at]
            kind, name = _opens(head)
            line = text.count('\n', 0, start + len(head) - len(head.lstrip())) + 1
            if kind == 'function' and _inside_initialisers(head):
                at = _skip(text, at)
                continue
            if kind == 'value':
                at = _skip(text, at)
                continue
            if kind == 'namespace':
                at = _walk(text, at + 1, None, '', functions, classes)
            elif kind == 'class':
                found = Class(name, line)
                classes.append(found)
                is_class = re.search(r'\bclass\b', _without_angles(head).split(name)[0])
                at = _walk(text, at + 1, found, 'private' if is_class else 'public', functions, classes)
            else:
                end = _skip(text, at)  # for lambdas too
                functions.append(Function(name, line, text.count('\n', 0, end - 1) + 1 - line + 1))
                _declared(head, owner, access)
                at = end
            start = at
        else:
            at += 1
    return at


def _declared(head, owner, access):
    """Counts a declaration in a class if it is a public, user-written function that does not override another."""
    if owner is None or access != 'public':
        return
    plain = re.sub(r'\s+', ' ', _without_angles(head)).strip()
    plain = re.sub(r'^template ', '', plain)
    if re.match(r'(using|friend|typedef|static_assert|enum|class|struct|union)\b', plain):
        return
    if re.search(r'= ?(default|delete)$|\b(override|final)$', plain):
        return
    kind, name = _opens(head)
    copies = re.search(r'\boperator\s*=\s*\(|\b%s\s*\((const )?%s ?&' % (owner.name, owner.name), head)
    if kind == 'function' and not name.startswith('~') and not copies:
        owner.public.append(name)
