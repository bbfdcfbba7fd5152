"""Runs all programs side by side on one core, a short batch each in turn, and counts instructions."""

import json
import os
import re
import statistics
import subprocess
import sys
import time
from collections import defaultdict
from datetime import datetime, timezone

from build import BIN, HOME, MODELS, REPOSITORY, programs

ROBOTS = ["panda", "panda_flex", "ur5", "ur5_flex", "talos", "talos_flex"]
RESULTS = HOME / "results.json"
COUNTS = HOME / "instructions.json"


class Program:
    """A worker process: it waits for the name of a row and answers with the time of a short batch."""

    def __init__(self, name, core, robots=ROBOTS):
        self.name = name
        path = BIN / name
        if not path.exists():
            sys.exit(f"{path} is missing: run the stage `build`")
        self.process = subprocess.Popen([str(path), str(MODELS), *robots], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                        text=True, bufsize=1)
        os.sched_setaffinity(self.process.pid, {core})
        self.errors = {}
        for line in self.process.stdout:
            if line.strip() == "ready":
                return
            row, _, error = line.removeprefix("row ").rpartition(" ")
            self.errors[row] = float(error)
        sys.exit(f"{name} stopped at its checks, see above; nothing was measured")

    def batch(self, row):
        self.process.stdin.write(row + "\n")
        self.process.stdin.flush()
        answer = self.process.stdout.readline().split()
        if len(answer) != 2:
            sys.exit(f"{self.name} stopped at {row}")
        return float(answer[0]), float(answer[1])

    def close(self):
        self.process.stdin.close()
        self.process.wait()


def family(row):
    """`panda/aba` of `panda/aba:local`."""
    return row.split(":")[0]


def library():
    """The commit that last changed gyroflex itself, and whether its files differ from it."""
    git = ["git", "-C", str(REPOSITORY)]
    commit = subprocess.run([*git, "log", "-1", "--format=%h", "--", "crates"], capture_output=True, text=True).stdout.strip()
    same = subprocess.run([*git, "diff", "--quiet", "HEAD", "--", "crates"]).returncode == 0
    return commit + ("" if same else " with changes")


def side_by_side(workers, wanted, options):
    """Rounds in which every program has its turn with every row that is wanted; what the run was like, and the times."""
    started = datetime.now(timezone.utc)
    # Rows of one robot and algorithm stand together, so that what is compared is measured within a tenth of a second.
    turns = defaultdict(list)
    for worker in workers:
        for row in worker.errors:
            if wanted(worker, row) and options.rows in row:
                turns[family(row)].append((worker, row))
    batches = defaultdict(list)
    load = os.getloadavg()[0]
    for number in range(options.rounds):
        for group in turns.values():
            # Nobody always comes first.
            shift = number % len(group)
            for worker, row in group[shift:] + group[:shift]:
                batches[worker.name, row].append(worker.batch(row))
        if number % 10 == 9:
            elapsed = (datetime.now(timezone.utc) - started).total_seconds()
            print(f"round {number + 1} of {options.rounds}, {elapsed:.0f} s, load {os.getloadavg()[0]:.1f}", flush=True)
    errors = {(worker.name, row): error for worker in workers for row, error in worker.errors.items()}
    for worker in workers:
        worker.close()
    rows = [{"program": program, "row": row, "error": errors[program, row],
             "fastest": [round(b[0], 2) for b in found], "middle": [round(b[1], 2) for b in found]}
            for (program, row), found in batches.items()]
    about = {"library": library(), "started": started.strftime("%Y-%m-%d %H:%M UTC"), "rounds": options.rounds, "core": options.core,
             "load": [round(load, 2), round(os.getloadavg()[0], 2)]}
    return about, rows


def kept(about, rows, stage, options, path):
    """Writes a whole run to a file; of some rows, prints the times and keeps nothing."""
    if options.rows:
        for entry in sorted(rows, key=lambda entry: family(entry["row"])):
            middle = statistics.median(entry["middle"])
            print(f"{entry['row']:40} {entry['program']:24} {min(entry['fastest']):10,.0f} ns, median {middle:10,.0f} ns")
        return
    about["command"] = f"benches/peers/run {stage}" + (f" --rounds {options.rounds}" if options.rounds != 100 else "")
    path.write_text(json.dumps({"about": about, "rows": rows}))
    print(f"written to {path}")


def measure(options):
    names = [name for name, _ in programs() if not options.rows or (BIN / name).exists()]
    workers = [Program(name, options.core) for name in names]
    ours = {family(row) for worker in workers if worker.name == "gyroflex" for row in worker.errors}
    about, rows = side_by_side(workers, lambda _, row: family(row) in ours, options)
    kept(about, rows, "measure", options, RESULTS)


def collected(program, row, calls):
    """Instructions of a whole run."""
    command = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", str(BIN / program), str(MODELS),
               family(row).split("/")[0], "--count", row, str(calls)]
    answer = subprocess.run(command, capture_output=True, text=True)
    found = re.search(r"Collected : (\d+)", answer.stderr)
    return int(found.group(1)) if answer.returncode == 0 and found else None


def instructions(_):
    """Instructions per call over the 256 states: a run with two passes less one with one, so that loading does not count."""
    if not RESULTS.exists():
        sys.exit("run the stage `measure` first: it says which rows there are")
    counts = []
    began = time.monotonic()
    for entry in json.loads(RESULTS.read_text())["rows"]:
        program, row = entry["program"], entry["row"]
        # valgrind has no AVX-512; rapier's step depends on where it has got to; benches/instructions counts ours, which takes a
        # different number to load at every start.
        if "native" in program or "rapier" in row or program.startswith("gyroflex"):
            continue
        once, twice = (collected(program, row, 256 * passes) for passes in (1, 2))
        if once is None or twice is None:
            print(f"{program} {row}: valgrind does not know one of its instructions", flush=True)
            continue
        counts.append({"program": program, "row": row, "instructions": round((twice - once) / 256)})
    COUNTS.write_text(json.dumps(counts))
    print(f"written to {COUNTS}, {time.monotonic() - began:.0f} s")
