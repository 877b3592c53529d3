"""Rotary axes from circular tests with RTCP on."""
