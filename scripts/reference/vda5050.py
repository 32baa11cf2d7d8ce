# SPDX-License-Identifier: Apache-2.0
"""Fields of VDA 5050: what a vehicle makes of each; and the cases of conform."""

from reference.markdown import code, page, prose, table

INTRODUCTION = (
    "A vehicle [of this system](../how-to/vda5050.md) does what a field says (driven), or does so"
    " in any case and refuses an order that says otherwise (checked), or refuses the order"
    " (refused). The error is an `orderError` with the field's name as a reference, in 3.0.0"
    " `UNSUPPORTED_PARAMETER` and the like. Fields that stand nowhere here cost a warning. Names"
    " are those of 2.1.0, and of 3.0.0 where that alone has the field."
)


def written() -> str:
    """Returns the page of fields."""
    from warehouse_vda5050 import field_rules
    from warehouse_vda5050.master.factsheet_fields import FIELDS
    from warehouse_vda5050.vehicle.abilities import ACTIONS, ZONE_ACTIONS

    sections = [section(place, rules) for place, rules in field_rules.TABLE.items()]
    names = [code(name) for name in field_rules.NOT_TOLD]
    left_out = f"## Left out of a state\n\n{', '.join(names)}"
    return page(
        "VDA 5050, field by field",
        INTRODUCTION,
        *sections,
        actions((*ACTIONS, *ZONE_ACTIONS)),
        left_out,
        factsheets(FIELDS),
    )


def section(place, rules) -> str:
    """Returns the fields of one object of a message."""
    rows = [(code(rule.name), rule.use.value, prose(rule.text)) for rule in rules]
    return f"## {place}\n\n{table(['field', '', ''], rows)}"


def factsheets(fields) -> str:
    """Returns what the master makes of the fields of a vehicle's factsheet."""
    text = (
        "The [master](../how-to/vda5050.md#master) reads these fields of a vehicle's factsheet. A"
        " field that is missing limits nothing. One that does not fit the schema is a REFUSED event"
        " with the field and what was expected."
    )
    rows = [
        (", ".join(code(name) for name in names.split(", ")), prose(about))
        for names, about in fields
    ]
    return f"## Factsheets of vehicles\n\n{text}\n\n{table(['field', ''], rows)}"


def actions(known) -> str:
    """Returns the actions, with their parameters."""
    rows = [
        (
            code(action.type),
            ", ".join(action.scopes),
            ", ".join(f"`{name}` ({prose(text)})" for name, _, _, text in action.parameters),
            prose(action.description),
        )
        for action in known
    ]
    return f"## Actions\n\n{table(['action', 'scope', 'parameters', ''], rows)}"


ABOUT_CASES = (
    "`rosrun warehouse_vda5050 conform` [tries a vehicle](../how-to/vda5050-conformance.md) by"
    " these cases. Sections are those of 2.1.0, of 3.0.0 in `version_3` and `zones`. Edges: how"
    " many the vehicle drives at least. Cases marked strict are recommendations, tried with"
    " `--strict`."
)


def cases() -> str:
    """Returns the page of the cases that conform tries."""
    from warehouse_vda5050.conform.cases import CASES

    chapters = dict.fromkeys(case.chapter for case in CASES)
    parts = [chapter(name, [c for c in CASES if c.chapter == name]) for name in chapters]
    return page("VDA 5050, cases of conformance", ABOUT_CASES, *parts)


ABOUT_MASTER_CASES = (
    "`rosrun warehouse_vda5050 conform --master` [tries a master]"
    "(../how-to/vda5050-conformance.md#try-a-master) by these cases. Sections are those of 2.1.0;"
    " of 3.0.0 where the case is for that alone. Cases marked strict are recommendations, tried"
    " with `--strict`."
)


def master_cases() -> str:
    """Returns the page of the cases for masters."""
    from warehouse_vda5050.conform.master.cases import CASES

    chapters = dict.fromkeys(case.chapter for case in CASES)
    parts = [master_chapter(name, [c for c in CASES if c.chapter == name]) for name in chapters]
    return page("VDA 5050, cases of conformance of masters", ABOUT_MASTER_CASES, *parts)


def master_chapter(name, chosen) -> str:
    """Returns the cases of one chapter."""
    rows = [
        (code(case.id), case.section, prose(case.sentence) + (" Strict." if case.strict else ""))
        for case in chosen
    ]
    return f"## {name}\n\n{table(['case', 'section', 'sentence'], rows)}"


def chapter(name, chosen) -> str:
    """Returns the cases of one chapter."""
    rows = [
        (
            code(case.id),
            case.section,
            prose(case.sentence) + (" Strict." if case.strict else ""),
            str(case.edges or ""),
        )
        for case in chosen
    ]
    return f"## {name}\n\n{table(['case', 'section', 'sentence', 'edges'], rows)}"
