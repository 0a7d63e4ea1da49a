# SPDX-License-Identifier: BSD-3-Clause
from typing import Any, Callable, Dict, List, Optional, Tuple

import numpy as np
import numpy.typing as npt

_Floats = npt.NDArray[np.float32]
_Progress = Optional[Callable[[str, float], object]]

def orient(
    points: _Floats, options: Dict[str, Any], progress: _Progress
) -> Tuple[_Floats, _Floats, npt.NDArray[np.int32], _Floats, npt.NDArray[np.int32], Dict[str, Any]]: ...
def normals(points: _Floats, options: Dict[str, Any], progress: _Progress) -> Tuple[_Floats, _Floats]: ...
def segment(
    points: _Floats, options: Dict[str, Any], progress: _Progress
) -> Tuple[npt.NDArray[np.int32], npt.NDArray[np.uint8], _Floats, _Floats]: ...
def sensors(
    points: _Floats, suggestions: _Floats, image_width: int, threads: int
) -> Tuple[
    List[Dict[str, Any]], npt.NDArray[np.int32], float, float, str, _Floats, bool
]: ...
def knn(
    points: _Floats, k: int, queries: Optional[_Floats], threads: int
) -> Tuple[npt.NDArray[np.int32], _Floats]: ...
def frame(points: npt.NDArray[Any]) -> Tuple[npt.NDArray[np.float64], npt.NDArray[np.int64]]: ...
def page(points: _Floats, given: Dict[str, Any], most: int, threads: int) -> bytes: ...
