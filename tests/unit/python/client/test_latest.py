# SPDX-License-Identifier: Apache-2.0
"""What wakes a worker thread is never lost."""

from warehouse_client.latest import News


def test_news_that_come_just_as_a_wait_ends_in_vain_are_kept(monkeypatch):
    news = News()

    def in_vain(_timeout):
        news.set()  # by another thread, before this one goes on
        return False

    with monkeypatch.context() as patch:
        patch.setattr(news._event, "wait", in_vain)
        assert not news.wait(0.2)
    assert news.wait(0.0)
    assert not news.wait(0.0)
