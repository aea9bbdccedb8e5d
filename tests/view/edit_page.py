"""Pages of ffd edit in a browser that stays open for all cases (edit.mjs), and what the tools of such a page do to control points,
worked out from section 8 of the interface, apart from the page."""

import array
import atexit
import base64
import json
import math
import os
import subprocess
import time

from harness import check, equal

HERE = os.path.dirname(os.path.abspath(__file__))
TYPES = {"Float32Array": "f", "Float64Array": "d", "Uint32Array": "I"}


class Browser:
    """Started with the first page."""

    def __init__(self, found, home):
        self.found, self.home, self.process = found, home, None

    def ask(self, **command):
        if self.process is None:
            self.process = subprocess.Popen(["node", os.path.join(HERE, "edit.mjs"), *self.found, self.home], stdin=subprocess.PIPE,
                                            stdout=subprocess.PIPE, env={**os.environ, "HOME": self.home}, text=True, encoding="utf-8")
            atexit.register(self.close)
        self.process.stdin.write(json.dumps(command) + "\n")
        self.process.stdin.flush()
        line = self.process.stdout.readline()
        check(line, "the browser ended")
        answer = json.loads(line)
        check("problem" not in answer, f"{command['do']}: {answer.get('problem')}")
        return answer["value"]

    def close(self):
        self.process.stdin.close()
        self.process.wait(timeout=20)

    def open(self, path, profile=None, width=640, height=480):
        """profile: a name; pages of one name find what others of it have stored."""
        number = self.ask(do="open", url="file://" + os.path.abspath(path), profile=profile, width=width, height=height,
                          name="edit-" + os.path.basename(path))
        return Page(self, number)


class Page:
    """Its methods are those of globalThis.ffdPage, but for the ones below."""

    def __init__(self, browser, number):
        self.browser, self.number = browser, number

    def __enter__(self):
        return self

    def __exit__(self, kind, *_):
        if kind is None:
            self.do("close")  # fails where the page has asked a network or written to the console

    def do(self, command, **members):
        return self.browser.ask(do=command, page=self.number, **members)

    def answer(self, name, *arguments):
        found = self.do("call", name=name, args=arguments)
        check("missing" not in found, f"ffdPage has no {name}")
        return found

    def __getattr__(self, name):
        def call(*arguments):
            found = self.answer(name, *arguments)
            check("thrown" not in found, f"ffdPage.{name}{arguments}: {found.get('thrown')}")
            if "bytes" not in found:
                return found["value"]
            check(found["type"] in TYPES, f"ffdPage.{name} gives {found['type']}")
            return array.array(TYPES[found["type"]], base64.b64decode(found["bytes"]))
        return call

    def refuses(self, name, *arguments):
        return "thrown" in self.answer(name, *arguments)

    def state(self):
        """All that an edit changes, to the bit."""
        return self.offsets().tobytes(), self.positions().tobytes(), json.loads(self.lattice()), self.figures()


def wait_for(condition, what, seconds=10):
    limit = time.monotonic() + seconds
    while not condition():
        check(time.monotonic() < limit, what)
        time.sleep(0.02)


def rows(numbers):
    return [list(numbers[i:i + 3]) for i in range(0, len(numbers), 3)]


# The tools.

def plane_of(mirror):
    """A point of the plane and its unit normal."""
    if "axis" in mirror:
        normal = direction(mirror["axis"])
        return [mirror["at"] * n for n in normal], normal
    return mirror["point"], direction(mirror["normal"])


def direction(axis):
    if isinstance(axis, str):
        return [float(axis == name) for name in "xyz"]
    size = math.hypot(*axis)
    return [x / size for x in axis]


def reflected(p, plane):
    point, normal = plane
    far = sum((x - o) * n for x, o, n in zip(p, point, normal))
    return [x - 2 * far * n for x, n in zip(p, normal)]


def soft_weights(rest, places, radius):
    """Of each point at rest, by its distance to the nearest of the places. Without a radius: 1 at the places, else 0."""
    found = []
    for p in rest:
        x = min(math.dist(p, place) for place in places)
        if x <= 1e-9:
            found.append(1.0)
        else:
            found.append((1 - (x / radius) ** 2) ** 2 if radius and x < radius else 0.0)
    return found


def edited(rest, offsets, selected, action, radius=None, mirror=None):
    """The offsets after an action, a function of a point: p + weight (action(p) - p). Then its mirror image."""
    found = [list(d) for d in offsets]

    def apply(places, function):
        for i, weight in enumerate(soft_weights(rest, places, radius)):
            p = [a + b for a, b in zip(rest[i], found[i])]
            if weight:
                found[i] = [d + weight * (y - x) for d, x, y in zip(found[i], p, function(p))]

    places = [rest[i] for i in selected]
    apply(places, action)
    if mirror:
        plane = plane_of(mirror)
        apply([reflected(p, plane) for p in places], lambda p: reflected(action(reflected(p, plane)), plane))
    return found


def centroid(rest, offsets, selected):
    return [sum(rest[i][a] + offsets[i][a] for i in selected) / len(selected) for a in range(3)]


def moved(by):
    return lambda p: [x + d for x, d in zip(p, by)]


def scaled(factor, about):
    factors = factor if isinstance(factor, list) else [factor] * 3
    return lambda p: [o + f * (x - o) for x, f, o in zip(p, factors, about)]


def turned(axis, degrees, about):
    """By the formula of Rodrigues, right-handed."""
    k, a = direction(axis), math.radians(degrees)

    def turn(p):
        v = [x - o for x, o in zip(p, about)]
        along = sum(x * y for x, y in zip(k, v))
        across = [k[1] * v[2] - k[2] * v[1], k[2] * v[0] - k[0] * v[2], k[0] * v[1] - k[1] * v[0]]
        return [o + x * math.cos(a) + c * math.sin(a) + n * along * (1 - math.cos(a)) for o, x, c, n in zip(about, v, across, k)]
    return turn


def same_offsets(found, expected, size, what):
    """To 1e-9 of a size: the page works in double precision."""
    check(found.typecode == "d", f"{what}: offsets are no Float64Array")
    equal(len(found), 3 * len(expected), f"{what}: numbers of offsets")
    off = max(math.dist(d, e) for d, e in zip(rows(found), expected))
    check(off <= 1e-9 * size, f"{what}: an offset is {off} off")
