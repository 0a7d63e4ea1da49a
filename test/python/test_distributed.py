# SPDX-License-Identifier: BSD-3-Clause
# Copyright (c) 2026, the segorient authors
"""segorient.distributed against the program's own run, on two local workers, one of which is killed."""

import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import threading
import unittest

try:
    import distributed
except ImportError:
    distributed = None

PROGRAM = os.environ["SEGORIENT_PROGRAM"]
FANDISK = os.path.join(os.environ["SEGORIENT_TEST_DATA"], "fandisk_16475.pcd")


class Distributed(unittest.TestCase):
    @unittest.skipIf(distributed is None, "dask.distributed is not installed")
    def test_two_workers_give_the_same_bytes_as_one_machine(self):
        import segorient.distributed

        with tempfile.TemporaryDirectory() as name:
            scratch = pathlib.Path(name)
            alone = scratch / "alone.ply"
            tiles = ["--memory", "1G", "--tile-points", "4000"]
            subprocess.run([PROGRAM, "orient", FANDISK, alone, "-q", *tiles], check=True)
            together = scratch / "together.ply"
            cluster = distributed.LocalCluster(
                n_workers=2, threads_per_worker=1, dashboard_address=None, local_directory=name
            )
            with cluster, distributed.Client(cluster) as client:
                # At some moment: what it was at is done again, by the other one or the next.
                worker = next(iter(client.run(os.getpid).values()))
                killer = threading.Timer(0.7, os.kill, [worker, signal.SIGKILL])
                killer.start()
                segorient.distributed.orient(
                    FANDISK, together, client=client, memory="1G", options=tiles[2:], program=PROGRAM
                )
                killer.join()
                self.assertEqual(alone.read_bytes(), together.read_bytes())
                self.assertFalse((scratch / "together.ply.work").exists())
                with self.assertRaisesRegex(RuntimeError, "nowhere.ply"):
                    segorient.distributed.orient(
                        scratch / "nowhere.ply", together, client=client, program=PROGRAM, retries=0
                    )

    def test_where_dask_is_missing_the_message_says_what_to_install(self):
        code = "import sys; sys.modules['distributed'] = None; import segorient.distributed"
        run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
        self.assertNotEqual(run.returncode, 0)
        self.assertIn("python3-distributed", run.stderr)


if __name__ == "__main__":
    unittest.main()
