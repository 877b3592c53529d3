"""Facts that do not hold yet, by what they wait for: a fact that holds must leave the list."""

WAITING = {
    "M words are not counted": """
        blocks_m_five
    """,
    "arcs in inches are held to the tolerance of mm": """
        arcs_off_in_inch
    """,
    "canned cycles": """
        cycles_cycle_in_inch cycles_cycle_then_rapid cycles_g73 cycles_g81_below_r
        cycles_g81_default cycles_g81_initial cycles_g81_no_position cycles_g81_r_level
        cycles_g81_repeated cycles_g81_repeated_g91 cycles_g81_zx cycles_g82 cycles_g83
        cycles_g84 cycles_g85 cycles_g86 cycles_g89 fanuc_canned_sticky_motions
        lcnc_cycle_g73_pullback lcnc_cycle_g84_feed_retract_to_initial
        lcnc_cycle_g85_feeds_out_to_R lcnc_cycle_g88_no_retract lcnc_cycle_g99_R
        lcnc_cycle_p_sticky lcnc_cycle_starts_below_R
    """,
    "cutter compensation": """
        cutters_arc_beside cutters_inner_corner cutters_left cutters_outer_corner cutters_right
    """,
    "parameters and expressions": """
        lcnc_expr_float_equal lcnc_expr_left_assoc_power lcnc_number_double_minus
        lcnc_param_assign_after_block lexical_number_double_minus values_and_or
        values_assigned_after values_atan_of_two values_code_by_expression
        values_code_by_parameter values_comparison_is_a_number values_degrees
        values_equal_within values_exists values_fix_is_floor values_fup_is_ceiling
        values_indirect values_minus_binds_first values_minus_parameter values_mod_and_times
        values_named values_not_less_within values_position_of_the_machine
        values_power_from_left values_round_half values_swapped values_times_before_plus
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
    "the end of a program is not asked for": """
        lexical_no_end lexical_percent_frame_without_end lexical_percent_only_at_end
    """,
    "the number of a spindle": """
        lexical_spindle_number
    """,
    "the programs of user codes are not known": """
        blocks_m100_unknown
    """,
    "tool tables": """
        lengths_t_unknown
    """,
    "work offsets and shifts": """
        grbl_g10_without_p
    """,
}
KNOWN = {name: reason for reason, names in WAITING.items() for name in names.split()}
