# SPDX-License-Identifier: Apache-2.0
"""Pictures of the warehouse from above, and the shapes and colours that all pictures share."""
