# SPDX-License-Identifier: Apache-2.0
"""Content security policies: which inline scripts and styles a page may have."""

import base64
import hashlib

# A report is a document of its own, with its style in it: it may show itself, and reach nothing.
REPORT_CONTENT = (
    "sandbox allow-scripts allow-downloads allow-modals; default-src 'none'; img-src data:;"
    " font-src data:; style-src 'unsafe-inline'; script-src 'unsafe-inline';"
    " frame-ancestors 'none'"
)


def csp_source(text: str) -> str:
    """Returns the source by which a policy allows an inline script or style of this text (Content
    Security Policy Level 3, hash-source)."""
    return f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"
