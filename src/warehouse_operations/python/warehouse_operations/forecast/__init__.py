# SPDX-License-Identifier: Apache-2.0
"""What comes of a shift that runs: it is forked as it stands, and many runs go on from there.

fork.py copies a shift, of_database.py reads one from its database, running.py has one in this
process. ahead.py is a run, workers.py makes many in processes of low priority, bands.py makes a
forecast of them, comparison.py puts two side by side.
"""
