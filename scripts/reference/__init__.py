# SPDX-License-Identifier: Apache-2.0
"""The generated part of the reference: each page is made from the code that it describes."""

from collections.abc import Callable

PAGES: dict[str, Callable[[], str]] = {}
