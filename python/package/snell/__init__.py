"""Snell: a Whitted ray tracer, the same picture to the last bit everywhere.

    import snell

    scene = snell.Scene(width=320, height=240, background=(0.4, 0.6, 0.8))
    scene.add("camera", snell.Camera(position=(0, 1, 5)))
    scene.add("sun", snell.DirectionalLight(direction=(-1, -2, -1)))
    scene.add("ball", snell.Sphere(radius=1), snell.Diffuse(0.8), snell.Mirror(0.2))
    scene.render().save("ball.png")

Every component of the scene format is a name here, with the fields that `scenes/README.md` lists; so are the words that
fields take, as in `snell.Checker(filter=snell.Trilinear)`.
"""

from .scene import Scene, Word, render
from .snell_native import Picture, SceneError

__all__ = ["Picture", "Scene", "SceneError", "Word", "render"]


def __getattr__(name):
    # Which words there are only the renderer knows, which tells what is wrong with one when a scene is read.
    if not name[:1].isupper():
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return Word(name)
