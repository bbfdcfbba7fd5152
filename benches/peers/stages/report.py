"""Prints the ratios and puts the tables of everything measured into docs/benchmarks.md, between two marks."""

import json
import re
import sys

import straight_line
from build import CXX_FLAGS, HERE, PACKAGES
from measure import COUNTS, RESULTS, ROBOTS, family
from tables import ALGORITHMS, DOCUMENT, details, listed, measured, ns, put, ratio, said, system, table, title

BEGIN = "<!-- measured by benches/peers/run: begin -->"
PEERS = {"Pinocchio": "pinocchio", "MuJoCo": "mujoco", "dynibo": "rust-peers", "rapier3d": "rust-peers"}
BUILDS = {"gyroflex": "default build", "gyroflex-x86-64-v3": "x86-64-v3 build", "gyroflex-native": "native build"}

# Of gyroflex's program: one state at a time, or several side by side.
WAYS = ["", "8 lanes", "16 lanes of f32"]


def of_peer(peer, entry):
    is_row = {"dynibo": "dynibo" in entry["row"], "rapier3d": "rapier" in entry["row"]}.get(peer, True)
    return is_row and entry["program"].startswith(PEERS[peer])


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


def is_derivative(entry):
    return family(entry["row"]).endswith("_derivatives")


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
        measured(about, "all programs"),
        system(),
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
    sections = [(RESULTS, whole), (straight_line.RESULTS, straight_line.section)]
    if not any(results.exists() for results, _ in sections):
        sys.exit("nothing is measured yet: run the stage `measure` first")
    for results, section in sections:
        if results.exists():
            section()
            print(f"\nwritten to {DOCUMENT} and, in full, {results}")


def whole():
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
    put(BEGIN, parts)
