# SPDX-License-Identifier: BSD-3-Clause
# Copyright (c) 2026, the segorient authors
"""Clouds of any size on many machines, by an engine of your own: a ``dask.distributed`` client.

    >>> from dask.distributed import Client
    >>> import segorient.distributed
    >>> with Client("tcp://scheduler:8786") as client:
    ...     segorient.distributed.orient("scans/", "oriented.ply", client=client, memory="4G")

All workers must see the same files under the same names, and have the program ``segorient`` of one
version. Tasks are the program's own steps (``segorient tiles``): files in, files out, so that what
a worker that died was at is simply done again.
"""

import os
import pathlib
import shutil
import subprocess
import time
from typing import Any, Dict, List, Optional, Sequence, Union

try:
    import distributed as _distributed
except ImportError as error:  # pragma: no cover - where it is missing
    raise ImportError(
        "segorient.distributed needs dask.distributed: install it by 'apt-get install "
        "python3-distributed' or 'pip install distributed'"
    ) from error

__all__ = ["orient"]

_Path = Union[str, "os.PathLike[str]"]


# The step of a worker that was killed goes on without it and holds the folder; what it leaves is
# what the repeated step would make.
_PATIENCE = 3600.0  # seconds


def _step(words: List[str]) -> str:
    """Runs one step on the worker; what it says on standard error is the exception."""
    end = time.monotonic() + _PATIENCE
    while True:
        run = subprocess.run(
            words, stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False
        )
        if run.returncode == 0:
            return run.stdout
        if "is in use by another run" not in run.stderr or time.monotonic() > end:
            raise RuntimeError(run.stderr.strip() or f"ended with status {run.returncode}")
        time.sleep(1.0)


def _absolute(path: _Path) -> str:
    return str(pathlib.Path(path).absolute())


def _slots(client: Any) -> int:
    """How many tasks one machine can run at once, of those where that is least."""
    slots: Dict[str, int] = {}
    for worker in client.scheduler_info()["workers"].values():
        slots[worker["host"]] = slots.get(worker["host"], 0) + worker["nthreads"]
    return min(slots.values(), default=1)


def _numbers(text: str) -> List[int]:
    """Those behind the words of a step's lines."""
    return [int(line.split()[1]) for line in text.splitlines()]


def orient(
    inputs: Union[_Path, Sequence[_Path]],
    output: _Path,
    *,
    client: Any,
    memory: str = "2G",
    work: Optional[_Path] = None,
    options: Sequence[str] = (),
    threads: int = 1,
    program: Optional[str] = None,
    retries: int = 3,
) -> None:
    """Orients clouds tile by tile on the workers of a client.

    Args:
        inputs: a file, a folder of clouds, or a sequence of either.
        output: a file (.ply, .pcd or .las), or a folder that is there: one output for each input.
        client: a ``dask.distributed.Client``.
        memory: what one task may take, as in "4G": no more than a worker has for each of its
            threads.
        work: the folder for tiles, which all workers see; the output's name and ".work" by default.
            A run that was interrupted goes on there if it is called again.
        options: more words for ``segorient tiles plan``, as in ["--up"], or
            ["--trajectory", "flight.txt"] with a name that all workers know.
        threads: threads of one task; as many as a worker's ``nthreads`` leaves it. Steps that all
            others wait for take what all workers of one machine have.
        program: the program's name on the workers; by default where it is here, or "segorient".
        retries: how often a task that failed is tried again.

    Raises:
        RuntimeError: with the line that the program wrote, if a step fails for good.
    """
    if isinstance(inputs, (str, os.PathLike)):
        inputs = [inputs]
    name = program or os.environ.get("SEGORIENT_PROGRAM") or shutil.which("segorient") or "segorient"
    folder = _absolute(work if work is not None else str(output).rstrip("/") + ".work")
    tiles = [name, "tiles"]
    how = ["--threads", str(threads)]
    alone = ["--threads", str(threads * _slots(client))]

    def run(task: List[List[str]]) -> List[str]:
        # Not pure: a task that is repeated must run again, whatever its words.
        futures = [client.submit(_step, words, pure=False, retries=retries) for words in task]
        try:
            return client.gather(futures)
        except BaseException:
            client.cancel(futures)
            raise

    plan = [*tiles, "plan", folder, *map(_absolute, inputs), _absolute(output)]
    count, outputs = _numbers(run([[*plan, "--memory", memory, *alone, *options]])[0])
    every_tile = [[*tiles, "tile", folder, str(n), *how] for n in range(count)]
    run(every_tile)
    again = _numbers(run([[*tiles, "join", folder, *alone]])[0])
    run([every_tile[n] for n in again])  # with the signs of the whole, as their own were others
    last = alone if outputs == 1 else how
    run([[*tiles, "write", folder, str(n), *last] for n in range(outputs)])
    run([[*tiles, "clean", folder]])
