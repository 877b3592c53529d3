"""Stamps: what has been done to a program, so that it is not done twice."""
