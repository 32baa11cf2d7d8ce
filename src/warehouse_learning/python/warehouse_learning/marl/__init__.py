# SPDX-License-Identifier: Apache-2.0
"""Learning for one robot or several, of RWARE's task or of Warehouses: IPPO and MAPPO in numpy,
policies as files, and the statistics of several trainings."""
