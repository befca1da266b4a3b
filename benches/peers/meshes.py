"""Meshes in the form that all contestants read."""

import array
import lzma
import math
import random
import struct
from pathlib import Path


class Mesh:
    """An indexed triangle mesh: flat arrays of coordinates and of corners."""

    def __init__(self, positions, corners):
        self.positions = array.array("f", positions)
        self.corners = array.array("I", corners)

    def write_tri(self, path):
        """Counts of vertices and triangles, positions, corners; all little-endian and of 32 bits."""
        with open(path, "wb") as file:
            file.write(struct.pack("<II", len(self.positions) // 3, len(self.corners) // 3))
            file.write(self.positions.tobytes())
            file.write(self.corners.tobytes())

    @staticmethod
    def read_tri(path):
        """What `write_tri` wrote."""
        with open(path, "rb") as file:
            vertices, triangles = struct.unpack("<II", file.read(8))
            mesh = Mesh([], [])
            mesh.positions.fromfile(file, 3 * vertices)
            mesh.corners.fromfile(file, 3 * triangles)
            return mesh

    def write_obj(self, path):
        """Nine digits, so that every reader gets the same `f32`."""
        with open(path, "w") as file:
            file.writelines(f"v {x:.9g} {y:.9g} {z:.9g}\n" for x, y, z in self.vertices())
            file.writelines(f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in self.triangles())

    def normals(self):
        """A unit normal a vertex: the mean of those of the faces around it, weighted by area."""
        sums = [[0.0, 0.0, 0.0] for _ in range(len(self.positions) // 3)]
        points = list(self.vertices())
        for face in self.triangles():
            a, b, c = (points[i] for i in face)
            e, f = [[q[i] - a[i] for i in range(3)] for q in (b, c)]
            normal = (e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2], e[0] * f[1] - e[1] * f[0])
            for i in face:
                for axis in range(3):
                    sums[i][axis] += normal[axis]
        lengths = (math.sqrt(x * x + y * y + z * z) for x, y, z in sums)
        return [(x / l, y / l, z / l) if l > 0 else (0, 1, 0) for (x, y, z), l in zip(sums, lengths)]

    def vertices(self):
        return zip(*[iter(self.positions)] * 3)

    def triangles(self):
        return zip(*[iter(self.corners)] * 3)


def read_obj(path):
    """The vertices and triangles of an OBJ file, which may be packed with xz; standing on the floor, two units large.

    Reads what the scanned models hold: `v` and `f` with indices from 1. Polygons are cut as fans.
    """
    opened = lzma.open(path, "rt") if path.suffix == ".xz" else open(path)
    positions, corners = array.array("d"), array.array("I")
    with opened as lines:
        for line in lines:
            if line.startswith("v "):
                positions.extend(map(float, line.split()[1:4]))
            elif line.startswith("f "):
                face = [int(word.split("/")[0]) - 1 for word in line.split()[1:]]
                for i in range(1, len(face) - 1):
                    corners.extend((face[0], face[i], face[i + 1]))
    low = [min(positions[axis::3]) for axis in range(3)]
    high = [max(positions[axis::3]) for axis in range(3)]
    scale = 2 / max(h - l for l, h in zip(low, high))
    origin = [(low[0] + high[0]) / 2, low[1], (low[2] + high[2]) / 2]
    moved = ((x - origin[i % 3]) * scale for i, x in enumerate(positions))
    return Mesh(moved, corners)


def soup(count, size, seed):
    """Random triangles in the unit cube, their corners up to `size` from a random centre along each axis."""
    numbers = random.Random(seed)
    positions = array.array("f")
    for _ in range(count):
        center = [numbers.random() for _ in range(3)]
        for _ in range(3):
            positions.extend(c + size * (2 * numbers.random() - 1) for c in center)
    return Mesh(positions, range(3 * count))


def subjects(data):
    """Names of all meshes, and how to make each; `data` is the folder of scanned models."""
    scanned = {
        "bunny": "stanford_bunny/stanford-bunny.obj",
        "dragon": "stanford_dragon/dragon_vrip.obj.xz",
    }
    made = {name: (lambda path=Path(data, "meshes", file): read_obj(path)) for name, file in scanned.items()}
    made["sparse"] = lambda: soup(30_000, 0.005, 1)
    made["dense"] = lambda: soup(30_000, 0.15, 2)
    return made
