"""Prints the ratios and puts the tables into docs/benchmarks.md, between two marks."""

import json
import platform
import re
import statistics
import subprocess
import sys

from build import CXX_FLAGS, HERE, HOME, PACKAGES, REPOSITORY
from measure import COUNTS, RESULTS, ROBOTS, family

DOCUMENT = REPOSITORY / "docs/benchmarks.md"
BEGIN, END = "<!-- measured by benches/peers/run: begin -->", "<!-- end -->"
ALGORITHMS = {"aba": "forward dynamics", "rnea": "inverse dynamics", "crba": "inertia matrix", "fk": "link poses",
              "aba_derivatives": "derivatives of forward dynamics", "rnea_derivatives": "derivatives of inverse dynamics",
              "constrained": "forward dynamics on two feet"}
PEERS = {"Pinocchio": "pinocchio", "MuJoCo": "mujoco", "dynibo": "rust-peers", "rapier3d": "rust-peers"}
BUILDS = {"gyroflex": "default build", "gyroflex-x86-64-v3": "x86-64-v3 build", "gyroflex-native": "native build"}

# Of gyroflex's program: one state at a time, or several side by side.
WAYS = ["", "8 lanes", "16 lanes of f32"]


def said(*command):
    try:
        answer = subprocess.run(command, capture_output=True, text=True, cwd=REPOSITORY)
    except FileNotFoundError:
        return "not installed"
    return (answer.stdout.strip().splitlines() or ["unknown"])[0]


def ns(number):
    return f"{number:,.0f}" if number >= 100 else f"{number:.1f}"


def table(head, rows):
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def of_peer(peer, entry):
    is_row = {"dynibo": "dynibo" in entry["row"], "rapier3d": "rapier" in entry["row"]}.get(peer, True)
    return is_row and entry["program"].startswith(PEERS[peer])


def title(robot):
    return robot.replace("_flex", ", with rotors")


def ratio(entry, ours):
    """How many times as long as ours, the median over the rounds: both had the same moment of the machine."""
    return statistics.median(theirs / mine for theirs, mine in zip(entry["fastest"], ours["fastest"]))


def comparison(entries):
    """One line per algorithm and robot, every peer with the fastest of its builds and ways."""
    rows = []
    for algorithm, words in ALGORITHMS.items():
        for robot in ROBOTS:
            group = [e for e in entries if family(e["row"]) == f"{robot}/{algorithm}"]
            ours = {e["program"]: e for e in group if e["program"] in BUILDS and ":" not in e["row"]}
            if not ours:
                continue
            cells = [f"{words} · {title(robot)}", *(ns(min(ours[build]["fastest"])) for build in BUILDS)]
            for peer in PEERS:
                found = [e for e in group if of_peer(peer, e)]
                best = min(found, key=lambda e: min(e["fastest"]), default=None)
                cells.append("–" if best is None else f"{ns(min(best['fastest']))} ({ratio(best, ours['gyroflex']):.1f}×)")
            rows.append(cells)
    return table(["", *(f"gyroflex, {build}" for build in BUILDS.values()), *PEERS], rows)


def variant(entry):
    call = entry["row"].partition(":")[2]
    return entry["program"] + (f", {call}" if call else "")


def details(entries, algorithm, counts):
    """Every program and call: fastest, median, and instructions where they are counted."""
    mine = [e for e in entries if family(e["row"]).endswith(f"/{algorithm}")]
    robots = [r for r in ROBOTS if any(e["row"].startswith(f"{r}/") for e in mine)]
    rows = []
    for name in sorted({variant(e) for e in mine}):
        cells = [name]
        for robot in robots:
            entry = next((e for e in mine if variant(e) == name and e["row"].startswith(f"{robot}/")), None)
            if entry is None:
                cells.append("–")
                continue
            count = counts.get((entry["program"], entry["row"]))
            cells.append(f"{ns(min(entry['fastest']))} ({ns(statistics.median(entry['middle']))})"
                         + (f" · {count:,}" if count else ""))
        rows.append(cells)
    return table([ALGORITHMS[algorithm], *map(title, robots)], rows)


def per_link(entries):
    """Cost per link of chains and binary trees with rotors, as their number grows."""
    sizes = sorted({int(e["row"].partition("/")[0].removeprefix("chain")) for e in entries if e["row"].startswith("chain")})
    rows = []
    for shape in ("chain", "tree"):
        for algorithm in ("aba", "rnea"):
            for program, words in BUILDS.items():
                found = {e["row"]: e for e in entries if e["program"] == program}
                costs = [min(found[f"{shape}{n}/{algorithm}"]["fastest"]) / n for n in sizes]
                rows.append([f"{ALGORITHMS[algorithm]} · {shape}, {words}", *map(ns, costs)])
    return table(["ns per link", *(f"{n} links" for n in sizes)], rows)


