"""Whole scenes, told once and written in the form of each renderer.

Models match term by term: point lights without fall-off and with hard shadows, ambient and Lambert terms, Phong's
highlight, a perfect mirror, clear glass with Fresnel's equations, four bounces, rays below 1/255 not followed, one ray
through the centre of each pixel.
"""

import math
from dataclasses import dataclass, field, replace
from pathlib import Path

import meshes

WIDTH, HEIGHT, BOUNCES, CUTOFF = 800, 600, 4, 1 / 255


@dataclass(frozen=True)
class Material:
    color: tuple = (1, 1, 1)
    ambient: float = 0
    diffuse: float = 0
    highlight: float = 0
    exponent: float = 1
    mirror: float = 0
    index: float = 0  # of clear glass; 0 for what is not clear


@dataclass(frozen=True)
class Scene:
    eye: tuple
    target: tuple
    lights: list  # positions
    light: float = 1  # strength of each
    up: tuple = (0, 1, 0)
    vertical_angle: float = 2 * math.degrees(math.atan(math.tan(math.radians(22.5)) * HEIGHT / WIDTH))
    background: tuple = (0.5, 0.7, 0.9)
    floor: bool = False  # y = 0, checkered in units of 1
    mesh: str = ""  # name of a file made by meshes.py
    smooth: bool = False
    mesh_material: Material = Material((0.8, 0.6, 0.4), ambient=0.1, diffuse=0.8)
    spheres: list = field(default_factory=list)  # (centre, radius, material)


FLOOR = Material(ambient=0.1, diffuse=0.8)
BRIGHT, DARK = 0.9, 0.15


def table(mesh):
    """A mesh between a mirror and a glass ball on a checkered floor."""
    return Scene(
        eye=(0, 1.8, 6),
        target=(0, 0.85, 0),
        lights=[(5, 8, 6)],
        floor=True,
        mesh=mesh,
        smooth=True,
        mesh_material=Material((0.75, 0.55, 0.4), ambient=0.1, diffuse=0.8, highlight=0.3, exponent=40),
        spheres=[
            ((-1.9, 0.9, -1), 0.9, Material(diffuse=0.05, mirror=0.9)),
            ((1.05, 0.6, 1.6), 0.6, Material(index=1.5)),
        ],
    )


def soup(mesh):
    return Scene(eye=(1.1, 1, 2.4), target=(0.5, 0.5, 0.5), lights=[(2.5, 3.5, 2.5)], mesh=mesh)


def flake(levels):
    """Half mirroring balls, each with nine of a third of its size about it: 7 381 for four levels."""
    material = Material((1, 0.9, 0.7), diffuse=0.5, mirror=0.5)
    spheres = []

    def grow(center, radius, axis, level):
        spheres.append((center, radius, material))
        if level == 0:
            return
        side = cross(axis, (1, 0, 0) if abs(axis[0]) < 0.5 else (0, 1, 0))
        side = scaled(side, 1 / math.sqrt(dot(side, side)))
        other = cross(axis, side)
        for count, height, turn in ((6, 0.0, 0.0), (3, 0.8, 0.5)):
            for i in range(count):
                angle = 2 * math.pi * (i + turn) / count
                flat = math.sqrt(1 - height * height)
                around = added(scaled(side, flat * math.cos(angle)), scaled(other, flat * math.sin(angle)))
                way = added(around, scaled(axis, height))
                grow(added(center, scaled(way, radius * 4 / 3)), radius / 3, way, level - 1)

    grow((0, 0.5, 0), 0.5, (0, 1, 0), levels)
    return Scene(
        eye=(2.1, 1.7, 1.3), target=(0, 0.45, 0), lights=[(4, 2, -3), (1, 4, 4), (-3, 5, 1)], light=0.577,
        background=(0.078, 0.361, 0.753), floor=True, spheres=spheres,
    )  # fmt: skip


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def scaled(a, factor):
    return tuple(x * factor for x in a)


def added(a, b):
    return tuple(x + y for x, y in zip(a, b))


SCENES = {
    "bunny": lambda: table("bunny"),
    "dragon": lambda: table("dragon"),
    "flake": lambda: flake(4),
    "sparse": lambda: soup("sparse"),
    "dense": lambda: soup("dense"),
}


def numbers(values, joint=", "):
    return joint.join(f"{value:.9g}" for value in values)


