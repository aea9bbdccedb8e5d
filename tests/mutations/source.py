"""Finds a definition in src by its name, and in it the code that a pattern describes.

A pattern is code of which only the tokens count, not blanks or comments. Of it, as in semgrep,

    $A, $B         (a capital letter) are any operands: a name, number, string or bracket, with all members, indices and
                   calls behind it. The same letter is the same code again.
    $name          is an operand that ends with the member `name`, whatever it is a member of, or the variable itself
    ...            is anything in the same statement, as short as possible, with its brackets in pairs

In the replacement they stand for the code that they were found to be.
"""

import functools
import os
import re
from typing import NamedTuple

SUFFIXES = (".c", ".cpp", ".h", ".py")
CODE = r"""(?:u8|[LuUrRbf])?"(?:\\.|[^"\\\n])*" | '(?:\\.|[^'\\\n])*' | \$\w+ | [A-Za-z_]\w*
    | 0[xX][0-9a-fA-F.]+(?:[pP][+-]?\d+)?\w* | \.?\d(?:[eE][+-]|[\w.])*
    | \.\.\. | -> | \+\+ | -- | <<=? | >>=? | && | \|\| | :: | \#\# | [-+*/%&|^<>=!:]= | \S"""
C = re.compile(r"//[^\n]* | /\*.*?\*/ | \\\n |" + f"({CODE})", re.VERBOSE | re.DOTALL)
PYTHON = re.compile(r"\#[^\n]* | \\\n | " + f'(""".*?""" | {CODE})', re.VERBOSE | re.DOTALL)
DIRECTIVE = re.compile(r"^[ \t]*\#[ \t]*(?:define[ \t]+(\w+))?(?:\\\n|[^\n])*", re.MULTILINE)
PYTHON_NAME = re.compile(r"^(?:([ \t]*)(?:def|class)[ \t]+(\w+)|(\w+)[^=\n()]*=(?!=))", re.MULTILINE)
OPERAND = re.compile(r"[\w\"'(\[]")
NAME = re.compile(r"[A-Za-z_]\w*$")
STANDS_FOR = re.compile(r"\$\w+|\.\.\.")
CLOSING = {"(": ")", "[": "]", "{": "}"}
KEYWORDS = {"if", "else", "for", "while", "switch", "case", "return", "sizeof", "__attribute__", "_Alignas", "alignas"}


class Token:
    __slots__ = ("text", "begin", "end")

    def __init__(self, text, begin, end):
        self.text = text
        self.begin = begin
        self.end = end


def split(text, language=C, begin=0, end=None):
    matches = language.finditer(text, begin, len(text) if end is None else end)
    return [Token(match[1], match.start(1), match.end(1)) for match in matches if match[1]]


def close(tokens, at):
    """Returns where the bracket at `at` is closed, or the last token."""
    depth = 0
    for i in range(at, len(tokens)):
        depth += (tokens[i].text in CLOSING) - (tokens[i].text in CLOSING.values())
        if depth == 0:
            return i
    return len(tokens) - 1


def define_c(text):
    """Yields (name, begin, end) of every macro, function and variable with a value, in namespaces and classes too."""
    for match in DIRECTIVE.finditer(text):
        if match[1]:
            yield match[1], match.start(), match.end()
    tokens = split(DIRECTIVE.sub(lambda match: " " * len(match[0]), text))
    first, name, is_value = 0, None, False
    i = 0
    while i < len(tokens):
        word = tokens[i].text
        done = word in (";", "}")
        if word == "=" and not is_value:
            before = i - 1
            while tokens[before].text == "]":
                before = max(k for k in range(before) if tokens[k].text == "[" and close(tokens, k) == before) - 1
            name, is_value = tokens[before].text, True
        elif word == "(" and not name and i > first and NAME.match(tokens[i - 1].text):
            name = tokens[i - 1].text if tokens[i - 1].text not in KEYWORDS else None
        if word in CLOSING and (word != "{" or name):
            i = close(tokens, i)
            done = word == "{" and not is_value
        elif word == "{":
            first = i + 1
        if done:
            if name and (is_value or word == "{"):
                yield name, tokens[first].begin, tokens[i].end
            first, name, is_value = i + 1, None, False
        i += 1


def define_python(text):
    """Yields (name, begin, end) of every function, class and variable of the module."""
    for match in PYTHON_NAME.finditer(text):
        indent = match[1] or ""
        deeper = re.compile(rf"(?:\n(?:[ \t]*(?=\n|\Z)|{indent}[ \t]+[^\n]*|{indent}[)\]}}][^\n]*))*")
        first = text.find("\n", match.end())
        first = len(text) if first < 0 else first
        yield match[2] or match[3], match.start(), deeper.match(text, first).end()


