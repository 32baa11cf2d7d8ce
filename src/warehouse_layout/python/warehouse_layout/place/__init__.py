# SPDX-License-Identifier: Apache-2.0
"""Places what a layout file describes, and checks that a fleet can work there."""
