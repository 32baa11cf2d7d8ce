# SPDX-License-Identifier: Apache-2.0
"""A run as one page, with everything in it: scores, verdicts, and the messages of each case."""

from html import escape

from warehouse_vda5050.conform.log import Entry
from warehouse_vda5050.conform.report.score import Run, Score
from warehouse_vda5050.conform.runner import Result
from warehouse_vda5050.conform.verdict import Verdict

MESSAGES, CHARACTERS = 40, 3000  # at most of a case, and of a message
STYLE = """
:root{color-scheme:light dark;--line:#8884;--good:#197a3d;--bad:#b3261e;--quiet:#777}
body{font:15px/1.5 system-ui,sans-serif;max-width:72rem;margin:2rem auto;padding:0 1rem}
table{border-collapse:collapse;margin:1rem 0}td,th{padding:.2rem .8rem .2rem 0;text-align:left}
tr{border-bottom:1px solid var(--line)}td.n,th.n{text-align:right}
details{border-bottom:1px solid var(--line);padding:.3rem 0}summary{cursor:pointer}
.v{font-weight:600}.conforms{color:var(--good)}.differs{color:var(--bad)}.other{color:var(--quiet)}
pre{white-space:pre-wrap;overflow-wrap:anywhere;font-size:12px;margin:.2rem 0 .2rem 1rem}
@media (prefers-color-scheme:dark){:root{--good:#6fcf8f;--bad:#ff8a80;--quiet:#aaa}}
"""


def page(run: Run) -> str:
    """Returns the document."""
    title = f"{run.vehicle}: VDA 5050 {run.version}"
    parts = [_chapter(run, score) for score in run.chapters]
    return (
        '<!doctype html><html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width">'
        f"<title>{escape(title)}</title><style>{STYLE}</style></head><body><main>"
        f"<h1>{escape(title)}</h1>{_head(run)}{_scores(run)}{''.join(parts)}</main></body></html>\n"
    )


def _head(run: Run) -> str:
    series = f", {run.series}" if run.series else ""
    ended = " It was interrupted." if run.interrupted else ""
    text = f"{run.began}, broker {run.broker}{series}; {run.seconds:.0f} s.{ended}"
    return f"<p>{escape(text)} <b>{escape(run.whole.text)} cases conform.</b></p>"


def _scores(run: Run) -> str:
    rows = "".join(_score(score) for score in [*run.chapters, run.whole])
    heads = "".join(f'<th class="n" scope="col">{verdict.value}</th>' for verdict in Verdict)
    return f'<table><tr><th scope="col">chapter</th>{heads}</tr>{rows}</table>'


def _score(score: Score) -> str:
    cells = "".join(f'<td class="n">{score.counts[verdict] or ""}</td>' for verdict in Verdict)
    name = escape(score.name)
    head = name if name == "all" else f'<a href="#{name}">{name}</a>'
    return f'<tr><th scope="row">{head}</th>{cells}</tr>'


def _chapter(run: Run, score: Score) -> str:
    results = [r for r in run.results if r.case.chapter == score.name]
    name = escape(score.name)
    return f'<h2 id="{name}">{name}</h2>{"".join(_result(result) for result in results)}'


def _result(result: Result) -> str:
    case, verdict = result.case, result.verdict
    kind = verdict.value if verdict in (Verdict.CONFORMS, Verdict.DIFFERS) else "other"
    reason = f"<p>{escape(result.reason)}</p>" if result.reason else ""
    opened = " open" if verdict is Verdict.DIFFERS else ""
    return (
        f'<details{opened} id="{escape(case.id)}"><summary><span class="v {kind}">{verdict.value}'
        f"</span> <b>{escape(case.id)}</b> ({escape(case.section)}) {escape(case.sentence)}"
        f" <small>{result.seconds:.1f} s</small></summary>{reason}{_messages(result)}</details>"
    )


def _messages(result: Result) -> str:
    entries = list(result.entries)
    shown = "".join(map(_message, entries[:MESSAGES]))
    left = len(entries) - MESSAGES
    rest = f"<p>{left} more in messages.jsonl</p>" if left > 0 else ""
    return shown + rest


def _message(entry: Entry) -> str:
    way = "sent" if entry.sent else "received"
    text = entry.text[:CHARACTERS] + (" …" if len(entry.text) > CHARACTERS else "")
    return f"<pre>{entry.time:9.3f} s {way} {escape(entry.topic)} {escape(text)}</pre>"
