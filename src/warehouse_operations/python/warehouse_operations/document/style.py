# SPDX-License-Identifier: Apache-2.0
"""The style of a report: on a screen of any width, dark and light, and on A4."""

from warehouse_layout.drawing import page_font
from warehouse_operations.document import tokens

NARROW = 620  # [px] below which charts are drawn narrow
STYLE = f"""
* {{ box-sizing: border-box; }}
html {{ background: var(--page); color: var(--text);
  font: 400 100%/1.5 Inter, system-ui, "DejaVu Sans", sans-serif; }}
body {{ margin: 0; font-size: .875rem; font-variant-numeric: tabular-nums; }}
main {{ max-width: 808px; margin: 32px auto; padding: 40px 64px 48px; background: var(--panel);
  border: 1px solid var(--line); border-radius: 8px; }}
h1, h2, h3, h4, p, figure, dl, dd, ul {{ margin: 0; padding: 0; }}
h1, h2, h3, h4 {{ font-weight: 650; line-height: 1.25; letter-spacing: -.01em;
  break-after: avoid; }}
a {{ color: var(--accent); }}
.kind {{ display: flex; flex-wrap: wrap; justify-content: space-between; gap: 2px 16px;
  color: var(--dim); font-size: .8125rem; border-bottom: 1px solid var(--line);
  padding-bottom: 8px; }}
h1 {{ font-size: 1.0625rem; color: var(--dim); font-weight: 550; margin-top: 24px;
  letter-spacing: 0; }}
.answer {{ font-size: 1.375rem; line-height: 1.35; font-weight: 600; letter-spacing: -.012em;
  margin-top: 6px; text-wrap: pretty; }}
.warning {{ color: var(--needs-help); font-weight: 600; margin-top: 12px; }}
.warning::before {{ content: "■ "; }}
.big {{ display: grid; grid-template-columns: repeat(auto-fit, minmax(130px, 1fr)); gap: 16px 24px;
  margin-top: 24px; }}
.big div {{ display: flex; flex-direction: column-reverse; justify-content: flex-end; }}
.big dt {{ color: var(--dim); font-size: .8125rem; line-height: 1.35; }}
.big dd {{ font-size: 1.75rem; font-weight: 650; line-height: 1.2; letter-spacing: -.02em;
  white-space: nowrap; }}
.big small {{ font-size: .8125rem; font-weight: 400; color: var(--dim); letter-spacing: 0; }}
section {{ margin-top: 28px; }}
.first section {{ margin-top: 22px; }}
h2 {{ font-size: 1.0625rem; margin-bottom: 6px; }}
h3 {{ font-size: .875rem; margin: 20px 0 6px; }}
.note {{ color: var(--dim); font-size: .8125rem; max-width: 68ch; text-wrap: pretty; }}
li {{ margin: 3px 0 3px 18px; }}
figure {{ margin-top: 10px; break-inside: avoid; }}
figcaption h3, figcaption h4 {{ font-size: .875rem; margin: 0; text-wrap: balance; }}
.quantity {{ color: var(--dim); font-size: .8125rem; }}
.row {{ display: grid; grid-template-columns: repeat(auto-fit, minmax(280px, 1fr)); gap: 12px 28px;
  align-items: start; }}
svg {{ display: block; max-width: 100%; height: auto; }}
svg text {{ paint-order: stroke; stroke: var(--panel); stroke-width: 3px;
  stroke-linejoin: round; }}
.narrow {{ display: none; }}
.key {{ display: flex; flex-wrap: wrap; gap: 2px 18px; margin-top: 6px; font-size: .8125rem; }}
.key b {{ margin-right: 6px; }}
.facts {{ display: grid; grid-template-columns: max-content 1fr max-content 1fr; gap: 3px 14px;
  font-size: .8125rem; line-height: 1.4; }}
.facts dt {{ color: var(--dim); }}
.facts dt.long {{ grid-column: 1; }}
.facts dd.long {{ grid-column: 2 / -1; }}
.scroll {{ overflow-x: auto; }}
.scroll:focus-visible, summary:focus-visible {{ outline: 2px solid var(--accent); }}
table {{ border-collapse: collapse; font-size: .8125rem; line-height: 1.4; min-width: 60%; }}
th, td {{ padding: 4px 0 4px 15px; text-align: right; vertical-align: baseline;
  border-bottom: 1px solid var(--line); white-space: nowrap; }}
th:first-child, td:first-child {{ text-align: left; padding-left: 0; }}
th {{ font-weight: 550; color: var(--dim); vertical-align: bottom; white-space: normal; }}
tbody th {{ color: var(--text); font-weight: 400; white-space: nowrap; }}
tr {{ break-inside: avoid; }}
thead {{ display: table-header-group; }}
details {{ margin-top: 4px; font-size: .8125rem; color: var(--dim); }}
summary {{ cursor: pointer; width: max-content; padding: 4px 0; }}
details table {{ color: var(--text); }}
.scroll + .scroll {{ margin-top: 20px; }}
.export {{ margin-top: 8px; }}
.export a {{ margin-right: 14px; }}
@media screen and (max-width: 840px) {{ main {{ margin: 0; border: 0; border-radius: 0;
  padding: 24px; }} }}
@media screen and (max-width: {NARROW}px) {{
  main {{ padding: 16px 20px 32px; }} .wide {{ display: none; }} .narrow {{ display: block; }}
  .facts {{ grid-template-columns: max-content 1fr; }} .facts .long {{ grid-column: auto
  !important; }}
  .answer {{ font-size: 1.125rem; }} .big dd {{ font-size: 1.375rem; }}
  summary {{ padding: 12px 0; }} .export a {{ display: inline-block; padding: 12px 0; }}
}}
@page {{ size: A4; margin: 14mm 14mm 15mm; @bottom-right {{ content: counter(page) " / "
  counter(pages); font: 8pt Inter, sans-serif; color: #535f6e; }} }}
@media print {{
  html {{ background: none; }} body {{ font-size: 10pt; }}
  main {{ max-width: none; margin: 0; padding: 0; border: 0; }}
  .first {{ break-after: page; }} .export, details {{ display: none; }}
  .scroll {{ overflow: visible; }} section.short {{ break-inside: avoid; }}
  .answer {{ font-size: 15pt; }}
  .halves {{ columns: 2; column-gap: 28px; }} .halves table {{ width: 100%; }}
  * {{ print-color-adjust: exact; -webkit-print-color-adjust: exact; }}
}}
"""


def css() -> str:
    """Returns the style of a report: its colours, its font and how it is laid out."""
    return tokens.css() + page_font.face() + STYLE
