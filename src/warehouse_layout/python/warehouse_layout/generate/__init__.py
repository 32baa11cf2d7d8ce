# SPDX-License-Identifier: Apache-2.0
"""Makes layouts: from counts, for the free floor of another world, by name."""
