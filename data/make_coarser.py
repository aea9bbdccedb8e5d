#!/usr/bin/env python3
"""Makes coarser levels of detail of an OBJ, for the recipe "Do in ffd what you did by hand in another program".

    python3 data/make_coarser.py MESH.obj SIZE >COARSER.obj

Vertices in one cube of the side SIZE become one, at their mean. Positions and faces only; the same bytes every time.
"""

import sys


def main():
    mesh, size = sys.argv[1], float(sys.argv[2])
    cubes, at, faces = {}, [], {}
    with open(mesh, encoding="ascii") as file:
        for words in map(str.split, file):
            if words[:1] == ["v"]:
                place = tuple(map(float, words[1:4]))
                members = cubes.setdefault(tuple(x // size for x in place), (len(cubes) + 1, []))
                members[1].append(place)
                at.append(members[0])
            elif words[:1] == ["f"]:
                corners = list(dict.fromkeys(at[int(word.split("/")[0]) - 1] for word in words[1:]))
                if len(corners) > 2:
                    faces.setdefault(frozenset(corners), corners)
    for _, members in cubes.values():
        print("v", *(f"{sum(axis) / len(members):.6f}" for axis in zip(*members)))
    for corners in faces.values():
        print("f", *corners)


if __name__ == "__main__":
    main()
