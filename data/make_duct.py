#!/usr/bin/env python3
"""Makes a duct of hexahedra, finer at its floor, for the recipe "A CFD mesh, and the cells that break".

    python3 data/make_duct.py >duct.su2

48 x 16 x 12 cells: flow along x, up along z. The same bytes every time.
"""

CELLS = (48, 16, 12)
LENGTH = (4, 1, 1)
GROWTH = 1.3  # from one layer of cells to the next, upward


def heights():
    """Where the layers lie, from 0 to 1."""
    sums = [0.0]
    for k in range(CELLS[2]):
        sums.append(sums[-1] + GROWTH**k)
    return [z / sums[-1] for z in sums]


def main():
    n, m, l = (count + 1 for count in CELLS)

    def point(i, j, k):
        return (k * m + j) * n + i

    print("NDIME= 3")
    print("NELEM=", CELLS[0] * CELLS[1] * CELLS[2])
    for k in range(CELLS[2]):
        for j in range(CELLS[1]):
            for i in range(CELLS[0]):
                base = [point(*corner) for corner in ((i, j, k), (i + 1, j, k), (i + 1, j + 1, k), (i, j + 1, k))]
                print(12, *base, *(corner + n * m for corner in base))
    print("NPOIN=", n * m * l)
    for z in heights():
        for j in range(m):
            for i in range(n):
                print(f"{LENGTH[0] * i / CELLS[0]:.6f} {LENGTH[1] * j / CELLS[1]:.6f} {LENGTH[2] * z:.6f}")
    sides = {
        "inlet": [(point(0, j, k), point(0, j, k + 1), point(0, j + 1, k + 1), point(0, j + 1, k)) for k in range(l - 1) for j in range(m - 1)],
        "outlet": [(point(n - 1, j, k), point(n - 1, j + 1, k), point(n - 1, j + 1, k + 1), point(n - 1, j, k + 1)) for k in range(l - 1) for j in range(m - 1)],
        "floor": [(point(i, j, 0), point(i, j + 1, 0), point(i + 1, j + 1, 0), point(i + 1, j, 0)) for j in range(m - 1) for i in range(n - 1)],
        "roof": [(point(i, j, l - 1), point(i + 1, j, l - 1), point(i + 1, j + 1, l - 1), point(i, j + 1, l - 1)) for j in range(m - 1) for i in range(n - 1)],
    }
    print("NMARK=", len(sides))
    for name, faces in sides.items():
        print(f"MARKER_TAG= {name}\nMARKER_ELEMS= {len(faces)}")
        for face in faces:
            print(9, *face)


if __name__ == "__main__":
    main()
