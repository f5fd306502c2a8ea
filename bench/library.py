#!/usr/bin/python3
"""Compares distances from Python with the library's own: taskset -c 1 python3 bench/library.py [scene ...]

Evaluates ten million points of a numpy array, in turns by the Python module and by the function of libfathom.so that
a C or C++ program calls, in one process on the same arrays. Prints nanoseconds per point, medians of ROUNDS rounds,
and the median of the rounds' ratios with the smallest and the largest. Exit status 1 if a median ratio is above BAR.
Needs a build with -DFATHOM_PYTHON=ON in build/release, and numpy.
"""
import ctypes
import pathlib
import statistics
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[1]
BUILD = ROOT / "build/release"
sys.path.insert(0, str(BUILD))

import fathom  # noqa: E402
import numpy as np  # noqa: E402

ROUNDS, COUNT, BAR = 9, 10_000_000, 1.1
SCENES = ["scenes/bench/a-primitives.json", "scenes/bench/f-formula.json", "scenes/showcase.json"]

library = ctypes.CDLL(str(BUILD / "libfathom.so"))
SUFFIX = {np.dtype(np.float32): "f32", np.dtype(np.float64): "f64"}


def load_by_library(path):
    scene = ctypes.c_void_p()
    assert library.fathom_load(str(path).encode(), None, ctypes.byref(scene), None, None) == 0
    return scene


def by_library(scene, points, out):
    function = getattr(library, "fathom_distance_" + SUFFIX[points.dtype])
    status = function(scene, points.ctypes.data_as(ctypes.c_void_p), ctypes.c_ssize_t(3),
                      ctypes.c_size_t(len(points)), out.ctypes.data_as(ctypes.c_void_p), None)
    assert status == 0


def seconds(work):
    begin = time.process_time()
    work()
    return time.process_time() - begin


def compare(path, kind):
    count = COUNT if kind == np.float32 else COUNT // 10
    points = np.random.default_rng(1).uniform(-2, 2, (count, 3)).astype(kind)
    ours, theirs = np.empty(count, kind), np.empty(count, kind)
    scene, raw = fathom.load(path), load_by_library(path)
    rounds = [(seconds(lambda: scene.distance(points, out=ours)), seconds(lambda: by_library(raw, points, theirs)))
              for _ in range(ROUNDS + 1)][1:]  # the first round compiles native code
    assert np.array_equal(ours, theirs)
    ratios = [a / b for a, b in rounds]
    ratio = statistics.median(ratios)
    nanoseconds = [1e9 * statistics.median(column) / count for column in zip(*rounds)]
    print(f"{path.stem:<14} {np.dtype(kind).name:<8} {nanoseconds[0]:8.2f} {nanoseconds[1]:8.2f}   {ratio:.3f} "
          f"({min(ratios):.3f} to {max(ratios):.3f})   <= {BAR} {'holds' if ratio <= BAR else 'missed'}")
    return ratio <= BAR


paths = [pathlib.Path(name) for name in sys.argv[1:]] or [ROOT / name for name in SCENES]
print(f"{'scene':<14} {'numbers':<8} {'Python':>8} {'library':>8}   Python / library, ns per point, {fathom.instruction_set}")
sys.exit(0 if all([compare(path, kind) for path in paths for kind in (np.float32, np.float64)]) else 1)
