# SPDX-License-Identifier: Apache-2.0
"""Ten questions that people ask of an assistant, and the tools that answer them."""

# The question, the tool, its arguments.
QUESTIONS = (
    ("What runs?", "list_simulations", {}),
    ("How is it going?", "describe_warehouse", {}),
    ("Why is pick3 waiting?", "why_waiting", {"what": "pick3"}),
    ("Where is robot 2?", "find", {"what": "kiva2"}),
    ("Where is unit 12, and what lies on it?", "find", {"what": "unit 12"}),
    ("Which orders wait?", "list_orders", {"state": "OPEN"}),
    ("What does pick1 work on?", "describe_station", {"station": "pick1"}),
    ("Who needs help?", "alarms", {}),
    ("What happened lately?", "recent_events", {}),
    ("How do I record a shift?", "search_documentation", {"words": "record a shift"}),
)
