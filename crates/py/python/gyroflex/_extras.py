"""Libraries that only some functions need."""

from __future__ import annotations

import importlib
from typing import Any

from .errors import MissingExtraError


def extra(module: str, name: str) -> Any:
    """Imports a module of the optional dependencies `name` of the wheel."""
    try:
        return importlib.import_module(module)
    except ImportError as error:
        problem = f"{module.partition('.')[0]} cannot be imported: {error}"
        remedy = f'run `pip install "./crates/py[{name}]"` in the repository of gyroflex'
        raise MissingExtraError(problem, "", "", remedy) from error
