# SPDX-License-Identifier: Apache-2.0
"""The hub over HTTP: its requests, their description, and the pages that it passes on."""
