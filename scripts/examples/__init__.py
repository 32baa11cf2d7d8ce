# SPDX-License-Identifier: Apache-2.0
"""The examples of the documentation: where they stand, and how each kind is run."""