class Source:
    """A file of src."""

    def __init__(self, root, path):
        self.path = path
        self.full = os.path.join(root, path)
        with open(self.full, encoding="utf-8") as file:
            self.text = file.read()
        self.language = PYTHON if path.endswith(".py") else C

    def define(self):
        named = (define_python if self.language is PYTHON else define_c)(self.text)
        return [Definition(self, name, begin, end) for name, begin, end in named]

    def name_line(self, at):
        return f"{self.path}:{self.text.count(chr(10), 0, at) + 1}"

    def write(self, text):
        with open(self.full, "w", encoding="utf-8") as file:
            file.write(text)


class Definition:
    """A function, macro or variable of a source."""

    def __init__(self, source, name, begin, end):
        self.source = source
        self.name = name
        self.begin = begin
        self.end = end

    def __str__(self):
        return self.source.name_line(self.begin)

    @functools.cached_property
    def tokens(self):
        return split(self.source.text, self.source.language, self.begin, self.end)

    @functools.cached_property
    def words(self):
        return {token.text for token in self.tokens}


def define_all(checkout):
    """The definitions of all of src, by name."""
    paths = [os.path.relpath(os.path.join(folder, name), checkout)
             for folder, _, names in os.walk(os.path.join(checkout, "src")) for name in names
             if name.endswith(SUFFIXES)]
    definitions = {}
    for path in sorted(paths):
        for definition in Source(checkout, path).define():
            definitions.setdefault(definition.name, []).append(definition)
    return definitions


def end_operand(tokens, at, member=None):
    """Returns the end of the operand that begins at `at`, or, with a member, where that ends it; None if none does."""
    word = tokens[at].text
    is_member = at > 0 and tokens[at - 1].text in (".", "->")
    if is_member or word in KEYWORDS or not OPERAND.match(word):
        return None
    at = close(tokens, at) + 1
    found = at if word == member else None
    while at + 1 < len(tokens):
        if tokens[at].text in (".", "->"):
            at += 2
            found = at if tokens[at - 1].text == member else found
        elif tokens[at].text in "([":
            at = close(tokens, at) + 1
        else:
            break
    return found if member else at


def list_words(tokens, first, last):
    return [token.text for token in tokens[first:last]]


def match_here(pattern, tokens, at, bound):
    """Returns the end of the code at `at` that the pattern describes, and fills `bound`; None if it does not."""
    for number, word in enumerate(pattern):
        if word == "...":
            return match_gap(pattern[number + 1:], tokens, at, bound)
        if at >= len(tokens):
            return None
        if word[0] == "$" and len(word) > 1:
            end = end_operand(tokens, at, None if re.fullmatch(r"\$[A-Z]", word) else word[1:])
            if end is None or list_words(tokens, *bound.get(word, (at, end))) != list_words(tokens, at, end):
                return None
            bound[word] = at, end
            at = end
        elif tokens[at].text == word:
            at += 1
        else:
            return None
    return at


def match_gap(pattern, tokens, at, bound):
    """Does what match_here does for a pattern behind an ellipsis."""
    end = at
    while end <= len(tokens):
        inner = {**bound, f"...{sum(key[0] == '.' for key in bound)}": (at, end)}
        last = match_here(pattern, tokens, end, inner)
        if last is not None:
            bound.clear()
            bound.update(inner)
            return last
        if end == len(tokens) or tokens[end].text in (*CLOSING.values(), ";"):
            return None
        end = close(tokens, end) + 1
    return None


class Place(NamedTuple):
    """Where a pattern is found, and what it is replaced by there."""
    definition: Definition
    begin: int
    end: int
    code: str

    def __str__(self):
        return self.source.name_line(self.begin)

    @property
    def source(self):
        return self.definition.source

    def change(self):
        """The text of the source with the change."""
        return self.source.text[:self.begin] + self.code + self.source.text[self.end:]


class Change:
    """A pattern and its replacement, written PATTERN => REPLACEMENT."""

    def __init__(self, text):
        self.pattern, arrow, self.replacement = (part.strip() for part in (text + " ").partition(" => "))
        if not arrow or not self.pattern:
            raise ValueError(f"`{text}` is not of the form PATTERN => REPLACEMENT")
        self.words = [token.text for token in split(self.pattern)]
        stands_for = [word for word in self.words if STANDS_FOR.fullmatch(word)]
        self.literal = set(self.words) - set(stands_for)
        for word in STANDS_FOR.findall(self.replacement):
            if word not in stands_for:
                raise ValueError(f"`{text}`: {word} is not in the pattern")
            if word == "...":
                stands_for.remove(word)

    def find(self, definition):
        """The places of a definition."""
        places = []
        tokens = definition.tokens
        for at in range(len(tokens) if self.literal <= definition.words else 0):
            bound = {}
            end = match_here(self.words, tokens, at, bound)
            if end:
                places.append(Place(definition, tokens[at].begin, tokens[end - 1].end, self.fill(definition, bound)))
        return places

    def fill(self, definition, bound):
        gaps = iter(sorted(key for key in bound if key[0] == "."))

        def code(match):
            first, last = bound[next(gaps) if match[0] == "..." else match[0]]
            tokens = definition.tokens[first:last]
            return definition.source.text[tokens[0].begin:tokens[-1].end] if tokens else ""

        return STANDS_FOR.sub(code, self.replacement)
