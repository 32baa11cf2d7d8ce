# SPDX-License-Identifier: Apache-2.0
"""What the HTTP API takes and gives: pydantic models by subject. SI units, radians, frame world."""
