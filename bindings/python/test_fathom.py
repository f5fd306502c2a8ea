"""Tests of the Python module, against an installed `fathom` program: python3 test_fathom.py"""
import copy
import math
import os
import pathlib
import pickle
import subprocess
import sys
import tempfile
import threading
import unittest

import fathom
import numpy as np

BALL = 'fathom 1\nparam r = 1\nobject "ball" sphere(r)\n'
ENDLESS = BALL + "background [1, 1, 1]\ncamera (position = [0, 0, 4], target = [0, 0, 0])\n"


class Points(unittest.TestCase):
    def setUp(self):
        self.scene = fathom.compile(BALL)
        self.points = np.random.default_rng(1).uniform(-2, 2, (1000, 3))

    def test_distances_equal_those_of_the_program(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "ball.fathom")
            path.write_text(BALL)
            for number, kind in (("f64", np.float64), ("f32", np.float32)):
                points = self.points.astype(kind)
                lines = "\n".join(" ".join(repr(float(c)) for c in p) for p in points)
                printed = subprocess.run(["fathom", "eval", path, "--points", "-", "--number", number], input=lines,
                                         capture_output=True, text=True, check=True).stdout.split("\n")[:-1]
                columns = np.array([[float(word) for word in line.split()[:4]] for line in printed]).astype(kind)
                np.testing.assert_array_equal(self.scene.distance(points), columns[:, 0])
                np.testing.assert_array_equal(self.scene.gradient(points), columns[:, 1:])

    def test_layouts_give_equal_distances(self):
        expected = self.scene.distance(self.points)
        self.assertEqual(expected.dtype, np.float64)
        np.testing.assert_array_equal(self.scene.distance(np.asfortranarray(self.points)), expected)
        np.testing.assert_array_equal(self.scene.distance(self.points[::-1])[::-1], expected)
        np.testing.assert_array_equal(self.scene.distance(self.points[::3]), expected[::3])
        np.testing.assert_array_equal(self.scene.distance(self.points.reshape(10, 100, 3)), expected.reshape(10, 100))
        swapped = np.moveaxis(self.points.reshape(10, 100, 3), 0, 1)
        np.testing.assert_array_equal(self.scene.distance(swapped), expected.reshape(10, 100).T)
        np.testing.assert_array_equal(self.scene.distance(self.points.tolist()), expected)
        self.assertEqual(self.scene.distance([0, 0, 0]), -1)
        self.assertEqual(self.scene.distance(np.zeros((0, 3))).shape, (0,))

    def test_results_can_have_a_place(self):
        out = np.empty(1000)
        self.assertIs(self.scene.distance(self.points, out=out), out)
        np.testing.assert_array_equal(out, self.scene.distance(self.points))
        for bad in (np.empty(999), np.empty(1000, np.float32), np.empty(2000)[::2]):
            with self.assertRaises(ValueError):
                self.scene.distance(self.points, out=bad)
        with self.assertRaisesRegex(ValueError, "x, y, z"):
            self.scene.distance(np.zeros((3, 2)))

    def test_ranges_contain_distances(self):
        lo, hi = self.points, self.points + 0.1
        bounds = self.scene.range(lo, hi)
        middle = self.scene.distance((lo + hi) / 2)
        self.assertTrue(np.all((bounds[:, 0] <= middle) & (middle <= bounds[:, 1])))

    def test_rays_hit_the_ball(self):
        hits = self.scene.march([[0, 0, 3], [0, 5, 3], [0, 0, 0]], [[0, 0, -2], [0, 0, -1], [1, 0, 0]])
        self.assertEqual(hits.hit.tolist(), [True, False, True])
        self.assertEqual(hits.inside.tolist(), [False, False, True])
        np.testing.assert_allclose(hits.t, [2, math.inf, 1], atol=1e-6)
        np.testing.assert_allclose(hits.position[0], [0, 0, 1], atol=1e-6)
        np.testing.assert_allclose(hits.normal[0], [0, 0, 1], atol=1e-6)
        self.assertFalse(self.scene.march([[0, 0, 3]], [[0, 0, -1]], t_max=1.5).hit[0])


    def test_one_origin_serves_all_rays(self):
        directions = np.random.default_rng(3).normal(size=(4, 5, 3))
        hits = self.scene.march([0, 0, 0], directions)
        self.assertEqual(hits.t.shape, (4, 5))
        np.testing.assert_array_equal(hits.t, self.scene.march(np.zeros((4, 5, 3)), directions).t)
        hits = self.scene.march(directions[0], [0, 0, -1])
        np.testing.assert_array_equal(hits.t, self.scene.march(directions[0], [[0, 0, -1]] * 5).t)
        self.assertEqual(self.scene.range([0, 0, 0], np.ones((4, 3))).shape, (4, 2))
        with self.assertRaisesRegex(ValueError, "origins and directions"):
            self.scene.march(np.zeros((2, 3)), np.ones((3, 3)))

    # numpy's failure to convert an argument was an internal error.
    def test_arguments_without_numbers_are_named(self):
        for bad in ("abc", ["a", "b", "c"], [[0, 0, 0], [0, 0]], [[0, 0, 0], 1], object(), {1: 2}):
            for name, call in (("points", self.scene.distance), ("points", self.scene.gradient),
                               ("points", self.scene.nearest), ("lo", lambda b: self.scene.range(b, [0, 0, 0])),
                               ("hi", lambda b: self.scene.range([0, 0, 0], b)),
                               ("origins", lambda b: self.scene.march(b, [0, 0, 1])),
                               ("directions", lambda b: self.scene.march([0, 0, 1], b)),
                               ("box", lambda b: self.scene.mesh(box=b))):
                with self.assertRaisesRegex(TypeError, f"^{name} is no array of numbers"):
                    call(bad)
        for bad in (None, 3, [], [1, 2], np.zeros((3, 2))):
            with self.assertRaisesRegex(ValueError, "points has no last axis"):
                self.scene.distance(bad)
        with self.assertRaisesRegex(TypeError, "t_max is no number"):
            self.scene.march([0, 0, 3], [0, 0, -1], t_max="far")
        with self.assertRaisesRegex(ValueError, "t_max"):
            self.scene.march([0, 0, 3], [0, 0, -1], t_max=math.nan)
        with self.assertRaisesRegex(TypeError, "out is no array"):
            self.scene.distance(self.points, out="here")

    def test_boxes_without_inside_are_named(self):
        for lo, hi, what in (([0, 0, 0], [1, -1, 1], "y from 0 to -1"), ([0, 0, math.nan], [1, 1, 1], "z from nan"),
                             ([0, 0, 0], [math.nan, 1, 1], "x from"), ([math.inf, 0, 0], [0, 0, 0], "x from inf")):
            with self.assertRaisesRegex(ValueError, "box 1: " + what):
                self.scene.range([[0, 0, 0], lo], [[1, 1, 1], hi])
            with self.assertRaisesRegex(ValueError, "box: " + what):
                self.scene.mesh(box=(lo, hi))
        with self.assertRaisesRegex(ValueError, "box is no pair"):
            self.scene.mesh(box=[[0, 0, 0]] * 3)
        self.assertEqual(self.scene.range([0, 0, 0], [0, 0, 0]).shape, (2,))


