# SPDX-License-Identifier: Apache-2.0
"""What a database's journal keeps in memory: nothing of orders that are over."""

from operations_site import site

from warehouse_operations import Operations


def sizes(journal):
    """The length of each container of a journal, by name."""
    return {
        name: len(of) for name, of in vars(journal).items() if isinstance(of, dict | set | list)
    }


def test_orders_that_are_over_take_no_memory(tmp_path):
    with Operations(site=site(), database=tmp_path / "run.db", orders="none") as ops:
        after = []
        for _ in range(3):
            for _ in range(4):
                ops.shift.submit([("sku-1", 1)])
            ops.run(minutes=10)
            after.append(sizes(ops.shift.journal))
        assert not ops.shift.orders
        assert after[0] == after[1] == after[2]
