"""Docstrings of the compiled half of the package for the reference: stubs have its types, the module itself its full text."""

from __future__ import annotations

import inspect
from functools import reduce
from typing import Any

import griffe
from gyroflex import _gyroflex

COMPILED = "gyroflex._gyroflex."


class CompiledDocstrings(griffe.Extension):
    """Takes the docstring of the running module wherever it has one."""

    def on_package(self, *, pkg: griffe.Module, **_: Any) -> None:
        pending: list[griffe.Object | griffe.Alias] = list(pkg["_gyroflex"].members.values())
        while pending:
            described = pending.pop()
            if described.is_alias:
                continue
            pending += described.members.values()
            running = reduce(lambda owner, name: getattr(owner, name, None), described.path.removeprefix(COMPILED).split("."), _gyroflex)
            text = inspect.getdoc(running) if running is not None else None
            if text and not described.is_attribute or text and described.path.count(".") > 2:
                described.docstring = griffe.Docstring(text, parent=described, parser="numpy")
