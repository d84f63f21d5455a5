"""The verb sweep from outside: signals, ranks in groups, job arrays on a cluster that loses jobs."""
import csv
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import h5py

PROGRAM, MPIEXEC = sys.argv[1], sys.argv[2]
HERE = pathlib.Path(__file__).resolve().parent
CLUSTER = HERE.parents[1] / "examples" / "cluster"
os.environ.update(OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", OMP_NUM_THREADS="1")

LAYERS = (HERE / "spread_small.toml").read_text().replace("replicates = 3\n", "checkpoint = true\n") + """
[sweep]
verb = "spread"
[sweep.vary]
machine.recoating_speed = ["60 mm/s", "90 mm/s"]
"""
TRACKS = (CLUSTER / "sweep.toml").read_text().split("[sweep.vary]")[0] + """
[sweep.vary]
laser.power = [60, 100, 140]
scan.scan_speed = [0.5, 1, 1.5, 2]
"""


def layerloop(*arguments, ranks=1):
    start = [MPIEXEC, "-n", str(ranks), "--oversubscribe"] if ranks > 1 else []
    return subprocess.run([*start, PROGRAM, *map(str, arguments)], capture_output=True, text=True, timeout=300)


def positions(folder):
    beds = {}
    for path in sorted(folder.glob("case_*/bed_*.h5")):
        with h5py.File(path) as file:
            beds[str(path.relative_to(folder))] = file["bed/position"][()].tobytes()
    return beds


def pools(folder):
    return [(c["settings"], c["pool"]) for c in json.loads((folder / "summary.json").read_text())["cases"]]


class Sweep(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="layerloop-test-"))
        cls.layers, cls.tracks = cls.folder / "layers.toml", cls.folder / "tracks.toml"
        cls.pair = cls.folder / "pair.toml"
        cls.pair.write_text(TRACKS.split("laser.power")[0] + "laser.power = [60, 62, 64]\n")
        cls.layers.write_text(LAYERS)
        cls.tracks.write_text(TRACKS)

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    def tracks_alone(self):
        """The tracks swept by one process."""
        out = self.folder / "alone"
        if not out.exists():
            self.assertEqual(layerloop("sweep", self.tracks, "-o", out, "--quiet").returncode, 0)
        return out

    def test_a_signal_leaves_a_checkpoint_and_resume_gives_the_same(self):
        whole, cut = self.folder / "whole", self.folder / "cut"
        self.assertEqual(layerloop("sweep", self.layers, "-o", whole, "--quiet").returncode, 0)
        stopped = 0
        for attempt in range(5):
            process = subprocess.Popen([PROGRAM, "sweep", self.layers, "-o", cut, "--quiet", "--resume"],
                                       start_new_session=True, stderr=subprocess.PIPE, text=True)
            begun, deadline = time.time(), time.monotonic() + 60
            while time.monotonic() < deadline and process.poll() is None and attempt < 2:
                if any(state.stat().st_mtime > begun for state in cut.glob("case_*/state.json")):  # it is at a case
                    process.send_signal(signal.SIGUSR1)
                    break
                time.sleep(0.005)
            _, words = process.communicate(timeout=120)
            if process.returncode == 0:
                break
            self.assertEqual(process.returncode, 5, words)
            self.assertIn("--resume", words)
            stopped += 1
        self.assertGreaterEqual(stopped, 1)
        self.assertEqual(positions(cut), positions(whole))
        self.assertGreater(len(positions(whole)), 0)

    def test_a_run_on_a_first_layer_from_the_cache_is_the_same_to_the_bit(self):
        loops = self.folder / "loops.toml"
        loops.write_text((HERE / "small.toml").read_text() +
                         "[sweep]\nverb = \"run\"\n[sweep.vary]\nlaser.power = [\"60 W\", \"80 W\"]\n")
        out, alone = self.folder / "swept", self.folder / "loop"
        self.assertEqual(layerloop("sweep", loops, "-o", out, "--quiet").returncode, 0)
        self.assertEqual(layerloop("run", HERE / "small.toml", "-o", alone, "--quiet").returncode, 0)
        self.assertEqual(len([path for path in (out / "beds").iterdir() if path.is_dir()]), 1)
        summaries = [json.loads((folder / "summary.json").read_text()) for folder in (out / "case_0002", alone)]
        for summary in summaries:
            del summary["wall_time"]
        self.assertEqual(*summaries)
        for name in ("bed_0001.h5", "bed_0002.h5"):
            with h5py.File(out / "case_0002" / name) as swept, h5py.File(alone / name) as single:
                self.assertEqual(swept["bed/position"][()].tobytes(), single["bed/position"][()].tobytes())

    def test_a_frozen_zone_is_part_of_every_run(self):
        zone = ["--set", "machine.frozen_zone=[\"220 um\", \"340 um\"]"]
        frozen, out, alone = self.folder / "frozen.toml", self.folder / "frozen", self.folder / "frozen_alone"
        case = (HERE / "small.toml").read_text()
        frozen.write_text(case + "[sweep]\nverb = \"run\"\n[sweep.vary]\nmachine.recoating_speed = [0.04]\n")
        self.assertEqual(layerloop("sweep", frozen, "-o", out, "--quiet", *zone).returncode, 0)
        self.assertEqual(layerloop("run", HERE / "small.toml", "-o", alone, "--quiet", *zone).returncode, 0)
        layers = [json.loads((folder / "summary.json").read_text())["layers"] for folder in (out / "case_0001", alone)]
        self.assertEqual(*layers)

    def test_two_tasks_that_end_at_once_both_end_well(self):
        for k in range(3):
            out = self.folder / f"ends{k}"
            self.assertEqual(layerloop("sweep", self.pair, "-o", out, "--quiet", "--index", 3).returncode, 0)
            tasks = [subprocess.Popen([PROGRAM, "sweep", self.pair, "-o", out, "--quiet", "--index", str(index)],
                                      stderr=subprocess.PIPE, text=True) for index in (1, 2)]
            for task in tasks:
                _, words = task.communicate(timeout=60)
                self.assertEqual(task.returncode, 0, words)
            self.assertEqual(len(pools(out)), 3)

    def test_groups_of_ranks_share_the_cases(self):
        alone, shared = self.tracks_alone(), self.folder / "shared"
        done = layerloop("sweep", self.tracks, "-o", shared, "--quiet", "--groups", 2, ranks=2)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(pools(shared), pools(alone))
        with open(shared / "cases.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([row["state"] for row in rows], ["done"] * 12)
        self.assertEqual([row["laser.power [W]"] for row in rows[::4]], ["60", "100", "140"])

    def test_a_case_that_a_guard_stops_ends_its_job_with_3(self):
        bad = self.folder / "bad.toml"
        bad.write_text(TRACKS.replace("[60, 100, 140]", "[60, 100]") + "effects.evaporation.enabled = [true, false]\n"
                       "laser.spot_diameter = [\"80 um\", \"20 um\"]\n")
        out = self.folder / "guarded"
        self.assertEqual(layerloop("sweep", bad, "-o", out, "--quiet", "--index", 1).returncode, 0)
        done = layerloop("sweep", bad, "-o", out, "--quiet", "--index", 4)
        self.assertEqual(done.returncode, 3, done.stderr)
        self.assertIn("evaporation", done.stderr)

    def test_a_cluster_that_loses_jobs_loses_no_case(self):
        done = subprocess.run([sys.executable, CLUSTER / "simulate.py", PROGRAM, self.tracks, self.folder / "cluster",
                               "--trouble", "0.5", "--seed", "3", "--longest", "0.5"], capture_output=True, text=True,
                              timeout=280)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn("every case is done once and none is lost", done.stdout)
        self.assertEqual(pools(self.folder / "cluster" / "sweep"), pools(self.tracks_alone()))


unittest.main(argv=sys.argv[:1] + sys.argv[3:])
