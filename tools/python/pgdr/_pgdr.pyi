# SPDX-FileCopyrightText: 2026 The pgdr authors
# SPDX-License-Identifier: Apache-2.0
# The extension module has no interface of its own; what the package promises is typed in its .py files.
from typing import Any

version: str

def __getattr__(name: str) -> Any: ...
