# SPDX-License-Identifier: BSD-3-Clause
# Copyright (c) 2026, the segorient authors
"""Segmented, consistently oriented point clouds, on numpy arrays.

    >>> import segorient
    >>> cloud = segorient.orient(points)      # points: an (n, 3) array
    >>> cloud.normals                         # (n, 3), outward where there is an outside
    >>> cloud.labels                          # (n,), the segment of each point
    >>> cloud.show()                          # a page that turns; cloud.save_html("cloud.html")

Keywords are named as the options of the program ``segorient``, angles are in degrees, and what is
left out is chosen from the cloud. Row i of every result belongs to row i of the points. Points with
NaN or infinite coordinates get NaN normals and label -1; so do strays that are farther from the bulk
of the points than 2^24 times its extent, where floats end, and rows of masked arrays of which
anything is hidden. Of what else is given by row, what a mask hides counts as not known.

Arrays of float32 whose rows are consecutive (an (n, 3) array, or the first three columns of a wider
one) are used where they are. Others are copied; float64 ones that lie far from the origin, such as
map coordinates, are moved there in double first, so that no precision is lost. Results are arrays
that own their memory; the interpreter's lock is released while the library works, so other Python
threads go on. Ctrl-C ends the work at the next stage.
"""

import html
import os
import pathlib
import tempfile
import warnings
import webbrowser
from typing import Any, Callable, Dict, List, NamedTuple, Optional, Sequence, Tuple, Union

import numpy as np
import numpy.typing as npt

from . import _core

__version__ = "1.0.0"
__all__ = [
    "Check",
    "Neighbors",
    "Normals",
    "Orientation",
    "Segments",
    "check",
    "Sensors",
    "knn",
    "normals",
    "orient",
    "segment",
    "sensors",
]

Floats = npt.NDArray[np.float32]
Progress = Callable[[str, float], object]
_Origin = npt.NDArray[np.float64]


class _Found(NamedTuple):
    normals: Floats  #: (n, 3) oriented unit normals; NaN where there is none
    curvatures: Floats  #: (n,) smallest variance in the sum of all three, as in PCL
    labels: npt.NDArray[np.int32]  #: (n,) segment, the largest first; -1 without a normal
    confidences: Floats  #: (n,) of the orientation: 0 a guess, 1 all evidence agrees
    components: npt.NDArray[np.int32]  #: (n,) connected component, the largest first; -1 as above
    report: Dict[str, Any]  #: what was done, as ``--report`` of the program has it, but for memory by stage


