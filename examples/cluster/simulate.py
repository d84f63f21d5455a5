#!/usr/bin/env python3
"""A cluster on one machine: runs every case of a sweep through sweep.sbatch as Slurm would, pre-empts some jobs (USR1 to
the batch shell), kills others with their whole process group, starts some twice at a time, puts what did not end back
into the queue, and checks that in the end every case is done once and none is lost.

  simulate.py LAYERLOOP SWEEP.toml OUT [--slots 2] [--trouble 0.3] [--seed 1] [--longest 1.0]

Ends with exit code 0 when everything is as it should be.
"""
import argparse, json, os, pathlib, random, signal, stat, subprocess, sys, time

HERE = pathlib.Path(__file__).resolve().parent


class Job:
    """One task of the array: a batch shell in a process group of its own, and what will befall it."""

    def __init__(self, index, fate, delay, environment, log):
        self.index, self.fate = index, fate
        self.at = time.monotonic() + delay
        self.process = subprocess.Popen(
            ["bash", str(HERE / "sweep.sbatch")], env=environment | {"SLURM_ARRAY_TASK_ID": str(index)},
            start_new_session=True, stdout=log, stderr=log)

    def strike(self):
        """Lets the fate come when its time has come. Returns what struck."""
        struck = self.fate
        if struck == "none" or time.monotonic() < self.at or self.process.poll() is not None:
            return "none"
        if struck == "kill":
            os.killpg(self.process.pid, signal.SIGKILL)
        else:
            os.kill(self.process.pid, signal.SIGUSR1)
        self.fate = "none"
        return struck


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("layerloop")
    parser.add_argument("sweep")
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--slots", type=int, default=2)
    parser.add_argument("--trouble", type=float, default=0.3, help="share of the jobs that something befalls")
    parser.add_argument("--longest", type=float, default=1.0, help="seconds until it does, at most")
    parser.add_argument("--seed", type=int, default=1)
    return parser.parse_args()


def environment_of(given):
    """What Slurm would set, and an scontrol that does nothing: the exit code tells that the job goes back."""
    tools = given.out / "tools"
    tools.mkdir(parents=True, exist_ok=True)
    scontrol = tools / "scontrol"
    scontrol.write_text("#!/bin/sh\necho \"$@\" >> \"" + str(given.out / "requeued.log") + "\"\n")
    scontrol.chmod(scontrol.stat().st_mode | stat.S_IXUSR)
    return dict(os.environ, PATH=f"{tools}:{os.environ['PATH']}", SWEEP=given.sweep, OUT=str(given.out / "sweep"),
                LAYERLOOP=given.layerloop, SLURM_ARRAY_JOB_ID="1", SLURM_CPUS_PER_TASK="1", OMP_NUM_THREADS="1")


def cases_of(given):
    text = subprocess.run([given.layerloop, "sweep", given.sweep, "--dry-run"], check=True, capture_output=True,
                          text=True).stdout
    return int(text.splitlines()[-1].split()[2])


def state_of(given, index):
    path = given.out / "sweep" / f"case_{index:04}" / "state.json"
    return json.loads(path.read_text()) if path.is_file() else {"state": "waiting", "attempts": 0}


def run(given, environment, count):
    """Runs the queue to its end. Returns what befell the jobs."""
    chance = random.Random(given.seed)
    queue, running = list(range(1, count + 1)), []
    tally = {"jobs": 0, "none": 0, "kill": 0, "preempt": 0, "twice": 0, "back": 0}
    ended, begun = set(), time.monotonic()
    with open(given.out / "jobs.log", "ab") as log:
        while queue or running:
            while queue and len(running) < given.slots:
                index = queue.pop(0)
                twins = 2 if chance.random() < given.trouble / 6 else 1  # requeued while it still runs
                tally["twice"] += twins - 1
                for _ in range(twins):
                    fate = chance.choice(["kill", "preempt"]) if chance.random() < given.trouble else "none"
                    running.append(Job(index, fate, chance.uniform(0, given.longest), environment, log))
                    tally["jobs"] += 1
            for job in list(running):
                tally[job.strike()] += 1
                if job.process.poll() is None:
                    continue
                running.remove(job)
                if job.process.returncode not in (0, 3):  # 3: a guard of the model, final
                    queue.append(job.index)
                    tally["back"] += 1
                elif state_of(given, job.index)["state"] in ("done", "failed"):
                    ended.add(job.index)
                else:
                    queue.append(job.index)  # its twin had the lock and did not end
            time.sleep(0.01)
            if tally["jobs"] % 100 == 0 and sys.stderr.isatty():
                print(f"\r{len(ended)} of {count} ended, {time.monotonic() - begun:.0f} s", end="", file=sys.stderr)
    return tally


def check(given, environment, count):
    """What is wrong in the end, in words."""
    complaints = []
    before = {k: state_of(given, k) for k in range(1, count + 1)}
    subprocess.run([given.layerloop, "sweep", given.sweep, "-o", environment["OUT"], "--resume", "--quiet"], check=True)
    summary = json.loads((given.out / "sweep" / "summary.json").read_text())
    if len(summary["cases"]) != count:
        complaints.append(f"{len(summary['cases'])} cases in summary.json, not {count}")
    if sorted(case["number"] for case in summary["cases"]) != list(range(1, count + 1)):
        complaints.append("a case is missing or there twice")
    for case in summary["cases"]:
        if case["state"] not in ("done", "failed"):
            complaints.append(f"case {case['number']} is {case['state']}: {case['reason']}")
        if case["attempts"] != before[case["number"]]["attempts"]:
            complaints.append(f"case {case['number']} was done again after it had ended")
        if case["state"] == "done" and "pool" not in case and "layers" not in case and "absorptivity" not in case:
            complaints.append(f"case {case['number']} is done without figures")
    return complaints, summary


def main():
    given = arguments()
    given.out.mkdir(parents=True, exist_ok=True)
    environment = environment_of(given)
    count = cases_of(given)
    begun = time.monotonic()
    tally = run(given, environment, count)
    complaints, summary = check(given, environment, count)
    states = [case["state"] for case in summary["cases"]]
    print(f"{count} cases in {tally['jobs']} jobs, {time.monotonic() - begun:.0f} s: {tally['kill']} killed, "
          f"{tally['preempt']} pre-empted, {tally['twice']} started twice, {tally['back']} went back into the queue")
    print(f"{states.count('done')} done, {states.count('failed')} stopped by a guard of the model, "
          f"{sum(case['attempts'] > 1 for case in summary['cases'])} were struck at work and begun again, one of them "
          f"{max(case['attempts'] for case in summary['cases'])} times in all")
    for complaint in complaints:
        print(complaint)
    print("every case is done once and none is lost" if not complaints else "FAILED")
    sys.exit(1 if complaints else 0)


if __name__ == "__main__":
    main()
