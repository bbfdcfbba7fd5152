"""Libraries that only some functions need."""

from __future__ import annotations

import importlib
from typing import Any

from .errors import MissingExtraError


def extra(module: str, name: str) -> Any:
    """Imports a module of the optional dependencies `gyroflex[name]`."""
    try:
        return importlib.import_module(module)
    except ImportError as error:
        problem, remedy = f"{module.partition('.')[0]} cannot be imported: {error}", f"run `pip install gyroflex[{name}]`"
        raise MissingExtraError(problem, "", "", remedy) from error
