# SPDX-License-Identifier: Apache-2.0
"""Problems and plans of the League of Robot Runners: read, planned, checked, driven."""
