"""What the tables of all sections are made of, and the document that they stand in."""

import platform
import re
import statistics
import subprocess

from build import REPOSITORY
from measure import ROBOTS, family

ALGORITHMS = {"aba": "forward dynamics", "rnea": "inverse dynamics", "crba": "inertia matrix", "fk": "link poses",
              "aba_derivatives": "derivatives of forward dynamics", "rnea_derivatives": "derivatives of inverse dynamics",
              "constrained": "forward dynamics on two feet"}
DOCUMENT = REPOSITORY / "docs/benchmarks.md"
END = "<!-- end -->"


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


def title(robot):
    return robot.replace("_flex", ", with rotors")


def ratio(entry, ours):
    """How many times as long as ours, the median over the rounds: both had the same moment of the machine."""
    return statistics.median(theirs / mine for theirs, mine in zip(entry["fastest"], ours["fastest"]))


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


def machine():
    with open("/proc/cpuinfo") as file:
        fields = dict(re.findall(r"^(model name|cpu family|model|stepping)\s*: (.*)$", file.read(), re.M))
    return f"{fields['model name']} (family {fields['cpu family']}, model {fields['model']}, stepping {fields['stepping']})"


def system():
    return f"* Machine: {machine()}, {platform.system()} {platform.release()}."


def measured(about, what):
    return (f"* Measured {about['started']} with `{about['command']}` on the library of commit {about['library']}, "
            f"{about['rounds']} rounds, {what} pinned to core {about['core']}, load average {about['load'][0]} before and "
            f"{about['load'][1]} after.")


def listed(errors):
    return ", ".join(f"{name} {error:.0e}" for name, error in errors.items())


def put(begin, parts):
    """Replaces what stands in the document between a mark and the next end."""
    text = DOCUMENT.read_text()
    before, _, rest = text.partition(begin)
    _, mark, after = rest.partition(END)
    if not mark:
        raise SystemExit(f"{DOCUMENT} has no place for the tables: it needs the lines `{begin}` and `{END}`")
    DOCUMENT.write_text(before + begin + "\n\n" + "\n\n".join(parts) + "\n\n" + END + after)
