#!/usr/bin/env python3
"""Makes a swept, tapered wing, for the recipe "A wing with a volume constraint that does not fold".

    python3 data/make_wing.py >wing.obj

24 sections of NACA 0012, 80 points each, closed at both ends: chord along x, thickness along y, span along z. The same
bytes every time.
"""

import math

ROUND, SECTIONS = 80, 24


def section():
    """Half an aerofoil's thickness at x, from the trailing edge along the lower side to the nose, and back along the upper one."""
    for k in range(ROUND):
        x = 0.5 * (1 + math.cos(2 * math.pi * k / ROUND))
        half = 0.6 * (0.2969 * math.sqrt(x) - 0.1260 * x - 0.3516 * x**2 + 0.2843 * x**3 - 0.1036 * x**4)
        yield x, half if 2 * k > ROUND else -half


def main():
    for row in range(SECTIONS):
        z = 2 * row / (SECTIONS - 1)
        chord = 1 - 0.25 * z
        for x, y in section():
            print(f"v {0.6 * z + chord * x:.6f} {chord * y:.6f} {z:.6f}")
    for row in range(SECTIONS - 1):
        for k in range(ROUND):
            a, b = row * ROUND + k + 1, row * ROUND + (k + 1) % ROUND + 1
            print("f", a, a + ROUND, b)
            print("f", b, a + ROUND, b + ROUND)
    last = (SECTIONS - 1) * ROUND
    for k in range(1, ROUND // 2 + 1):  # between the lower and the upper side: a bent section stays one
        upper, after = (ROUND + 1 - k) % ROUND + 1, ROUND + 1 - k
        for corners in ((k, k + 1, upper), (k + 1, after, upper)):
            if len(set(corners)) == 3:
                print("f", *corners)
                print("f", *(last + corner for corner in reversed(corners)))


if __name__ == "__main__":
    main()
