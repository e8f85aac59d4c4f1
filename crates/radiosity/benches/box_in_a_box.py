#!/usr/bin/env python3
"""Writes box-N.obj: the unit cube seen from inside, N × N squares a face, and a cube of side .4 in its centre, .4 N
squares a face, every square cut into two triangles. N = 5, 10, 20 make 348, 1392, 5568 triangles.

    python3 box_in_a_box.py 20 FOLDER
"""

import sys
from itertools import product
from pathlib import Path

MATERIAL = """# Emission and reflectance are the same everywhere: B = E/(1 − ρ) = 2 W/m².
newmtl wall
Kd 0.5 0.5 0.5
Ke 0.3183098861837907 0.3183098861837907 0.3183098861837907
"""


def cube(low, high, n, inwards):
    """The triangles of a cube's faces, counter-clockwise as seen from the front."""
    at = [low + (high - low) * k / n for k in range(n + 1)]
    for axis, far in product(range(3), (False, True)):
        def point(i, j):
            p = [high if far else low] * 3
            p[(axis + 1) % 3], p[(axis + 2) % 3] = at[i], at[j]
            return tuple(p)

        for i, j in product(range(n), repeat=2):
            corners = [point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)]
            if far == inwards:
                corners.reverse()
            a, b, c, d = corners
            yield from ((a, b, c), (a, c, d))


def main():
    n, folder = int(sys.argv[1]), Path(sys.argv[2])
    indices, lines = {}, [f"# A box in a box, {n} squares along a wall.", "mtllib box.mtl"]
    faces = ["usemtl wall"]
    for name, triangles in (("room", cube(0, 1, n, True)), ("block", cube(0.3, 0.7, 2 * n // 5, False))):
        faces.append(f"o {name}")
        for triangle in triangles:
            faces.append("f " + " ".join(str(indices.setdefault(p, len(indices) + 1)) for p in triangle))
    lines += ["v " + " ".join(f"{c:.17g}" for c in p) for p in indices]
    (folder / "box.mtl").write_text(MATERIAL)
    (folder / f"box-{n}.obj").write_text("\n".join(lines + faces) + "\n")


main()
