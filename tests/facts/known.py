"""Facts that are not read as they say, and why."""

KNOWN = {
    "haas_g28_alone": "it asks for a refusal for want of a source; the operator's manual (96-8000, "
    "G28) says that all axes go to machine zero at once",
    "haas_g12_pocket": "it asks for a refusal, for other controls have no such pocket; in its own "
    "it stays as it stands, and no place is known behind it",
    "siemens_mcall": "it names neither a motion code nor a feed, so settings of the control decide "
    "both (MD20150); with G0 and F before, tests/test_siemens.py reads it as the fact says",
    "klipper_g92_bare_zeroes": "G92 alone is refused: firmware differs in what it sets",
    "prusa_g92_bare_nothing": "G92 alone is refused: firmware differs in what it sets",
    "rrf_r_beats_ij": "an arc with R and a centre is refused in every dialect",
    "smoothie_g4_p_plus_s": "a dwell with two times is refused in every dialect",
    "g2_slash_deletes": "it asks for a refusal, for other controls have a switch; g2core has none "
    "(gcode_parser), and in another control such a block is refused",
    "mach3_dwell_unit_setting": "in its own control G4 stays as it stands, whatever P counts; "
    "tests/test_more_controls.py asks that no other control is given it",
    "okuma_dwell_unit_setting": "as mach3_dwell_unit_setting, of F",
    "okuma_g71_m53_return": "cycles of an Okuma are refused by name",
    "okuma_word_expression": "variables of an Okuma are refused",
    "marlin_g61_returns": "G60 and G61, a place that firmware stores, are refused by name",
    "marlin_g90_cancels_m83": "firmware differs in whether G90 makes E absolute: it is asked for",
    "marlin_m200_volume": "M200, E as a volume, is refused by name",
}
