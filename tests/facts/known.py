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
    "diameters": """
        frames_diameter frames_diameter_arc frames_diameter_g53 frames_diameter_g92
        frames_diameter_incremental lcnc_g10_l20_diameter lcnc_g7_x_diameter_i_radial
    """,
    "motion tied to the spindle": """
        others_constant_speed others_thread
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
    "reference points": """
        grbl_g28_through grbl_g28_z_only homes_g28_1 homes_g28_all homes_g28_incremental
        homes_g28_plunges homes_g28_shifted homes_g28_through homes_g28_x_and_y homes_g30
        lcnc_g28_incremental_z0 lcnc_g28_intermediate_then_home lcnc_g28_no_words_all_axes
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
    "tool lengths": """
        grbl_g43_1 lengths_g43_1 lengths_g43_1_incremental lengths_g43_2 lengths_g43_h
        lengths_g43_loaded lengths_g43_vector lengths_g49
    """,
    "tool tables": """
        lengths_t_unknown
    """,
    "work offsets and shifts": """
        frames_arc_in_a_shift frames_g10_l2 frames_g10_l20 frames_g10_l2_active
        frames_g10_l2_rotated frames_g10_l2_twice frames_g52 frames_g52_replaces_g92 frames_g53
        frames_g53_feed frames_g53_modal frames_g55 frames_g59_3 frames_g92 frames_g92_1
        frames_g92_2 frames_g92_and_g55 frames_g92_incremental grbl_g10_l2 grbl_g10_without_p
        grbl_g53_absolute_in_g91 grbl_g92 lcnc_g10_l2_ignores_g91 lcnc_g52_replaces_g92
        lcnc_g92_survives_g55 lengths_g53_length
    """,
}
KNOWN = {name: reason for reason, names in WAITING.items() for name in names.split()}
