#!/usr/bin/python3
"""Writes drum.stl: the mantle and the two ends of a drum about the y axis, in mm, as text.

    make_drum.py [FACETS] > drum.stl

The middles of the mantle's facets lie at the radius, so that particles see the same gap as in a round drum. The ends
are cut into the sectors of the mantle, so that the mesh is watertight. Normals point outwards.
"""
import math
import sys

RADIUS, LENGTH = 50.0, 16.0  # mm


def drum(facets):
    corner_radius = RADIUS / math.cos(math.pi / facets)
    corners = [(corner_radius * math.sin(2 * math.pi * i / facets), -corner_radius * math.cos(2 * math.pi * i / facets))
               for i in range(facets)]
    front, back = -LENGTH / 2, LENGTH / 2
    for i, (x, z) in enumerate(corners):
        u, w = corners[(i + 1) % facets]
        yield (x, front, z), (u, back, w), (u, front, w)
        yield (x, front, z), (x, back, z), (u, back, w)
        yield (0, front, 0), (x, front, z), (u, front, w)
        yield (0, back, 0), (u, back, w), (x, back, z)


def main():
    facets = int(sys.argv[1]) if len(sys.argv) > 1 else 96
    print("solid drum")
    for triangle in drum(facets):
        a, b, c = triangle
        e = [b[k] - a[k] for k in range(3)]
        f = [c[k] - a[k] for k in range(3)]
        n = (e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2], e[0] * f[1] - e[1] * f[0])
        size = math.sqrt(sum(k * k for k in n))
        print(" facet normal " + " ".join(f"{k / size:.6g}" for k in n) + "\n  outer loop")
        for corner in triangle:
            print("   vertex " + " ".join(f"{k:.7g}" for k in corner))
        print("  endloop\n endfacet")
    print("endsolid drum")


main()
