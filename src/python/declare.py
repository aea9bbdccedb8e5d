#!/usr/bin/env python3
"""Generates from include/ffd the ctypes declarations of the library's structures and functions for the Python package,
a C source with which the compiler checks that both sides agree on every size and offset, and the list of what the library
shows on Windows.

    declare.py HEADERS DECLARATIONS.py LAYOUT.c EXPORTS.def COMPILER...

COMPILER is used as a preprocessor only. No declaration of the library is written by hand.
"""

import ctypes
import os
import subprocess
import sys
import tempfile

from pycparser import c_ast, c_parser

# Replacements for the system's headers, which pycparser cannot parse.
STANDARD = {
    "stddef.h": "typedef unsigned long size_t; typedef long ptrdiff_t;\n",
    "stdint.h": "typedef unsigned char uint8_t; typedef unsigned uint32_t; typedef unsigned long uint64_t;\n",
    "stdbool.h": "typedef _Bool bool;\n",
}

NUMBERS = {
    "void": "None", "bool": "c_bool", "char": "c_char", "int": "c_int", "unsigned": "c_uint", "double": "c_double",
    "size_t": "c_size_t", "ptrdiff_t": "c_ssize_t", "uint8_t": "c_uint8", "uint32_t": "c_uint32", "uint64_t": "c_uint64",
}


def expand(headers, compiler):
    """The preprocessed text of all public headers."""
    with tempfile.TemporaryDirectory() as folder:
        for name, text in STANDARD.items():
            with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
                file.write(text)
        return subprocess.run(
            [*compiler, "-E", "-P", "-nostdinc", "-U__GNUC__", "-x", "c", "-I", folder, "-I", os.path.dirname(headers),
             "-DFFD_STATIC", os.path.join(headers, "ffd.h")], check=True, capture_output=True, text=True).stdout


class Headers:
    """The declarations in the headers, with types as ctypes expressions."""

    def __init__(self, text):
        self.structures, self.enumerations, self.functions, self.callbacks, self.opaque = {}, {}, {}, set(), set()
        for node in c_parser.CParser().parse(text).ext:
            if isinstance(node, c_ast.Typedef):
                self.typedef(node)
            elif isinstance(node.type, c_ast.FuncDecl):
                self.functions[node.name] = self.function(node.type)

    def typedef(self, node):
        kind = node.type.type
        if isinstance(node.type, c_ast.PtrDecl) and isinstance(kind, c_ast.FuncDecl) or isinstance(node.type, c_ast.FuncDecl):
            self.callbacks.add(node.name)
        elif isinstance(kind, c_ast.Struct) and kind.decls is None:
            self.opaque.add(node.name)
        elif isinstance(kind, c_ast.Struct):
            self.structures[node.name] = [(member.name, self.type(member.type)) for member in kind.decls]
        elif isinstance(kind, c_ast.Enum):
            self.enumerations[node.name] = dict(self.constants(kind))

    def constants(self, enumeration):
        following = 0
        for entry in enumeration.values.enumerators:
            value = following if entry.value is None else self.number(entry.value)
            following = value + 1
            yield entry.name, value

    def number(self, node):
        if isinstance(node, c_ast.Constant):
            return int(node.value.rstrip("uUlL"), 0)
        if isinstance(node, c_ast.UnaryOp) and node.op == "-":
            return -self.number(node.expr)
        if isinstance(node, c_ast.ID):
            return next(values[node.name] for values in self.enumerations.values() if node.name in values)
        sys.exit(f"declare.py: no number: {node}")

    def function(self, node):
        arguments = [self.type(argument.type, True) for argument in node.args.params]
        return self.type(node.type), [] if arguments == ["None"] else arguments

    def type(self, node, argument=False):
        """The ctypes expression of a type. An array argument is a pointer."""
        if isinstance(node, c_ast.ArrayDecl):
            return "c_void_p" if argument else f"{self.type(node.type)} * {self.number(node.dim)}"
        if isinstance(node, c_ast.PtrDecl):
            return self.pointer(node.type, argument)
        name = " ".join(node.type.names)
        if name in NUMBERS:
            return NUMBERS[name]
        if name in self.enumerations:
            return "c_int"
        if name in self.callbacks:
            return "c_void_p"
        if name in self.structures:
            return name
        sys.exit(f"declare.py: unknown type: {name}")

    def pointer(self, target, argument):
        """A typed pointer for texts and structures that a structure holds, so that ctypes keeps them alive; else an address."""
        if isinstance(target, c_ast.TypeDecl) and isinstance(target.type, c_ast.IdentifierType):
            name = target.type.names[-1]
            if name == "char" and "const" in target.quals:
                return "c_char_p"
            if name in self.structures and not argument:
                return f"POINTER({name})"
        if isinstance(target, c_ast.PtrDecl) and not argument and self.pointer(target.type, False) == "c_char_p":
            return "POINTER(c_char_p)"
        return "c_void_p"


def python(headers):
    """The text of the generated module."""
    lines = ['"""Made from include/ffd by src/python/declare.py."""', "", "from ctypes import *", ""]
    for name, members in headers.structures.items():
        lines += ["", f"class {name}(Structure):", "    _fields_ = ["]
        lines += [f"        ({member!r}, {kind})," for member, kind in members] + ["    ]", ""]
    lines += ["", "# Enumeration -> constant -> its number.", f"ENUMERATIONS = {headers.enumerations!r}", ""]
    lines += ["# Function -> type of its result, types of its arguments.", "FUNCTIONS = {"]
    lines += [f"    {name!r}: ({result}, [{', '.join(arguments)}]),"
              for name, (result, arguments) in headers.functions.items()]
    return "\n".join(lines + ["}", ""])


def layout(headers, text):
    """C code that compiles only if the compiler's structures match those of the module."""
    names = {}
    exec(text, names)  # the generated module
    lines = ["/* layout.c - made by declare.py: the structures of ctypes are those of the compiler. */",
             "#include <ffd/ffd.h>", "#include <stddef.h>", ""]
    for name, members in headers.structures.items():
        structure = names[name]
        lines.append(f'_Static_assert(sizeof({name}) == {ctypes.sizeof(structure)}, "size of {name}");')
        lines += [f'_Static_assert(offsetof({name}, {member}) == {getattr(structure, member).offset}, "{name}.{member}");'
                  for member, _ in members]
    lines += [f'_Static_assert((int)({constant}) == {value}, "{constant}");'
              for values in headers.enumerations.values() for constant, value in values.items()]
    return "\n".join(lines + [""])


def main():
    folder, module, source, exports, *compiler = sys.argv[1:]
    headers = Headers(expand(folder, compiler))
    text = python(headers)
    # With the one of base/file/program_words.h, by which the program begins.
    names = "".join(f"    {name}\n" for name in sorted({*headers.functions, "ffd_program_words"}))
    for path, content in ((module, text), (source, layout(headers, text)), (exports, f"EXPORTS\n{names}")):
        with open(path, "w", encoding="utf-8") as file:
            file.write(content)


main()
