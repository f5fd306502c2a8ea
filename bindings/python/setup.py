"""Builds the module with CMake from the source tree: pip install ./bindings/python

Needs the packages of `scripts/install-packages`, and Python's headers (Debian: python3-dev). pip brings pybind11;
--no-build-isolation takes the system's (pybind11-dev). CMAKE_ARGS may hold further options of CMake, e.g.
-DFATHOM_ISAS=host.
"""
import os
import pathlib
import shlex
import shutil
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = pathlib.Path(__file__).resolve().parents[2]


class CMakeBuild(build_ext):
    def build_extension(self, extension):
        target = pathlib.Path(self.get_ext_fullpath(extension.name)).resolve()
        build = ROOT / "build/python"
        options = ["-DCMAKE_BUILD_TYPE=Release", "-DFATHOM_PYTHON=ON", "-DFATHOM_TESTS=OFF", "-DFATHOM_BENCH=OFF",
                   f"-DPython_EXECUTABLE={sys.executable}", f"-DCMAKE_INSTALL_PREFIX={target.parent}",
                   "-DFATHOM_PYTHON_DIR=.", *shlex.split(os.environ.get("CMAKE_ARGS", ""))]
        try:
            import pybind11
            options.append(f"-Dpybind11_DIR={pybind11.get_cmake_dir()}")
        except ImportError:
            options.append("-Upybind11_DIR")  # of an isolated build before, which is gone
        if shutil.which("ccache"):
            options.append("-DCMAKE_CXX_COMPILER_LAUNCHER=ccache")
            os.environ.setdefault("CCACHE_BASEDIR", str(ROOT))
        subprocess.run(["cmake", "-G", "Ninja", "-S", ROOT, "-B", build, *options], check=True)
        subprocess.run(["cmake", "--build", build, "--target", "fathom_python"], check=True)
        subprocess.run(["cmake", "--install", build, "--component", "python", "--strip"], check=True)


# Leaves nothing in the source tree.
WHEEL = ROOT / "build/python-wheel"
WHEEL.mkdir(parents=True, exist_ok=True)

setup(options={"build": {"build_base": str(WHEEL)}, "egg_info": {"egg_base": str(WHEEL)}}, py_modules=[],
      ext_modules=[Extension("fathom", sources=[])], cmdclass={"build_ext": CMakeBuild})
