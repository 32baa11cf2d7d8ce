# SPDX-License-Identifier: Apache-2.0
"""The warm-up of a shift: the first minutes, in which an empty warehouse fills with work.

MSER-5 (White, "An effective truncation heuristic for bias reduction in simulation output",
Simulation 69, 1997; White, Cobb & Spratt, Proc. 2000 Winter Simulation Conference): means of five
values each; the cut minimises the squared standard error of the mean of the rest. It lies in the
first half: a shorter rest would be too small a sample.
"""

import numpy as np
from numpy.typing import ArrayLike

BATCH = 5


def mser5(series: ArrayLike) -> int:
    """Returns how many of the first values are to be dropped: a multiple of BATCH.

    series: values, (n,), or of several shifts, (shifts, n), whose mean is judged. Of fewer than
    four batches nothing is dropped.
    """
    values = np.atleast_2d(np.asarray(series, float)).mean(axis=0)
    count = len(values) // BATCH
    if count < 4:
        return 0
    batches = values[: count * BATCH].reshape(count, BATCH).mean(axis=1)
    cuts = range(count // 2 + 1)
    errors = [batches[cut:].var() / (count - cut) for cut in cuts]
    return BATCH * int(np.argmin(errors))
