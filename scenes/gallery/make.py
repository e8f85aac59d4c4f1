#!/usr/bin/env python3
"""Writes room.obj and furniture.obj: an L of two halls with a colonnade between them. Millimetres, z is up."""

from math import cos, pi, sin
from pathlib import Path

HEIGHT = 4000
BAYS = [0, 3000, 6000, 9000]          # the hall along the windows: y from 0 to 4000
FRONT, NARROW, BACK = 4000, 5000, 9000  # the second hall: x from 0 to 5000, y from 4000 to 9000
COLUMNS, RADIUS = [1250, 2500, 3750], 250


class Mesh:
    def __init__(self, comment):
        self.lines = [f"# {comment} Written by make.py.", "mtllib gallery.mtl"]
        self.indices = {}

    def of(self, name, material):
        self.lines += [f"o {name}", f"usemtl {material}"]

    def vertex(self, point):
        """Each point is written once, so that neighbours share it."""
        if point not in self.indices:
            self.indices[point] = len(self.indices) + 1
            self.lines.append("v " + " ".join(f"{c:g}" for c in point))
        return self.indices[point]

    def face(self, *points):
        """Counter-clockwise as seen from the front."""
        self.lines.append("f " + " ".join([str(self.vertex(p)) for p in points]))

    def write(self, name):
        # Vertices first, as most programs expect them after each other.
        head = [line for line in self.lines if line[0] in "#m"]
        vertices = [line for line in self.lines if line[0] == "v"]
        rest = [line for line in self.lines if line[0] in "ouf"]
        Path(__file__).with_name(name).write_text("\n".join(head + vertices + rest) + "\n")


def around(x, y, radius, angles):
    """Points of a circle; in whole tenths, so that both sides of a seam agree."""
    return [(round(x + radius * cos(a * pi / 180), 1), round(y + radius * sin(a * pi / 180), 1)) for a in angles]


def wall(mesh, p, q):
    """From p to q with the room to the left."""
    mesh.face((*q, 0), (*p, 0), (*p, HEIGHT), (*q, HEIGHT))


def window(mesh, x0, x1):
    """A bay of the wall y = 0: a frame of four faces round a pane."""
    outer = [(x1, 0, 0), (x0, 0, 0), (x0, 0, HEIGHT), (x1, 0, HEIGHT)]
    inner = [(x1 - 600, 0, 900), (x0 + 600, 0, 900), (x0 + 600, 0, 3300), (x1 - 600, 0, 3300)]
    mesh.of("south", "plaster")
    for i in range(4):
        j = (i + 1) % 4
        mesh.face(outer[i], outer[j], inner[j], inner[i])
    mesh.of("windows", "glass")
    mesh.face(*inner)


def box(mesh, low, high, name, material, below=None):
    """A solid, seen from outside; its underside may be of another material."""
    (x0, y0, z0), (x1, y1, z1) = low, high
    mesh.of(name, material)
    mesh.face((x0, y0, z1), (x1, y0, z1), (x1, y1, z1), (x0, y1, z1))
    mesh.face((x0, y0, z0), (x1, y0, z0), (x1, y0, z1), (x0, y0, z1))
    mesh.face((x1, y0, z0), (x1, y1, z0), (x1, y1, z1), (x1, y0, z1))
    mesh.face((x1, y1, z0), (x0, y1, z0), (x0, y1, z1), (x1, y1, z1))
    mesh.face((x0, y1, z0), (x0, y0, z0), (x0, y0, z1), (x0, y1, z1))
    mesh.of(name, below or material)
    mesh.face((x0, y1, z0), (x1, y1, z0), (x1, y0, z0), (x0, y0, z0))


def octahedron(mesh, centre, radius, name, material):
    x, y, z = centre
    belt = [(x + radius, y, z), (x, y + radius, z), (x - radius, y, z), (x, y - radius, z)]
    mesh.of(name, material)
    for i in range(4):
        a, b = belt[i], belt[(i + 1) % 4]
        mesh.face(a, b, (x, y, z + 1.5 * radius))
        mesh.face(b, a, (x, y, z - 1.5 * radius))


def room():
    mesh = Mesh("Two halls with a colonnade between them, closed, seen from inside.")
    # The seam between the halls runs through the columns, so that each floor is one outline with their halves cut out.
    seam_front, seam_back = [], []
    for x in COLUMNS:
        seam_front = around(x, FRONT, RADIUS, range(0, -181, -45)) + seam_front
        seam_back += around(x, FRONT, RADIUS, range(180, -1, -45))
    front = [(x, 0) for x in BAYS] + [(BAYS[-1], FRONT), (NARROW, FRONT)] + seam_front + [(0, FRONT)]
    back = [(0, FRONT)] + seam_back + [(NARROW, FRONT), (NARROW, BACK), (0, BACK)]
    mesh.of("floor", "stone")
    for outline in front, back:
        mesh.face(*[(*p, 0) for p in outline])
    mesh.of("ceiling", "plaster")
    for outline in front, back:
        mesh.face(*[(*p, HEIGHT) for p in reversed(outline)])
    for x0, x1 in zip(BAYS, BAYS[1:]):
        window(mesh, x0, x1)
    mesh.of("east", "ultramarine")
    wall(mesh, (BAYS[-1], 0), (BAYS[-1], FRONT))
    mesh.of("corner", "plaster")
    wall(mesh, (BAYS[-1], FRONT), (NARROW, FRONT))
    wall(mesh, (NARROW, FRONT), (NARROW, BACK))
    mesh.of("north", "ochre")
    wall(mesh, (NARROW, BACK), (0, BACK))
    mesh.of("west", "terracotta")
    wall(mesh, (0, BACK), (0, FRONT))
    wall(mesh, (0, FRONT), (0, 0))
    for number, x in enumerate(COLUMNS, 1):
        mesh.of(f"column{number}", "plaster")
        shaft = around(x, FRONT, RADIUS, range(180, -180, -45))
        for p, q in zip(shaft, shaft[1:] + shaft[:1]):
            wall(mesh, p, q)
    mesh.write("room.obj")


def furniture():
    mesh = Mesh("Benches, pendants and three suspended octahedra: closed solids that touch nothing.")
    box(mesh, (1500, 1700, 80), (3900, 2200, 450), "bench", "oak")
    box(mesh, (1300, 6600, 80), (3700, 7100, 450), "bench", "oak")
    box(mesh, (1000, 5400, 2900), (1600, 6000, 3000), "pendant", "plaster", below="lamp")
    box(mesh, (3400, 5400, 2900), (4000, 6000, 3000), "pendant", "plaster", below="lamp")
    octahedron(mesh, (7300, 2300, 1500), 500, "first", "ochre")
    octahedron(mesh, (6300, 2900, 2100), 300, "second", "terracotta")
    octahedron(mesh, (8200, 3100, 2500), 350, "third", "ultramarine")
    mesh.write("furniture.obj")


room()
furniture()