class Orientation(_Found):
    """What :func:`orient` found: a tuple, and a page that shows it (:meth:`show`, :meth:`save_html`)."""

    _points: Floats
    _origin: _Origin
    _sensors: Optional[npt.NDArray[Any]]

    def _html(self, points: int, title: str) -> bytes:
        most = _whole("points", points, 1, (1 << 31) - 1)
        report = self.report
        sides = [component["oriented_by"] for component in report["components"]]
        texts = []
        for segment in report["segments"]:
            text = f"{segment['kind']}, by {segment['oriented_by']}"
            if 0 <= segment["component"] < len(sides):
                text += f", side by {sides[segment['component']]}"
            texts.append(text + (", hard" if segment["hard"] else ""))
        given = {
            "title": _word("title", title),
            "origin": self._origin,
            "normals": self.normals,
            "labels": self.labels.astype(np.uint32),  # -1 becomes the program's 4294967295
            "confidences": self.confidences,
            "segments": texts,
            "contradictions": np.array(
                [[place[axis] for axis in "xyz"] for place in report["contradictions"]], np.float64
            ),
        }
        if self._sensors is not None:
            given["sensors"] = self._sensors
        return _core.page(self._points, given, most or 1, 0)

    def save_html(self, path: Union[str, "os.PathLike[str]"], *, points: int = 1_000_000, title: str = "segorient") -> None:
        """Writes a page that shows the cloud in any browser with WebGL 2: one file, no network.

        :param path: of the file
        :param points: at most so many, spread evenly; a million take some 13 MB
        :param title: of the page
        :raises OSError: if it cannot be written; what was there before then stays
        """
        page = self._html(points, title)
        target = os.path.realpath(os.fspath(path))
        handle, temporary = tempfile.mkstemp(dir=os.path.dirname(target), suffix=".html")
        try:
            with os.fdopen(handle, "wb") as file:
                file.write(page)
            umask = os.umask(0)
            os.umask(umask)
            os.chmod(temporary, 0o666 & ~umask)
            os.replace(temporary, target)
        except BaseException:
            os.unlink(temporary)
            raise

    def _repr_html_(self) -> str:
        """The page in a frame, as notebooks show it; at most 200,000 points, which a notebook keeps."""
        page = html.escape(self._html(200_000, "segorient").decode(errors="replace"))
        return (
            '<iframe title="segorient: the oriented cloud, to be turned" style="width:100%;height:560px;border:0" '
            f'sandbox="allow-scripts" srcdoc="{page}"></iframe>'
        )

    def show(self) -> None:
        """Shows the page: in a notebook below the cell, elsewhere in the browser."""
        try:
            from IPython import get_ipython  # type: ignore
            from IPython.display import HTML, display  # type: ignore

            notebook = get_ipython() is not None and hasattr(get_ipython(), "kernel")
        except ImportError:
            notebook = False
        if notebook:
            display(HTML(self._repr_html_()))
            return
        # The browser reads it after this returns, so it stays until the system clears such files.
        path = os.path.join(tempfile.mkdtemp(prefix="segorient_"), "cloud.html")
        self.save_html(path)
        webbrowser.open(pathlib.Path(path).as_uri())


class Check(NamedTuple):
    """What :func:`check` found."""

    contradictions: npt.NDArray[np.uint8]  #: (n,) 0 none, 1 the sensor, 2 the surface, 3 inside out
    places: npt.NDArray[np.int32]  #: (n,) into ``report["places"]``, the largest first; -1: none
    report: Dict[str, Any]  #: as ``segorient check --report`` of the program has it


class Normals(NamedTuple):
    """What :func:`normals` found."""

    normals: Floats  #: (n, 3) unit normals of arbitrary sign; NaN where there is none
    curvatures: Floats  #: (n,) smallest variance in the sum of all three, as in PCL


class Segments(NamedTuple):
    """What :func:`segment` found."""

    labels: npt.NDArray[np.int32]  #: (n,) segment, the largest first; -1 without a normal
    kinds: npt.NDArray[np.uint8]  #: (segments,) 0 regular, 1 connected, 2 isolated
    normals: Floats  #: (n, 3) unit normals that agree within each segment
    curvatures: Floats  #: (n,) smallest variance in the sum of all three, as in PCL


class Sensors(NamedTuple):
    """What :func:`sensors` found."""

    sensors: List[Dict[str, Any]]  #: each with kind, x, y, z, points, cost_ratio, sure and more
    sensor_of: npt.NDArray[np.int32]  #: (n,) the sensor of each point; -1 = none
    deviation: float  #: mean deviation of the log density from a constant
    chance: float  #: the same if points were strewn at random
    why: str  #: in a few words, what was found or why nothing
    #: (n, 3) where no sensor was found, but that all was seen from within: the mean direction to
    #: where each point was seen from, 0 = unknown; otherwise (0, 3)
    directions: Floats
    #: no sensor was found, but it is one surface over the ground, of which the upper side is seen
    faces_up: bool


class Neighbors(NamedTuple):
    """What :func:`knn` found."""

    indices: npt.NDArray[np.int32]  #: (n, k) rows of the points, nearest first; -1 where none is left
    distances: Floats  #: (n, k) ascending; infinite where none is left


def _unmasked(value: npt.ArrayLike) -> npt.NDArray[Any]:
    """The same as an array; entries that a masked array hides are NaN, which no result comes from."""
    if not isinstance(value, np.ma.MaskedArray) or value.dtype.kind not in "fiu":
        return np.asarray(value)
    if not np.ma.getmaskarray(value).any():
        return np.asarray(value.data)
    as_real = value if value.dtype.kind == "f" else value.astype(np.float64)
    return np.asarray(as_real.filled(np.nan))