class Scenes(unittest.TestCase):
    def test_paths_are_text_bytes_or_objects(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "bäll.fathom")
            path.write_text(BALL)
            for name in (path, str(path), os.fsencode(path)):
                self.assertEqual(fathom.load(name).objects, ["ball"])
            self.assertEqual(fathom.compile('fathom 1\nimport "bäll.fathom" as b\nobject "a" sphere(1)\n', folder=path.parent)
                             .objects, ["a"])
        for bad in ("ball\0.fathom", b"ball\0.fathom"):
            with self.assertRaisesRegex(ValueError, "path holds a zero byte"):
                fathom.load(bad)
        with self.assertRaisesRegex(ValueError, "folder holds a zero byte"):
            fathom.compile(BALL, folder="a\0b")
        with self.assertRaises(TypeError):
            fathom.load(3)

    # pybind11 gave such an object memory without contents, which every method then read.
    def test_objects_come_from_functions_alone(self):
        for kind in (fathom.Scene, fathom.Image, fathom.Diagnostic):
            for make in (kind, lambda: kind.__new__(kind), lambda: object.__new__(kind),
                         lambda: kind.__mro__[1].__new__(kind), type("Other", (kind,), {})):
                with self.assertRaises(TypeError):
                    make()

    def test_a_scene_can_be_pickled(self):
        scene = fathom.compile(ENDLESS, {"r": 1.5})
        for copied in (pickle.loads(pickle.dumps(scene)), copy.copy(scene), copy.deepcopy(scene)):
            self.assertEqual((copied.objects, copied.parameters), (["ball"], {"r": 1.5}))
            self.assertEqual(copied.distance([2, 0, 0]), 0.5)
            np.testing.assert_array_equal(copied.render(width=8, height=8, samples=2).radiance,
                                          scene.render(width=8, height=8, samples=2).radiance)
        # A model of another format is rendered on a stage.
        model = fathom.compile("# a comment\n_0 var-x\n_1 const 1.0\n_2 sub _0 _1\n")
        copied = pickle.loads(pickle.dumps(model))
        np.testing.assert_array_equal(copied.render(width=8, height=8, samples=2).radiance,
                                      model.render(width=8, height=8, samples=2).radiance)
        for bad in (b"", b"x", b"S", b"Sx", pickle.dumps(scene)):
            with self.assertRaises(ValueError):
                fathom.Scene._unpack(bad)

    def test_parameters_are_named_without_options_of_the_program(self):
        for bad, what in (({"radius": 1}, "`radius`"), ({"r": math.nan}, "`r`")):
            with self.assertRaisesRegex(fathom.SceneError, what) as caught:
                fathom.compile(BALL, bad)
            self.assertNotIn("-D", str(caught.exception))
        with self.assertRaisesRegex(TypeError, r"parameters\['r'\] is no number"):
            fathom.compile(BALL, {"r": "wide"})
        with self.assertRaisesRegex(TypeError, "parameters: a name"):
            fathom.compile(BALL, {1: 2})
        self.assertEqual(fathom.compile(BALL, {"r": np.float32(0.5)}).parameters, {"r": 0.5})

    def test_errors_have_spans(self):
        with self.assertRaises(fathom.SceneError) as caught:
            fathom.compile('fathom 1\nobject "ä" spere(1)\n')
        (error,) = caught.exception.diagnostics
        self.assertEqual((error.severity, error.line, error.column), ("error", 2, 12))
        self.assertEqual(error.span, (21, 26))
        self.assertIn("sphere", str(caught.exception))
        with self.assertRaises(OSError):
            fathom.load("no such file")

    def test_facts_of_a_scene(self):
        scene = fathom.compile(BALL, {"r": 2})
        self.assertEqual(scene.parameters, {"r": 2})
        self.assertEqual(scene.objects, ["ball"])
        self.assertEqual(scene.bounds, ((-2, -2, -2), (2, 2, 2)))
        self.assertEqual((scene.lipschitz, scene.certified), (1, True))
        self.assertEqual(scene.nearest([[3, 0, 0]]).tolist(), [0])

    def test_threads_share_a_scene(self):
        scene = fathom.compile(BALL)
        points = np.random.default_rng(2).uniform(-2, 2, (100_000, 3)).astype(np.float32)
        expected, results = scene.distance(points), []
        threads = [threading.Thread(target=lambda: results.append(scene.distance(points))) for _ in range(8)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(len(results), 8)
        for result in results:
            np.testing.assert_array_equal(result, expected)


class Meshes(unittest.TestCase):
    def test_the_mesh_of_a_ball_is_closed_and_near(self):
        mesh = fathom.compile(BALL).mesh(tolerance=0.02)
        self.assertTrue(mesh.proved)
        self.assertLessEqual(mesh.bound, 0.02)
        edges = np.concatenate([mesh.triangles[:, [i, (i + 1) % 3]] for i in range(3)])
        self.assertEqual({tuple(e) for e in edges.tolist()}, {tuple(e) for e in edges[:, ::-1].tolist()})
        self.assertLess(np.abs(np.linalg.norm(mesh.vertices, axis=1) - 1).max(), mesh.bound)
        a, b, c = (mesh.vertices[mesh.triangles[:, i]] for i in range(3))
        volume = np.einsum("ij,ij->", a, np.cross(b, c)) / 6
        self.assertAlmostEqual(volume, 4 / 3 * math.pi, delta=0.2)
        self.assertEqual(mesh.lost, [])

    def test_a_scene_without_end_needs_a_box(self):
        scene = fathom.compile('fathom 1\nobject "ground" plane([0, 1, 0])\n')
        with self.assertRaisesRegex(ValueError, "box"):
            scene.mesh()
        mesh = scene.mesh(box=((-1, -1, -1), (1, 1, 1)), resolution=16)
        np.testing.assert_allclose(mesh.vertices.max(axis=0), [1, 0, 1], atol=mesh.bound)


class Renders(unittest.TestCase):
    def test_layers_show_the_ball(self):
        image = fathom.compile(ENDLESS).render(width=33, height=21, samples=4)
        self.assertTrue(image.complete)
        self.assertEqual(image.samples, 33 * 21 * 4)
        for layer in (image.radiance, image.albedo, image.normal, image.position):
            self.assertEqual((layer.shape, layer.dtype), ((21, 33, 3), np.float32))
        self.assertEqual(image.display.dtype, np.uint8)
        self.assertAlmostEqual(float(image.depth[10, 16]), 3, delta=0.05)
        self.assertEqual((int(image.object[10, 16]), int(image.object[0, 0])), (0, fathom.NO_OBJECT))
        np.testing.assert_allclose(image.radiance[0, 0], 1, atol=1e-6)

    def test_another_thread_ends_a_render(self):
        stop = threading.Event()
        threading.Timer(0.2, stop.set).start()
        seen = []

        def progress(fraction):
            seen.append(fraction)
            return not stop.is_set()

        image = fathom.compile(ENDLESS).render(width=64, height=64, samples=1 << 20, progress=progress)
        self.assertFalse(image.complete)
        self.assertGreater(image.samples, 0)
        self.assertTrue(seen)

    def test_exceptions_of_the_callback_pass(self):
        def progress(fraction):
            raise KeyError("mine")

        with self.assertRaises(KeyError):
            fathom.compile(ENDLESS).render(width=64, height=64, samples=1 << 20, progress=progress)

    def test_wrong_options_are_named(self):
        scene = fathom.compile(ENDLESS)
        with self.assertRaisesRegex(ValueError, "samples"):
            scene.render(samples=0)
        with tempfile.TemporaryDirectory() as folder:
            image = scene.render(width=4, height=4, samples=1)
            image.save(pathlib.Path(folder, "ball.png"))
            self.assertGreater(pathlib.Path(folder, "ball.png").stat().st_size, 50)
            with self.assertRaises(ValueError):
                image.save(pathlib.Path(folder, "ball.gif"))
            image.save(os.fsencode(pathlib.Path(folder, "bytes.png")))
            self.assertEqual(pathlib.Path(folder, "bytes.png").read_bytes(), image._repr_png_())
            with self.assertRaisesRegex(ValueError, "path holds a zero byte"):
                image.save(str(pathlib.Path(folder, "x\0.png")))
            self.assertEqual(sorted(os.listdir(folder)), ["ball.png", "bytes.png"])
        with self.assertRaisesRegex(TypeError, "progress"):
            scene.render(width=4, height=4, samples=1, progress="loud")


if __name__ == "__main__":
    sys.exit(unittest.main(verbosity=1))
