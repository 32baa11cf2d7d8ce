# SPDX-License-Identifier: Apache-2.0
"""The steps between the cells of a map, as a graph."""

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix


def steps_between(passable: NDArray[np.bool_]) -> csr_matrix:
    """Returns the steps between passable cells, which are numbered in their order."""
    cells = np.cumsum(passable).reshape(passable.shape) - 1
    across, along = passable[:, :-1] & passable[:, 1:], passable[:-1] & passable[1:]
    starts = np.concatenate([cells[:, :-1][across], cells[:-1][along]])
    ends = np.concatenate([cells[:, 1:][across], cells[1:][along]])
    shape = (cells.max() + 1,) * 2
    return csr_matrix((np.ones(len(starts)), (starts, ends)), shape=shape)