def _rows(name: str, value: npt.ArrayLike) -> npt.NDArray[Any]:
    """Checks that this is an (n, 3) array of real numbers."""
    array = _unmasked(value)
    if array.dtype.names is not None:
        raise TypeError(
            f"{name} must be an (n, 3) array of numbers, not one of fields {', '.join(array.dtype.names)}: "
            f"numpy.lib.recfunctions.structured_to_unstructured({name}[['x', 'y', 'z']]) makes one of it"
        )
    if array.dtype.kind not in "fiu":
        raise TypeError(f"{name} must be real numbers, not {array.dtype}")
    if array.ndim != 2 or array.shape[1] != 3:
        raise ValueError(f"{name} must be an (n, 3) array, not one of shape {array.shape}")
    return array


def _is_viewable(array: npt.NDArray[Any]) -> bool:
    """Whether the library can read these rows where they are."""
    return bool(
        array.dtype == np.float32
        and array.dtype.isnative
        and array.flags.aligned
        and array.strides[1] == 4
        and array.strides[0] >= 12
        and array.strides[0] % 4 == 0
    )


def _moved(array: npt.NDArray[Any], origin: _Origin) -> Floats:
    """The same less `origin`, subtracted in double, as float32 in memory of its own."""
    out = np.empty(array.shape, np.float32)
    with np.errstate(over="ignore", invalid="ignore"):
        np.subtract(array, origin, out=out, casting="unsafe", dtype=np.float64)
    return out


def _local(points: npt.ArrayLike) -> Tuple[Floats, _Origin]:
    """Points as float32 near the origin, and what they were moved by; strays beyond floats are NaN."""
    array = _rows("points", points)
    origin, strays = _core.frame(array if array.flags.aligned else array.copy())
    if array.dtype == np.float32:
        origin = np.zeros(3)  # to move them would bring nothing back
    if _is_viewable(array) and len(strays) == 0:
        return array, origin
    moved = _moved(array, origin)
    moved[strays] = np.nan
    return moved, origin


def _to_world(places: List[Dict[str, Any]], origin: _Origin) -> None:
    """Adds `origin` to the x, y, z of each."""
    for place in places:
        for axis, name in enumerate("xyz"):
            place[name] += origin[axis]


def _angle(name: str, value: Optional[float]) -> Optional[float]:
    if value is None:
        return None
    if isinstance(value, (str, bytes)) or not np.isscalar(value):
        raise TypeError(f"{name} must be a number of degrees, not {value!r}")
    if not 0.0 < float(value) <= 180.0:  # type: ignore[arg-type]
        raise ValueError(f"{name} must be above 0 and at most 180 degrees, not {value!r}")
    return float(value)  # type: ignore[arg-type]


# As many as the program takes.
_MOST_THREADS = (1 << 31) - 1


def _whole(name: str, value: Optional[int], least: int, most: int) -> Optional[int]:
    if value is None:
        return None
    if isinstance(value, bool) or not isinstance(value, (int, np.integer)):
        raise TypeError(f"{name} must be a whole number, not {value!r}")
    if not least <= value <= most:
        raise ValueError(f"{name} must be {least} to {most}, not {value!r}")
    return int(value)


def _word(name: str, value: str) -> str:
    if not isinstance(value, str):
        raise TypeError(f"{name} must be a string, not {value!r}")
    return value


def _options(
    k: Optional[int],
    normals: str,
    alpha: Optional[float],
    beta: Optional[float],
    delta: Optional[float],
    epsilon: Optional[float],
    recompute: int,
    threads: int,
) -> Dict[str, Any]:
    """The options that are given, checked."""
    options = {
        "k": _whole("k", k, 1, 1000),
        "normals": _word("normals", normals),
        "alpha": _angle("alpha", alpha),
        "beta": _angle("beta", beta),
        "delta": _angle("delta", delta),
        "epsilon": _angle("epsilon", epsilon),
        "recompute": _whole("recompute", recompute, 0, 100),
        "threads": _whole("threads", threads, 0, _MOST_THREADS),
    }
    return {name: value for name, value in options.items() if value is not None}


