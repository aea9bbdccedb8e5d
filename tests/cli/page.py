"""Reads the pages of ffd view as a browser does: what is in their data blocks, in the file's units."""

import base64
import json
import re
import struct

from harness import check, equal

BLOCK = re.compile(rb'<script type="([^"]*)" id="([^"]*)">([^<]*)</script>')


class Page:
    def __init__(self, content):
        check(content.startswith(b"<!DOCTYPE html>") and content.rstrip().endswith(b"</html>"), "a page from end to end")
        check(b"Content-Security-Policy\" content=\"default-src 'none'" in content, "a page that may ask for nothing")
        self.blocks = {name.decode("ascii"): text for _, name, text in BLOCK.findall(content)}
        self.scene, self.report = json.loads(self.blocks["scene"]), json.loads(self.blocks["report"])
        self.before = self.positions()
        self.after = [[x + self.scene["moveStep"] * d for x, d in zip(p, move)]
                      for p, move in zip(self.before, self.rows("data-move", "h", 3))]
        self.triangles = self.list_triangles()
        equal([len(self.before), len(self.triangles)], [self.scene["vertices"], self.scene["triangles"]], "sizes")

    def rows(self, name, code, width):
        """Rows of a block, None where the page has no such block."""
        if name not in self.blocks:
            return None
        data = base64.b64decode(self.blocks[name])
        values = struct.unpack(f"<{len(data) // struct.calcsize(code)}{code}", data)
        return [list(values[i:i + width]) for i in range(0, len(values), width)]

    def list_triangles(self):
        """With a texture their corners are wedges, each of a vertex."""
        wedges = self.column("data-wedge", "I")
        if wedges is None:
            return self.rows("data-triangle", "I", 3)
        return [[wedges[corner] for corner in row] for row in self.rows("data-corner", "I", 3)]

    def column(self, name, code):
        rows = self.rows(name, code, 1)
        return None if rows is None else [row[0] for row in rows]

    def positions(self):
        low, step = self.scene["low"], self.scene["step"]
        return [[a + s * x for a, s, x in zip(low, step, row)] for row in self.rows("data-before", "H", 3)]

    @property
    def numbers(self):
        """Of the vertices, in the order of ffd embed."""
        code = "d" if self.scene["numberSize"] == 8 else "I"
        found = self.column("data-number", code)
        return list(range(len(self.before))) if found is None else [int(n) for n in found]

    @property
    def statuses(self):
        return self.column("data-status", "B")

    @property
    def dets(self):
        return self.column("data-det", "f")

    @property
    def flipped(self):
        return self.column("data-flipped", "B")

    def cage(self, number):
        """Control points at rest and deformed."""
        rows = self.rows(f"data-cage-{number}", "d", 6)
        return [row[:3] for row in rows], [row[3:] for row in rows]

    def tears(self):
        """(numbers of the ends, step) of each torn edge that is listed."""
        return [(tuple(end["number"] for end in tear["ends"]), tear["step"]) for tear in self.scene["tears"]]

    def names(self):
        return [part["name"] for part in self.scene["parts"]]


def read_page(run, name):
    return Page(run.read(name))
