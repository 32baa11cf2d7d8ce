# SPDX-License-Identifier: Apache-2.0
"""The program `layout`: checks, draws, converts and makes layout files; and the progress line of
all long programs."""