def _warn_of_unused(reason: str, **given: bool) -> None:
    """Names those arguments that were given though nothing looks at them."""
    for name, is_given in given.items():
        if is_given:
            warnings.warn(f"{name} changes nothing {reason}", stacklevel=3)


def _flag(name: str, value: bool) -> bool:
    if not isinstance(value, (bool, np.bool_)):
        raise TypeError(f"{name} must be True, False or None, not {value!r}")
    return bool(value)


def _rows_of(name: str, value: npt.ArrayLike, size: int) -> npt.NDArray[Any]:
    """Checks that this is an array of a row for each point."""
    rows = _rows(name, value)
    if len(rows) != size:
        raise ValueError(f"{name} must have a row for each of the {size} points, not {len(rows)}")
    return rows


def _one_each(name: str, value: npt.ArrayLike, size: int, kinds: str) -> npt.NDArray[Any]:
    """Checks that this is an array of one number for each point, of one of these kinds.

    What a mask hides is not known: NaN, or -1 where numbers are whole.
    """
    array = np.asarray(value)
    if array.dtype.kind not in kinds:
        raise TypeError(f"{name} must be {'whole' if kinds == 'iu' else 'real'} numbers, not {array.dtype}")
    if isinstance(value, np.ma.MaskedArray):
        array = np.ma.filled(value.astype(np.int64), -1) if kinds == "iu" else _unmasked(value)
    if array.shape != (size,):
        raise ValueError(
            f"{name} must have one number for each of the {size} points, not shape {array.shape}"
        )
    return array


def _joined(
    trajectory: npt.ArrayLike, times: npt.ArrayLike, viewpoints: Optional[npt.NDArray[Any]], size: int
) -> npt.NDArray[Any]:
    """Viewpoints from a trajectory, under those that are known already."""
    poses = _unmasked(trajectory)
    if poses.dtype.kind not in "fiu":
        raise TypeError(f"trajectory must be real numbers, not {poses.dtype}")
    if poses.ndim != 2 or poses.shape[1] != 4:
        raise ValueError(f"trajectory must be an (m, 4) array of time x y z, not one of shape {poses.shape}")
    seen, joined, outside, reason = _core.join_trajectory(poses, _one_each("times", times, size, "fiu"))
    if size > 0 and joined == 0:
        raise ValueError(reason)
    if outside > 0:
        text = f"{outside} points were measured outside of the trajectory's time: no sensor is known"
        warnings.warn(text, stacklevel=4)
    if viewpoints is None:
        return np.asarray(seen)
    return np.where(np.isfinite(viewpoints).all(axis=1)[:, None], viewpoints, seen)


