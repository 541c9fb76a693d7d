# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
"""What methods of `Plc` and `Mesh` do by functions that need these classes themselves: the modules of such functions put them here, and
the methods find them, so that no module needs one that needs it."""
from __future__ import annotations

from typing import Any, Callable, Dict, TypeVar

_F = TypeVar("_F", bound=Callable[..., Any])
_FUNCTIONS: Dict[str, Callable[..., Any]] = {}


def door(function: _F) -> _F:
    """Lets methods find a function by its name. `pgdr/__init__.py` imports all modules that have one."""
    _FUNCTIONS[function.__name__] = function
    return function


def through(name: str) -> Callable[..., Any]:
    """The function of this name."""
    return _FUNCTIONS[name]
