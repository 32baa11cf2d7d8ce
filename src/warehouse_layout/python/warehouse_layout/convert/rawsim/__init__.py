# SPDX-License-Identifier: Apache-2.0
"""Files of RAWSim-O: instances, layout configurations, and how its stations work."""
