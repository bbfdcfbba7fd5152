"""Links of notebooks to pages of the guide, which in the repository are Markdown and in the site HTML."""

from __future__ import annotations

import re
from typing import Any


def on_page_content(html: str, *, page: Any, **_: Any) -> str:
    if not page.file.src_uri.endswith(".ipynb"):
        return html
    return re.sub(r'(href="[^":]+)\.(?:md|ipynb)(["#])', r"\1.html\2", html)
