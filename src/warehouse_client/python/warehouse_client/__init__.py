# SPDX-License-Identifier: Apache-2.0
"""What nodes share to talk to a running warehouse: its services, its models, its messages."""
