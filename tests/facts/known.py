"""Facts that do not hold yet, by what they wait for: a fact that holds must leave the list."""

WAITING = {
    "parameters and expressions": """
        values_code_by_expression values_code_by_parameter values_position_of_the_machine
        values_undefined_is_zero
    """,
    "polar words": """
        lexical_polar
    """,
    "subprograms and loops": """
        flow_break flow_call flow_call_is_local flow_do_while flow_if_else flow_m98
        flow_m98_is_global flow_m98_no_time flow_m98_three_times flow_modes_leak
        flow_modes_restored flow_modes_restored_by_sub flow_repeat flow_return_value flow_while
        lcnc_g91_leaks_from_sub lcnc_while_loop
    """,
}
KNOWN = {name: reason for reason, names in WAITING.items() for name in names.split()}

UNFINISHED = {
    "is code that would have to be run": "subprograms and loops",
    "it runs a program that is not in this file": "subprograms and loops",
    "polar words": "polar words",
}
"""What refusals say that name a feature which is not there yet, and the feature."""
