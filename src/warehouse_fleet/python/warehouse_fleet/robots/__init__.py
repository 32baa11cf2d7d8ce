# SPDX-License-Identifier: Apache-2.0
"""Single robots: what they report, how they move, how they fail."""