def throughput(entries):
    """Million states a second on one core: one at a time, and side by side where there is such a thing."""
    rows = []
    for algorithm in ("aba", "rnea"):
        for robot in ROBOTS:
            group = [e for e in entries if family(e["row"]) == f"{robot}/{algorithm}"]
            cells = [f"{ALGORITHMS[algorithm]} · {title(robot)}"]
            for program in ("gyroflex", "gyroflex-native"):
                for way in WAYS:
                    found = next(e for e in group if e["program"] == program and e["row"].partition(":")[2] == way)
                    cells.append(f"{1e3 / min(found['fastest']):.2f}")
            for peer in ("Pinocchio", "MuJoCo", "dynibo"):
                cells.append(f"{1e3 / min(min(e['fastest']) for e in group if of_peer(peer, e)):.2f}")
            rows.append(cells)
    ours = [f"gyroflex, {BUILDS[program]}, {way or 'one state'}" for program in ("gyroflex", "gyroflex-native") for way in WAYS]
    return table(["million states a second", *ours, "Pinocchio", "MuJoCo", "dynibo"], rows)


def machine():
    with open("/proc/cpuinfo") as file:
        fields = dict(re.findall(r"^(model name|cpu family|model|stepping)\s*: (.*)$", file.read(), re.M))
    return f"{fields['model name']} (family {fields['cpu family']}, model {fields['model']}, stepping {fields['stepping']})"


def is_derivative(entry):
    return family(entry["row"]).endswith("_derivatives")


def listed(errors):
    return ", ".join(f"{name} {error:.0e}" for name, error in errors.items())


def circumstances(about, entries):
    crates = re.findall(r'name = "(dynibo|rapier3d-f64)"\nversion = "(.*)"', (HERE / "rust/Cargo.lock").read_text())
    values = [e for e in entries if not is_derivative(e)]
    errors = {peer: max((e["error"] for e in values if of_peer(peer, e)), default=0) for peer in PEERS}
    for name, single in (("gyroflex in f32", True), ("gyroflex", False)):
        mine = (e["error"] for e in values if e["program"] in BUILDS and e["row"].endswith("f32") == single)
        errors = {name: max(mine), **errors}
    slopes = {name: max((e["error"] for e in entries if is_derivative(e) and is_mine(e)), default=0)
              for name, is_mine in (("gyroflex", lambda e: e["program"] in BUILDS),
                                    ("Pinocchio", lambda e: of_peer("Pinocchio", e)))}
    return "\n".join([
        f"* Measured {about['started']} with `{about['command']}` on the library of commit {about['library']}, "
        f"{about['rounds']} rounds, all programs pinned to core {about['core']}, load average {about['load'][0]} before and "
        f"{about['load'][1]} after.",
        f"* Machine: {machine()}, {platform.system()} {platform.release()}.",
        f"* Compilers: {said('rustc', '--version')}; {said('clang++', '--version')}.",
        f"* Versions: {', '.join(package.replace('==', ' ') for package in PACKAGES)}; "
        f"{', '.join(f'{name} {version}' for name, version in crates)}.",
        f"* Flags: Pinocchio (headers alone) `clang++ {' '.join(CXX_FLAGS)}` with `-march=native` and `-march=x86-64-v3`; MuJoCo as "
        "in its wheel; gyroflex `cargo build --release` without flags, and with `-C target-cpu=`; the other crates "
        "`-C target-cpu=` with link-time optimisation.",
        f"* Largest difference from the expected values: {listed(errors)}; of derivatives, where Pinocchio's builds differ from each "
        f"other with light fast rotors: {listed(slopes)}.",
    ])


def report(_):
    if not RESULTS.exists():
        sys.exit("nothing is measured yet: run the stage `measure` first")
    found = json.loads(RESULTS.read_text())
    entries = found["rows"]
    counted = json.loads(COUNTS.read_text()) if COUNTS.exists() else []
    counts = {(c["program"], c["row"]): c["instructions"] for c in counted}
    summary = comparison(entries)
    print(summary)
    parts = [circumstances(found["about"], entries),
             "Nanoseconds per call, the fastest batch. In brackets how many times as long as gyroflex's default build, "
             "the median over the rounds; each peer with the fastest of its builds and ways.", summary,
             "Throughput of one core. Lanes are states computed side by side by the same source; the others have no such thing.",
             throughput(entries),
             "Every build and way, with lanes per state: fastest batch (median batch)" + (" · instructions per call; gyroflex's are in "
             "benches/instructions.txt, where `arm7` is built like `panda`" if counts else "") + "."]
    parts += [details(entries, algorithm, counts) for algorithm in ALGORITHMS]
    parts += ["Chains and binary trees of any size, every joint with a rotor behind an elastic transmission, gyroflex alone:",
              per_link(entries)]
    text = DOCUMENT.read_text()
    before, _, rest = text.partition(BEGIN)
    _, mark, after = rest.partition(END)
    if not mark:
        sys.exit(f"{DOCUMENT} has no place for the tables: it needs the lines `{BEGIN}` and `{END}`")
    DOCUMENT.write_text(before + BEGIN + "\n\n" + "\n\n".join(parts) + "\n\n" + END + after)
    print(f"\nwritten to {DOCUMENT} and, in full, {HOME / 'results.json'}")
