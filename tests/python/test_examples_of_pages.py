"""The Python examples of the READMEs and the guide run as written, one after the other."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

PROJECT = Path(__file__).parents[2]
PAGES = [path for path in (PROJECT / "README.md", PROJECT / "crates/py/README.md", *sorted((PROJECT / "docs").glob("*.md"))) if "```python\n" in path.read_text()]


@pytest.mark.parametrize("page", PAGES, ids=lambda path: str(path.relative_to(PROJECT)))
def test_the_examples_of_a_page_run(page: Path, tmp_path: Path) -> None:
    (tmp_path / "robots").symlink_to(PROJECT / "robots")
    examples = re.findall(r"```python\n(.*?)```", page.read_text(), flags=re.DOTALL)
    # Pages of the guide do not import for every line that they show, and there is no cluster here.
    imports = [] if page.name == "README.md" else ["import gyroflex, numpy as np"]
    program = "\n".join([*imports, *(example for example in examples if "scheduler:" not in example)])
    done = subprocess.run([sys.executable, "-c", program], cwd=tmp_path, env=os.environ | {"MPLBACKEND": "Agg"}, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