def _sensors(
    size: int,
    origin: _Origin,
    viewpoint: Optional[Union[Sequence[float], npt.NDArray[Any]]],
    viewpoints: Optional[npt.ArrayLike],
    trajectory: Optional[npt.ArrayLike],
    times: Optional[npt.ArrayLike],
    up: bool,
    scans: Optional[npt.ArrayLike],
    organized: Optional[Tuple[int, int]],
) -> Dict[str, Any]:
    """What is said of the sensors, checked, near `origin`."""
    options: Dict[str, Any] = {}
    if viewpoint is not None:
        place = np.asarray(viewpoint)
        if place.dtype.kind not in "fiu":
            raise TypeError(f"viewpoint must be three numbers, not {viewpoint!r}")
        if place.shape != (3,):
            raise ValueError(f"viewpoint must be three numbers, not an array of shape {place.shape}")
        if np.ma.getmaskarray(viewpoint).any():
            raise ValueError("viewpoint is masked: leave it out where it is not known")
        if not np.isfinite(place).all():
            raise ValueError("viewpoint is not finite: leave it out where it is not known")
        options["viewpoint"] = _moved(place, origin)
    seen = None if viewpoints is None else _rows_of("viewpoints", viewpoints, size)
    if (trajectory is None) != (times is None):
        raise TypeError("trajectory and times belong together")
    if trajectory is not None and times is not None:
        seen = _joined(trajectory, times, seen, size)
    if seen is not None:
        options["viewpoints"] = _moved(seen, origin)
    if not isinstance(up, (bool, np.bool_)):
        raise TypeError(f"up must be True or False, not {up!r}")
    if up and viewpoint is not None:
        raise ValueError("up and viewpoint exclude each other: both say where all points were seen from")
    if up:
        options["direction"] = np.array([0.0, 0.0, 1.0], np.float32)
    if scans is not None:
        numbers = _one_each("scans", scans, size, "iu")
        if size > 0 and numbers.max() > np.iinfo(np.int32).max:
            raise ValueError("scans must fit into 32 bits")
        options["scans"] = np.maximum(numbers, -1).astype(np.int32)
    if organized is not None:
        shape = np.asarray(organized)
        if shape.dtype.kind not in "iu" or shape.shape != (2,):
            raise TypeError(f"organized must be (height, width), not {organized!r}")
        if (shape < 1).any() or int(shape[0]) * int(shape[1]) != size:
            raise ValueError(f"organized must be height and width of {size} points, not {organized!r}")
        if shape[0] > 1:
            options["grid"] = [int(shape[0]), int(shape[1])]
    return options


