"""Docstrings of the compiled half of the package for the reference: stubs have its types, the module itself its full text."""

from __future__ import annotations

import inspect
from typing import Any

import griffe
from gyroflex import _gyroflex


class CompiledDocstrings(griffe.Extension):
    """Takes the docstrings of the compiled classes where they are more than the first line that the stubs have."""

    def on_package(self, *, pkg: griffe.Module, **_: Any) -> None:
        for name in _gyroflex.__all__:
            running, described = getattr(_gyroflex, name), pkg["_gyroflex"][name]
            described = described.final_target if described.is_alias else described
            explain(described, running)
            for member in described.members.values():
                explain(member, getattr(running, member.name, None))


def explain(described: Any, running: object) -> None:
    text = inspect.getdoc(running)
    if text and "\n" in text:
        described.docstring = griffe.Docstring(text, parent=described, parser="numpy")
