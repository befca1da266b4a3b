"""Scenes in Python: they are written as the text that scene files hold, and read by the same reader."""

import math

from . import snell_native


class Word:
    """A word of the scene format: `Word("Plane")`; with fields, `Word("Sphere")(radius=1)`."""

    def __init__(self, name, fields=""):
        if not name.isidentifier():
            raise ValueError(f"a word is letters, digits and underscores, not {name!r}")
        self.name, self.fields = name, fields

    def __call__(self, *values, **fields):
        parts = [written(value) for value in values]
        parts += [f"{_field(key)}: {written(value)}" for key, value in fields.items()]
        return Word(self.name, f"({', '.join(parts)})")

    def __str__(self):
        return self.name + self.fields

    def __repr__(self):
        return f"snell.{self}"


class Scene:
    """Named entities made of components, and settings.

    `native` is a module that `snell_native::fill` made, for components that are not built in.
    """

    def __init__(self, *, native=snell_native, **settings):
        self._native = native
        self.settings = settings
        self.entities = {}

    def add(self, name, *components):
        """Adds an entity; one that has this name already is replaced."""
        for component in components:
            if not isinstance(component, Word):
                raise TypeError(f"{name}: expected a component such as snell.Sphere(radius=1), found {component!r}")
        self.entities[name] = components
        return self

    def to_text(self):
        """The scene as the text of a scene file."""
        settings = "".join(f"\n        {_field(key)}: {written(value)}," for key, value in self.settings.items())
        settings = f"    settings: ({settings}\n    ),\n" if settings else ""
        entities = "".join(
            f"        {written(name)}: [{', '.join(map(str, components))}],\n"
            for name, components in self.entities.items()
        )
        return f"Scene(\n    version: 1,\n{settings}    entities: {{\n{entities}    }},\n)\n"

    def save(self, path):
        """Writes the scene as a scene file."""
        with open(path, "w", encoding="utf-8", newline="\n") as file:
            file.write(self.to_text())

    def render(self, *, threads=None, region=None, path="scene.ron"):
        """Draws the scene; files that it names are looked for beside `path`.

        `region` is x, y, width and height in pixels. Raises `SceneError` with every fault of the scene.
        """
        return _drawn(self._native, lambda renderer: renderer.load_text(self.to_text(), path), threads, region)


def render(path, *, native=snell_native, threads=None, region=None):
    """Draws a scene file."""
    return _drawn(native, lambda renderer: renderer.load(path), threads, region)


def _drawn(native, read, threads, region):
    renderer = native.renderer()
    try:
        read(renderer)
        return renderer.render(threads, region)
    except native.SceneError as faults:
        # Each module has an error of its own; all are known as this one.
        raise snell_native.SceneError(str(faults)) from None


def written(value):
    """A value as scene files have it."""
    if isinstance(value, Word):
        return str(value)
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return _quoted(value)
    if isinstance(value, (tuple, list)) or hasattr(value, "tolist"):
        items = value.tolist() if hasattr(value, "tolist") else value
        if not isinstance(items, (tuple, list)):
            return written(items)
        texts = ", ".join(map(written, items))
        return f"[{texts}]" if isinstance(value, list) else f"({texts})"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        if not math.isfinite(value):
            raise ValueError(f"scenes hold finite numbers, not {value}")
        return repr(value)
    raise TypeError(f"scenes hold numbers, text, tuples, lists and words, not {value!r}")


def _quoted(text):
    escaped = {'"': '\\"', "\\": "\\\\"}
    return '"' + "".join(escaped.get(c, c if c.isprintable() else f"\\u{{{ord(c):x}}}") for c in text) + '"'


def _field(key):
    if not key.isidentifier():
        raise ValueError(f"a field is letters, digits and underscores, not {key!r}")
    return key
