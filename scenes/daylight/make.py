#!/usr/bin/env python3
"""Writes room.obj and the luminaires: a room with a window to the south, a house across the street. Metres, z up, y north."""

from math import cos, radians, sin
from pathlib import Path

WIDTH, DEPTH, HEIGHT, WALL = 5, 4, 2.8, 0.3
LEFT, RIGHT, SILL, LINTEL = 1.1, 3.9, 0.8, 2.4


class Mesh:
    def __init__(self):
        self.lines, self.indices = ["# A room with a window. Written by make.py.", "mtllib room.mtl"], {}

    def of(self, name, material):
        self.lines += [f"o {name}", f"usemtl {material}"]

    def vertex(self, point):
        if point not in self.indices:
            self.indices[point] = len(self.indices) + 1
            self.lines.append("v " + " ".join(f"{c:g}" for c in point))
        return self.indices[point]

    def face(self, *points):
        """Counter-clockwise as seen from the front."""
        self.lines.append("f " + " ".join([str(self.vertex(p)) for p in points]))

    def box(self, low, high):
        """A solid, seen from outside."""
        (x0, y0, z0), (x1, y1, z1) = low, high
        self.face((x0, y0, z1), (x1, y0, z1), (x1, y1, z1), (x0, y1, z1))
        self.face((x0, y0, z0), (x1, y0, z0), (x1, y0, z1), (x0, y0, z1))
        self.face((x1, y0, z0), (x1, y1, z0), (x1, y1, z1), (x1, y0, z1))
        self.face((x1, y1, z0), (x0, y1, z0), (x0, y1, z1), (x1, y1, z1))
        self.face((x0, y1, z0), (x0, y0, z0), (x0, y0, z1), (x0, y1, z1))
        self.face((x0, y1, z0), (x1, y1, z0), (x1, y0, z0), (x0, y0, z0))

    def write(self):
        head = [line for line in self.lines if line[0] in "#m"]
        vertices = [line for line in self.lines if line[0] == "v"]
        rest = [line for line in self.lines if line[0] in "ouf"]
        Path(__file__).with_name("room.obj").write_text("\n".join(head + vertices + rest) + "\n")


def room(mesh):
    w, d, h = WIDTH, DEPTH, HEIGHT
    mesh.of("floor", "oak")
    mesh.face((0, 0, 0), (w, 0, 0), (w, d, 0), (0, d, 0))
    mesh.of("ceiling", "white")
    mesh.face((0, 0, h), (0, d, h), (w, d, h), (w, 0, h))
    mesh.of("west", "ochre")
    mesh.face((0, 0, 0), (0, d, 0), (0, d, h), (0, 0, h))
    mesh.of("east", "white")
    mesh.face((w, 0, 0), (w, 0, h), (w, d, h), (w, d, 0))
    mesh.of("north", "white")
    mesh.face((0, d, 0), (w, d, 0), (w, d, h), (0, d, h))
    # The south wall is a frame of four faces round the opening, whose sides are as deep as the wall.
    outer = [(w, 0, 0), (0, 0, 0), (0, 0, h), (w, 0, h)]
    inner = [(RIGHT, 0, SILL), (LEFT, 0, SILL), (LEFT, 0, LINTEL), (RIGHT, 0, LINTEL)]
    far = [(x, -WALL, z) for x, _, z in inner]
    facade = [(x, -WALL, z) for x, _, z in outer]
    mesh.of("south", "white")
    for i in range(4):
        j = (i + 1) % 4
        mesh.face(outer[i], outer[j], inner[j], inner[i])
    mesh.of("reveal", "white")
    for i in range(4):
        j = (i + 1) % 4
        mesh.face(inner[i], inner[j], far[j], far[i])
    mesh.of("facade", "white")
    for i in range(4):
        j = (i + 1) % 4
        mesh.face(facade[j], facade[i], far[i], far[j])
    mesh.of("mullion", "white")
    middle = (LEFT + RIGHT) / 2
    mesh.box((middle - 0.03, -0.2, SILL), (middle + 0.03, -0.14, LINTEL))


def furniture(mesh):
    mesh.of("table", "oak")
    mesh.box((1.9, 1.5, 0.7), (3.5, 2.3, 0.74))
    for x in 2, 3.34:
        mesh.box((x, 1.6, 0), (x + 0.06, 2.2, 0.7))
    mesh.of("box", "blue")
    mesh.box((2.9, 1.7, 0.74), (3.2, 2, 1.04))


def outside(mesh):
    """The street up to the house across it, which hides the horizon from the room: no more than is seen."""
    mesh.of("ground", "ground")
    mesh.face((-18, -14, -0.3), (12, -14, -0.3), (12, 0, -0.3), (-18, 0, -0.3))
    mesh.of("house", "brick")
    mesh.box((-16, -17, -0.3), (9, -14, 2.6))
    mesh.of("shed", "white")
    mesh.box((-5, -13, -0.3), (-2.5, -11, 1.7))


def ies():
    """A downlight of 0.12 m: cos⁵γ up to 60 degrees."""
    gammas = list(range(0, 91, 5))
    candela = [round(900 * cos(radians(g)) ** 5 * max(0, min(1, (75 - g) / 15)), 1) for g in gammas]
    words = lambda numbers: " ".join(f"{n:g}" for n in numbers)
    text = f"""IESNA:LM-63-2002
[TEST] made by make.py, not measured
[MANUFAC] none
[LUMINAIRE] downlight
TILT=NONE
1 1200 1 {len(gammas)} 1 1 2 -0.12 -0.12 0
1 1 12
{words(gammas)}
0
{words(candela)}
"""
    Path(__file__).with_name("downlight.ies").write_text(text)


def ldt():
    """A wall washer of 0.2 × 0.1 m, brightest at 35 degrees towards C = 0, the same in the mirror of C = 0 and 180."""
    planes, gammas = list(range(0, 360, 30)), list(range(0, 181, 10))
    axis = radians(35)

    def value(c, g):
        cosine = sin(radians(g)) * cos(radians(c)) * sin(axis) + cos(radians(g)) * cos(axis)
        return round(1100 * max(0, cosine) ** 8 * (g < 90), 1)

    lines = ["none", 1, 2, len(planes), 30, len(gammas), 10, "made by make.py, not measured", "wall washer", 1, "wall.ldt", ""]
    lines += [200, 100, 50, 200, 100, 0, 0, 0, 0, 100, 78, 1, 0, 1, 1, "LED", 1500, 3000, 80, 15] + [0.5] * 10
    lines += planes + gammas + [value(c, g) for c in planes if c <= 180 for g in gammas]
    Path(__file__).with_name("wall.ldt").write_text("\n".join(map(str, lines)) + "\n")


mesh = Mesh()
room(mesh)
furniture(mesh)
outside(mesh)
mesh.write()
ies()
ldt()