def write_ron(scene, obj, path):
    """For Snell; the mesh is an OBJ file."""

    def effects(m):
        if m.index:
            return f"Dielectric({m.index})"
        parts = [f"Color(({numbers(m.color)}))", f"Ambient({m.ambient})", f"Diffuse({m.diffuse})"]
        if m.highlight:
            parts.append(f"Highlight(strength: {m.highlight}, exponent: {m.exponent})")
        if m.mirror:
            parts.append(f"Mirror({m.mirror})")
        return ", ".join(parts)

    with open(path, "w") as out:
        line = lambda text: out.write(text + "\n")
        line("Scene(version: 1,")
        line(f" settings: (width: {WIDTH}, height: {HEIGHT}, depth: {BOUNCES}, cutoff: {CUTOFF:.9g},")
        line(f"  background: ({numbers(scene.background)})),")
        line(' entities: { "sky": [AmbientLight(1)],')
        line(f'  "eye": [Camera(position: ({numbers(scene.eye)}), target: ({numbers(scene.target)}),')
        line(f"   up: ({numbers(scene.up)}), field_of_view: {scene.vertical_angle:.12g})],")
        for i, at in enumerate(scene.lights):
            line(f'  "lamp{i}": [PointLight(position: ({numbers(at)}), intensity: {scene.light})],')
        if scene.floor:
            line(f'  "floor": [Plane, Checker(even: {DARK}, odd: {BRIGHT}), {effects(FLOOR)}],')
        if scene.mesh:
            shading = "Smooth" if scene.smooth else "Flat"
            line(f'  "mesh": [Mesh(model: "{obj}", shading: {shading}), {effects(scene.mesh_material)}],')
        for i, (center, radius, material) in enumerate(scene.spheres):
            line(f'  "ball{i}": [Sphere(radius: {radius:.9g}), Transform([Translate(({numbers(center)}))]),')
            line(f"   {effects(material)}],")
        line(" })")


def write_text(scene, tri, path):
    """For the renderer on Embree; the mesh is a `.tri` file."""

    def material(out, m):
        values = [*m.color, m.ambient, m.diffuse, m.highlight, m.exponent, m.mirror, m.index]
        out.write(f"material {numbers(values, ' ')}\n")

    with open(path, "w") as out:
        view = [*scene.eye, *scene.target, *scene.up, scene.vertical_angle]
        out.write(f"camera {numbers(view, ' ')}\nbackground {numbers(scene.background, ' ')}\n")
        for at in scene.lights:
            out.write(f"light {numbers([*at, scene.light], ' ')}\n")
        if scene.floor:
            material(out, FLOOR)
            out.write(f"floor {BRIGHT} {DARK}\n")
        if scene.mesh:
            material(out, scene.mesh_material)
            out.write(f"mesh {int(scene.smooth)} {tri}\n")
        last = None
        for center, radius, of in scene.spheres:
            if of != last:
                material(out, of)
                last = of
            out.write(f"sphere {numbers([*center, radius], ' ')}\n")


def write_pov(scene, mesh, path):
    """For POV-Ray; the mesh is written into the scene."""

    def finish(m):
        if m.index:
            glass = "ambient 0 diffuse 0 reflection { 0, 1 fresnel on } conserve_energy"
            return f"pigment {{ rgbf 1 }} finish {{ {glass} }} interior {{ ior {m.index} }}"
        shine = f"phong {m.highlight} phong_size {m.exponent} " if m.highlight else ""
        shine += f"reflection {m.mirror} " if m.mirror else ""
        return f"pigment {{ rgb <{numbers(m.color)}> }} finish {{ ambient {m.ambient} diffuse {m.diffuse} {shine}}}"

    with open(path, "w") as out:
        line = lambda text: out.write(text + "\n")
        line("#version 3.7;")
        line(f"global_settings {{ assumed_gamma 1 max_trace_level {BOUNCES + 1} ambient_light 1 }}")
        line(f"background {{ rgb <{numbers(scene.background)}> }}")
        across = 2 * math.degrees(math.atan(math.tan(math.radians(scene.vertical_angle / 2)) * WIDTH / HEIGHT))
        line(f"camera {{ perspective location <{numbers(scene.eye)}> right <-{WIDTH}/{HEIGHT}, 0, 0> up y")
        line(f" sky <{numbers(scene.up)}> angle {across:.12g} look_at <{numbers(scene.target)}> }}")
        for at in scene.lights:
            line(f"light_source {{ <{numbers(at)}> rgb {scene.light} }}")
        if scene.floor:
            squares = f"pigment {{ checker rgb {BRIGHT} rgb {DARK} }}"
            line(f"plane {{ y, 0 {squares} finish {{ ambient {FLOOR.ambient} diffuse {FLOOR.diffuse} }} }}")
        for center, radius, of in scene.spheres:
            line(f"sphere {{ <{numbers(center)}>, {radius:.9g} {finish(of)} }}")
        if scene.mesh:
            vectors = lambda values: ", ".join(f"<{numbers(v)}>" for v in values)
            line(f"mesh2 {{ vertex_vectors {{ {len(mesh.positions) // 3}, {vectors(mesh.vertices())} }}")
            if scene.smooth:
                normals = mesh.normals()
                line(f"normal_vectors {{ {len(normals)}, {vectors(normals)} }}")
            corners = ", ".join(f"<{a}, {b}, {c}>" for a, b, c in mesh.triangles())
            line(f"face_indices {{ {len(mesh.corners) // 3}, {corners} }}")
            line(f"{finish(scene.mesh_material)} }}")
