"""Checks that every link within a site leads to a file of it, and to a place in that file.

Links to elsewhere are not followed. Usage: check_links.py FOLDER
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from functools import cache
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit


class Page(HTMLParser):
    """Links of a page, and the places in it."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.links: set[str] = set()
        self.places: set[str] = set()
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        for key, value in attrs:
            if value and key in ("href", "src"):
                self.links.add(value)
            elif value and key in ("id", "name"):
                self.places.add(value)


@cache
def page(path: Path) -> Page:
    return Page(path.read_text(encoding="utf-8", errors="replace"))


def broken(path: Path, site: Path) -> Iterator[str]:
    """Links of a page that lead nowhere."""
    for link in sorted(page(path).links):
        parts = urlsplit(link)
        if parts.scheme or parts.netloc:
            continue
        target = path if not parts.path else (path.parent / unquote(parts.path)).resolve()
        if target.is_dir():
            target /= "index.html"
        places = {parts.fragment, unquote(parts.fragment)}
        if target.is_relative_to(site / "rust" / "trait.impl"):
            continue  # lists of other crates' implementations, which rustdoc asks for even where there are none
        if parts.path.startswith("/") or not target.is_relative_to(site) or not target.is_file():
            yield link
        elif parts.fragment and target.suffix == ".html" and not (page(target).places & places or is_line_of_source(target, site)):
            yield link


def is_line_of_source(target: Path, site: Path) -> bool:
    """Lines of rustdoc's source pages get their places when they are shown."""
    return target.is_relative_to(site / "rust" / "src")


def main() -> int:
    site = Path(sys.argv[1]).resolve()
    pages = sorted(site.rglob("*.html"))
    found = [(path, link) for path in pages if path.name != "404.html" for link in broken(path, site)]
    for path, link in found:
        print(f"{path.relative_to(site)}: {link} leads nowhere")
    print(f"{len(pages)} pages, {len(found)} broken links")
    return 1 if found or not pages else 0


if __name__ == "__main__":
    sys.exit(main())
