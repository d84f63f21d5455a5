"""Runs `layerloop melt`; what has been computed once, by the same program from the same case, is not computed again."""
import concurrent.futures
import hashlib
import json
import os
import pathlib
import shutil
import subprocess

HERE = pathlib.Path(__file__).parent


class Melt:
    def __init__(self, program, out, jobs, accept_older):
        self.program, self.out, self.jobs, self.accept_older = program.resolve(), out.resolve(), jobs, accept_older
        self.build = hashlib.sha256(self.program.read_bytes()).hexdigest()
        out.mkdir(parents=True, exist_ok=True)

    def __call__(self, cases):
        """[(case file, settings, further arguments), ...] side by side; their summaries, None where a run stopped."""
        return [json.loads((folder / "summary.json").read_text()) for folder in self.side_by_side("melt", cases)]

    def spread(self, cases):
        """The same of `layerloop spread`; the folders."""
        return self.side_by_side("spread", cases)

    def side_by_side(self, verb, cases):
        """The folders of the cases; those that are the same run once."""
        wanted = [(self.folder(verb, *case), case) for case in cases]
        with concurrent.futures.ThreadPoolExecutor(self.jobs) as pool:
            list(pool.map(lambda case: self.done(verb, *case), dict(wanted).values()))
        return [folder for folder, _ in wanted]

    def done(self, verb, case, settings, arguments=()):
        """The folder of a run that is there now."""
        folder = self.folder(verb, case, settings, arguments)
        if self.fresh(folder):
            return folder
        shutil.rmtree(folder, ignore_errors=True)
        run = self.start(verb, case, settings, arguments, folder)
        if run.returncode == 3:  # a guard of the physics; kept, so that it is not tried again
            folder.mkdir(exist_ok=True)
            (folder / "summary.json").write_text("null")
            (folder / "stopped.txt").write_text(run.stderr)
        elif run.returncode:
            raise RuntimeError(f"{' '.join(map(str, run.args))}\n{run.stderr}")
        for large in folder.glob("*.h5"):
            large.unlink()
        (folder / "build.txt").write_text(self.build)
        return folder

    def folder(self, verb, case, settings, arguments=()):
        told = json.dumps([verb, (HERE / case).read_text(), sorted(settings.items()), [file_or_word(a) for a in arguments]])
        return self.out / hashlib.sha256(told.encode()).hexdigest()[:16]

    def fresh(self, folder):
        mark = folder / "build.txt"
        return (folder / "summary.json").exists() and mark.exists() and (self.accept_older or mark.read_text() == self.build)

    def start(self, verb, case, settings, arguments, folder):
        sets = [word for key, value in settings.items() for word in ("--set", f"{key}={value}")]
        return subprocess.run([self.program, verb, HERE / case, *arguments, *sets, "-o", folder, "--quiet", "--threads", "1"],
                              capture_output=True, text=True, cwd=self.out, env={**os.environ, "OMP_NUM_THREADS": "1"})


def file_or_word(argument):
    """What an argument says: of a file its contents."""
    path = pathlib.Path(argument)
    return hashlib.sha256(path.read_bytes()).hexdigest() if path.is_file() else str(argument)
