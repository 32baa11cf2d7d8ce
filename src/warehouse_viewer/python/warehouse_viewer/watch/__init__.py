# SPDX-License-Identifier: Apache-2.0
"""What a server notes about a running warehouse while no page is open: states, alarms, figures."""
