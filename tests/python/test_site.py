"""What checks the links of the documentation's site finds those that lead nowhere, and no others."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

CHECK = Path(__file__).parents[2] / "docs" / "site" / "check_links.py"
TARGET = '<h1 id="there">There</h1><a name="old"></a>'


@pytest.mark.parametrize(
    ("link", "leads"),
    [
        ("b.html", True),
        ("b.html#there", True),
        ("b.html#old", True),
        ("#here", True),
        ("folder/", True),
        ("folder/index.html?shown=1", True),
        ("https://example.org/nowhere", True),
        ("mailto:somebody@example.org", True),
        ("c.html", False),
        ("b.html#elsewhere", False),
        ("#elsewhere", False),
        ("empty/", False),
        ("/b.html", False),
        ("../outside.html", False),
    ],
)
def test_links_that_lead_nowhere_are_found(tmp_path: Path, link: str, leads: bool) -> None:
    site = tmp_path / "site"
    for folder in ("folder", "empty"):
        (site / folder).mkdir(parents=True)
    (tmp_path / "outside.html").write_text(TARGET)
    (site / "b.html").write_text(TARGET)
    (site / "folder" / "index.html").write_text(TARGET)
    (site / "a.html").write_text(f'<h1 id="here">Here</h1><a href="{link}">on</a>')
    done = subprocess.run([sys.executable, CHECK, site], capture_output=True, text=True, check=False)
    assert done.returncode == (0 if leads else 1), done.stdout
    assert (f"a.html: {link} leads nowhere" in done.stdout) is not leads
