# SPDX-License-Identifier: Apache-2.0
"""Content security policies: which inline scripts and styles a page may have."""

import base64
import hashlib


def csp_source(text: str) -> str:
    """Returns the source by which a policy allows an inline script or style of this text (Content
    Security Policy Level 3, hash-source)."""
    return f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"