def _sensor_places(viewpoint: Any, viewpoints: Any) -> Optional[npt.NDArray[Any]]:
    """The different places of sensors, a sample of them where they are many."""
    given = [np.reshape(np.asarray(v, np.float64), (-1, 3)) for v in (viewpoint, viewpoints) if v is not None]
    if not given:
        return None
    places = np.concatenate(given)
    places = np.unique(places[np.isfinite(places).all(axis=1)], axis=0)
    return places[:: len(places) // 200 + 1]


def orient(
    points: npt.ArrayLike,
    *,
    method: str = "auto",
    k: Optional[int] = None,
    normals: str = "auto",
    alpha: Optional[float] = None,
    beta: Optional[float] = None,
    gamma: Optional[float] = None,
    delta: Optional[float] = None,
    epsilon: Optional[float] = None,
    recompute: int = 0,
    viewpoint: Optional[Union[Sequence[float], npt.NDArray[Any]]] = None,
    viewpoints: Optional[npt.ArrayLike] = None,
    trajectory: Optional[npt.ArrayLike] = None,
    times: Optional[npt.ArrayLike] = None,
    up: bool = False,
    scans: Optional[npt.ArrayLike] = None,
    organized: Optional[Tuple[int, int]] = None,
    closed: Optional[bool] = None,
    keep: Optional[npt.ArrayLike] = None,
    seeds: Optional[Tuple[npt.ArrayLike, npt.ArrayLike]] = None,
    find_sensors: bool = True,
    threads: int = 0,
    progress: Optional[Progress] = None,
) -> Orientation:
    """One oriented normal a point: outward where there is an outside, consistent elsewhere.

    >>> cloud = segorient.orient(np.asarray(pcd.points))              # Open3D and back
    >>> pcd.normals = open3d.utility.Vector3dVector(cloud.normals)

    :param points: (n, 3)
    :param method: of orientation: ``auto`` (the best known), ``propagation``, ``boundary``,
        ``combined`` or ``extremal`` (the paper's), ``hoppe`` (the classical tree over points)
    :param k: neighbours of a point; None: from the cloud's noise
    :param normals: estimator for the paper's methods: ``auto`` (chosen from the cloud itself),
        ``plane``, ``lct``, ``ldt``, ``awas``, ``awas3``; method ``auto`` has its own way
    :param alpha: degrees, largest angle between normals of neighbours in a segment
    :param beta: degrees, largest angle between a normal and its segment's
    :param gamma: degrees, angles between segments up to this decide (the paper's methods)
    :param delta: degrees, what makes a border a sharp one for `recompute` (the paper's methods)
    :param epsilon: degrees, by how much the clean-up of segments may exceed `beta`
    :param recompute: rounds of finding normals at sharp edges again (the paper's methods)
    :param viewpoint: where an open surface was seen from; closed ones know their outside
    :param viewpoints: (n, 3), where each point was seen from; NaN: unknown
    :param trajectory: (m, 4), time x y z of a moving sensor, for `times`: each point was seen from
        where the sensor then was, between two rows in proportion; before the first and after the last
        row that is not known. Rows of `viewpoints` that are known come first
    :param times: (n,), when each point was measured, in the time base of `trajectory`
    :param up: True: the sensor was far above (+z), as on an aircraft; for points without a place of
        their own in `viewpoints` or `trajectory`
    :param scans: (n,) whole numbers, which scan each point is of; below 0: unknown
    :param organized: (height, width) where the points are a range image, row by row, NaN where
        nothing was seen
    :param closed: True: each part has an inside; False: a viewpoint decides; None: as it looks
    :param keep: (n, 3) normals whose signs say something; NaN or 0: none
    :param seeds: points and their normals, (m, 3) each, that are known
    :param find_sensors: where none is known, look for where the sensors stood, see :func:`sensors`
    :param threads: 0 = as many as the work is worth; results do not depend on it
    :param progress: called with a stage's name and the fraction that is done
    :raises TypeError, ValueError: for arguments that make no sense
    """
    options = _options(k, normals, alpha, beta, delta, epsilon, recompute, threads)
    options["method"] = _word("method", method)
    if gamma is not None:
        options["gamma"] = _angle("gamma", gamma)
    if not isinstance(find_sensors, (bool, np.bool_)):
        raise TypeError(f"find_sensors must be True or False, not {find_sensors!r}")
    if method == "auto":
        _warn_of_unused(
            "with method 'auto'",
            normals=normals != "auto",
            gamma=gamma is not None,
            delta=delta is not None,
            recompute=recompute > 0,
        )
    else:
        _warn_of_unused("without recompute", delta=delta is not None and recompute == 0)
        _warn_of_unused(
            "without method 'auto'",
            viewpoint=viewpoint is not None,
            viewpoints=viewpoints is not None,
            trajectory=trajectory is not None,
            up=bool(up),
            scans=scans is not None,
            organized=organized is not None,
            closed=closed is not None,
            keep=keep is not None,
            seeds=seeds is not None,
            find_sensors=not find_sensors and (normals != "auto" or k is not None),
        )
        _warn_of_unused("with method 'hoppe'", gamma=gamma is not None and method == "hoppe")
    array, origin = _local(points)
    options["find_sensors"] = bool(find_sensors)
    options["suggested"] = _moved(np.zeros(3), origin)
    options.update(
        _sensors(len(array), origin, viewpoint, viewpoints, trajectory, times, up, scans, organized)
    )
    if keep is not None:
        options["keep"] = _moved(_rows_of("keep", keep, len(array)), np.zeros(3))
    if closed is not None:
        options["closed"] = _flag("closed", closed)
    if seeds is not None:
        if not isinstance(seeds, (tuple, list)) or len(seeds) != 2:
            raise TypeError("seeds must be a pair: points and their normals")
        places = _rows("points of seeds", seeds[0])
        directions = _rows("normals of seeds", seeds[1])
        if len(places) != len(directions):
            raise ValueError(f"seeds have {len(places)} points and {len(directions)} normals")
        options["seeds"] = np.hstack([_moved(places, origin), _moved(directions, np.zeros(3))])
    result = Orientation(*_core.orient(array, options, progress))
    # As it is now: the caller may go on to change what was given.
    result._points = array.copy()
    result._origin = origin
    result._sensors = _sensor_places(viewpoint, viewpoints)
    for kind in ("contradictions", "known_sensors", "sensors"):
        _to_world(result.report[kind], origin)
    return result


def check(
    points: npt.ArrayLike,
    normals: npt.ArrayLike,
    *,
    viewpoint: Optional[Union[Sequence[float], npt.NDArray[Any]]] = None,
    viewpoints: Optional[npt.ArrayLike] = None,
    trajectory: Optional[npt.ArrayLike] = None,
    times: Optional[npt.ArrayLike] = None,
    up: bool = False,
    scans: Optional[npt.ArrayLike] = None,
    organized: Optional[Tuple[int, int]] = None,
    closed: Optional[bool] = None,
    threads: int = 0,
    progress: Optional[Progress] = None,
) -> Check:
    """Which normals contradict the sensors that saw their points, or the surface.

    >>> found = segorient.check(points, normals)
    >>> assert not found.places.max() >= 0, found.report["places"]

    Patches that are turned over, and closed parts that are inside out; single points prove nothing.

    :param points: (n, 3)
    :param normals: (n, 3), of any length; NaN or 0: none
    :param viewpoint, viewpoints, trajectory, times, up, scans, organized, closed: as of :func:`orient`
    :param threads: 0 = as many as the work is worth; results do not depend on it
    :param progress: called with a stage's name and the fraction that is done
    :raises TypeError, ValueError: for arguments that make no sense
    """
    options = _options(None, "auto", None, None, None, None, 0, threads)
    array, origin = _local(points)
    given = _moved(_rows_of("normals", normals, len(array)), np.zeros(3))
    if len(array) > 0 and not (np.isfinite(given).all(axis=1) & given.any(axis=1)).any():
        raise ValueError("normals has none: all rows are zero or not finite")
    options.update(
        _sensors(len(array), origin, viewpoint, viewpoints, trajectory, times, up, scans, organized)
    )
    if closed is not None:
        options["closed"] = _flag("closed", closed)
    result = Check(*_core.check(array, given, options, progress))
    _to_world(result.report["places"], origin)
    return result


def normals(
    points: npt.ArrayLike,
    *,
    normals: str = "auto",
    k: Optional[int] = None,
    alpha: Optional[float] = None,
    beta: Optional[float] = None,
    delta: Optional[float] = None,
    epsilon: Optional[float] = None,
    recompute: int = 0,
    threads: int = 0,
    progress: Optional[Progress] = None,
) -> Normals:
    """One unoriented normal a point.

    :param points: (n, 3)
    :param normals: estimator: ``auto`` (it and its neighbours chosen from the cloud itself),
        ``plane``, ``lct`` and ``ldt`` (local triangulations), ``awas`` and ``awas3`` (quadratic and
        cubic surfaces)
    :param k: neighbours of a point; None: 12, or more where `normals` is ``auto`` and there is noise
    :param alpha, beta, epsilon: degrees, of the segments that `recompute` goes by; see :func:`segment`
    :param delta: degrees, what makes a border a sharp one for `recompute`, which then follows the
        paper's rule instead of fitting surfaces to one side
    :param recompute: rounds of finding normals at sharp edges again
    :param threads: 0 = as many as the work is worth; results do not depend on it
    :param progress: called with a stage's name and the fraction that is done
    :raises TypeError, ValueError: for arguments that make no sense
    """
    options = _options(k, normals, alpha, beta, delta, epsilon, recompute, threads)
    _warn_of_unused(
        "without recompute",
        **{
            name: value is not None and recompute == 0
            for name, value in (("alpha", alpha), ("beta", beta), ("delta", delta), ("epsilon", epsilon))
        },
    )
    return Normals(*_core.normals(_local(points)[0], options, progress))


def segment(
    points: npt.ArrayLike,
    *,
    faces: bool = False,
    split: bool = False,
    method: str = "auto",
    normals: str = "auto",
    k: Optional[int] = None,
    alpha: Optional[float] = None,
    beta: Optional[float] = None,
    delta: Optional[float] = None,
    epsilon: Optional[float] = None,
    recompute: int = 0,
    threads: int = 0,
    progress: Optional[Progress] = None,
) -> Segments:
    """Cuts a cloud into segments of similar normals: those that :func:`orient` gives with the same
    arguments.

    :param points: (n, 3)
    :param faces: unite segments whose common border is smooth: a cylinder is one face then
    :param split: what `faces` is not; up to version 1.0 it had to be asked for
    :param method: see :func:`orient`
    :param normals: estimator, see :func:`normals`; with it or `recompute`, and method ``auto``, segments
        are the paper's by those normals
    :param k: neighbours of a point; None: as :func:`orient`, and 12 with `normals` or `recompute`
    :param alpha: degrees, largest angle between normals of neighbours in a segment; about 20
    :param beta: degrees, largest angle between a normal and its segment's; 30
    :param delta: degrees, see :func:`normals`
    :param epsilon: degrees, by how much the clean-up may exceed `beta`; 10
    :param recompute: rounds of finding normals at sharp edges again before the segments are made anew
    :param threads: 0 = as many as the work is worth; results do not depend on it
    :param progress: called with a stage's name and the fraction that is done
    :raises TypeError, ValueError: for arguments that make no sense
    """
    options = _options(k, normals, alpha, beta, delta, epsilon, recompute, threads)
    for name, value in (("faces", faces), ("split", split)):
        if not isinstance(value, (bool, np.bool_)):
            raise TypeError(f"{name} must be True or False, not {value!r}")
    if faces and split:
        raise ValueError("faces and split contradict each other")
    options["faces"] = bool(faces)
    options["method"] = _word("method", method)
    _warn_of_unused("without recompute", delta=delta is not None and recompute == 0)
    _warn_of_unused("without method 'auto'", faces=bool(faces) and method != "auto")
    return Segments(*_core.segment(_local(points)[0], options, progress))


def knn(
    points: npt.ArrayLike,
    k: int = 15,
    *,
    queries: Optional[npt.ArrayLike] = None,
    threads: int = 0,
) -> Neighbors:
    """The k nearest neighbours of every point, exactly; the point itself is the first.

    :param points: (n, 3)
    :param k: neighbours, the point included
    :param queries: (m, 3) places whose nearest points are wanted instead
    :param threads: 0 = as many as the work is worth; results do not depend on it
    :raises TypeError, ValueError: for arguments that make no sense
    """
    wanted = _whole("k", k, 1, 1000)
    cores = _whole("threads", threads, 0, _MOST_THREADS)
    if wanted is None or cores is None:
        raise TypeError("k and threads must be whole numbers")
    array, origin = _local(points)
    places = None
    if queries is not None:
        rows = _rows("queries", queries)
        places = rows if _is_viewable(rows) and not origin.any() else _moved(rows, origin)
    return Neighbors(*_core.knn(array, wanted, places, cores))


def sensors(
    points: npt.ArrayLike,
    *,
    suggestions: Optional[npt.ArrayLike] = None,
    width: int = 0,
    threads: int = 0,
) -> Sensors:
    """Where the sensors stood, from positions alone: from the density of points on surfaces, which
    falls with distance and incidence, or from the pixels of an organised cloud.

    :param points: (n, 3)
    :param suggestions: (m, 3) positions that are tried first; None: the origin
    :param width: pixels in a row of an organised cloud, row by row; 0: not organised
    :param threads: 0 = as many as the work is worth; results do not depend on it
    :raises TypeError, ValueError: for arguments that make no sense
    """
    cores = _whole("threads", threads, 0, _MOST_THREADS)
    pixels = _whole("width", width, 0, 1 << 30)
    if cores is None or pixels is None:
        raise TypeError("width and threads must be whole numbers")
    array, origin = _local(points)
    places = np.zeros((1, 3)) if suggestions is None else _rows("suggestions", suggestions)
    *found, directions, faces_up = _core.sensors(array, _moved(places, origin), pixels, cores)
    _to_world(found[0], origin)
    return Sensors(*found, directions.reshape(-1, 3), faces_up)
