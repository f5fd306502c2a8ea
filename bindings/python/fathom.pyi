"""Types of the module, for editors and type checkers."""

from os import PathLike
from typing import Any, Callable, NamedTuple

import numpy as np
import numpy.typing as npt

__version__: str
instruction_set: str
NO_OBJECT: int

class Diagnostic:
    severity: str
    code: str
    message: str
    file: str
    line: int
    column: int
    span: tuple[int, int]
    label: str
    help: list[str]

class SceneError(ValueError):
    diagnostics: list[Diagnostic]

class Hits(NamedTuple):
    hit: npt.NDArray[np.bool_]
    t: npt.NDArray[np.float64]
    position: npt.NDArray[np.float64]
    normal: npt.NDArray[np.float64]
    object: npt.NDArray[np.uint32]
    inside: npt.NDArray[np.bool_]

class Mesh(NamedTuple):
    vertices: npt.NDArray[np.float64]
    triangles: npt.NDArray[np.uint32]
    object: npt.NDArray[np.uint32]
    bound: float
    proved: bool
    lost: list[tuple[tuple[float, float, float], float, int, bool]]

class Image:
    width: int
    height: int
    complete: bool
    samples: int
    radiance: npt.NDArray[np.float32]
    albedo: npt.NDArray[np.float32]
    normal: npt.NDArray[np.float32]
    position: npt.NDArray[np.float32]
    depth: npt.NDArray[np.float32]
    object: npt.NDArray[np.uint32]
    display: npt.NDArray[np.uint8]
    def save(self, path: str | bytes | PathLike[str]) -> None: ...
    def _repr_png_(self) -> bytes: ...

class Scene:
    objects: list[str]
    warnings: list[Diagnostic]
    parameters: dict[str, float]
    bounds: tuple[tuple[float, float, float], tuple[float, float, float]]
    lipschitz: float
    certified: bool
    def distance(self, points: npt.ArrayLike, out: npt.NDArray[Any] | None = None) -> npt.NDArray[Any]: ...
    def gradient(self, points: npt.ArrayLike, out: npt.NDArray[Any] | None = None) -> npt.NDArray[Any]: ...
    def nearest(self, points: npt.ArrayLike) -> npt.NDArray[np.uint32]: ...
    def range(self, lo: npt.ArrayLike, hi: npt.ArrayLike) -> npt.NDArray[np.float64]: ...
    def march(self, origins: npt.ArrayLike, directions: npt.ArrayLike, t_max: float | None = None) -> Hits: ...
    def mesh(
        self,
        *,
        tolerance: float | None = None,
        resolution: int = 256,
        box: npt.ArrayLike | None = None,
        simplify: bool = True,
        threads: int = 0,
    ) -> Mesh: ...
    def render(
        self,
        *,
        width: int | None = None,
        height: int | None = None,
        samples: int | None = None,
        seed: int | None = None,
        denoise: bool = False,
        threads: int = 0,
        time_limit: float | None = None,
        progress: Callable[[float], bool | None] | None = None,
    ) -> Image: ...

def compile(
    text: str,
    parameters: dict[str, float] | None = None,
    *,
    name: str = "scene",
    folder: str | bytes | PathLike[str] = "",
) -> Scene: ...
def load(path: str | bytes | PathLike[str], parameters: dict[str, float] | None = None) -> Scene: ...
