# SPDX-License-Identifier: Apache-2.0
"""What rostests and programs that look at pages share; imported as `rostest_support`."""
