"""The package as users have it: `bash python/test.sh` builds it and runs this."""

import hashlib
import os
import pathlib
import subprocess
import tempfile
import threading
import unittest

import rings
import snell

ROOT = pathlib.Path(__file__).resolve().parents[2]


def ball(**settings):
    scene = snell.Scene(width=40, height=30, **settings)
    scene.add("camera", snell.Camera(position=(0, 1, 5)))
    scene.add("sun", snell.DirectionalLight(direction=(-1, -2, -1)))
    scene.add("ball", snell.Sphere(radius=1), snell.Color("#e07050"), snell.Diffuse(0.8))
    return scene


class Scenes(unittest.TestCase):
    def test_the_picture_is_that_of_the_command_line(self):
        scene = ball(background=(0.4, 0.6, 0.8))
        scene.add("floor", snell.Plane, snell.Checker(odd=0.3), snell.Transform([snell.Translate((0, -1, 0))]))
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "ball.ron"
            scene.save(path)
            program = os.environ.get("SNELL", ROOT / "target/debug/snell")
            if not os.path.exists(program):
                self.skipTest(f"{program} is not built")
            told = subprocess.run([program, "hash", "--quiet", path], capture_output=True, text=True, check=True).stdout
            self.assertIn(scene.render().hash, told)
            self.assertEqual(snell.render(path).hash, scene.render(threads=2).hash)

    def test_pixels_are_what_the_hash_is_of(self):
        picture = ball().render()
        self.assertEqual(picture.shape, (30, 40, 3))
        self.assertEqual(len(picture.tobytes()), 30 * 40 * 12)
        self.assertEqual(len(picture.tobytes8()), 30 * 40 * 3)
        self.assertEqual(len(picture.hash), len(hashlib.sha256().hexdigest()))
        self.assertNotEqual(picture.pixel(20, 16), picture.pixel(0, 0))
        self.assertIsNone(picture.pixel(40, 0))
        self.assertGreater(picture.rays, 30 * 40)

    def test_a_region_is_that_part_of_the_whole(self):
        whole, part = ball().render(), ball().render(region=(10, 8, 20, 15))
        self.assertEqual(part.shape, (15, 20, 3))
        self.assertEqual(part.pixel(3, 4), whole.pixel(13, 12))

    def test_every_kind_of_value_is_written_as_scene_files_have_it(self):
        word = snell.Thing(1, 0.5, True, "a\"b\\c\n", (1, 2.5), [snell.Four], name=snell.Inner(x=-1e-300))
        self.assertEqual(str(word), 'Thing(1, 0.5, true, "a\\"b\\\\c\\u{a}", (1, 2.5), [Four], name: Inner(x: -1e-300))')
        for bad, error in [(float("nan"), ValueError), (float("inf"), ValueError), (None, TypeError), ({}, TypeError)]:
            with self.assertRaises(error):
                snell.Sphere(radius=bad)

    def test_faults_name_what_is_wrong_and_what_is_near(self):
        with self.assertRaises(snell.SceneError) as caught:
            ball().add("b", snell.Spere(radius=1)).add("c", snell.Sphere(radios=1)).render()
        text = str(caught.exception)
        for part in ["Spere", "`Sphere`", "radios", "`radius`"]:
            self.assertIn(part, text)
        with self.assertRaises(snell.SceneError):
            snell.Scene().add("ball", snell.Sphere(radius=-1)).render()
        with self.assertRaises(TypeError):
            snell.Scene().add("ball", "Sphere")

    def test_pictures_are_saved_by_the_ending_of_the_name(self):
        picture = ball().render()
        with tempfile.TemporaryDirectory() as folder:
            for name, begin in [("a.png", b"\x89PNG"), ("a.exr", b"\x76\x2f\x31\x01")]:
                path = pathlib.Path(folder) / name
                picture.save(path)
                self.assertTrue(path.read_bytes().startswith(begin))
            with self.assertRaises(OSError):
                picture.save(pathlib.Path(folder) / "a.gif")

    def test_threads_of_python_draw_side_by_side(self):
        hashes = [None] * 4

        def draw(i):
            hashes[i] = ball().render(threads=1).hash

        threads = [threading.Thread(target=draw, args=(i,)) for i in range(4)]
        [thread.start() for thread in threads]
        [thread.join() for thread in threads]
        self.assertEqual(set(hashes), {ball().render().hash})


class Outside(unittest.TestCase):
    """Shapes, lights and textures of another crate, which nothing here names but these tests."""

    def test_they_are_words_like_any_other(self):
        scene = snell.Scene(native=rings, width=40, height=30)
        scene.add("camera", snell.Camera(position=(0, 2, 5), target=(0, 0, 0)))
        scene.add("beam", snell.Beam(position=(0, 5, 0), direction=(0, -1, 0), radius=3))
        without = scene.render().hash
        scene.add("ring", snell.Torus(major=1, minor=0.35), snell.Stripes(), snell.Diffuse(0.8))
        self.assertNotEqual(scene.render().hash, without)

    def test_their_faults_are_told_as_those_of_built_in_ones(self):
        scene = snell.Scene(native=rings).add("camera", snell.Camera()).add("ring", snell.Torus(mayor=1, minor=0.35))
        with self.assertRaises(snell.SceneError) as caught:
            scene.render()
        self.assertIn("mayor", str(caught.exception))
        self.assertIn("`major`", str(caught.exception))

    def test_without_their_module_they_are_unknown(self):
        with self.assertRaises(snell.SceneError):
            snell.Scene().add("camera", snell.Camera()).add("ring", snell.Torus(major=1, minor=0.35)).render()


if __name__ == "__main__":
    unittest.main()
