# SPDX-License-Identifier: Apache-2.0
"""Learning for several robots in RWARE's task: IPPO and MAPPO in numpy, policies as files, and the
statistics of several trainings."""
